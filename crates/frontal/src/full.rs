//! A full matrix of moderate size, factorised by the kernels of the fronts.

use crate::dense::{Panel, Pivot, PivotRule};
use crate::panels::{BackwardTransposed, ForwardTransposed, Panels};
use crate::together::exchange;
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_unit_upper_triangular_in_place};
use faer::{Accum, MatMut, MatRef, Par};

/// A full matrix `A`, factorised with partial pivoting. What is stored is `P A^T = L U`: the rows of `A` are the columns
/// of the kernels.
///
/// ```
/// let matrix = frontal::Full::factorise(2, vec![0.0, 2.0, 3.0, 1.0]).expect("a regular matrix");
/// let mut x = [4.0, 5.0];
/// matrix.solve(&mut x);
/// assert_eq!(x, [1.0, 2.0]);
/// assert!(matrix.has_negative_determinant());
/// assert!(frontal::Full::factorise(2, vec![1.0, 2.0, 2.0, 4.0]).is_none());
/// ```
#[derive(Debug, Clone)]
pub struct Full {
    factors: Vec<f64>,
    pivots: Vec<Pivot>,
}

impl Full {
    /// Factorises the `n` x `n` matrix given by rows. `None` if it is singular in the arithmetic, or not finite.
    ///
    /// # Panics
    /// Unless there are `n` rows of `n` entries.
    pub fn factorise(n: usize, mut rows: Vec<f64>) -> Option<Self> {
        assert_eq!(rows.len(), n * n, "a matrix of {n} rows");
        let mut pivots = vec![Pivot::default(); n];
        let rule = PivotRule { smallest: 0.0, rounding: 0.0, share: 0.0, replacement: 1.0, regular: false };
        let mut panel = Panel { left: &mut rows, m: n, p: n, rule, symmetric: false, parallel: false };
        panel.factorise(0..n, &mut pivots);
        let regular = pivots.iter().all(|pivot| !pivot.perturbed) && rows.iter().all(|x| x.is_finite());
        regular.then_some(Full { factors: rows, pivots })
    }

    /// Whether the determinant is negative.
    pub fn has_negative_determinant(&self) -> bool {
        let odd = |(k, pivot): &(usize, &Pivot)| (pivot.row as usize != *k) != pivot.negative;
        self.pivots.iter().enumerate().filter(odd).count() % 2 == 1
    }

    /// `x <- A^-1 x`.
    ///
    /// # Panics
    /// Unless `x` holds one number for each row.
    pub fn solve(&self, x: &mut [f64]) {
        let n = self.pivots.len();
        assert_eq!(x.len(), n, "a vector for {n} rows");
        let panels = Panels { left: &self.factors, right: &[], pivots: &self.pivots, m: n, p: n, symmetric: false };
        panels.take::<ForwardTransposed>(x);
        panels.take::<BackwardTransposed>(x);
    }

    /// `x <- A^-1 x` for `width` vectors that lie next to each other: `x` holds a row of numbers for each unknown.
    ///
    /// # Panics
    /// Unless `x` holds `width` numbers for each row.
    pub fn solve_together(&self, x: &mut [f64], width: usize) {
        let n = self.pivots.len();
        let transposed = MatRef::from_column_major_slice(&self.factors, n, n).transpose();
        let mut rows = MatMut::from_row_major_slice_mut(&mut *x, n, width);
        solve_lower_triangular_in_place(transposed, rows.as_mut(), Par::Seq);
        solve_unit_upper_triangular_in_place(transposed, rows, Par::Seq);
        for (k, pivot) in self.pivots.iter().enumerate().rev() {
            exchange(x, width, k, pivot.row as usize);
        }
    }
}

/// `Y <- Y - A^T X` for matrices given by rows, of which those of `X` and `Y` hold `width` numbers.
///
/// # Panics
/// Unless `A` has a row for every row of `X` and a column for every row of `Y`.
pub fn subtract_product(y: &mut [f64], a: &[f64], x: &[f64], width: usize) {
    let [rows, inner] = [&*y, x].map(|v| v.len() / width.max(1));
    let a = MatRef::from_row_major_slice(a, inner, rows).transpose();
    let (y, x) = (MatMut::from_row_major_slice_mut(y, rows, width), MatRef::from_row_major_slice(x, inner, width));
    matmul(y, Accum::Add, a, x, -1.0, Par::Seq);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(n: usize, factor: f64) -> Vec<f64> {
        (0..n).map(|k| (factor * (k * k % 101) as f64).sin()).collect()
    }

    #[test]
    fn vectors_together_are_solved_for_as_each_alone() {
        for (n, width) in [(1, 1), (5, 3), (70, 1), (70, 9), (130, 40)] {
            let mut a = wave(n * n, 0.7);
            (0..n).for_each(|k| a[(n + 1) * k] += if k % 3 == 0 { 0.1 } else { 3.0 });
            let (full, b) = (Full::factorise(n, a.clone()).expect("a regular matrix"), wave(n * width, 0.3));
            let mut x = b.clone();
            full.solve_together(&mut x, width);
            for k in 0..width {
                let mut alone: Vec<f64> = b.iter().skip(k).step_by(width).copied().collect();
                full.solve(&mut alone);
                let largest = alone.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
                let together = x.iter().skip(k).step_by(width);
                assert!(together.zip(&alone).all(|(x, y)| (x - y).abs() <= 1e-10 * largest), "{n}, {width}");
            }
            let mut left = b;
            let transposed: Vec<f64> =
                (0..n).flat_map(|j| (0..n).map(move |i| (i, j))).map(|(i, j)| a[n * i + j]).collect();
            subtract_product(&mut left, &transposed, &x, width);
            let worst = left.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let largest = x.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
            assert!(worst < 1e-12 * n as f64 * largest, "{worst:.1e} of {largest:.1e} is left, {n}, {width}");
        }
    }
}
