//! Extend-add: the children's contribution blocks are spread over the front of their parent.

use crate::assembly_tree::Front;
use rayon::prelude::*;

/// Columns of a front that one thread fills at a time.
const CHUNK: usize = 64;
/// Columns of the transposed part filled together, so that the child's block is read by pieces of columns.
const NARROW_CHUNK: usize = 16;

/// A child's contribution block, column by column, and its rows in the parent's front in ascending order.
#[derive(Clone, Copy)]
pub(crate) struct Contribution<'a> {
    pub block: &'a [f64],
    pub relative: &'a [u32],
    /// Whether only the lower half of the block is there.
    pub lower: bool,
}

impl<'a> Contribution<'a> {
    /// Indices of the child's rows that lie in this range of the front.
    fn rows_in(&self, start: usize, end: usize) -> std::ops::Range<usize> {
        let index = |row: usize| self.relative.partition_point(|&r| (r as usize) < row);
        index(start)..index(end)
    }

    /// First row of a column that is there.
    fn top(&self, j: usize) -> usize {
        if self.lower { j } else { 0 }
    }

    fn column(&self, j: usize) -> &'a [f64] {
        let n = self.relative.len();
        &self.block[n * j..n * (j + 1)]
    }
}

/// The parts of a front, see [`Front`].
pub(crate) struct Parts<'a> {
    pub left: &'a mut [f64],
    pub right: &'a mut [f64],
    pub block: &'a mut [f64],
}

/// Adds the children in their order to the front's parts; `block` is cleared first.
pub(crate) fn assemble<'a>(
    front: &Front,
    parts: &mut Parts,
    children: usize,
    child: impl Fn(usize) -> Contribution<'a> + Sync,
    parallel: bool,
) {
    let (m, p, b) = (front.size(), front.pivots, front.border);
    let Parts { left, right, block } = parts;
    if parallel {
        chunks(left, m * CHUNK).for_each(|(k, columns)| {
            (0..children).for_each(|c| add_left(columns, m, k * CHUNK, &child(c)));
        });
        chunks(right, b * NARROW_CHUNK).for_each(|(k, columns)| {
            (0..children).for_each(|c| add_right(columns, p, b, k * NARROW_CHUNK, &child(c)));
        });
        chunks(block, b * CHUNK).for_each(|(k, columns)| {
            columns.fill(0.0);
            (0..children).for_each(|c| add_block(columns, p, b, k * CHUNK, &child(c)));
        });
        return;
    }
    block.fill(0.0);
    for child in (0..children).map(child) {
        add_left(left, m, 0, &child);
        for (k, columns) in right.chunks_mut((b * NARROW_CHUNK).max(1)).enumerate() {
            add_right(columns, p, b, k * NARROW_CHUNK, &child);
        }
        add_block(block, p, b, 0, &child);
    }
}

fn chunks(data: &mut [f64], len: usize) -> impl IndexedParallelIterator<Item = (usize, &mut [f64])> {
    data.par_chunks_mut(len.max(1)).enumerate()
}

/// Adds to columns of `[F11; F21]`, the first of which is column `first` of the front.
fn add_left(columns: &mut [f64], m: usize, first: usize, child: &Contribution) {
    for k in child.rows_in(first, first + columns.len() / m) {
        let j = child.relative[k] as usize - first;
        let top = child.top(k);
        scatter(&mut columns[m * j..m * (j + 1)], &child.column(k)[top..], &child.relative[top..], 0);
    }
}

/// Adds to columns of F12 transposed, the first of which is row `first` of the front.
fn add_right(columns: &mut [f64], p: usize, b: usize, first: usize, child: &Contribution) {
    let rows = child.rows_in(first, first + columns.len() / b);
    if rows.is_empty() || child.lower {
        return;
    }
    for k in child.rows_in(p, p + b) {
        let j = child.relative[k] as usize - p;
        for (value, &row) in child.column(k)[rows.clone()].iter().zip(&child.relative[rows.clone()]) {
            columns[b * (row as usize - first) + j] += value;
        }
    }
}

/// Adds to columns of F22, the first of which is column `first` of it.
fn add_block(columns: &mut [f64], p: usize, b: usize, first: usize, child: &Contribution) {
    if columns.is_empty() {
        return;
    }
    let border = child.rows_in(p, p + b);
    for k in child.rows_in(p + first, p + first + columns.len() / b) {
        let j = child.relative[k] as usize - p - first;
        let rows = border.start.max(child.top(k))..border.end;
        let column = &child.column(k)[rows.clone()];
        scatter(&mut columns[b * j..b * (j + 1)], column, &child.relative[rows], p);
    }
}

/// `target[rows - shift] += values`.
fn scatter(target: &mut [f64], values: &[f64], rows: &[u32], shift: usize) {
    for (value, &row) in values.iter().zip(rows) {
        target[row as usize - shift] += value;
    }
}
