//! Elimination of one front: dense LU with partial pivoting among the fully summed rows.

use crate::assembly_tree::Front;
use crate::vector::subtract;
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::solve_unit_lower_triangular_in_place;
use faer::{Accum, MatMut, MatRef, Par};
use pulp::Arch;
use rayon::prelude::*;
use std::ops::Range;

/// Columns factorised by simple loops; wider blocks are halved.
const NARROW: usize = 16;
/// Below this many multiplications simple loops beat the set-up of blocked kernels.
const SMALL: usize = 1024;
/// Columns of a tile, the unit of parallel work; large enough to keep the blocked kernels at full speed.
const TILE: usize = 256;

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

impl PivotRule {
    /// Replaces a pivot that is too small, and says so.
    fn enforce(&self, pivot: &mut f64) -> bool {
        let too_small = pivot.abs() <= self.smallest;
        if too_small {
            *pivot = self.replacement.copysign(*pivot);
        }
        too_small
    }
}

/// Eliminates the pivots of an assembled front: `factor` holds its `left` and `right` parts, `block` its F22, which
/// becomes the contribution to the parent. The tiles are the same whether or not they are computed in parallel.
pub(crate) fn eliminate(
    front: &Front,
    factor: &mut [f64],
    block: &mut [f64],
    pivots: &mut [Pivot],
    rule: PivotRule,
    parallel: bool,
) {
    let (m, p, b) = (front.size(), front.pivots, front.border);
    let (left, right) = factor.split_at_mut(m * p);
    Panel { left: &mut *left, m, p, rule, parallel }.factorise(0..p, pivots);
    if b == 0 {
        return;
    }
    for (k, pivot) in pivots.iter().enumerate() {
        swap_columns(right, b, k, pivot.row as usize);
    }
    if p * b * b <= SMALL {
        return Arch::new().dispatch(|| {
            solve_right_small(left, right, m, p, b);
            update_block_small(left, right, block, m, p, b);
        });
    }
    let left = MatRef::from_column_major_slice(left, m, p);
    let (upper, lower) = left.split_at_row(p);
    let mut right = MatMut::from_column_major_slice_mut(right, b, p);
    tiles(right.as_mut().transpose_mut(), parallel, |_, tile| {
        solve_unit_lower_triangular_in_place(upper, tile, Par::Seq);
    });
    let right = right.as_ref();
    tiles(MatMut::from_column_major_slice_mut(block, b, b), parallel, |first, tile| {
        let rows = right.subrows(first, tile.ncols());
        matmul(tile, Accum::Add, lower, rows.transpose(), -1.0, Par::Seq);
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
struct Panel<'a> {
    left: &'a mut [f64],
    m: usize,
    p: usize,
    rule: PivotRule,
    parallel: bool,
}

impl Panel<'_> {
    /// LU of the columns `range`, whose earlier columns are done, by halves. Pivots come from the first `p` rows;
    /// exchanges are made in all columns.
    fn factorise(&mut self, range: Range<usize>, pivots: &mut [Pivot]) {
        let (start, end) = (range.start, range.end);
        if end - start <= NARROW {
            return Arch::new().dispatch(|| self.factorise_narrow(range, pivots));
        }
        let middle = start + ((end - start) / 2).next_multiple_of(8);
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
        tiles(rest, self.parallel, |_, tile| {
            let (_, tile) = tile.split_at_row_mut(start);
            let (mut top, bottom) = tile.split_at_row_mut(middle - start);
            solve_unit_lower_triangular_in_place(upper, top.as_mut(), Par::Seq);
            matmul(bottom, Accum::Add, lower, top.as_ref(), -1.0, Par::Seq);
        });
    }

    /// The same for a few columns, one after the other.
    #[inline(always)]
    fn factorise_narrow(&mut self, range: Range<usize>, pivots: &mut [Pivot]) {
        let (m, p) = (self.m, self.p);
        for k in range.clone() {
            let row = largest(&self.left[m * k + k..m * k + p]) + k;
            range.clone().for_each(|j| self.left.swap(m * j + k, m * j + row));
            let (done, rest) = self.left[..m * range.end].split_at_mut(m * (k + 1));
            let column = &mut done[m * k..];
            let perturbed = self.rule.enforce(&mut column[k]);
            pivots[k] = Pivot { row: row as u32, perturbed };
            let inverse = 1.0 / column[k];
            column[k + 1..].iter_mut().for_each(|x| *x *= inverse);
            for other in rest.chunks_exact_mut(m) {
                let factor = other[k];
                subtract(&mut other[k + 1..], factor, &column[k + 1..]);
            }
        }
        for j in (0..range.start).chain(range.end..p) {
            let column = &mut self.left[m * j..m * (j + 1)];
            range.clone().for_each(|k| column.swap(k, pivots[k].row as usize));
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

/// `right <- right L11^-T`, where L11 is the unit lower triangle of the first rows of `left`.
#[inline(always)]
fn solve_right_small(left: &[f64], right: &mut [f64], m: usize, p: usize, b: usize) {
    for k in 0..p {
        let (done, rest) = right.split_at_mut(b * (k + 1));
        for (column, &factor) in rest.chunks_exact_mut(b).zip(&left[m * k + k + 1..m * k + p]) {
            subtract(column, factor, &done[b * k..]);
        }
    }
}

/// `block <- block - L21 U12`.
#[inline(always)]
fn update_block_small(left: &[f64], right: &[f64], block: &mut [f64], m: usize, p: usize, b: usize) {
    for (j, column) in block.chunks_exact_mut(b).enumerate() {
        for k in 0..p {
            subtract(column, right[b * k + j], &left[m * k + p..m * (k + 1)]);
        }
    }
}
