//! Neo-Hookean hyperelasticity, volume and shape apart: `W = G/2 (tr b J^(-2/3) - 3) + K/2 ((J^2 - 1)/2 - ln J)`, so
//! `sigma = G J^(-5/3) dev b + K/2 (J - 1/J) I`.

use super::hyper;
use crate::Failure;
use crate::declare::{Entry, Parameter, Range, unit};
use crate::material::{HyperLaw, Material};
use crate::tensor::{Scalar, Tensor2};

pub(super) const BULK: Parameter = Parameter {
    key: "bulk",
    meaning: "bulk modulus of the undeformed solid",
    unit: unit::STRESS,
    range: Range::POSITIVE,
    default: None,
};

const SHEAR: Parameter = Parameter {
    key: "shear",
    meaning: "shear modulus of the undeformed solid",
    unit: unit::STRESS,
    range: Range::POSITIVE,
    default: None,
};

pub(super) const ENTRY: Entry<Box<dyn Material>> = Entry {
    name: "neo_hookean",
    meaning: "neo-Hookean hyperelasticity",
    parameters: &[SHEAR, BULK],
    pairs: None,
    build: |v| Ok(hyper(NeoHookean { shear: v[0], bulk: v[1] })),
};

/// The law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NeoHookean {
    /// Shear modulus.
    pub shear: f64,
    /// Bulk modulus.
    pub bulk: f64,
}

/// Mean stress at the volume ratio `j`.
pub(super) fn pressure<T: Scalar>(bulk: f64, j: T) -> T {
    (j - j.recip()) * (0.5 * bulk)
}

/// Energy of the volume ratio `j`.
pub(super) fn volume_energy(bulk: f64, j: f64) -> f64 {
    0.5 * bulk * (0.5 * (j * j - 1.0) - j.ln())
}

impl HyperLaw for NeoHookean {
    fn stress<T: Scalar>(&self, b: &Tensor2<T>) -> Result<Tensor2<T>, Failure> {
        let j = b.det().sqrt();
        let scale = j.powf(-5.0 / 3.0) * self.shear;
        Ok(b.deviator() * scale + Tensor2::identity() * pressure(self.bulk, j))
    }

    fn energy(&self, b: &Tensor2) -> f64 {
        let j = b.det().sqrt();
        0.5 * self.shear * (b.trace() * j.powf(-2.0 / 3.0) - 3.0) + volume_energy(self.bulk, j)
    }
}
