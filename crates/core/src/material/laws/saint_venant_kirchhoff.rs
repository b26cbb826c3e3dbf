//! Saint Venant and Kirchhoff's hyperelasticity, linear between Green's strain `E` and the second stress of Piola and
//! Kirchhoff: `W = lambda/2 (tr E)^2 + G E:E`, so `J sigma = lambda tr(E) b + G (b^2 - b)`, `tr E = (tr b - 3)/2`.
//!
//! For large rotations and small strains: pressed to less than 0.58 of its length a bar gives way.

use super::elastic::{Elastic, POISSON, YOUNG};
use super::hyper;
use crate::Failure;
use crate::declare::Entry;
use crate::material::{HyperLaw, Material};
use crate::tensor::{Scalar, Tensor2};

pub(super) const ENTRY: Entry<Box<dyn Material>> = Entry {
    name: "saint_venant_kirchhoff",
    meaning: "hyperelasticity linear in Green's strain, for large rotations and small strains",
    parameters: &[YOUNG, POISSON],
    pairs: None,
    build: |v| Ok(hyper(SaintVenantKirchhoff(Elastic::new(v[0], v[1])))),
};

/// The law, by Lame's constants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SaintVenantKirchhoff(pub Elastic);

impl HyperLaw for SaintVenantKirchhoff {
    const APART: bool = false;

    fn stress<T: Scalar>(&self, b: &Tensor2<T>) -> Result<Tensor2<T>, Failure> {
        let Elastic { lambda, shear } = self.0;
        let volume = (b.trace() - 3.0) * (0.5 * lambda);
        Ok((*b * (volume - shear) + *b * *b * T::from(shear)) * b.det().sqrt().recip())
    }

    fn energy(&self, b: &Tensor2) -> f64 {
        let Elastic { lambda, shear } = self.0;
        let (trace, square) = (0.5 * (b.trace() - 3.0), 0.25 * (b.contract(*b) - 2.0 * b.trace() + 3.0));
        0.5 * lambda * trace * trace + shear * square
    }
}
