//! Yeoh's hyperelasticity (1993), volume and shape apart:
//! `W = c10 x + c20 x^2 + c30 x^3 + K/2 ((J^2 - 1)/2 - ln J)` with `x = I1 - 3`; the shear modulus is `2 c10`.

use super::hyper;
use super::isochoric::{coefficient, invariants, stress};
use super::neo_hookean::{BULK, volume_energy};
use crate::Failure;
use crate::declare::{Entry, Range};
use crate::material::{HyperLaw, Material};
use crate::tensor::{Scalar, Tensor2};

pub(super) const ENTRY: Entry<Box<dyn Material>> = Entry {
    name: "yeoh",
    meaning: "hyperelasticity of Yeoh, a cubic in the first invariant",
    parameters: &[
        coefficient("c10", "coefficient of I1 - 3, half of the shear modulus", Range::POSITIVE, None),
        coefficient("c20", "coefficient of its square; negative where rubber softens first", Range::ANY, None),
        coefficient("c30", "coefficient of its cube", Range::NOT_NEGATIVE, None),
        BULK,
    ],
    pairs: None,
    build: |v| Yeoh { coefficients: [v[0], v[1], v[2]], bulk: v[3] }.checked().map(hyper),
};

/// The law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Yeoh {
    /// Coefficients of the three powers of `I1 - 3`.
    pub coefficients: [f64; 3],
    /// Bulk modulus.
    pub bulk: f64,
}

impl Yeoh {
    /// The energy must rise with `I1` for every `I1` above 3.
    fn checked(self) -> Result<Self, String> {
        let [c10, c20, c30] = self.coefficients;
        if c20 < 0.0 && c20 * c20 >= 3.0 * c10 * c30 {
            return Err(format!(
                "the stiffness falls to nothing on the way: a negative `c20` must be above {}, the root of 3 `c10` `c30`",
                -(3.0 * c10 * c30).sqrt()
            ));
        }
        Ok(self)
    }
}

impl HyperLaw for Yeoh {
    fn stress<T: Scalar>(&self, b: &Tensor2<T>) -> Result<Tensor2<T>, Failure> {
        let [c10, c20, c30] = self.coefficients;
        Ok(stress(b, self.bulk, |[first, _]| {
            let x = first - 3.0;
            [(x * (3.0 * c30) + 2.0 * c20) * x + c10, T::zero()]
        }))
    }

    fn energy(&self, b: &Tensor2) -> f64 {
        let ([c10, c20, c30], x) = (self.coefficients, invariants(b)[0] - 3.0);
        ((c30 * x + c20) * x + c10) * x + volume_energy(self.bulk, b.det().sqrt())
    }
}
