//! Neo-Hookean hyperelasticity, volume and shape apart: `W = G/2 (tr b J^(-2/3) - 3) + K/2 ((J^2 - 1)/2 - ln J)`, so
//! `sigma = G J^(-5/3) dev b + K/2 (J - 1/J) I`.

use super::hyper;
use crate::Failure;
use crate::declare::{Entry, Parameter, Range, unit};
use crate::material::{HyperLaw, Material, Slopes};
use crate::tensor::{Scalar, Tensor2};

pub(super) const BULK: Parameter = Parameter {
    key: "bulk",
    meaning: "bulk modulus of the undeformed solid",
    unit: unit::STRESS,
    range: Range::POSITIVE,
    default: None,
};

pub(super) const SHEAR: Parameter = Parameter {
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

    /// With `dJ = J/2 b^-1 : db`.
    fn stress_with_slopes(&self, b: &Tensor2, slopes: &mut Slopes) -> Result<Tensor2, Failure> {
        let (j, [xx, yy, zz, xy, yz, xz]) = (b.det().sqrt(), b.inverse().to_voigt());
        let (scale, volume) = (self.shear * (-5.0 / 3.0 * j.ln()).exp(), [xx, yy, zz, 2.0 * xy, 2.0 * yz, 2.0 * xz]);
        let (shape, normal) = ((b.deviator() * scale).to_voigt(), 0.25 * self.bulk * (j + 1.0 / j));
        for (r, row) in slopes.iter_mut().enumerate() {
            let along = -5.0 / 6.0 * shape[r] + if r < 3 { normal } else { 0.0 };
            *row = volume.map(|volume| along * volume);
            row[r] += scale;
            if r < 3 {
                row[..3].iter_mut().for_each(|slope| *slope -= scale / 3.0);
            }
        }
        Ok(Tensor2::from_voigt(shape) + Tensor2::identity() * pressure(self.bulk, j))
    }

    fn energy(&self, b: &Tensor2) -> f64 {
        let j = b.det().sqrt();
        let shape = b.trace() * (-2.0 / 3.0 * j.ln()).exp();
        0.5 * self.shear * (shape - 3.0) + volume_energy(self.bulk, j)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::hyper::by_duals;

    #[test]
    fn slopes_are_those_of_dual_numbers() {
        let law = NeoHookean { shear: 0.7, bulk: 2.3 };
        let b = Tensor2::from_voigt([1.3, 0.8, 1.1, 0.2, -0.3, 0.1]);
        let (mut written, mut dual) = (Slopes::default(), Slopes::default());
        let stress = law.stress_with_slopes(&b, &mut written).unwrap();
        let residue = by_duals(&law, &b, &mut dual).unwrap() - stress;
        assert!(residue.contract(residue).sqrt() < 1e-15);
        for (x, y) in written.as_flattened().iter().zip(dual.as_flattened()) {
            assert!((x - y).abs() < 1e-14, "{x} against {y}");
        }
    }
}
