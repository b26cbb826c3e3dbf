//! Isotropic linear elasticity between Cauchy stress and Jaumann's rate: `dsigma = lambda tr(de) I + 2 G de`.
//!
//! A rate law is not conservative: a closed cycle of large strain may leave stress behind (theory: Truesdell 1955).

use super::rate;
use crate::Failure;
use crate::declare::{Entry, Parameter, Range, unit};
use crate::material::{Lapse, Material, RateLaw, Variable};
use crate::tensor::{Scalar, Tensor2};

pub(super) const YOUNG: Parameter =
    Parameter { key: "young", meaning: "Young's modulus", unit: unit::STRESS, range: Range::POSITIVE, default: None };

pub(super) const POISSON: Parameter = Parameter {
    key: "poisson",
    meaning: "Poisson's ratio",
    unit: unit::NONE,
    range: Range::between(-1.0, 0.5),
    default: None,
};

pub(super) const ENTRY: Entry<Box<dyn Material>> = Entry {
    name: "elastic",
    meaning: "isotropic linear elasticity of an objective rate",
    parameters: &[YOUNG, POISSON],
    pairs: None,
    build: |v| Ok(rate(Elastic::new(v[0], v[1]))),
};

/// The law, by Lame's constants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elastic {
    /// Lame's first constant.
    pub lambda: f64,
    /// Shear modulus.
    pub shear: f64,
}

impl Elastic {
    /// From Young's modulus and Poisson's ratio.
    pub fn new(young: f64, poisson: f64) -> Self {
        Self {
            lambda: young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)),
            shear: 0.5 * young / (1.0 + poisson),
        }
    }

    /// The stress that a small strain adds.
    #[inline]
    pub fn stress<T: Scalar>(&self, strain: &Tensor2<T>) -> Tensor2<T> {
        let mean = strain.trace() * self.lambda;
        Tensor2::from_fn(|i, j| {
            let shear = strain[(i, j)] * (2.0 * self.shear);
            if i == j { shear + mean } else { shear }
        })
    }

    /// Bulk modulus.
    pub fn bulk(&self) -> f64 {
        self.lambda + 2.0 / 3.0 * self.shear
    }

    /// Energy per volume: `sigma : C^-1 : sigma / 2`.
    pub fn energy(&self, stress: &Tensor2) -> f64 {
        let (mean, deviator) = (stress.trace() / 3.0, stress.deviator());
        0.5 * mean * mean / self.bulk() + 0.25 * deviator.contract(deviator) / self.shear
    }
}

impl RateLaw for Elastic {
    type Vars<T: Scalar> = ();
    const VARIABLES: &'static [Variable] = &[];

    fn update<T: Scalar>(
        &self,
        de: Tensor2<T>,
        stress: Tensor2<T>,
        _: &(),
        _lapse: Lapse,
    ) -> Result<(Tensor2<T>, ()), Failure> {
        Ok((stress + self.stress(&de), ()))
    }

    fn elastic_step(&self, _: &Tensor2, _: &Tensor2, (): &(), _: Lapse) -> Option<[f64; 2]> {
        Some([self.lambda, self.shear])
    }

    fn stored_energy(&self, stress: &Tensor2, _: &()) -> f64 {
        self.energy(stress)
    }
}
