//! Mooney (1940) and Rivlin's (1948) hyperelasticity, volume and shape apart:
//! `W = c10 (I1 - 3) + c01 (I2 - 3) + K/2 ((J^2 - 1)/2 - ln J)`; the shear modulus is `2 (c10 + c01)`.

use super::hyper;
use super::isochoric::{coefficient, invariants, stress};
use super::neo_hookean::{BULK, volume_energy};
use crate::Failure;
use crate::declare::{Entry, Range};
use crate::material::{HyperLaw, Material};
use crate::tensor::{Scalar, Tensor2};

pub(super) const ENTRY: Entry<Box<dyn Material>> = Entry {
    name: "mooney_rivlin",
    meaning: "hyperelasticity of Mooney and Rivlin in the first two invariants",
    parameters: &[
        coefficient("c10", "coefficient of the first invariant", Range::NOT_NEGATIVE, None),
        coefficient("c01", "coefficient of the second invariant", Range::NOT_NEGATIVE, None),
        BULK,
    ],
    pairs: None,
    build: |v| match v[0] + v[1] > 0.0 {
        true => Ok(hyper(MooneyRivlin { first: v[0], second: v[1], bulk: v[2] })),
        false => Err("`c10` and `c01` are both zero: there is no stiffness in shear".into()),
    },
};

/// The law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MooneyRivlin {
    /// Coefficient of the first invariant.
    pub first: f64,
    /// Coefficient of the second.
    pub second: f64,
    /// Bulk modulus.
    pub bulk: f64,
}

impl HyperLaw for MooneyRivlin {
    fn stress<T: Scalar>(&self, b: &Tensor2<T>) -> Result<Tensor2<T>, Failure> {
        Ok(stress(b, self.bulk, |_| [T::from(self.first), T::from(self.second)]))
    }

    fn energy(&self, b: &Tensor2) -> f64 {
        let [first, second] = invariants(b);
        self.first * (first - 3.0) + self.second * (second - 3.0) + volume_energy(self.bulk, b.det().sqrt())
    }
}
