//! The eight chains of Arruda and Boyce (1993), volume and shape apart, by the first five terms of the inverse Langevin
//! function: `W = mu sum_i a_i/l^(2 i - 2) (I1^i - 3^i) + K/2 ((J^2 - 1)/2 - ln J)`, `a = 1/2, 1/20, 11/1050, 19/7000,
//! 519/673750`, with the stretch `l` at which chains are straight. The shear modulus of the undeformed solid is
//! `2 W'(3)`, above `mu`: `mu (1 + 3/(5 l^2) + 99/(175 l^4) + 513/(875 l^6) + 42039/(67375 l^8))`.

use super::hyper;
use super::isochoric::{coefficient, invariants, stress};
use super::neo_hookean::{BULK, volume_energy};
use crate::Failure;
use crate::declare::{Entry, Parameter, Range, unit};
use crate::material::{HyperLaw, Material};
use crate::tensor::{Scalar, Tensor2};

const LOCKING: Parameter = Parameter {
    key: "locking_stretch",
    meaning: "stretch at which chains are straight",
    unit: unit::NONE,
    range: Range { least: Some((1.0, false)), most: None },
    default: None,
};

pub(super) const ENTRY: Entry<Box<dyn Material>> = Entry {
    name: "arruda_boyce",
    meaning: "hyperelasticity of Arruda and Boyce, eight chains of limited length",
    parameters: &[
        coefficient("modulus", "rubber modulus mu, somewhat below the shear modulus", Range::POSITIVE, None),
        LOCKING,
        BULK,
    ],
    pairs: None,
    build: |v| Ok(hyper(ArrudaBoyce { modulus: v[0], locking: v[1], bulk: v[2] })),
};

/// The law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArrudaBoyce {
    /// Rubber modulus.
    pub modulus: f64,
    /// Stretch at which chains are straight.
    pub locking: f64,
    /// Bulk modulus.
    pub bulk: f64,
}

/// Terms of the energy.
const TERMS: [f64; 5] = [1.0 / 2.0, 1.0 / 20.0, 11.0 / 1050.0, 19.0 / 7000.0, 519.0 / 673_750.0];

impl ArrudaBoyce {
    /// Power and factor of each term.
    fn terms(&self) -> [(i32, f64); 5] {
        let square = self.locking * self.locking;
        std::array::from_fn(|k| (k as i32 + 1, self.modulus * TERMS[k] / square.powi(k as i32)))
    }
}

impl HyperLaw for ArrudaBoyce {
    fn stress<T: Scalar>(&self, b: &Tensor2<T>) -> Result<Tensor2<T>, Failure> {
        Ok(stress(b, self.bulk, |[first, _]| {
            // Horner's rule from the highest power.
            let slope = self.terms().iter().rev().fold(T::zero(), |sum, &(i, a)| sum * first + f64::from(i) * a);
            [slope, T::zero()]
        }))
    }

    fn energy(&self, b: &Tensor2) -> f64 {
        let first = invariants(b)[0];
        let shape: f64 = self.terms().iter().map(|&(i, a)| a * (first.powi(i) - 3.0_f64.powi(i))).sum();
        shape + volume_energy(self.bulk, b.det().sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Hyper;

    /// The series against the inverse Langevin function itself, found by halving: `W' = mu l/(6 L) L^-1(L/l)` with the stretch
    /// `L = sqrt(I1/3)` of a chain.
    #[test]
    fn chains_follow_the_inverse_langevin_function() {
        let law = ArrudaBoyce { modulus: 0.4, locking: 3.0, bulk: 1e3 };
        for stretch in [1.0_f64, 1.1, 1.3, 1.5] {
            let first = stretch * stretch + 2.0 / stretch;
            let chain = (first / 3.0).sqrt();
            let (mut low, mut high) = (1e-9_f64, 50.0_f64);
            for _ in 0..200 {
                let beta = 0.5 * (low + high);
                *(if beta.tanh().recip() - beta.recip() < chain / law.locking { &mut low } else { &mut high }) = beta;
            }
            let slope = law.modulus * law.locking / (6.0 * chain) * low;
            let b = Tensor2::from_voigt([stretch * stretch, 1.0 / stretch, 1.0 / stretch, 0.0, 0.0, 0.0]);
            let stress = law.stress(&b).unwrap();
            let drawn = 2.0 * slope * (stretch * stretch - 1.0 / stretch);
            let found = stress[(0, 0)] - stress[(1, 1)];
            assert!((found - drawn).abs() <= 1e-3 * drawn + 1e-12, "{stretch}: {found} {drawn}");
        }
        let square = 9.0_f64;
        let shear = 1.0 + 0.6 / square + 99.0 / 175.0 / square.powi(2) + 513.0 / 875.0 / square.powi(3);
        let shear = law.modulus * (shear + 42_039.0 / 67_375.0 / square.powi(4));
        assert!((Hyper(law).moduli()[1] / shear - 1.0).abs() < 1e-12);
    }
}
