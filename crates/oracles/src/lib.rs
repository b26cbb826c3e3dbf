//! faer's sparse LU (COLAMD order, supernodal) behind the same three steps as `frontal`.

use faer::linalg::solvers::Solve;
use faer::sparse::linalg::LuError;
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::{SparseColMat, Triplet};
use frontal::Pattern;

/// A matrix in faer's format.
pub type Matrix = SparseColMat<usize, f64>;

/// The matrix in faer's format, column by column.
pub fn matrix(pattern: &Pattern, values: &[f64]) -> Matrix {
    let starts = pattern.starts();
    let rows = (0..pattern.len()).flat_map(|row| (starts[row]..starts[row + 1]).map(move |at| (row, at)));
    let triplets = rows.map(|(row, at)| Triplet::new(row, pattern.columns()[at], values[at])).collect::<Vec<_>>();
    Matrix::try_new_from_triplets(pattern.len(), pattern.len(), &triplets).expect("a pattern within bounds")
}

/// Order and structure.
pub fn analyse(matrix: &Matrix) -> SymbolicLu<usize> {
    SymbolicLu::try_new(matrix.symbolic()).expect("enough memory")
}

/// Factorises.
///
/// # Errors
/// faer's own.
pub fn factorise(symbolic: &SymbolicLu<usize>, matrix: &Matrix) -> Result<Lu<usize, f64>, LuError> {
    Lu::try_new_with_symbolic(symbolic.clone(), matrix.as_ref())
}

/// Solves in place.
pub fn solve(factor: &Lu<usize, f64>, rhs: &mut [f64]) {
    let n = rhs.len();
    factor.solve_in_place(faer::MatMut::from_column_major_slice_mut(rhs, n, 1));
}
