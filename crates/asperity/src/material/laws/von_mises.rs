//! Von Mises' plasticity with isotropic hardening (linear and Voce, Swift, a curve) and kinematic hardening (Prager,
//! or Armstrong and Frederick): `f = q(s - X) - sy(p)`, flow along `N = 3/2 (s - X)/q`,
//! `dX = (2/3 C N - gamma X) dp`.
//!
//! Backward Euler leaves one equation in the increment `dp`: with `w = 1/(1 + gamma dp)` the direction of `s - X` is
//! that of `s_trial - w X_n`, and `q(s_trial - w X_n) - (3 G + w C) dp = sy(p_n + dp)`.

use super::elastic::{Elastic, POISSON, YOUNG};
use super::hardening::{CURVE, EXPONENT, Hardening, LINEAR, OFFSET, SATURATION, SATURATION_RATE, STRENGTH, YIELD};
use super::rate;
use crate::Failure;
use crate::declare::{Entry, Parameter, Range, VariableKind, unit};
use crate::integrate::{System, root};
use crate::material::{Flow, Material, RateLaw, ScalarsAndTensor, Variable};
use crate::tensor::{Scalar, Tensor2};

const KINEMATIC: Parameter = Parameter {
    key: "kinematic",
    meaning: "modulus C of the kinematic hardening (Prager): dX = 2/3 C dep",
    unit: unit::STRESS,
    range: Range::NOT_NEGATIVE,
    default: Some(0.0),
};

const RECOVERY: Parameter = Parameter {
    key: "recovery",
    meaning: "dynamic recovery gamma of the back stress (Armstrong and Frederick), which saturates at C/gamma",
    unit: unit::NONE,
    range: Range::NOT_NEGATIVE,
    default: Some(0.0),
};

pub(super) const COMBINED: Entry<Box<dyn Material>> = Entry {
    name: "von_mises",
    meaning: "von Mises plasticity with linear and saturating (Voce) hardening",
    parameters: &[YOUNG, POISSON, YIELD, LINEAR, SATURATION, SATURATION_RATE, KINEMATIC, RECOVERY],
    pairs: None,
    build: |v| {
        let hardening = Hardening::Combined { first: v[2], linear: v[3], saturation: v[4], rate: v[5] };
        if (v[4] == 0.0) != (v[5] == 0.0) {
            return Err("`saturation` and `saturation_rate` need each other".into());
        }
        build(v, hardening, &v[6..8])
    },
};

pub(super) const SWIFT: Entry<Box<dyn Material>> = Entry {
    name: "von_mises_swift",
    meaning: "von Mises plasticity with Swift's power law",
    parameters: &[YOUNG, POISSON, STRENGTH, OFFSET, EXPONENT, KINEMATIC, RECOVERY],
    pairs: None,
    build: |v| build(v, Hardening::Swift { strength: v[2], offset: v[3], exponent: v[4] }, &v[5..7]),
};

pub(super) const TABLE: Entry<Box<dyn Material>> = Entry {
    name: "von_mises_table",
    meaning: "von Mises plasticity with a measured flow curve",
    parameters: &[YOUNG, POISSON, KINEMATIC, RECOVERY],
    pairs: Some(CURVE),
    build: |v| build(v, Hardening::table(&v[4..])?, &v[2..4]),
};

fn build(elastic: &[f64], hardening: Hardening, back: &[f64]) -> Result<Box<dyn Material>, String> {
    let elastic = Elastic::new(elastic[0], elastic[1]);
    let (kinematic, recovery) = (back[0], back[1]);
    if recovery > 0.0 && kinematic == 0.0 {
        return Err("`recovery` has nothing to recover without `kinematic`".into());
    }
    hardening.check(3.0 * elastic.shear)?;
    Ok(rate(VonMises { elastic, hardening, kinematic, recovery }))
}

/// The law.
#[derive(Debug, Clone, PartialEq)]
pub struct VonMises {
    /// Elasticity.
    pub elastic: Elastic,
    /// Flow stress.
    pub hardening: Hardening,
    /// Modulus C of the kinematic hardening.
    pub kinematic: f64,
    /// Recovery gamma of the back stress.
    pub recovery: f64,
}

/// The equation of a step; its data are `s:s`, `s:X`, `X:X` of the trial state and `p` at the beginning.
struct Consistency<'a> {
    law: &'a VonMises,
    /// Stress by which the residual is divided.
    scale: f64,
}

impl System<1, 4> for Consistency<'_> {
    fn residual<S: Scalar>(&self, [dp]: &[S; 1], [ss, sx, xx, p]: &[S; 4]) -> [S; 1] {
        let law = self.law;
        let w = (*dp * law.recovery + 1.0).recip();
        let q = ((*ss - *sx * w * 2.0 + *xx * w * w) * 1.5).sqrt();
        let flow = law.hardening.stress(*p + *dp);
        [(q - *dp * (w * law.kinematic + 3.0 * law.elastic.shear) - flow) / self.scale]
    }
}

impl VonMises {
    /// Whether a trial state with `s:s`, `s:X`, `X:X` lies within yield at the plastic strain `p`.
    fn bears(&self, [ss, sx, xx, p]: [f64; 4]) -> bool {
        (1.5 * (ss - 2.0 * sx + xx)).sqrt() <= self.hardening.stress(p)
    }

    /// Stress and variables with the plastic increment `dp`.
    fn relax<T: Scalar>(&self, trial: &Tensor2<T>, vars: &State<T>, dp: T) -> (Tensor2<T>, State<T>) {
        let w = (dp * self.recovery + 1.0).recip();
        let shifted = trial.deviator() - vars.tensor * w;
        let flow = shifted * (dp * 1.5 / (shifted.contract(shifted) * 1.5).sqrt());
        let back = (vars.tensor + flow * T::from(2.0 / 3.0 * self.kinematic)) * w;
        let stress = *trial - flow * T::from(2.0 * self.elastic.shear);
        (stress, ScalarsAndTensor { scalars: [vars.scalars[0] + dp], tensor: back })
    }
}

type State<T> = ScalarsAndTensor<T, 1>;

impl RateLaw for VonMises {
    type Vars<T: Scalar> = State<T>;
    const VARIABLES: &'static [Variable] = &[
        Variable { name: "equivalent_plastic_strain", kind: VariableKind::Scalar },
        Variable { name: "back_stress", kind: VariableKind::Symmetric },
    ];

    fn update<T: Scalar>(
        &self,
        de: Tensor2<T>,
        stress: Tensor2<T>,
        vars: &State<T>,
        _dt: f64,
    ) -> Result<(Tensor2<T>, State<T>), Failure> {
        let trial = stress + self.elastic.stress(&de);
        let (s, x) = (trial.deviator(), vars.tensor);
        let data = [s.contract(s), s.contract(x), x.contract(x), vars.scalars[0]];
        let [ss, sx, xx, p] = data.map(T::re);
        if self.bears([ss, sx, xx, p]) {
            return Ok((trial, *vars));
        }
        let reach = (1.5 * ss).sqrt() + (1.5 * xx).sqrt();
        let equation = Consistency { law: self, scale: reach };
        let dp = root(&equation, [0.0, reach / (3.0 * self.elastic.shear)], &data, "von Mises")?;
        Ok(self.relax(&trial, vars, dp))
    }

    fn has_back_stress(&self) -> bool {
        self.kinematic > 0.0
    }

    fn elastic_step(&self, de: &Tensor2, stress: &Tensor2, vars: &State<f64>) -> Option<[f64; 2]> {
        let (s, x) = ((*stress + self.elastic.stress(de)).deviator(), vars.tensor);
        let bears = self.bears([s.contract(s), s.contract(x), x.contract(x), vars.scalars[0]]);
        bears.then_some([self.elastic.lambda, self.elastic.shear])
    }

    fn flow(&self) -> Flow {
        Flow::Isochoric
    }

    fn stored_energy(&self, stress: &Tensor2, vars: &State<f64>) -> f64 {
        let back = vars.tensor.contract(vars.tensor);
        let stored = if self.kinematic > 0.0 { 0.75 * back / self.kinematic } else { 0.0 };
        self.elastic.energy(stress) + stored
    }

    fn dissipation(&self, old: (&Tensor2, &State<f64>), new: (&Tensor2, &State<f64>)) -> f64 {
        let (p, back) = (new.1.scalars[0], new.1.tensor);
        let recovered = if self.kinematic > 0.0 { 1.5 * self.recovery / self.kinematic } else { 0.0 };
        (self.hardening.stress(p) + recovered * back.contract(back)) * (p - old.1.scalars[0])
    }
}
