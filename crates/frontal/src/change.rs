//! A factor put right for a change of low rank: with `A` factorised,
//! `(A + U V^T)^-1 = A^-1 - A^-1 U (I + V^T A^-1 U)^-1 V^T A^-1` (Hager, SIAM Review 31, 1989). Where few entries of a
//! matrix jump and the others change little, the old factor with this correction is a preconditioner as good as if nothing
//! had jumped.

use crate::factor::Factor;
use crate::solve::Workspace;
use crate::vector::{dot, subtract};

/// Numbers at some unknowns.
pub type Sparse = Vec<(usize, f64)>;

/// The change `sum of columns[k] rows[k]^T` of a matrix that was factorised.
#[derive(Debug, Clone)]
pub struct Change {
    columns: Vec<Sparse>,
    rows: Vec<Sparse>,
    small: Small,
}

impl Change {
    /// A change; `capacitance` holds `I + V^T A^-1 U` by rows, see [`Factor::influence`]. `None` if that is singular, and
    /// with it the changed matrix, or not finite.
    ///
    /// # Panics
    /// Unless there is a row for every column, and as many rows and columns of the capacitance.
    pub fn new(columns: Vec<Sparse>, rows: Vec<Sparse>, capacitance: Vec<f64>) -> Option<Self> {
        let n = columns.len();
        assert!(rows.len() == n && capacitance.len() == n * n, "a change of rank {n}");
        Some(Change { columns, rows, small: Small::factorise(n, capacitance)? })
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
}

impl Factor {
    /// `x <- (A + U V^T)^-1 x` for the equilibrated matrix. The second substitution begins where the first turned round.
    pub(crate) fn substitute_changed(&self, change: &Change, x: &mut [f64], work: &mut Workspace) {
        let position = |unknown: usize| self.symbolic.tree.position[unknown];
        let at = |list: &[Sparse]| list.iter().flatten().map(|&(unknown, _)| position(unknown)).collect::<Vec<_>>();
        let (from, to) = (at(&change.columns), at(&change.rows));
        self.permuted(x, work, |factor, work| {
            factor.forward(work);
            let halfway = work.vectors().to_vec();
            factor.backward_to(&to, work);
            let x = work.vectors();
            let weights = change.weights(|unknown| x[position(unknown) as usize] * factor.scaling.columns[unknown]);
            x.fill(0.0);
            for (column, weight) in change.columns.iter().zip(weights) {
                for &(unknown, value) in column {
                    x[position(unknown) as usize] -= weight * value * factor.scaling.rows[unknown];
                }
            }
            factor.forward_from(&from, work);
            subtract(work.vectors(), -1.0, &halfway);
            factor.backward(work);
        });
    }
}

/// A small dense matrix by rows, factorised with partial pivoting.
#[derive(Debug, Clone)]
struct Small {
    rows: Vec<f64>,
    swaps: Vec<usize>,
}

impl Small {
    fn factorise(n: usize, mut rows: Vec<f64>) -> Option<Self> {
        let mut swaps = Vec::with_capacity(n);
        for k in 0..n {
            let largest = |&i: &usize, &j: &usize| rows[i * n + k].abs().total_cmp(&rows[j * n + k].abs());
            let pivot = (k..n).max_by(largest)?;
            swaps.push(pivot);
            (0..n).for_each(|j| rows.swap(k * n + j, pivot * n + j));
            let (upper, lower) = rows.split_at_mut((k + 1) * n);
            let upper = &upper[k * n + k..];
            if upper[0] == 0.0 || !upper[0].is_finite() {
                return None;
            }
            for row in lower.chunks_exact_mut(n).map(|row| &mut row[k..]).filter(|row| row[0] != 0.0) {
                row[0] /= upper[0];
                let factor = row[0];
                subtract(&mut row[1..], factor, &upper[1..]);
            }
        }
        Some(Small { rows, swaps })
    }

    fn solve(&self, x: &mut [f64]) {
        let n = x.len();
        for (k, &pivot) in self.swaps.iter().enumerate() {
            x.swap(k, pivot);
        }
        for k in 0..n {
            x[k] -= dot(&self.rows[k * n..k * n + k], &x[..k]);
        }
        for k in (0..n).rev() {
            let row = &self.rows[k * n..(k + 1) * n];
            x[k] = (x[k] - dot(&row[k + 1..], &x[k + 1..])) / row[k];
        }
    }
}
