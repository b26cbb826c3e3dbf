//! Extend-add: the children's contribution blocks are spread over the front of their parent.

use crate::assembly_tree::Front;
use crate::stripes::Stripes;
use rayon::prelude::*;
use std::ops::Range;

/// Columns of a front that one thread fills at a time.
const CHUNK: usize = 64;
/// Columns of the transposed part filled together, so that the child's block is read by pieces of columns.
const NARROW_CHUNK: usize = 16;

/// A child's contribution block and its rows in the parent's front in ascending order.
#[derive(Clone, Copy)]
pub(crate) struct Contribution<'a> {
    pub block: &'a [f64],
    pub layout: Stripes,
    pub relative: &'a [u32],
    /// Whether only the lower half of the block is there.
    pub lower: bool,
}

impl<'a> Contribution<'a> {
    /// Indices of the child's rows that lie in this range of the front.
    fn rows_in(&self, start: usize, end: usize) -> Range<usize> {
        let index = |row: usize| self.relative.partition_point(|&r| (r as usize) < row);
        index(start)..index(end)
    }

    /// First row of a column that is there.
    fn top(&self, j: usize) -> usize {
        if self.lower { j } else { 0 }
    }

    /// Some rows of a column.
    fn column(&self, j: usize, rows: Range<usize>) -> &'a [f64] {
        let place = self.layout.place(rows.start, j);
        &self.block[place..place + rows.len()]
    }
}

/// The parts of a front, see [`Front`].
pub(crate) struct Parts<'a> {
    pub left: &'a mut [f64],
    pub right: &'a mut [f64],
    pub block: &'a mut [f64],
}

/// Some columns of a part, in the rows from `top` on, `rows` of them.
struct Columns<'a> {
    entries: &'a mut [f64],
    first: usize,
    top: usize,
    rows: usize,
}

impl Columns<'_> {
    fn end(&self) -> usize {
        self.first + self.entries.len() / self.rows.max(1)
    }

    fn column(&mut self, j: usize) -> &mut [f64] {
        &mut self.entries[self.rows * (j - self.first)..][..self.rows]
    }
}

/// All columns of a part, at most so many together.
fn columns(entries: &mut [f64], layout: Stripes, most: usize) -> impl Iterator<Item = Columns<'_>> {
    let mut rest = entries;
    layout.iter().flat_map(move |stripe| {
        let (own, later) = std::mem::take(&mut rest).split_at_mut(stripe.rows * stripe.columns);
        rest = later;
        let chunks = own.chunks_mut((stripe.rows * most.min(stripe.columns)).max(1)).enumerate();
        chunks.map(move |(k, entries)| {
            let (first, top) = (stripe.first + k * most, stripe.first);
            Columns { entries, first, top, rows: stripe.rows }
        })
    })
}

/// Adds the children in their order to the front's parts; `block` is cleared first.
pub(crate) fn assemble<'a>(
    front: &Front,
    parts: &mut Parts,
    children: usize,
    child: impl Fn(usize) -> Contribution<'a> + Sync,
    parallel: bool,
) {
    let (p, b) = (front.pivots, front.border);
    let Parts { left, right, block } = parts;
    if parallel {
        let pieces: Vec<_> = columns(left, front.left(), CHUNK).collect();
        pieces.into_par_iter().for_each(|mut columns| (0..children).for_each(|c| add_left(&mut columns, &child(c))));
        right.par_chunks_mut((b * NARROW_CHUNK).max(1)).enumerate().for_each(|(k, columns)| {
            (0..children).for_each(|c| add_right(columns, p, b, k * NARROW_CHUNK, &child(c)));
        });
        let pieces: Vec<_> = columns(block, front.block(), CHUNK).collect();
        pieces.into_par_iter().for_each(|mut columns| {
            columns.entries.fill(0.0);
            (0..children).for_each(|c| add_block(&mut columns, p, &child(c)));
        });
        return;
    }
    block.fill(0.0);
    for child in (0..children).map(child) {
        columns(left, front.left(), usize::MAX).for_each(|mut columns| add_left(&mut columns, &child));
        for (k, columns) in right.chunks_mut((b * NARROW_CHUNK).max(1)).enumerate() {
            add_right(columns, p, b, k * NARROW_CHUNK, &child);
        }
        columns(block, front.block(), usize::MAX).for_each(|mut columns| add_block(&mut columns, p, &child));
    }
}

/// Adds to columns of `[F11; F21]`.
fn add_left(columns: &mut Columns, child: &Contribution) {
    for k in child.rows_in(columns.first, columns.end()) {
        let rows = child.top(k)..child.relative.len();
        let (values, relative, top) = (child.column(k, rows.clone()), &child.relative[rows], columns.top);
        scatter(columns.column(child.relative[k] as usize), values, relative, top);
    }
}

/// Adds to columns of F12 transposed, the first of which is row `first` of the front.
fn add_right(columns: &mut [f64], p: usize, b: usize, first: usize, child: &Contribution) {
    let rows = child.rows_in(first, first + columns.len() / b);
    if rows.is_empty() {
        return;
    }
    for k in child.rows_in(p, p + b) {
        let j = child.relative[k] as usize - p;
        for (value, &row) in child.column(k, rows.clone()).iter().zip(&child.relative[rows.clone()]) {
            columns[b * (row as usize - first) + j] += value;
        }
    }
}

/// Adds to columns of F22, which is the front from row and column `p` on.
fn add_block(columns: &mut Columns, p: usize, child: &Contribution) {
    let border = child.rows_in(p, usize::MAX).start;
    for k in child.rows_in(p + columns.first, p + columns.end()) {
        let rows = border.max(child.top(k))..child.relative.len();
        let (values, relative, top) = (child.column(k, rows.clone()), &child.relative[rows], p + columns.top);
        scatter(columns.column(child.relative[k] as usize - p), values, relative, top);
    }
}

/// `target[rows - shift] += values`.
fn scatter(target: &mut [f64], values: &[f64], rows: &[u32], shift: usize) {
    for (value, &row) in values.iter().zip(rows) {
        target[row as usize - shift] += value;
    }
}
