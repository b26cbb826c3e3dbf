//! A factor put right for a change of low rank: with `A` factorised,
//! `(A + U V^T)^-1 = A^-1 - A^-1 U (I + V^T A^-1 U)^-1 V^T A^-1` (Hager, SIAM Review 31, 1989). Where few entries of a
//! matrix jump and the others change little, the old factor with this correction is a preconditioner as good as if nothing
//! had jumped.

use crate::error::FrontalError;
use crate::factor::Factor;
use crate::full::Full;
use crate::pattern::check_length;
use crate::solve::{Halves, Workspace};
use crate::vector::{Number, subtract};

/// Numbers at some unknowns.
pub type Sparse = Vec<(usize, f64)>;

/// The change `sum of columns[k] rows[k]^T` of a matrix that was factorised.
#[derive(Debug, Clone)]
pub struct LowRankChange {
    columns: Vec<Sparse>,
    rows: Vec<Sparse>,
    small: Full,
}

impl LowRankChange {
    /// A change; `capacitance` holds `I + V^T A^-1 U` by rows, see [`Factor::influence`]. `None` if that is singular, and
    /// with it the changed matrix, or not finite.
    ///
    /// # Panics
    /// Unless there is a row for every column, and as many rows and columns of the capacitance.
    pub fn new(columns: Vec<Sparse>, rows: Vec<Sparse>, capacitance: Vec<f64>) -> Option<Self> {
        let n = columns.len();
        assert!(rows.len() == n && capacitance.len() == n * n, "a change of rank {n}");
        Some(LowRankChange { columns, rows, small: Full::factorise(n, capacitance)? })
    }

    /// Its rank, at the most.
    pub fn rank(&self) -> usize {
        self.columns.len()
    }

    /// `(I + V^T A^-1 U)^-1 V^T x`.
    pub fn weights(&self, x: impl Fn(usize) -> f64) -> Vec<f64> {
        let along = |row: &Sparse| row.iter().map(|&(unknown, value)| value * x(unknown)).sum();
        let mut weights: Vec<f64> = self.rows.iter().map(along).collect();
        self.small.solve(&mut weights);
        weights
    }

    /// The same for `width` vectors that lie next to each other: `x` gives a row of numbers for each unknown.
    pub fn weights_together<'a>(&self, width: usize, x: impl Fn(usize) -> &'a [f64]) -> Vec<f64> {
        let mut weights = vec![0.0; self.rank() * width];
        for (weights, row) in weights.chunks_exact_mut(width).zip(&self.rows) {
            row.iter().for_each(|&(unknown, value)| subtract(weights, -value, x(unknown)));
        }
        self.small.solve_together(&mut weights, width);
        weights
    }

    /// Adds `U weights` to a vector.
    pub fn push(&self, weights: &[f64], x: &mut [f64]) {
        for (column, weight) in self.columns.iter().zip(weights) {
            column.iter().for_each(|&(unknown, value)| x[unknown] += weight * value);
        }
    }
}

impl<T: Number> Halves<'_, T> {
    /// `x <- (A + U V^T)^-1 x` for the equilibrated matrix. The second substitution begins where the first turned round.
    pub fn substitute_changed(&self, change: &LowRankChange, x: &mut [f64], work: &mut Workspace<T>) {
        let Factor { symbolic, scaling, .. } = self.factor;
        let position = |unknown: usize| symbolic.tree.position[unknown];
        let at = |list: &[Sparse]| list.iter().flatten().map(|&(unknown, _)| position(unknown)).collect::<Vec<_>>();
        let (from, to) = (at(&change.columns), at(&change.rows));
        self.factor.permuted(x, work, |work| {
            self.forward(work);
            let halfway = work.x().to_vec();
            self.backward_to(&to, work);
            let x = work.x();
            let weights = change.weights(|unknown| x[position(unknown) as usize].into() * scaling.columns[unknown]);
            x.fill(T::round(0.0));
            for (column, weight) in change.columns.iter().zip(weights) {
                for &(unknown, value) in column {
                    x[position(unknown) as usize] -= T::round(weight * value * scaling.rows[unknown]);
                }
            }
            self.forward_from(&from, work);
            subtract(work.x(), T::round(-1.0), &halfway);
            self.backward(work);
        });
    }
}

impl<T: Number> Halves<'_, T> {
    /// `x <- (A + U V^T)^-1 x` for the matrix itself.
    ///
    /// # Errors
    /// [`FrontalError::NotFactorised`]; [`FrontalError::WrongLength`] unless there is one number for each unknown.
    pub fn apply_inverse(&self, change: Option<&LowRankChange>, x: &mut [f64]) -> Result<(), FrontalError> {
        let Factor { scaling, symbolic, .. } = self.factor;
        self.factor.check_ready()?;
        check_length("x", symbolic.pattern.len(), x.len())?;
        let mut work = Workspace::new(self.factor);
        x.iter_mut().zip(&scaling.rows).for_each(|(x, scale)| *x *= scale);
        match change {
            Some(change) => self.substitute_changed(change, x, &mut work),
            None => self.substitute(x, &mut work),
        }
        x.iter_mut().zip(&scaling.columns).for_each(|(x, scale)| *x *= scale);
        Ok(())
    }
}
