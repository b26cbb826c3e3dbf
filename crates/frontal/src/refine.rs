//! Iterative refinement with a componentwise backward error.

use crate::error::FrontalError;
use crate::factor::Factor;
use crate::krylov::{Krylov, System, fgmres, multiply, multiply_transposed};
use crate::pattern::{Pattern, check_length};
use crate::recycle::Outer;
use crate::solve::Workspace;

/// A solution with a larger backward error than this is refused.
const ACCEPTABLE: f64 = 1e-10;
/// Multiple of the unknowns' number and of rounding below which an equation of a symmetric matrix holds nothing but rounding.
const ROUNDED: f64 = 1e3;
/// What is tried when refinement does not converge because pivots were perturbed.
const LAST_RESORT: Krylov = Krylov { tolerance: 1e-13, iterations: 90, restart: 30 };

/// How well a solution satisfies its equations.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Accuracy {
    /// Largest `|b - A x|_i / (|A| |x| + |b|)_i` (Oettli & Prager; Arioli, Demmel & Duff, SIAM J. Matrix Anal. Appl.
    /// 10, 1989): the relative change of single entries of A and b that makes the solution exact.
    pub backward_error: f64,
    /// Steps of refinement made.
    pub refinements: usize,
}

/// Whether the equations are those of the matrix or of its transpose.
#[derive(Clone, Copy)]
enum Side {
    Plain,
    Transposed,
}

impl Side {
    fn substitute(self, factor: &Factor, x: &mut [f64], work: &mut Workspace<f64>) {
        match self {
            Side::Plain => factor.substitute(x, work),
            Side::Transposed => factor.substitute_transposed(x, work),
        }
    }
}

/// The equilibrated matrix, preconditioned by its own factor with perturbed pivots.
struct Perturbed<'a> {
    factor: &'a Factor,
    side: Side,
    work: &'a mut Workspace<f64>,
}

impl System for Perturbed<'_> {
    fn multiply(&mut self, x: &[f64], y: &mut [f64]) {
        let (pattern, values) = (&self.factor.symbolic.pattern, &self.factor.values);
        match self.side {
            Side::Plain => multiply(pattern, values, x, y),
            Side::Transposed => multiply_transposed(pattern, values, x, y),
        }
    }

    fn precondition(&mut self, x: &mut [f64]) {
        self.side.substitute(self.factor, x, self.work);
    }
}

impl Factor {
    /// The largest scaled value of a row.
    fn largest_in_row(&self, row: usize) -> f64 {
        let range = self.symbolic.pattern.starts()[row]..self.symbolic.pattern.starts()[row + 1];
        self.values[range].iter().fold(0.0, |most, value| most.max(value.abs()))
    }

    /// Solves `A x = b` in place, for one or many right-hand sides: `rhs` holds them one after the other, `n` numbers
    /// each. Every solution is refined until its backward error is that of [`Options`](crate::Options). Returns the
    /// worst accuracy.
    ///
    /// # Errors
    /// [`FrontalError::NotFactorised`]; [`FrontalError::WrongLength`] unless the length is a multiple of `n`; [`FrontalError::NotFinite`];
    /// [`FrontalError::Inaccurate`] if refinement cannot bring the backward error below 1e-10, with `rhs` undefined.
    pub fn solve(&self, rhs: &mut [f64]) -> Result<Accuracy, FrontalError> {
        self.solve_all(rhs, Side::Plain)
    }

    /// Solves `A^T x = b` like [`Factor::solve`].
    ///
    /// # Errors
    /// Those of [`Factor::solve`].
    pub fn solve_transposed(&self, rhs: &mut [f64]) -> Result<Accuracy, FrontalError> {
        self.solve_all(rhs, Side::Transposed)
    }

    /// `x <- A^-1 x` by one substitution, not refined, perturbed pivots included.
    ///
    /// # Errors
    /// [`FrontalError::NotFactorised`]; [`FrontalError::WrongLength`] unless there is one number for each unknown.
    pub fn apply_inverse(&self, x: &mut [f64]) -> Result<(), FrontalError> {
        self.check_ready()?;
        check_length("x", self.symbolic.pattern.len(), x.len())?;
        x.iter_mut().zip(&self.scaling.rows).for_each(|(x, scale)| *x *= scale);
        self.substitute(x, &mut Workspace::new(self));
        x.iter_mut().zip(&self.scaling.columns).for_each(|(x, scale)| *x *= scale);
        Ok(())
    }

    fn solve_all(&self, rhs: &mut [f64], side: Side) -> Result<Accuracy, FrontalError> {
        self.check_ready()?;
        let n = self.symbolic.pattern.len();
        if n == 0 || !rhs.len().is_multiple_of(n) {
            check_length("rhs", n, rhs.len())?;
            return Ok(Accuracy::default());
        }
        check_finite(rhs, n)?;
        let mut refinement = Refinement::new(self, side);
        let mut worst = Accuracy::default();
        for b in rhs.chunks_exact_mut(n) {
            let accuracy = refinement.solve(b)?;
            worst.backward_error = worst.backward_error.max(accuracy.backward_error);
            worst.refinements = worst.refinements.max(accuracy.refinements);
        }
        Ok(worst)
    }
}

pub(crate) fn check_finite(rhs: &[f64], n: usize) -> Result<(), FrontalError> {
    match rhs.iter().position(|value| !value.is_finite()) {
        Some(at) => Err(FrontalError::NotFinite { row: at % n, column: at / n }),
        None => Ok(()),
    }
}

/// Solves in the scaled variables: with `A_s = R A C`, `A_s (C^-1 x) = R b`. The backward error is the same there.
struct Refinement<'a> {
    factor: &'a Factor,
    side: Side,
    work: Workspace<f64>,
    x: Vec<f64>,
    residual: Vec<f64>,
    /// `|A| |x| + |b|`.
    bound: Vec<f64>,
}

impl<'a> Refinement<'a> {
    fn new(factor: &'a Factor, side: Side) -> Self {
        let zeros = vec![0.0; factor.symbolic.pattern.len()];
        let (x, residual, bound) = (zeros.clone(), zeros.clone(), zeros);
        Refinement { factor, side, work: Workspace::new(factor), x, residual, bound }
    }

    fn solve(&mut self, b: &mut [f64]) -> Result<Accuracy, FrontalError> {
        let scaling = &self.factor.scaling;
        let (before, after) = match self.side {
            Side::Plain => (&scaling.rows, &scaling.columns),
            Side::Transposed => (&scaling.columns, &scaling.rows),
        };
        b.iter_mut().zip(before).for_each(|(b, scale)| *b *= scale);
        let accuracy = self.refine(b)?;
        for ((b, x), scale) in b.iter_mut().zip(&self.x).zip(after) {
            *b = x * scale;
        }
        Ok(accuracy)
    }

    fn refine(&mut self, b: &[f64]) -> Result<Accuracy, FrontalError> {
        let options = &self.factor.symbolic.options;
        self.x.copy_from_slice(b);
        self.side.substitute(self.factor, &mut self.x, &mut self.work);
        let mut accuracy = Accuracy { backward_error: self.backward_error(b), refinements: 0 };
        while accuracy.backward_error > options.backward_error && accuracy.refinements < options.refinements {
            accuracy.refinements += 1;
            self.correct();
            let before = std::mem::replace(&mut accuracy.backward_error, self.backward_error(b));
            if accuracy.backward_error > 0.5 * before {
                break;
            }
        }
        if accuracy.backward_error > ACCEPTABLE {
            let system = &mut Perturbed { factor: self.factor, side: self.side, work: &mut self.work };
            accuracy.refinements += fgmres(system, b, &mut self.x, &LAST_RESORT, &mut Outer::default()).iterations;
            accuracy.backward_error = self.backward_error(b);
        }
        if accuracy.backward_error <= ACCEPTABLE {
            return Ok(accuracy);
        }
        let unknowns = self.factor.perturbed().to_vec();
        Err(FrontalError::Inaccurate { backward_error: accuracy.backward_error, unknowns })
    }

    /// `x <- x + A^-1 r`.
    fn correct(&mut self) {
        self.side.substitute(self.factor, &mut self.residual, &mut self.work);
        self.x.iter_mut().zip(&self.residual).for_each(|(x, dx)| *x += dx);
    }

    /// Computes the residual on the way. A solution that is not a number has an infinite error.
    fn backward_error(&mut self, b: &[f64]) -> f64 {
        self.residual.copy_from_slice(b);
        self.bound.iter_mut().zip(b).for_each(|(bound, b)| *bound = b.abs());
        let pattern = &self.factor.symbolic.pattern;
        match self.side {
            Side::Plain => self.subtract_product(pattern),
            Side::Transposed => self.subtract_transposed_product(pattern),
        }
        // A factor of symmetric values knows one of two mirrored ones, which differ by rounding: in an equation that holds little
        // more, a bound of its own numbers tells nothing (Arioli, Demmel & Duff, section 2).
        let (n, symmetric) = (pattern.len(), self.factor.symbolic.options.symmetric);
        let largest = self.x.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let rounded = if symmetric { ROUNDED * n as f64 * f64::EPSILON } else { 0.0 };
        let mut worst = 0.0_f64;
        for (row, (residual, &bound)) in self.residual.iter().zip(&self.bound).enumerate() {
            let mut bound = bound;
            if rounded > 0.0 {
                let size = largest * self.factor.largest_in_row(row);
                bound += if bound <= rounded * size { size } else { 0.0 };
            }
            let error = if *residual == 0.0 { 0.0 } else { residual.abs() / bound };
            worst = if error.is_nan() { f64::INFINITY } else { worst.max(error) };
        }
        worst
    }

    fn subtract_product(&mut self, pattern: &Pattern) {
        for row in 0..pattern.len() {
            let range = pattern.starts()[row]..pattern.starts()[row + 1];
            let (mut product, mut size) = (0.0, 0.0);
            for (value, &column) in self.factor.values[range.clone()].iter().zip(&pattern.columns()[range]) {
                let term = value * self.x[column];
                product += term;
                size += term.abs();
            }
            self.residual[row] -= product;
            self.bound[row] += size;
        }
    }

    fn subtract_transposed_product(&mut self, pattern: &Pattern) {
        for row in 0..pattern.len() {
            let range = pattern.starts()[row]..pattern.starts()[row + 1];
            for (value, &column) in self.factor.values[range.clone()].iter().zip(&pattern.columns()[range]) {
                let term = value * self.x[row];
                self.residual[column] -= term;
                self.bound[column] += term.abs();
            }
        }
    }
}
