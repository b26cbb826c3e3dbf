//! Perzyna's viscoplasticity over von Mises: `dp/dt = gamma (q/sy(p) - 1)^n` beyond yield.
//!
//! With the overstress ratio `y = q/sy - 1` at the end of the step, `dp = gamma dt y^n` and
//! `q_trial - 3 G dp = sy(p_n + dp) (1 + y)`: one equation that falls in `y`.

use super::elastic::{Elastic, POISSON, YOUNG};
use super::hardening::YIELD;
use super::invariants::Invariants;
use super::rate;
use crate::Failure;
use crate::declare::{Entry, Parameter, Range, VariableKind, unit};
use crate::integrate::{System, Update, root};
use crate::material::{Creep, Flow, Lapse, Material, RateLaw, Variable};
use crate::tensor::{Scalar, Tensor2};

const HARDENING: Parameter = Parameter {
    key: "hardening",
    meaning: "linear hardening modulus of the yield stress",
    unit: unit::STRESS,
    range: Range::NOT_NEGATIVE,
    default: Some(0.0),
};

const FLUIDITY: Parameter = Parameter {
    key: "fluidity",
    meaning: "rate gamma of plastic strain at twice the yield stress",
    unit: unit::RATE,
    range: Range::POSITIVE,
    default: None,
};

const POWER: Parameter = Parameter {
    key: "power",
    meaning: "power n of the overstress",
    unit: unit::NONE,
    range: Range::from_to(1.0, 100.0),
    default: Some(1.0),
};

pub(super) const ENTRY: Entry<Box<dyn Material>> = Entry {
    name: "perzyna",
    meaning: "elasto-viscoplasticity of Perzyna over von Mises",
    parameters: &[YOUNG, POISSON, YIELD, HARDENING, FLUIDITY, POWER],
    pairs: None,
    build: |v| {
        let elastic = Elastic::new(v[0], v[1]);
        Ok(rate(Perzyna { elastic, first: v[2], hardening: v[3], fluidity: v[4], power: v[5] }))
    },
};

/// The law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Perzyna {
    /// Elasticity.
    pub elastic: Elastic,
    /// First yield stress.
    pub first: f64,
    /// Linear hardening modulus.
    pub hardening: f64,
    /// Fluidity gamma.
    pub fluidity: f64,
    /// Power n.
    pub power: f64,
}

/// The equation in the overstress ratio; its data are `q` of the trial stress and the yield stress at the beginning.
struct Overstress<'a> {
    law: &'a Perzyna,
    dt: f64,
    scale: f64,
}

impl Overstress<'_> {
    fn flow<S: Scalar>(&self, y: S) -> S {
        y.powf(self.law.power) * (self.law.fluidity * self.dt)
    }
}

impl System<1, 2> for Overstress<'_> {
    fn residual<S: Scalar>(&self, [y]: &[S; 1], [q, yield_stress]: &[S; 2]) -> [S; 1] {
        let dp = self.flow(*y);
        let flow = (*yield_stress + dp * self.law.hardening) * (*y + 1.0);
        [(*q - dp * (3.0 * self.law.elastic.shear) - flow) / self.scale]
    }
}

impl RateLaw for Perzyna {
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
        let yield_stress = p * self.hardening + self.first;
        // Without time there is no flow, at whatever stress.
        if at.q.re() <= yield_stress.re() || lapse.dt == 0.0 {
            return Ok((trial, [p]));
        }
        let equation = Overstress { law: self, dt: lapse.dt, scale: at.q.re() };
        let most = at.q.re() / yield_stress.re() - 1.0;
        // All of the trial stress relaxed: the other bound, which keeps large powers finite.
        let relaxed = at.q.re() / (3.0 * self.elastic.shear * self.fluidity * lapse.dt);
        let high = most.min(relaxed.powf(1.0 / self.power));
        let y = root(&equation, [0.0, high], &[at.q, yield_stress], "Perzyna")?;
        let dp = equation.flow(y);
        Ok((at.with(at.p, at.q - dp * (3.0 * self.elastic.shear)), [p + dp]))
    }

    fn creep(&self, stress: &Tensor2, &[p]: &[f64; 1]) -> Option<Creep> {
        let (n, stress) = (self.power, Invariants::of(stress).q);
        let yield_stress = p * self.hardening + self.first;
        let over = (stress / yield_stress - 1.0).max(0.0);
        let slope = if over > 0.0 { self.fluidity * n * over.powf(n - 1.0) / yield_stress } else { 0.0 };
        let hardening = slope * self.hardening * stress / yield_stress;
        Some(Creep {
            stress,
            rate: self.fluidity * over.powf(n),
            slope,
            hardening,
            stiffness: 3.0 * self.elastic.shear,
        })
    }

    fn own_update(&self) -> Option<Update> {
        Some(Update::ADAPTIVE)
    }

    fn elastic_step(&self, de: &Tensor2, stress: &Tensor2, &[p]: &[f64; 1], _: Lapse) -> Option<[f64; 2]> {
        let q = Invariants::of(&(*stress + self.elastic.stress(de))).q;
        (q <= p * self.hardening + self.first).then_some([self.elastic.lambda, self.elastic.shear])
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
