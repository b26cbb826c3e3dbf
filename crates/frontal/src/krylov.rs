//! FGMRES (Saad, SIAM J. Sci. Comput. 14, 1993), preconditioned by a factor, within a recycled outer space.

use crate::change::Change;
use crate::error::Error;
use crate::factor::Factor;
use crate::pattern::{Pattern, check_length};
use crate::recycle::{Outer, Recycled, orthogonalise};
use crate::refine::check_finite;
use crate::solve::Workspace;
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
    /// [`Error::NotFactorised`], [`Error::WrongLength`], [`Error::NotFinite`].
    pub fn solve_with(&self, values: &[f64], rhs: &mut [f64], krylov: &Krylov) -> Result<Convergence, Error> {
        self.solve_recycling((values, None), rhs, krylov, &mut Recycled::default())
    }

    /// The same with a preconditioner put right for a change, beginning in the space of the directions of earlier
    /// solutions, to which its own are added.
    pub(crate) fn solve_recycling(
        &self,
        (values, change): (&[f64], Option<&Change>),
        rhs: &mut [f64],
        krylov: &Krylov,
        recycled: &mut Recycled,
    ) -> Result<Convergence, Error> {
        self.check_ready()?;
        let pattern = &self.symbolic.pattern;
        check_length("values", pattern.nonzeros(), values.len())?;
        check_length("rhs", pattern.len(), rhs.len())?;
        if pattern.len() == 0 {
            return Ok(Convergence { converged: true, ..Default::default() });
        }
        pattern.check_finite(values)?;
        check_finite(rhs, pattern.len())?;
        let mut system = OtherValues { factor: self, values, change, work: Workspace::new(self), scaled: rhs.to_vec() };
        let mut x = vec![0.0; rhs.len()];
        scale(rhs, &self.scaling.rows);
        let convergence = fgmres(&mut system, rhs, &mut x, krylov, recycled);
        scale(&mut x, &self.scaling.columns);
        rhs.copy_from_slice(&x);
        Ok(convergence)
    }
}

/// A matrix and a preconditioner.
pub(crate) trait System {
    /// `y <- A x`.
    fn multiply(&mut self, x: &[f64], y: &mut [f64]);
    /// `x <- M^-1 x`.
    fn precondition(&mut self, x: &mut [f64]);
}

/// Other values than those factorised, in the scale of the factor.
struct OtherValues<'a> {
    factor: &'a Factor,
    values: &'a [f64],
    change: Option<&'a Change>,
    work: Workspace,
    scaled: Vec<f64>,
}

impl System for OtherValues<'_> {
    fn multiply(&mut self, x: &[f64], y: &mut [f64]) {
        self.scaled.copy_from_slice(x);
        scale(&mut self.scaled, &self.factor.scaling.columns);
        multiply(&self.factor.symbolic.pattern, self.values, &self.scaled, y);
        scale(y, &self.factor.scaling.rows);
    }

    fn precondition(&mut self, x: &mut [f64]) {
        match self.change {
            Some(change) => self.factor.substitute_changed(change, x, &mut self.work),
            None => self.factor.substitute(x, &mut self.work),
        }
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
/// recycled directions, and adds its own to them.
pub(crate) fn fgmres(
    system: &mut impl System,
    b: &[f64],
    x: &mut [f64],
    krylov: &Krylov,
    recycled: &mut Recycled,
) -> Convergence {
    let goal = krylov.tolerance * norm(b);
    let mut basis = Basis { outer: Outer::new(system, recycled), ..Basis::default() };
    let mut residual = vec![0.0; b.len()];
    subtract_from(system, b, x, &mut residual);
    basis.outer.correct(&residual, x);
    let mut iterations = 0;
    loop {
        subtract_from(system, b, x, &mut residual);
        let size = norm(&residual);
        let relative_residual = if size == 0.0 { 0.0 } else { size / norm(b) };
        let done = Convergence { iterations, relative_residual, converged: size <= goal };
        if done.converged || iterations >= krylov.iterations || !size.is_finite() {
            return done;
        }
        let length = krylov.restart.max(1).min(krylov.iterations - iterations);
        iterations += basis.cycle(system, &residual, size, goal, length);
        let before = size;
        let predicted = basis.add_correction(x);
        recycled.keep(std::mem::take(&mut basis.z));
        // A cycle that gains nothing will gain nothing when repeated.
        if predicted > 0.99 * before {
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
    outer: Outer,
    v: Vec<Vec<f64>>,
    z: Vec<Vec<f64>>,
    r: Vec<Vec<f64>>,
    parts: Vec<Vec<f64>>,
    rotations: Vec<(f64, f64)>,
    g: Vec<f64>,
}

impl Basis {
    fn restart(&mut self, residual: &[f64], size: f64) {
        let outer = std::mem::take(&mut self.outer);
        let v = vec![residual.iter().map(|r| r / size).collect()];
        *self = Basis { outer, g: vec![size], v, ..Default::default() };
    }

    /// Iterates from a residual of this `size` until its estimate is below the goal; returns the iterations made.
    fn cycle(&mut self, system: &mut impl System, residual: &[f64], size: f64, goal: f64, length: usize) -> usize {
        self.restart(residual, size);
        for k in 0..length {
            let mut z = self.v[k].clone();
            system.precondition(&mut z);
            let mut w = vec![0.0; z.len()];
            system.multiply(&z, &mut w);
            self.parts.push(self.outer.take_out(&mut w));
            let mut column = self.v.iter().map(|v| orthogonalise(&mut w, v)).collect::<Vec<_>>();
            let remainder = norm(&w);
            self.z.push(z);
            self.rotate(&mut column, remainder);
            self.r.push(column);
            if self.g[k + 1].abs() <= goal || remainder == 0.0 || !remainder.is_finite() {
                return k + 1;
            }
            w.iter_mut().for_each(|w| *w /= remainder);
            self.v.push(w);
        }
        length
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

    /// Adds the combination of directions that makes the residual least; returns the norm of that residual.
    fn add_correction(&mut self, x: &mut [f64]) -> f64 {
        let predicted = self.g.pop().map_or(0.0, f64::abs);
        for k in (0..self.g.len()).rev() {
            let (column, pivot) = (&self.r[k], self.r[k][k]);
            let y = if pivot == 0.0 { 0.0 } else { self.g[k] / pivot };
            subtract(&mut self.g[..k], y, &column[..k]);
            subtract(x, -y, &self.z[k]);
            self.outer.put_back(&self.parts[k], y, x);
        }
        predicted
    }
}
