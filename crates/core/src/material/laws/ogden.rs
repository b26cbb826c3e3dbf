//! Ogden's hyperelasticity in principal stretches, volume and shape apart (Ogden 1972):
//! `W = sum_i mu_i/alpha_i (l_1^alpha_i + l_2^alpha_i + l_3^alpha_i - 3) + K/2 ((J^2 - 1)/2 - ln J)` of the stretches
//! `l_a = lambda_a J^(-1/3)`, so `J sigma_a = sum_i mu_i (l_a^alpha_i - mean) + K/2 (J^2 - 1)`. The shear modulus is
//! `sum_i mu_i alpha_i / 2`.

use super::hyper;
use super::neo_hookean::{BULK, pressure, volume_energy};
use crate::Failure;
use crate::declare::{Entry, Pairs};
use crate::material::{HyperLaw, Material, Slopes};
use crate::tensor::{Isotropic, Scalar, Tensor2, principal};

const TERMS: Pairs = Pairs { key: "terms", meaning: "pairs [modulus mu (stress), exponent alpha]", least: 1, most: 16 };

pub(super) const ENTRY: Entry<Box<dyn Material>> = Entry {
    name: "ogden",
    meaning: "Ogden's hyperelasticity in principal stretches",
    parameters: &[BULK],
    pairs: Some(TERMS),
    build: |v| {
        let law = Ogden { bulk: v[0], terms: v[1..].as_chunks().0.to_vec() };
        match law.terms.iter().find(|[mu, alpha]| mu * alpha <= 0.0) {
            Some([mu, alpha]) => Err(format!("the term [{mu}, {alpha}] of `terms` must have a positive product")),
            None => Ok(hyper(law)),
        }
    },
};

/// The law.
#[derive(Debug, Clone, PartialEq)]
pub struct Ogden {
    /// Bulk modulus.
    pub bulk: f64,
    /// Modulus and exponent of each term.
    pub terms: Vec<[f64; 2]>,
}

/// From principal values of `b` to those of the Cauchy stress.
impl Isotropic for Ogden {
    fn principal<S: Scalar>(&self, b: [S; 3]) -> Result<[S; 3], Failure> {
        let j = (b[0] * b[1] * b[2]).sqrt();
        let shape = j.powf(-2.0 / 3.0);
        let mut stress = [S::zero(); 3];
        for [mu, alpha] in &self.terms {
            let powers = b.map(|b| (b * shape).powf(0.5 * alpha) * *mu);
            let mean = (powers[0] + powers[1] + powers[2]) * (1.0 / 3.0);
            stress.iter_mut().zip(powers).for_each(|(s, power)| *s += power - mean);
        }
        Ok(stress.map(|s| s / j + pressure(self.bulk, j)))
    }
}

impl HyperLaw for Ogden {
    fn stress<T: Scalar>(&self, b: &Tensor2<T>) -> Result<Tensor2<T>, Failure> {
        self.of(b)
    }

    fn stress_with_slopes(&self, b: &Tensor2, slopes: &mut Slopes) -> Result<Tensor2, Failure> {
        self.with_slopes(b, slopes)
    }

    fn energy(&self, b: &Tensor2) -> f64 {
        let j = b.det().sqrt();
        let squares = principal(b).0.map(|b| b * j.powf(-2.0 / 3.0));
        let term =
            |[mu, alpha]: &[f64; 2]| mu / alpha * (squares.iter().map(|l| l.powf(0.5 * alpha)).sum::<f64>() - 3.0);
        self.terms.iter().map(term).sum::<f64>() + volume_energy(self.bulk, j)
    }
}
