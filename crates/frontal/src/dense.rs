//! Elimination of one front: dense LU with partial pivoting among the fully summed rows.

use crate::assembly_tree::Front;
use crate::extend_add::Parts;
use crate::vector::subtract;
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::solve_unit_lower_triangular_in_place;
use faer::{Accum, MatMut, MatRef, Par};
use pulp::Arch;
use rayon::prelude::*;
use std::ops::Range;

/// Columns factorised by simple loops; wider blocks are halved.
const NARROW: usize = 4;
/// Below this many multiplications simple loops beat the set-up of blocked kernels.
const SMALL: usize = 1024;
/// Columns of a tile, the unit of parallel work; large enough to keep the blocked kernels at full speed.
const TILE: usize = 256;

/// The row exchanged with that of a pivot, counted in the front, whether the pivot had to be enlarged, whether it would have done
/// in a matrix that is known to be regular, and its sign.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Pivot {
    pub row: u32,
    pub perturbed: bool,
    pub sound: bool,
    pub negative: bool,
}

/// Which pivots are too small, and what replaces them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PivotRule {
    /// What is no larger may be nothing but rounding.
    pub smallest: f64,
    /// What is no larger is rounding.
    pub rounding: f64,
    /// Share of the largest number of its column that a pivot has to be.
    pub share: f64,
    pub replacement: f64,
    /// Whether the matrix is known to be regular: a sound pivot then stays, however small.
    pub regular: bool,
}

impl PivotRule {
    /// Replaces a pivot, the first number of its column, that is too small; says whether it did, and whether the pivot is sound: more
    /// than rounding, with multipliers no larger than those of one that is replaced. All of a positive definite matrix are,
    /// as `a_ij^2 <= a_ii a_jj`.
    fn enforce(&self, column: &mut [f64]) -> (bool, bool) {
        let size = column[0].abs();
        if size > self.smallest {
            return (false, true);
        }
        let largest = column[1..].iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let sound = size > self.rounding && size >= self.share * largest;
        let perturbed = !(self.regular && sound);
        if perturbed {
            column[0] = self.replacement.copysign(column[0]);
        }
        (perturbed, sound)
    }
}

/// Eliminates the pivots of an assembled front; `block` becomes the contribution to the parent. The tiles are the same
/// whether or not they are computed in parallel.
pub(crate) fn eliminate(front: &Front, parts: &mut Parts, pivots: &mut [Pivot], rule: PivotRule, parallel: bool) {
    let (m, p, b) = (front.size(), front.pivots, front.border);
    let Parts { left, right, block } = parts;
    Panel { left, m, p, rule, symmetric: false, parallel }.factorise(0..p, pivots);
    if b == 0 {
        return;
    }
    let small = p * b * b <= SMALL;
    for (k, pivot) in pivots.iter().enumerate() {
        swap_columns(right, b, k, pivot.row as usize);
    }
    solve_right(left, right, front, parallel && !small);
    if small {
        return Arch::new().dispatch(
            #[inline(always)]
            || update_block_small(left, right, block, front),
        );
    }
    let lower = MatRef::from_column_major_slice(left, m, p).subrows(p, b);
    let right = MatRef::from_column_major_slice(right, b, p);
    tiles(MatMut::from_column_major_slice_mut(block, b, b), parallel, |first, tile| {
        let upper = right.subrows(first, tile.ncols()).transpose();
        matmul(tile, Accum::Add, lower, upper, -1.0, Par::Seq);
    });
}

/// `right <- right L11^-T`, where L11 is the unit lower triangle of the first rows of `left`.
fn solve_right(left: &[f64], right: &mut [f64], front: &Front, parallel: bool) {
    let (m, p, b) = (front.size(), front.pivots, front.border);
    if p * p * b <= SMALL {
        return Arch::new().dispatch(
            #[inline(always)]
            || solve_right_small(left, right, m, p, b),
        );
    }
    let upper = MatRef::from_column_major_slice(left, m, p).subrows(0, p);
    let right = MatMut::from_column_major_slice_mut(right, b, p);
    tiles(right.transpose_mut(), parallel, |_, tile| {
        solve_unit_lower_triangular_in_place(upper, tile, Par::Seq);
    });
}

/// Does the work on tiles of columns; it is told the first column of each.
fn tiles(matrix: MatMut<'_, f64>, parallel: bool, work: impl Fn(usize, MatMut<'_, f64>) + Sync) {
    if parallel {
        return matrix.par_col_chunks_mut(TILE).enumerate().for_each(|(k, tile)| work(k * TILE, tile));
    }
    let (mut rest, mut first) = (matrix, 0);
    while rest.ncols() > 0 {
        let width = rest.ncols().min(TILE);
        let (tile, later) = rest.split_at_col_mut(width);
        work(first, tile);
        (rest, first) = (later, first + width);
    }
}

/// The fully summed columns of a front: `left`, `m` x `p`.
pub(crate) struct Panel<'a> {
    pub left: &'a mut [f64],
    pub m: usize,
    pub p: usize,
    pub rule: PivotRule,
    pub symmetric: bool,
    pub parallel: bool,
}

impl Panel<'_> {
    /// LU of the columns `range`, whose earlier columns are done, by halves. Pivots come from the first `p` rows;
    /// exchanges are made in all columns.
    pub fn factorise(&mut self, range: Range<usize>, pivots: &mut [Pivot]) {
        let (start, end) = (range.start, range.end);
        if end - start <= NARROW {
            return Arch::new().dispatch(
                #[inline(always)]
                || self.factorise_narrow(range, pivots),
            );
        }
        let middle = start + ((end - start) / 2).next_multiple_of(4);
        self.factorise(start..middle, pivots);
        self.update(start, middle, end);
        self.factorise(middle..end, pivots);
    }

    /// Applies the pivots `start..middle` to the columns `middle..end`.
    fn update(&mut self, start: usize, middle: usize, end: usize) {
        let m = self.m;
        let (done, rest) = self.left.split_at_mut(m * middle);
        let done = MatRef::from_column_major_slice(&done[m * start..], m, middle - start);
        let (upper, lower) = (done.subrows(start, middle - start), done.subrows(middle, m - middle));
        let rest = MatMut::from_column_major_slice_mut(&mut rest[..m * (end - middle)], m, end - middle);
        let symmetric = self.symmetric;
        tiles(rest, self.parallel, |first, tile| {
            let (_, tile) = tile.split_at_row_mut(start);
            let (mut top, bottom) = tile.split_at_row_mut(middle - start);
            if symmetric {
                mirror(upper, lower.subrows(first, top.ncols()), top.as_mut());
                let height = bottom.nrows() - first;
                let (bottom, lower) = (bottom.subrows_mut(first, height), lower.subrows(first, height));
                return matmul(bottom, Accum::Add, lower, top.as_ref(), -1.0, Par::Seq);
            }
            solve_unit_lower_triangular_in_place(upper, top.as_mut(), Par::Seq);
            matmul(bottom, Accum::Add, lower, top.as_ref(), -1.0, Par::Seq);
        });
    }

    /// The same for a few columns, one after the other.
    #[inline(always)]
    fn factorise_narrow(&mut self, range: Range<usize>, pivots: &mut [Pivot]) {
        let (m, p) = (self.m, self.p);
        for k in range.clone() {
            let row = if self.symmetric { k } else { largest(&self.left[m * k + k..m * k + p]) + k };
            if self.symmetric {
                (k + 1..range.end).for_each(|j| self.left[m * j + k] = self.left[m * k + j]);
            } else {
                range.clone().for_each(|j| self.left.swap(m * j + k, m * j + row));
            }
            let (done, rest) = self.left[..m * range.end].split_at_mut(m * (k + 1));
            let column = &mut done[m * k..];
            let (perturbed, sound) = self.rule.enforce(&mut column[k..]);
            pivots[k] = Pivot { row: row as u32, perturbed, sound, negative: column[k] < 0.0 };
            let inverse = 1.0 / column[k];
            column[k + 1..].iter_mut().for_each(|x| *x *= inverse);
            for other in rest.chunks_exact_mut(m) {
                let factor = other[k];
                subtract(&mut other[k + 1..], factor, &column[k + 1..]);
            }
        }
        let others = if self.symmetric { 0..0 } else { range.end..p };
        for j in (0..range.start).filter(|_| !self.symmetric).chain(others) {
            let column = &mut self.left[m * j..m * (j + 1)];
            range.clone().for_each(|k| column.swap(k, pivots[k].row as usize));
        }
    }
}

/// `top <- D L^T`: the rows of U that follow from the columns of L in a symmetric front.
fn mirror(done: MatRef<'_, f64>, lower: MatRef<'_, f64>, mut top: MatMut<'_, f64>) {
    for j in 0..top.ncols() {
        for i in 0..top.nrows() {
            top[(i, j)] = done[(i, i)] * lower[(j, i)];
        }
    }
}

/// Index of the first value of largest size.
#[inline(always)]
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

/// [`solve_right`] by simple loops.
#[inline(always)]
fn solve_right_small(left: &[f64], right: &mut [f64], m: usize, p: usize, b: usize) {
    for k in 0..p {
        let (done, rest) = right.split_at_mut(b * (k + 1));
        for (column, &factor) in rest.chunks_exact_mut(b).zip(&left[m * k + k + 1..m * k + p]) {
            subtract(column, factor, &done[b * k..]);
        }
    }
}

/// `block <- block - L21 U12` by simple loops.
#[inline(always)]
fn update_block_small(left: &[f64], right: &[f64], block: &mut [f64], front: &Front) {
    let (m, p, b) = (front.size(), front.pivots, front.border);
    for (j, column) in block.chunks_exact_mut(b).enumerate() {
        for k in 0..p {
            subtract(column, right[b * k + j], &left[m * k + p..m * (k + 1)]);
        }
    }
}
