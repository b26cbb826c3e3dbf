//! Is a matrix with perturbed pivots singular, and if so, along which vectors?

use crate::error::FrontalError;
use crate::factor::Factor;
use crate::solve::Workspace;
use crate::vector::{dot, norm, subtract};
use std::fmt;

/// A matrix is called singular if `|A x|` is no more than this share of `|A| |x|` for some vector, in the Euclidean norm and in the
/// equilibrated scale. Measured: up to 1e-13 for the rigid motions of a plate of 40 000 cells that nothing holds, 3e-13 and more for
/// strips that are held at one end, 1 500 to 5 000 times as long as they are thick.
const SINGULAR: f64 = 2e-13;
/// Steps towards the null space; see `check_regular`.
const STEPS: usize = 3;
/// Null vectors looked for at the most: two free bodies in space have twelve rigid motions.
const MOST: usize = 12;
/// Vectors beyond the number of perturbed pivots: a pivot that rounding keeps just above the threshold hides a null
/// vector that the iteration still finds.
const SPARE: usize = 3;
/// Entries of a null vector that are reported.
const LARGEST: usize = 24;

/// Which unknowns make a matrix singular.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Singular {
    /// Unknowns whose pivots vanished.
    pub unknowns: Vec<usize>,
    /// Vectors that the matrix sends to zero, or nearly so: if the matrix is a stiffness they span the rigid motions
    /// of what is not held. At least one, orthogonal in the equilibrated scale, twelve at the most.
    pub null_vectors: Vec<NullVector>,
}

/// A null vector of a matrix, scaled to a largest entry of one.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct NullVector {
    /// All of its entries, one per unknown.
    pub entries: Vec<f64>,
    /// The unknowns with the largest entries, largest first.
    pub largest: Vec<usize>,
    /// `|A x|` over the larger of `|A| |x|` and `|x|`, Euclidean, in the equilibrated scale.
    pub residual: f64,
}

impl fmt::Display for Singular {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the matrix is singular: no pivot for unknowns {:?}", self.unknowns)?;
        for vector in &self.null_vectors {
            write!(f, "; a null vector is largest at")?;
            for &unknown in vector.largest.iter().take(4) {
                write!(f, " {unknown} ({:.3})", vector.entries[unknown])?;
            }
        }
        Ok(())
    }
}

/// Iterates `x <- x - (A + E)^-1 A x`, where E holds the perturbations of the pivots, on orthonormal vectors: null
/// vectors of A stay as they are and all else shrinks to what E leaves of it.
///
/// # Errors
/// [`FrontalError::Singular`] if there are null vectors.
pub(crate) fn check_regular(factor: &Factor) -> Result<(), FrontalError> {
    let mut work = Workspace::new(factor);
    let n = factor.symbolic.pattern.len();
    let count = (factor.perturbed().len() + SPARE).min(MOST).min(n);
    let mut vectors = (0..count).map(|v| (0..n).map(|k| start(k, v)).collect()).collect::<Vec<Vec<f64>>>();
    for _ in 0..STEPS {
        for x in &mut vectors {
            let mut correction = factor.times(x);
            factor.substitute(&mut correction, &mut work);
            subtract(x, 1.0, &correction);
        }
        orthonormalise(&mut vectors);
    }
    let null_vectors = vectors.into_iter().filter_map(|x| null_vector(factor, x)).collect::<Vec<_>>();
    if null_vectors.is_empty() {
        return Ok(());
    }
    Err(FrontalError::Singular(Box::new(Singular { unknowns: factor.perturbed().to_vec(), null_vectors })))
}

/// A vector, in the equilibrated scale, as the caller sees it; `None` if the matrix does not send it to zero.
fn null_vector(factor: &Factor, mut x: Vec<f64>) -> Option<NullVector> {
    let length = norm(&x);
    let residual = norm(&factor.times(&x)) / length.max(norm(&factor.sizes(&x)));
    let is_null = length > 0.0 && residual <= SINGULAR;
    x.iter_mut().zip(&factor.scaling.columns).for_each(|(x, scale)| *x *= scale);
    normalise(&mut x);
    is_null.then(|| NullVector { largest: largest(&x), entries: x, residual })
}

/// Vectors with a share of everything: fractional parts of the multiples of square roots.
pub(crate) fn start(k: usize, vector: usize) -> f64 {
    ((k + 1) as f64 * ((2 + vector) as f64 * 1.618_033_988_749_895).sqrt()).fract() - 0.5
}

/// Gram and Schmidt, twice for safety. A vector that depends on those before it becomes zero.
fn orthonormalise(vectors: &mut [Vec<f64>]) {
    for k in 0..vectors.len() {
        let (done, rest) = vectors.split_at_mut(k);
        let x = &mut rest[0];
        let before = norm(x);
        for v in done.iter().chain(done.iter()) {
            let part = dot(x, v);
            subtract(x, part, v);
        }
        let length = norm(x);
        let factor = if length > 1e-10 * before { 1.0 / length } else { 0.0 };
        x.iter_mut().for_each(|x| *x *= factor);
    }
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
