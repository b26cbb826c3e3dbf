//! Von Mises' plasticity with any curve of isotropic hardening and with kinematic hardening by one back stress (Prager, or
//! Armstrong and Frederick 1966) or by the sum of three (Chaboche 1986): `f = q(s - X) - sy(p)`, flow along
//! `N = 3/2 (s - X)/q`, `X = sum_i X_i`, `dX_i = (2/3 C_i N - gamma_i X_i) dp`.
//!
//! Backward Euler leaves one equation in the increment `dp`: with `w_i = 1/(1 + gamma_i dp)` the direction of `s - X` is
//! that of `s_trial - sum_i w_i X_i,n`, and `q(s_trial - sum_i w_i X_i,n) - (3 G + sum_i w_i C_i) dp = sy(p_n + dp)`.
//! Where the flow stress depends on the rate it is that of `dp/dt`, and without time nothing flows.

use super::elastic::Elastic;
use super::hardening::{FlowStress, Hardening, Kind};
use super::rate;
use crate::Failure;
use crate::declare::{Entry, Parameter, Range, VariableKind, unit};
use crate::integrate::{System, Update, root};
use crate::material::{Flow, Lapse, Material, RateLaw, ScalarsAndTensors, Spin, Variable};
use crate::tensor::{Scalar, Tensor2};

const fn modulus(key: &'static str, meaning: &'static str, default: Option<f64>) -> Parameter {
    Parameter { key, meaning, unit: unit::STRESS, range: Range::NOT_NEGATIVE, default }
}

const fn recovery(key: &'static str, meaning: &'static str) -> Parameter {
    Parameter { key, meaning, unit: unit::NONE, range: Range::NOT_NEGATIVE, default: Some(0.0) }
}

const ONE_BACK: &[Parameter] = &[
    modulus("kinematic", "modulus C of the kinematic hardening (Prager): dX = 2/3 C dep", Some(0.0)),
    recovery(
        "recovery",
        "dynamic recovery gamma of the back stress (Armstrong and Frederick), which saturates at C/gamma",
    ),
];

const THREE_BACKS: &[Parameter] = &[
    modulus("kinematic_1", "modulus C of the first back stress: dX = 2/3 C dep - gamma X dp", None),
    recovery("recovery_1", "dynamic recovery gamma of the first back stress, which saturates at C/gamma"),
    modulus("kinematic_2", "modulus of the second back stress", Some(0.0)),
    recovery("recovery_2", "dynamic recovery of the second back stress"),
    modulus("kinematic_3", "modulus of the third back stress", Some(0.0)),
    recovery("recovery_3", "dynamic recovery of the third back stress"),
];

pub(super) const COMBINED: Entry<Box<dyn Material>> = Entry {
    name: "von_mises",
    meaning: "von Mises plasticity with linear and saturating (Voce) hardening",
    parameters: &Kind::Combined.between::<10>(ONE_BACK),
    pairs: None,
    build: |v| build::<1>(v, Kind::Combined, &["kinematic"]),
};

pub(super) const SWIFT: Entry<Box<dyn Material>> = Entry {
    name: "von_mises_swift",
    meaning: "von Mises plasticity with Swift's power law",
    parameters: &Kind::Swift.between::<7>(ONE_BACK),
    pairs: None,
    build: |v| build::<1>(v, Kind::Swift, &["kinematic"]),
};

pub(super) const TABLE: Entry<Box<dyn Material>> = Entry {
    name: "von_mises_table",
    meaning: "von Mises plasticity with a measured flow curve",
    parameters: &Kind::Table.between::<5>(ONE_BACK),
    pairs: Kind::Table.pairs(),
    build: |v| build::<1>(v, Kind::Table, &["kinematic"]),
};

pub(super) const JOHNSON_COOK: Entry<Box<dyn Material>> = Entry {
    name: "von_mises_johnson_cook",
    meaning: "von Mises plasticity with Ludwik's power law, by rate and temperature (Johnson and Cook)",
    parameters: &Kind::JohnsonCook.between::<12>(ONE_BACK),
    pairs: None,
    build: |v| build::<1>(v, Kind::JohnsonCook, &["kinematic"]),
};

pub(super) const CHABOCHE: Entry<Box<dyn Material>> = Entry {
    name: "chaboche",
    meaning: "von Mises plasticity with up to three back stresses and saturating isotropic hardening (Chaboche)",
    parameters: &Kind::Combined.between::<14>(THREE_BACKS),
    pairs: None,
    build: |v| build::<3>(v, Kind::Combined, &["kinematic_1", "kinematic_2", "kinematic_3"]),
};

fn build<const K: usize>(v: &[f64], kind: Kind, keys: &[&str; K]) -> Result<Box<dyn Material>, String> {
    let elastic = Elastic::new(v[0], v[1]);
    let (hardening, own) = kind.take(v, 2 * K)?;
    let back = std::array::from_fn(|i| BackStress { modulus: own[2 * i], recovery: own[2 * i + 1] });
    for (BackStress { modulus, recovery }, key) in back.iter().zip(keys) {
        if *recovery > 0.0 && *modulus == 0.0 {
            let recovery = key.replace("kinematic", "recovery");
            return Err(format!("`{recovery}` has nothing to recover without `{key}`"));
        }
    }
    hardening.check(3.0 * elastic.shear)?;
    Ok(rate(VonMises::<K> { elastic, hardening, back }))
}

/// The hardening of one back stress.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BackStress {
    /// Modulus C.
    pub modulus: f64,
    /// Dynamic recovery gamma.
    pub recovery: f64,
}

/// The law with `K` back stresses, one or three.
#[derive(Debug, Clone, PartialEq)]
pub struct VonMises<const K: usize = 1> {
    /// Elasticity.
    pub elastic: Elastic,
    /// Flow stress.
    pub hardening: Hardening,
    /// Kinematic hardening.
    pub back: [BackStress; K],
}

/// Contractions of a trial state in an array: `p`, `s:s`, `s:X_i`, `X_i:X_j`.
type Contractions<T> = [T; 11];
/// Where `s:X_1` and `X_i:X_j` stand.
const CROSS: usize = 2;
const PAIRS: [[usize; 3]; 3] = [[5, 6, 7], [6, 8, 9], [7, 9, 10]];

/// The equation of a step.
struct Consistency<'a, const K: usize> {
    law: &'a VonMises<K>,
    flow: FlowStress<'a>,
    /// Stress by which the residual is divided.
    scale: f64,
}

impl<const K: usize> System<1, 11> for Consistency<'_, K> {
    fn residual<S: Scalar>(&self, &[dp]: &[S; 1], data: &Contractions<S>) -> [S; 1] {
        let law = self.law;
        let w = law.left(dp);
        let mut stiffness = S::from(3.0 * law.elastic.shear);
        (0..K).for_each(|i| stiffness += w[i] * law.back[i].modulus);
        [(VonMises::shifted(data, &w) - dp * stiffness - self.flow.after(data[0], dp)) / self.scale]
    }
}

impl<const K: usize> VonMises<K> {
    /// What recovery leaves of each back stress, `w`.
    fn left<S: Scalar>(&self, dp: S) -> [S; K] {
        std::array::from_fn(|i| (dp * self.back[i].recovery + 1.0).recip())
    }

    fn contractions<T: Scalar>(s: &Tensor2<T>, vars: &State<T, K>) -> Contractions<T> {
        let mut data = [T::zero(); 11];
        (data[0], data[1]) = (vars.scalars[0], s.contract(*s));
        for (i, x) in vars.tensors.iter().enumerate() {
            data[CROSS + i] = s.contract(*x);
            (i..K).for_each(|j| data[PAIRS[i][j]] = x.contract(vars.tensors[j]));
        }
        data
    }

    /// `q(s - sum_i w_i X_i)`, where that is zero without the rounding of its square.
    fn shifted<S: Scalar>(data: &Contractions<S>, w: &[S; K]) -> S {
        let mut square = data[1];
        for (i, left) in w.iter().enumerate() {
            square -= data[CROSS + i] * *left * 2.0;
            (0..K).for_each(|j| square += data[PAIRS[i][j]] * *left * w[j]);
        }
        if square.re() > 0.0 { (square * 1.5).sqrt() } else { S::zero() }
    }

    fn bears(flow: &FlowStress, data: &Contractions<f64>) -> bool {
        Self::shifted(data, &[1.0; K]) <= flow.slow(data[0])
    }

    /// Stress and variables with the plastic increment `dp`.
    fn relax<T: Scalar>(&self, trial: &Tensor2<T>, vars: &State<T, K>, dp: T) -> (Tensor2<T>, State<T, K>) {
        let w = self.left(dp);
        let shifted = (0..K).fold(trial.deviator(), |sum, i| sum - vars.tensors[i] * w[i]);
        let flow = shifted * (dp * 1.5 / (shifted.contract(shifted) * 1.5).sqrt());
        let back = |i: usize| (vars.tensors[i] + flow * T::from(2.0 / 3.0 * self.back[i].modulus)) * w[i];
        let stress = *trial - flow * T::from(2.0 * self.elastic.shear);
        (stress, State { scalars: [vars.scalars[0] + dp], tensors: std::array::from_fn(back) })
    }
}

type State<T, const K: usize> = ScalarsAndTensors<T, 1, K>;

const STRAIN: Variable = Variable { name: "equivalent_plastic_strain", kind: VariableKind::Scalar };

const fn back_stress(name: &'static str) -> Variable {
    Variable { name, kind: VariableKind::Symmetric }
}

impl<const K: usize> RateLaw for VonMises<K> {
    type Vars<T: Scalar> = State<T, K>;
    const VARIABLES: &'static [Variable] = if K == 1 {
        &[STRAIN, back_stress("back_stress")]
    } else {
        &[STRAIN, back_stress("back_stress_1"), back_stress("back_stress_2"), back_stress("back_stress_3")]
    };

    fn update<T: Scalar>(
        &self,
        de: Tensor2<T>,
        stress: Tensor2<T>,
        vars: &State<T, K>,
        lapse: Lapse,
    ) -> Result<(Tensor2<T>, State<T, K>), Failure> {
        let flow = self.hardening.over(lapse)?;
        let trial = stress + self.elastic.stress(&de);
        let data = Self::contractions(&trial.deviator(), vars);
        let plain = data.map(T::re);
        if Self::bears(&flow, &plain) || flow.rests() {
            return Ok((trial, *vars));
        }
        let size = |square: f64| (1.5 * square).sqrt();
        let reach = size(plain[1]) + (0..K).map(|i| size(plain[PAIRS[i][i]])).sum::<f64>();
        let equation = Consistency { law: self, flow, scale: reach };
        let dp = root(&equation, [0.0, reach / (3.0 * self.elastic.shear)], &data, "von Mises")?;
        Ok(self.relax(&trial, vars, dp))
    }

    fn serves(&self, update: Update) -> Result<(), String> {
        self.hardening.serves(update)
    }

    fn own_update(&self) -> Option<Update> {
        self.back.iter().any(|back| back.recovery > 0.0).then_some(Update::ADAPTIVE)
    }

    fn own_spin(&self) -> Option<Spin> {
        self.back.iter().any(|back| back.modulus > 0.0).then_some(Spin::Logarithmic)
    }

    fn elastic_step(&self, de: &Tensor2, stress: &Tensor2, vars: &State<f64, K>, lapse: Lapse) -> Option<[f64; 2]> {
        let s = (*stress + self.elastic.stress(de)).deviator();
        let flow = self.hardening.over(lapse).ok()?;
        Self::bears(&flow, &Self::contractions(&s, vars)).then_some([self.elastic.lambda, self.elastic.shear])
    }

    fn flow(&self) -> Flow {
        Flow::Isochoric
    }

    fn stored_energy(&self, stress: &Tensor2, vars: &State<f64, K>) -> f64 {
        let stored = self.back.iter().zip(&vars.tensors).filter(|(back, _)| back.modulus > 0.0);
        let stored = stored.map(|(back, x)| 0.75 * x.contract(*x) / back.modulus);
        self.elastic.energy(stress) + stored.sum::<f64>()
    }

    /// Of the work of the flow what no back stress stores: `(q(s - X) + sum_i 3/2 gamma_i/C_i X_i:X_i) dp`.
    fn dissipation(&self, old: (&Tensor2, &State<f64, K>), new: (&Tensor2, &State<f64, K>)) -> f64 {
        let recovered = self.back.iter().zip(&new.1.tensors).filter(|(back, _)| back.modulus > 0.0);
        let recovered = recovered.map(|(back, x)| 1.5 * back.recovery / back.modulus * x.contract(*x));
        let effective = Self::shifted(&Self::contractions(&new.0.deviator(), new.1), &[1.0; K]);
        (effective + recovered.sum::<f64>()) * (new.1.scalars[0] - old.1.scalars[0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bar that is unloaded through its back stress: what rounding leaves of the square is negative.
    #[test]
    fn a_stress_that_is_the_back_stress_does_not_flow() {
        let mut data = [0.0; 11];
        (data[1], data[2], data[5]) = (13066.66665911514, 13066.666645584806, 13066.66663205447);
        assert_eq!(VonMises::<3>::shifted(&data, &[1.0; 3]), 0.0);
    }
}
