//! Substitution for several vectors at once, which lie next to each other: a row of numbers for each unknown. The factor
//! is then read once for all of them, and what is done at a front are products of matrices.

use crate::assembly_tree::Front;
use crate::factor::Factor;
use crate::panels::Panels;
use crate::solve::Halves;
use crate::stripes::{Stripe, Stripes};
use crate::vector::{Number, subtract};
use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use pulp::Arch;
use std::ops::Range;

/// Pivots taken one after the other; more are halved.
const NARROW: usize = 16;
/// Products with fewer entries of the factor are done by simple loops.
const SMALL: usize = 256;

/// Vectors in elimination order, each row `width` numbers, and room for the rows of a front.
pub(crate) struct Together<T> {
    width: usize,
    x: Vec<T>,
    local: Vec<T>,
}

impl<T: Number> Together<T> {
    /// Room for `most` vectors.
    pub fn with_room_for(factor: &Factor, most: usize) -> Self {
        let symbolic = &factor.symbolic;
        let [x, local] =
            [symbolic.pattern.len(), symbolic.prediction.largest_front].map(|n| Vec::with_capacity(n * most));
        Together { width: most, x, local }
    }

    /// Sets so many vectors to zero.
    pub fn clear(&mut self, factor: &Factor, width: usize) {
        self.width = width;
        self.x.clear();
        self.x.resize(factor.symbolic.pattern.len() * width, T::round(0.0));
        self.local.resize(factor.symbolic.prediction.largest_front * width, T::round(0.0));
    }

    /// What all vectors are at a position.
    pub fn row(&mut self, position: u32) -> &mut [T] {
        row(&mut self.x, self.width, position)
    }
}

fn row<T>(x: &mut [T], width: usize, position: u32) -> &mut [T] {
    &mut x[width * position as usize..][..width]
}

impl<T: Number> Halves<'_, T> {
    /// `x <- A^-1 x` for the equilibrated matrix, passing the fronts that none of the entries `from`, all that are not zero,
    /// reaches and those that none of the entries `to` needs.
    pub(crate) fn substitute_between(&self, from: &[u32], to: &[u32], vectors: &mut Together<T>) {
        let tree = &self.factor.symbolic.tree;
        for (front, _) in tree.fronts.iter().zip(tree.above(from)).filter(|(_, reached)| *reached) {
            self.forward_at(front, vectors);
        }
        for (front, _) in tree.fronts.iter().zip(tree.above(to)).rev().filter(|(_, needed)| *needed) {
            self.backward_at(front, vectors);
        }
    }

    /// `[L11; L21]` downwards.
    fn forward_at(&self, front: &Front, vectors: &mut Together<T>) {
        let (Together { width, x, local }, panels) = (vectors, self.panels(front));
        let (width, m, p) = (*width, panels.m, panels.p);
        let top = &mut x[width * front.first..][..width * p];
        if !panels.symmetric {
            for (k, pivot) in panels.pivots.iter().enumerate() {
                exchange(top, width, k, pivot.row as usize);
            }
        }
        let local = &mut local[..width * (m - p)];
        local.fill(T::round(0.0));
        for stripe in front.left().iter() {
            let block = Block::of(&panels, stripe);
            let (own, later) = top[width * stripe.first..].split_at_mut(width * stripe.columns);
            let (within, border) = block.below(p - stripe.first);
            lower(block, 0..stripe.columns, own, width);
            take(later, &within, own, width);
            take(local, &border, own, width);
        }
        for (local, &at) in local.chunks_exact(width).zip(self.factor.symbolic.tree.rows(front)) {
            row(x, width, at).iter_mut().zip(local).for_each(|(x, local)| *x += *local);
        }
    }

    /// `[U11 U12]` upwards.
    fn backward_at(&self, front: &Front, vectors: &mut Together<T>) {
        let (Together { width, x, local }, panels) = (vectors, self.panels(front));
        let (width, m, p) = (*width, panels.m, panels.p);
        let border = &mut local[..width * (m - p)];
        for (local, &at) in border.chunks_exact_mut(width).zip(self.factor.symbolic.tree.rows(front)) {
            local.copy_from_slice(row(x, width, at));
        }
        let top = &mut x[width * front.first..][..width * p];
        if panels.symmetric {
            return symmetric_upper((&panels, front.left()), (top, border), width);
        }
        let right = Part { entries: panels.right, leading: m - p, rows: 0..m - p, columns: 0..p, transposed: true };
        take(top, &right, border, width);
        upper(Block { entries: panels.left, leading: m }, 0..p, top, width);
    }
}

/// `D [L11; L21]^T` upwards, from the last stripe to the first.
fn symmetric_upper<T: Number>((panels, layout): (&Panels<T>, Stripes), (top, border): (&mut [T], &[T]), width: usize) {
    for (k, x) in top.chunks_exact_mut(width).enumerate() {
        let pivot = panels.column_below(k)[0];
        x.iter_mut().for_each(|x| *x /= pivot);
    }
    let last = panels.p.saturating_sub(1);
    let mut stripe = layout.of(last);
    loop {
        let block = Block::of(panels, stripe);
        let (own, later) = top[width * stripe.first..].split_at_mut(width * stripe.columns);
        let (within, beyond) = block.below(panels.p - stripe.first);
        take(own, &within.transposed(), later, width);
        take(own, &beyond.transposed(), border, width);
        lower_transposed(block, 0..stripe.columns, own, width);
        if stripe.first == 0 {
            return;
        }
        stripe = layout.of(stripe.first - 1);
    }
}

/// Exchanges two rows.
pub(crate) fn exchange<T>(x: &mut [T], width: usize, j: usize, k: usize) {
    if j != k {
        let (head, tail) = x.split_at_mut(width * k);
        head[width * j..][..width].swap_with_slice(&mut tail[..width]);
    }
}

/// Some rows and columns of a matrix that is stored by columns, or their transpose.
struct Part<'a, T> {
    entries: &'a [T],
    leading: usize,
    rows: Range<usize>,
    columns: Range<usize>,
    transposed: bool,
}

/// Columns of the factor, of which all rows from the first column on are there.
#[derive(Clone, Copy)]
struct Block<'a, T> {
    entries: &'a [T],
    leading: usize,
}

impl<'a, T: Number> Block<'a, T> {
    fn of(panels: &Panels<'a, T>, stripe: Stripe) -> Self {
        Block { entries: &panels.left[stripe.start..stripe.end()], leading: stripe.rows }
    }

    fn part(self, rows: Range<usize>, columns: Range<usize>) -> Part<'a, T> {
        Part { entries: self.entries, leading: self.leading, rows, columns, transposed: false }
    }

    /// What is below the square, before row `border` and from there on.
    fn below(self, border: usize) -> (Part<'a, T>, Part<'a, T>) {
        let columns = self.entries.len() / self.leading.max(1);
        (self.part(columns..border, 0..columns), self.part(border..self.leading, 0..columns))
    }
}

impl<T: Number> Part<'_, T> {
    fn transposed(self) -> Self {
        Part { transposed: true, ..self }
    }

    fn column(&self, k: usize) -> &[T] {
        &self.entries[self.leading * k..][self.rows.clone()]
    }

    fn matrix(&self) -> MatRef<'_, T> {
        let all = MatRef::from_column_major_slice(self.entries, self.leading, self.entries.len() / self.leading.max(1));
        let part = all.get(self.rows.clone(), self.columns.clone());
        if self.transposed { part.transpose() } else { part }
    }
}

/// `y <- y - part x`, where rows have this width.
fn take<T: Number>(y: &mut [T], part: &Part<T>, x: &[T], width: usize) {
    if part.rows.len() * part.columns.len() <= SMALL {
        return Arch::new().dispatch(
            #[inline(always)]
            || take_small(y, part, x, width),
        );
    }
    let rows = |x: &[T]| x.len() / width;
    let (y_rows, x_rows) = (rows(y), rows(x));
    let y = MatMut::from_row_major_slice_mut(y, y_rows, width);
    matmul(y, Accum::Add, part.matrix(), MatRef::from_row_major_slice(x, x_rows, width), T::round(-1.0), Par::Seq);
}

#[inline(always)]
fn take_small<T: Number>(y: &mut [T], part: &Part<T>, x: &[T], width: usize) {
    for (j, k) in part.columns.clone().enumerate() {
        for (i, &factor) in part.column(k).iter().enumerate() {
            let (to, from) = if part.transposed { (j, i) } else { (i, j) };
            subtract(&mut y[width * to..][..width], factor, &x[width * from..][..width]);
        }
    }
}

/// `x <- L11^-1 x` for the pivots of a range, whose rows `x` holds.
fn lower<T: Number>(block: Block<T>, range: Range<usize>, x: &mut [T], width: usize) {
    if range.len() <= NARROW {
        return Arch::new().dispatch(
            #[inline(always)]
            || lower_narrow(block, range, x, width),
        );
    }
    let middle = range.start + range.len() / 2;
    let (first, second) = x.split_at_mut(width * (middle - range.start));
    lower(block, range.start..middle, first, width);
    let (rows, columns) = (middle..range.end, range.start..middle);
    take(second, &block.part(rows, columns), first, width);
    lower(block, middle..range.end, second, width);
}

#[inline(always)]
fn lower_narrow<T: Number>(block: Block<T>, range: Range<usize>, x: &mut [T], width: usize) {
    for (done, k) in range.clone().enumerate() {
        let (x, rest) = x.split_at_mut(width * (done + 1));
        let factors = &block.entries[block.leading * k..][k + 1..range.end];
        for (row, &factor) in rest.chunks_exact_mut(width).zip(factors) {
            subtract(row, factor, &x[width * done..]);
        }
    }
}

/// `x <- U11^-1 x` for the pivots of a range, whose rows `x` holds.
fn upper<T: Number>(block: Block<T>, range: Range<usize>, x: &mut [T], width: usize) {
    if range.len() <= NARROW {
        return Arch::new().dispatch(
            #[inline(always)]
            || upper_narrow(block, range, x, width),
        );
    }
    let middle = range.start + range.len() / 2;
    let (first, second) = x.split_at_mut(width * (middle - range.start));
    upper(block, middle..range.end, second, width);
    let (rows, columns) = (range.start..middle, middle..range.end);
    take(first, &block.part(rows, columns), second, width);
    upper(block, range.start..middle, first, width);
}

#[inline(always)]
fn upper_narrow<T: Number>(block: Block<T>, range: Range<usize>, x: &mut [T], width: usize) {
    for (above, k) in range.clone().enumerate().rev() {
        let column = &block.entries[block.leading * k..][range.start..=k];
        let (rest, x) = x.split_at_mut(width * above);
        let x = &mut x[..width];
        x.iter_mut().for_each(|x| *x /= column[above]);
        for (row, &factor) in rest.chunks_exact_mut(width).zip(column) {
            subtract(row, factor, x);
        }
    }
}

/// `x <- L11^-T x` for the pivots of a range, whose rows `x` holds.
fn lower_transposed<T: Number>(block: Block<T>, range: Range<usize>, x: &mut [T], width: usize) {
    if range.len() <= NARROW {
        return Arch::new().dispatch(
            #[inline(always)]
            || lower_transposed_narrow(block, range, x, width),
        );
    }
    let middle = range.start + range.len() / 2;
    let (first, second) = x.split_at_mut(width * (middle - range.start));
    lower_transposed(block, middle..range.end, second, width);
    let (rows, columns) = (middle..range.end, range.start..middle);
    take(first, &block.part(rows, columns).transposed(), second, width);
    lower_transposed(block, range.start..middle, first, width);
}

#[inline(always)]
fn lower_transposed_narrow<T: Number>(block: Block<T>, range: Range<usize>, x: &mut [T], width: usize) {
    for (above, k) in range.clone().enumerate().rev() {
        let factors = &block.entries[block.leading * k..][k + 1..range.end];
        let (own, rest) = x[width * above..].split_at_mut(width);
        for (row, &factor) in rest.chunks_exact(width).zip(factors) {
            subtract(own, factor, row);
        }
    }
}
