//! Elimination of one front: dense LU with partial pivoting among the fully summed rows.

use crate::assembly_tree::Front;
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::solve_unit_lower_triangular_in_place;
use faer::{Accum, MatMut, MatRef, Par};

/// Columns factorised by simple loops; wider blocks are halved.
const NARROW: usize = 16;
/// Below this many multiplications simple loops beat the set-up of blocked kernels.
const SMALL: usize = 8 * 1024;

/// The row exchanged with that of a pivot, counted in the front, and whether the pivot had to be enlarged.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Pivot {
    pub row: u32,
    pub perturbed: bool,
}

/// Which pivots are too small, and what replaces them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PivotRule {
    pub smallest: f64,
    pub replacement: f64,
}

/// Eliminates the pivots of an assembled front: `factor` holds its `left` and `right` parts, `block` its F22, which
/// becomes the contribution to the parent.
pub(crate) fn eliminate(front: &Front, factor: &mut [f64], block: &mut [f64], pivots: &mut [Pivot], rule: PivotRule) {
    let (m, p, b) = (front.size(), front.pivots, front.border);
    let (left, right) = factor.split_at_mut(m * p);
    factorise(left, m, p, 0..p, pivots, rule);
    if b == 0 {
        return;
    }
    for (k, pivot) in pivots.iter().enumerate() {
        swap_columns(right, b, k, pivot.row as usize);
    }
    if p * b * b <= SMALL {
        solve_right_small(left, right, m, p, b);
        update_block_small(left, right, block, m, p, b);
    } else {
        let left = MatRef::from_column_major_slice(left, m, p);
        let mut right = MatMut::from_column_major_slice_mut(right, b, p);
        let lower = left.subrows(0, p);
        solve_unit_lower_triangular_in_place(lower, right.as_mut().transpose_mut(), Par::Seq);
        let block = MatMut::from_column_major_slice_mut(block, b, b);
        matmul(block, Accum::Add, left.subrows(p, b), right.as_ref().transpose(), -1.0, Par::Seq);
    }
}

/// LU of the columns `range` of the `m` x `p` matrix `left`, whose earlier columns are done, by halves. Pivots come
/// from the first `p` rows; exchanges are made in all columns.
fn factorise(
    left: &mut [f64],
    m: usize,
    p: usize,
    range: std::ops::Range<usize>,
    pivots: &mut [Pivot],
    rule: PivotRule,
) {
    let (start, end) = (range.start, range.end);
    if end - start <= NARROW {
        return factorise_narrow(left, m, p, range, pivots, rule);
    }
    let middle = start + ((end - start) / 2).next_multiple_of(8);
    factorise(left, m, p, start..middle, pivots, rule);
    let (done, rest) = left.split_at_mut(m * middle);
    let done = MatRef::from_column_major_slice(&done[m * start..], m, middle - start);
    let rest = MatMut::from_column_major_slice_mut(&mut rest[..m * (end - middle)], m, end - middle);
    let (upper, lower) = rest.subrows_mut(start, m - start).split_at_row_mut(middle - start);
    let mut upper = upper;
    solve_unit_lower_triangular_in_place(done.subrows(start, middle - start), upper.as_mut(), Par::Seq);
    matmul(lower, Accum::Add, done.subrows(middle, m - middle), upper.as_ref(), -1.0, Par::Seq);
    factorise(left, m, p, middle..end, pivots, rule);
}

/// The same for a few columns, one after the other.
fn factorise_narrow(
    left: &mut [f64],
    m: usize,
    p: usize,
    range: std::ops::Range<usize>,
    pivots: &mut [Pivot],
    rule: PivotRule,
) {
    for k in range.clone() {
        let column = &mut left[m * k..m * (k + 1)];
        let row = largest(&column[k..p]) + k;
        pivots[k] = Pivot { row: row as u32, perturbed: false };
        for j in range.clone() {
            left.swap(m * j + k, m * j + row);
        }
        let (done, rest) = left[..m * range.end].split_at_mut(m * (k + 1));
        let column = &mut done[m * k..];
        if column[k].abs() <= rule.smallest {
            pivots[k].perturbed = true;
            column[k] = rule.replacement.copysign(column[k]);
        }
        let inverse = 1.0 / column[k];
        column[k + 1..].iter_mut().for_each(|x| *x *= inverse);
        for other in rest.chunks_exact_mut(m) {
            let factor = other[k];
            subtract(&mut other[k + 1..], factor, &column[k + 1..]);
        }
    }
    for j in (0..range.start).chain(range.end..p) {
        let column = &mut left[m * j..m * (j + 1)];
        for k in range.clone() {
            column.swap(k, pivots[k].row as usize);
        }
    }
}

/// Index of the first value of largest size.
fn largest(values: &[f64]) -> usize {
    let mut best = 0;
    for (k, value) in values.iter().enumerate() {
        if value.abs() > values[best].abs() {
            best = k;
        }
    }
    best
}

fn swap_columns(matrix: &mut [f64], rows: usize, j: usize, k: usize) {
    if j != k {
        let (head, tail) = matrix.split_at_mut(rows * k);
        head[rows * j..rows * (j + 1)].swap_with_slice(&mut tail[..rows]);
    }
}

/// `right <- right L11^-T`, where L11 is the unit lower triangle of the first rows of `left`.
fn solve_right_small(left: &[f64], right: &mut [f64], m: usize, p: usize, b: usize) {
    for k in 0..p {
        let (done, rest) = right.split_at_mut(b * (k + 1));
        for (column, &factor) in rest.chunks_exact_mut(b).zip(&left[m * k + k + 1..m * k + p]) {
            subtract(column, factor, &done[b * k..]);
        }
    }
}

/// `block <- block - L21 U12`.
fn update_block_small(left: &[f64], right: &[f64], block: &mut [f64], m: usize, p: usize, b: usize) {
    for (j, column) in block.chunks_exact_mut(b).enumerate() {
        for k in 0..p {
            subtract(column, right[b * k + j], &left[m * k + p..m * (k + 1)]);
        }
    }
}

/// `y <- y - factor x`.
fn subtract(y: &mut [f64], factor: f64, x: &[f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y -= factor * x;
    }
}
