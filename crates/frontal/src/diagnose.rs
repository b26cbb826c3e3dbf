//! Is a matrix with perturbed pivots singular, and if so, along which vector?

use crate::error::Error;
use crate::factor::Factor;
use crate::krylov::multiply;
use crate::solve::Workspace;
use std::fmt;

/// A matrix is called singular if it sends some vector of largest entry one to entries below this, in the equilibrated
/// matrix whose largest entries are near one.
const SINGULAR: f64 = 1e-12;
/// Steps towards the null space; see `check_regular`.
const STEPS: usize = 3;
/// Entries of a null vector that are reported.
const LARGEST: usize = 24;

/// Which unknowns make a matrix singular.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Singular {
    /// Unknowns whose pivots vanished.
    pub unknowns: Vec<usize>,
    /// A vector that the matrix sends to zero, or nearly so: a rigid body mode, if the matrix is a stiffness.
    pub null_vector: NullVector,
}

/// A null vector of a matrix, scaled to a largest entry of one.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct NullVector {
    /// All of its entries, one per unknown.
    pub entries: Vec<f64>,
    /// The unknowns with the largest entries, largest first.
    pub largest: Vec<usize>,
    /// Largest entry of its image under the equilibrated matrix.
    pub residual: f64,
}

impl fmt::Display for Singular {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the matrix is singular: no pivot for unknowns {:?}; its null vector is largest at", self.unknowns)?;
        for &unknown in self.null_vector.largest.iter().take(6) {
            write!(f, " {unknown} ({:.3})", self.null_vector.entries[unknown])?;
        }
        Ok(())
    }
}

/// Iterates `x <- x - (A + E)^-1 A x`, where E holds the perturbations of the pivots: a null vector of A stays as it is
/// and all else shrinks to what E leaves of it.
///
/// # Errors
/// [`Error::Singular`] if there is a null vector.
pub(crate) fn check_regular(factor: &Factor) -> Result<(), Error> {
    let mut work = Workspace::new(factor);
    let mut x = (0..factor.symbolic.pattern.len()).map(start).collect::<Vec<_>>();
    for _ in 0..STEPS {
        let mut correction = factor.times(&x);
        factor.substitute(&mut correction, &mut work);
        x.iter_mut().zip(&correction).for_each(|(x, correction)| *x -= correction);
        normalise(&mut x);
    }
    let residual = factor.times(&x).iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    if residual > SINGULAR {
        return Ok(());
    }
    x.iter_mut().zip(&factor.scaling.columns).for_each(|(x, scale)| *x *= scale);
    normalise(&mut x);
    let null_vector = NullVector { largest: largest(&x), entries: x, residual };
    Err(Error::Singular(Box::new(Singular { unknowns: factor.perturbed().to_vec(), null_vector })))
}

/// A vector with a share of everything: the fractional parts of the multiples of the golden section.
fn start(k: usize) -> f64 {
    (k as f64 * 0.618_033_988_749_894_9).fract() + 0.5
}

fn normalise(x: &mut [f64]) {
    let largest = x.iter().fold(0.0, |largest: f64, x| if x.abs() > largest.abs() { *x } else { largest });
    if largest != 0.0 {
        x.iter_mut().for_each(|x| *x /= largest);
    }
}

fn largest(x: &[f64]) -> Vec<usize> {
    let mut unknowns = (0..x.len()).collect::<Vec<_>>();
    unknowns.sort_by(|&i, &j| x[j].abs().total_cmp(&x[i].abs()));
    unknowns.truncate(LARGEST);
    unknowns
}

impl Factor {
    /// The equilibrated matrix times `x`.
    fn times(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        multiply(&self.symbolic.pattern, &self.values, x, &mut y);
        y
    }
}
