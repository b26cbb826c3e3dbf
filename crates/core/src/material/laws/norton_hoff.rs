//! Norton and Hoff's viscoplasticity with elasticity: `q = K sqrt(3)^(m + 1) (dp/dt)^m`, without a yield stress.
//!
//! Backward Euler: `q + 3 G dt (q/K')^(1/m) = q_trial`, `K' = K sqrt(3)^(m + 1)`.

use super::elastic::{Elastic, POISSON, YOUNG};
use super::invariants::Invariants;
use super::rate;
use crate::Failure;
use crate::declare::{Entry, Parameter, Range, VariableKind, unit};
use crate::integrate::{System, Update, root};
use crate::material::{Creep, Flow, Lapse, Material, RateLaw, Variable};
use crate::tensor::{Scalar, Tensor2};

const CONSISTENCY: Parameter = Parameter {
    key: "consistency",
    meaning: "consistency K (a stress times a time to the power of the sensitivity)",
    unit: unit::STRESS,
    range: Range::POSITIVE,
    default: None,
};

const SENSITIVITY: Parameter = Parameter {
    key: "sensitivity",
    meaning: "sensitivity m to the rate; 1 is a Newtonian fluid",
    unit: unit::NONE,
    range: Range::from_to(0.01, 1.0),
    default: None,
};

pub(super) const ENTRY: Entry<Box<dyn Material>> = Entry {
    name: "norton_hoff",
    meaning: "viscoplasticity of Norton and Hoff with elasticity, without a yield stress",
    parameters: &[YOUNG, POISSON, CONSISTENCY, SENSITIVITY],
    pairs: None,
    build: |v| Ok(rate(NortonHoff::new(Elastic::new(v[0], v[1]), v[2], v[3]))),
};

/// The law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NortonHoff {
    elastic: Elastic,
    /// Equivalent stress at the unit rate of strain.
    unit_stress: f64,
    exponent: f64,
}

impl NortonHoff {
    /// From elasticity, consistency K and sensitivity m.
    pub fn new(elastic: Elastic, consistency: f64, sensitivity: f64) -> Self {
        let unit_stress = consistency * 3.0_f64.powf(0.5 * (sensitivity + 1.0));
        Self { elastic, unit_stress, exponent: 1.0 / sensitivity }
    }
}

/// The equation in `q` as a ratio to the trial one, whose value is the datum.
struct Relaxation<'a> {
    law: &'a NortonHoff,
    dt: f64,
    scale: f64,
}

impl Relaxation<'_> {
    fn flow<S: Scalar>(&self, q: S) -> S {
        (q / self.law.unit_stress).powf(self.law.exponent) * self.dt
    }
}

impl System<1, 1> for Relaxation<'_> {
    fn residual<S: Scalar>(&self, [q]: &[S; 1], [trial]: &[S; 1]) -> [S; 1] {
        [(*q + self.flow(*q) * (3.0 * self.law.elastic.shear) - *trial) / self.scale]
    }
}

impl RateLaw for NortonHoff {
    type Vars<T: Scalar> = [T; 1];
    const VARIABLES: &'static [Variable] =
        &[Variable { name: "equivalent_plastic_strain", kind: VariableKind::Scalar }];

    fn update<T: Scalar>(
        &self,
        de: Tensor2<T>,
        stress: Tensor2<T>,
        &[p]: &[T; 1],
        lapse: Lapse,
    ) -> Result<(Tensor2<T>, [T; 1]), Failure> {
        let trial = stress + self.elastic.stress(&de);
        let at = Invariants::of(&trial);
        if at.q.re() == 0.0 || lapse.dt == 0.0 {
            return Ok((trial, [p]));
        }
        let equation = Relaxation { law: self, dt: lapse.dt, scale: at.q.re() };
        // All of the trial stress relaxed: the other bound, which keeps large powers finite.
        let relaxed = at.q.re() / (3.0 * self.elastic.shear * lapse.dt);
        let high = at.q.re().min(self.unit_stress * relaxed.powf(1.0 / self.exponent));
        let q = root(&equation, [0.0, high], &[at.q], "Norton-Hoff")?;
        Ok((at.with(at.p, q), [p + equation.flow(q)]))
    }

    fn creep(&self, stress: &Tensor2, _: &[f64; 1]) -> Option<Creep> {
        let (n, stress) = (self.exponent, Invariants::of(stress).q);
        let rate = (stress / self.unit_stress).powf(n);
        let slope = n * (stress / self.unit_stress).powf(n - 1.0) / self.unit_stress;
        Some(Creep { stress, rate, slope, hardening: 0.0, stiffness: 3.0 * self.elastic.shear })
    }

    fn own_update(&self) -> Option<Update> {
        Some(Update::ADAPTIVE)
    }

    fn flow(&self) -> Flow {
        Flow::Isochoric
    }

    fn stored_energy(&self, stress: &Tensor2, _: &[f64; 1]) -> f64 {
        self.elastic.energy(stress)
    }

    /// By the trapezoidal rule, exact while a stress relaxes.
    fn dissipation(&self, old: (&Tensor2, &[f64; 1]), new: (&Tensor2, &[f64; 1])) -> f64 {
        0.5 * (Invariants::of(old.0).q + Invariants::of(new.0).q) * (new.1[0] - old.1[0])
    }
}
