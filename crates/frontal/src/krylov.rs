//! FGMRES (Saad, SIAM J. Sci. Comput. 14, 1993), preconditioned by a factor, within a recycled outer space.

use crate::error::FrontalError;
use crate::factor::Factor;
use crate::pattern::{Pattern, check_length};
use crate::recycle::{Outer, orthogonalise};
use crate::refine::check_finite;
use crate::scaling::Scaling;
use crate::vector::{norm, subtract};

/// When an iterative solution ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Krylov {
    /// Residual to reach, relative to the right-hand side, in the Euclidean norm of the equilibrated system: rows in
    /// different units then weigh alike.
    pub tolerance: f64,
    /// Iterations at the most; each is one substitution with the factor and one product with the matrix.
    pub iterations: usize,
    /// Iterations after which the basis is given up and begun anew.
    pub restart: usize,
}

impl Default for Krylov {
    fn default() -> Self {
        Krylov { tolerance: 1e-10, iterations: 60, restart: 30 }
    }
}

/// How an iterative solution ended.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Convergence {
    /// Iterations made.
    pub iterations: usize,
    /// Norm of the residual over that of the right-hand side, as in [`Krylov::tolerance`], computed from the solution
    /// itself.
    pub relative_residual: f64,
    /// Whether the tolerance was reached.
    pub converged: bool,
}

impl Factor {
    /// Solves `A x = b` in place for a matrix of the same pattern with other `values` than those factorised: the
    /// factor is the preconditioner. If the tolerance is not reached, `rhs` holds the best solution found, and the
    /// result says so.
    ///
    /// # Errors
    /// [`FrontalError::NotFactorised`], [`FrontalError::WrongLength`], [`FrontalError::NotFinite`].
    pub fn solve_with(&self, values: &[f64], rhs: &mut [f64], krylov: &Krylov) -> Result<Convergence, FrontalError> {
        self.check_ready()?;
        let pattern = &self.symbolic.pattern;
        let precondition = |x: &mut [f64]| self.halves().apply_inverse(None, x);
        let system = Scaled::new((pattern, values), &self.scaling, (precondition, |_: &mut [f64]| Ok(())))?;
        solve_recycling(system, rhs, krylov, (&mut Outer::default(), true))
    }
}

/// Solves in place beginning in the space of the directions of earlier solutions, with the `same` matrix or with another; its own
/// are added to them.
pub(crate) fn solve_recycling<P: FnMut(&mut [f64]) -> Result<(), E>, C, E: From<FrontalError>>(
    mut system: Scaled<'_, P, C, E>,
    rhs: &mut [f64],
    krylov: &Krylov,
    (outer, same): (&mut Outer, bool),
) -> Result<Convergence, E>
where
    C: FnMut(&mut [f64]) -> Result<(), E>,
{
    let pattern = system.matrix.0;
    check_length("rhs", pattern.len(), rhs.len())?;
    if pattern.len() == 0 {
        return Ok(Convergence { converged: true, ..Default::default() });
    }
    check_finite(rhs, pattern.len())?;
    let mut x = vec![0.0; rhs.len()];
    scale(rhs, &system.scaling.rows);
    if !same {
        outer.carry_over(&mut system);
    }
    let convergence = fgmres(&mut system, rhs, &mut x, krylov, outer);
    scale(&mut x, &system.scaling.columns);
    rhs.copy_from_slice(&x);
    match system.failure {
        Some(failure) => Err(failure),
        None => Ok(convergence),
    }
}

/// A matrix and a preconditioner.
pub(crate) trait System {
    /// `y <- A x`.
    fn multiply(&mut self, x: &[f64], y: &mut [f64]);
    /// `x <- M^-1 x`.
    fn precondition(&mut self, x: &mut [f64]);
}

/// An equilibrated matrix with what preconditions the matrix itself.
pub(crate) struct Scaled<'a, P, C, E> {
    matrix: (&'a Pattern, &'a [f64]),
    scaling: &'a Scaling,
    precondition: P,
    /// Completes a product of which there are some rows.
    complete: C,
    scaled: Vec<f64>,
    /// What one of both failed of.
    failure: Option<E>,
}

impl<'a, P, C, E> Scaled<'a, P, C, E> {
    /// The matrix with these factors of rows and columns.
    ///
    /// # Errors
    /// [`FrontalError::WrongLength`], [`FrontalError::NotFinite`].
    pub fn new(
        matrix: (&'a Pattern, &'a [f64]),
        scaling: &'a Scaling,
        (precondition, complete): (P, C),
    ) -> Result<Self, FrontalError> {
        let (pattern, values) = matrix;
        check_length("values", pattern.nonzeros(), values.len())?;
        check_length("factors", pattern.len(), scaling.rows.len())?;
        pattern.check_finite(values)?;
        Ok(Scaled { matrix, scaling, precondition, complete, scaled: vec![0.0; pattern.len()], failure: None })
    }
}

impl<P, C, E> System for Scaled<'_, P, C, E>
where
    P: FnMut(&mut [f64]) -> Result<(), E>,
    C: FnMut(&mut [f64]) -> Result<(), E>,
{
    fn multiply(&mut self, x: &[f64], y: &mut [f64]) {
        self.scaled.copy_from_slice(x);
        scale(&mut self.scaled, &self.scaling.columns);
        let (pattern, values) = self.matrix;
        multiply(pattern, values, &self.scaled, y);
        if let Err(failure) = (self.complete)(y) {
            y.fill(f64::NAN);
            self.failure = Some(failure);
        }
        scale(y, &self.scaling.rows);
    }

    /// The factors are powers of two: nothing is rounded.
    fn precondition(&mut self, x: &mut [f64]) {
        x.iter_mut().zip(&self.scaling.rows).for_each(|(x, factor)| *x /= factor);
        if let Err(failure) = (self.precondition)(x) {
            // Of no use, which ends the iterations.
            x.fill(f64::NAN);
            self.failure = Some(failure);
        }
        x.iter_mut().zip(&self.scaling.columns).for_each(|(x, factor)| *x /= factor);
    }
}

fn scale(x: &mut [f64], factors: &[f64]) {
    x.iter_mut().zip(factors).for_each(|(x, factor)| *x *= factor);
}

/// `y <- A x`.
pub(crate) fn multiply(pattern: &Pattern, values: &[f64], x: &[f64], y: &mut [f64]) {
    for (row, y) in y.iter_mut().enumerate() {
        let range = pattern.starts()[row]..pattern.starts()[row + 1];
        *y = gather_dot(&values[range.clone()], &pattern.columns()[range], x);
    }
}

/// Product of a row with a vector, in four interleaved sums.
fn gather_dot(values: &[f64], columns: &[usize], x: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (value_parts, column_parts) = (values.chunks_exact(4), columns.chunks_exact(4));
    let rest = value_parts.remainder().iter().zip(column_parts.remainder());
    let tail = rest.map(|(value, &column)| value * x[column]).sum::<f64>();
    for (values, columns) in value_parts.zip(column_parts) {
        (0..4).for_each(|k| sums[k] += values[k] * x[columns[k]]);
    }
    (sums[0] + sums[2]) + (sums[1] + sums[3]) + tail
}

/// `y <- A^T x`.
pub(crate) fn multiply_transposed(pattern: &Pattern, values: &[f64], x: &[f64], y: &mut [f64]) {
    y.fill(0.0);
    for (row, x) in x.iter().enumerate() {
        pattern.entries(row).for_each(|(at, column)| y[column] += values[at] * x);
    }
}

/// Improves `x` until `A x = b` to the tolerance, by cycles of at most `restart` iterations. Begins in the space of the
/// outer directions, and adds its own to them.
pub(crate) fn fgmres(
    system: &mut impl System,
    b: &[f64],
    x: &mut [f64],
    krylov: &Krylov,
    outer: &mut Outer,
) -> Convergence {
    let goal = krylov.tolerance * norm(b);
    let mut residual = b.to_vec();
    if x.iter().any(|x| *x != 0.0) {
        subtract_from(system, b, x, &mut residual);
    }
    outer.correct(0, &mut residual, x);
    let mut iterations = 0;
    loop {
        let size = norm(&residual);
        let relative_residual = if size == 0.0 { 0.0 } else { size / norm(b) };
        let done = Convergence { iterations, relative_residual, converged: size <= goal };
        if done.converged || iterations >= krylov.iterations || !size.is_finite() {
            return done;
        }
        let length = krylov.restart.max(1).min(krylov.iterations - iterations);
        let mut basis = Basis::new(&residual, size);
        iterations += basis.cycle((system, outer), goal, length);
        let (known, predicted) = (outer.len(), basis.predicted());
        basis.join(outer);
        outer.correct(known, &mut residual, x);
        outer.trim();
        subtract_from(system, b, x, &mut residual);
        // A cycle that gains nothing will gain nothing when repeated.
        if predicted > 0.99 * size {
            return Convergence { iterations, ..done };
        }
    }
}

/// `residual <- b - A x`.
fn subtract_from(system: &mut impl System, b: &[f64], x: &[f64], residual: &mut [f64]) {
    system.multiply(x, residual);
    residual.iter_mut().zip(b).for_each(|(r, b)| *r = b - *r);
}

/// The Arnoldi basis `v`, the preconditioned directions `z`, and the triangular factor `r` of the Hessenberg matrix
/// with the rotated right-hand side `g`; `parts` holds what was taken out of every image along the outer space.
#[derive(Default)]
struct Basis {
    v: Vec<Vec<f64>>,
    z: Vec<Vec<f64>>,
    r: Vec<Vec<f64>>,
    parts: Vec<Vec<f64>>,
    rotations: Vec<(f64, f64)>,
    g: Vec<f64>,
}

impl Basis {
    /// Begins from a residual of this `size`.
    fn new(residual: &[f64], size: f64) -> Self {
        let v = vec![residual.iter().map(|r| r / size).collect()];
        Self { g: vec![size], v, ..Self::default() }
    }

    /// Iterates until the estimate of the residual is below the goal; returns the iterations made.
    fn cycle(&mut self, (system, outer): (&mut impl System, &Outer), goal: f64, length: usize) -> usize {
        for k in 0..length {
            let mut z = self.v[k].clone();
            system.precondition(&mut z);
            let mut w = vec![0.0; z.len()];
            system.multiply(&z, &mut w);
            self.parts.push(outer.take_out(&mut w));
            let mut column = self.v.iter().map(|v| orthogonalise(&mut w, v)).collect::<Vec<_>>();
            let remainder = norm(&w);
            self.z.push(z);
            self.rotate(&mut column, remainder);
            self.r.push(column);
            if remainder == 0.0 || !remainder.is_finite() {
                return k + 1;
            }
            w.iter_mut().for_each(|w| *w /= remainder);
            self.v.push(w);
            if self.predicted() <= goal {
                return k + 1;
            }
        }
        length
    }

    /// Estimate of the residual's norm.
    fn predicted(&self) -> f64 {
        self.g[self.g.len() - 1].abs()
    }

    /// Givens rotations that keep the Hessenberg matrix triangular.
    fn rotate(&mut self, column: &mut [f64], remainder: f64) {
        let k = column.len() - 1;
        for (i, &(c, s)) in self.rotations.iter().enumerate() {
            (column[i], column[i + 1]) = (c * column[i] + s * column[i + 1], c * column[i + 1] - s * column[i]);
        }
        let length = column[k].hypot(remainder);
        let (c, s) = if length == 0.0 { (1.0, 0.0) } else { (column[k] / length, remainder / length) };
        column[k] = length;
        self.rotations.push((c, s));
        self.g.push(-s * self.g[k]);
        self.g[k] *= c;
    }

    /// Adds its directions to the outer ones: with `H = Q R`, `A (Z - U parts) R^-1 = V Q`, whose columns are orthonormal.
    fn join(self, outer: &mut Outer) {
        let mut directions = Vec::<Vec<f64>>::new();
        for (k, mut u) in self.z.into_iter().enumerate() {
            let pivot = self.r[k][k];
            if pivot == 0.0 || !pivot.is_finite() {
                break;
            }
            outer.put_back(&self.parts[k], 1.0, &mut u);
            directions.iter().zip(&self.r[k]).for_each(|(before, r)| subtract(&mut u, *r, before));
            u.iter_mut().for_each(|u| *u /= pivot);
            directions.push(u);
        }
        for (k, u) in directions.into_iter().enumerate() {
            let mut c = vec![0.0; u.len()];
            let weights = column_of_q(&self.rotations, k);
            self.v.iter().zip(weights).for_each(|(v, q)| subtract(&mut c, -q, v));
            outer.add(u, c);
        }
    }
}

/// Column `k` of the orthogonal factor whose transposed is the product of these rotations.
fn column_of_q(rotations: &[(f64, f64)], k: usize) -> Vec<f64> {
    let mut q = vec![0.0; rotations.len() + 1];
    q[k] = 1.0;
    for (i, &(c, s)) in rotations.iter().enumerate().take(k + 1).rev() {
        (q[i], q[i + 1]) = (c * q[i] - s * q[i + 1], s * q[i] + c * q[i + 1]);
    }
    q
}
