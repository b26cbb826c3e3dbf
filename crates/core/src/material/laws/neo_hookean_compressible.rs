//! Compressible neo-Hookean hyperelasticity whose volume and shape are not apart (Simo and Pister 1984):
//! `W = G/2 (tr b - 3) - G ln J + lambda/2 (ln J)^2`, so `J sigma = G (b - I) + lambda ln J I`, `lambda = K - 2/3 G`.

use super::hyper;
use super::neo_hookean::{BULK, SHEAR};
use crate::Failure;
use crate::declare::Entry;
use crate::material::{HyperLaw, Material};
use crate::tensor::{Scalar, Tensor2};

pub(super) const ENTRY: Entry<Box<dyn Material>> = Entry {
    name: "neo_hookean_compressible",
    meaning: "neo-Hookean hyperelasticity of compressible solids, volume and shape coupled (Simo and Pister)",
    parameters: &[SHEAR, BULK],
    pairs: None,
    build: |v| Ok(hyper(NeoHookeanCompressible { shear: v[0], lambda: v[1] - 2.0 / 3.0 * v[0] })),
};

/// The law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NeoHookeanCompressible {
    /// Shear modulus of the undeformed solid.
    pub shear: f64,
    /// Lame's first constant of the undeformed solid.
    pub lambda: f64,
}

impl HyperLaw for NeoHookeanCompressible {
    const APART: bool = false;

    fn stress<T: Scalar>(&self, b: &Tensor2<T>) -> Result<Tensor2<T>, Failure> {
        let j = b.det().sqrt();
        let volume = j.ln() * self.lambda - self.shear;
        Ok((*b * T::from(self.shear) + Tensor2::identity() * volume) * j.recip())
    }

    fn energy(&self, b: &Tensor2) -> f64 {
        let log = 0.5 * b.det().ln();
        0.5 * self.shear * (b.trace() - 3.0) - self.shear * log + 0.5 * self.lambda * log * log
    }
}
