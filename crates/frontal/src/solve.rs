//! Substitution with the factors: `P A = L U` front by front, and the transposed system.

use crate::assembly_tree::Front;
use crate::factor::Factor;
use crate::vector::{dot, dot_four, subtract, subtract_four};
use pulp::Arch;

/// Working memory of a solve, in elimination order.
pub(crate) struct Workspace {
    x: Vec<f64>,
    /// Gathered unknowns of one front.
    local: Vec<f64>,
}

impl Workspace {
    pub fn new(factor: &Factor) -> Self {
        let symbolic = &factor.symbolic;
        Workspace { x: vec![0.0; symbolic.pattern.len()], local: vec![0.0; symbolic.prediction.largest_front] }
    }

    /// Room for `count` vectors at once.
    pub fn with_room_for(factor: &Factor, count: usize) -> Self {
        let one = Self::new(factor);
        Workspace { x: vec![0.0; one.x.len() * count], local: vec![0.0; one.local.len() * count] }
    }

    /// How many vectors it holds.
    pub fn count(&self, factor: &Factor) -> usize {
        self.x.len() / factor.symbolic.pattern.len().max(1)
    }

    /// The vectors, and room for the gathered unknowns of a front.
    pub fn vectors_and_local(&mut self) -> (&mut [f64], &mut [f64]) {
        (&mut self.x, &mut self.local)
    }

    /// The vectors, one after the other.
    pub fn vectors(&mut self) -> &mut [f64] {
        &mut self.x
    }
}

impl Factor {
    /// `x <- A^-1 x` for the equilibrated matrix as it was factorised, perturbed pivots included.
    pub(crate) fn substitute(&self, x: &mut [f64], work: &mut Workspace) {
        self.permuted(x, work, |factor, work| {
            factor.forward(work);
            factor.backward(work);
        });
    }

    /// The first half of a substitution, in elimination order.
    pub(crate) fn forward(&self, work: &mut Workspace) {
        self.symbolic.tree.fronts.iter().for_each(|front| self.at_front(front, work, forward));
    }

    /// The second half.
    pub(crate) fn backward(&self, work: &mut Workspace) {
        self.symbolic.tree.fronts.iter().rev().for_each(|front| self.at_front(front, work, backward));
    }

    /// The first half where only the entries `from` are not zero.
    pub(crate) fn forward_from(&self, from: &[u32], work: &mut Workspace) {
        let fronts = self.symbolic.tree.fronts.iter().zip(self.symbolic.tree.above(from));
        for (front, _) in fronts.filter(|(_, reached)| *reached) {
            self.at_front(front, work, |panels, x| {
                if x[..panels.p].iter().any(|x| *x != 0.0) {
                    forward(panels, x);
                }
            });
        }
    }

    /// The second half where only the entries `to` are needed.
    pub(crate) fn backward_to(&self, to: &[u32], work: &mut Workspace) {
        let fronts = self.symbolic.tree.fronts.iter().zip(self.symbolic.tree.above(to));
        for (front, _) in fronts.rev().filter(|(_, needed)| *needed) {
            self.at_front(front, work, backward);
        }
    }

    /// `x <- A^-T x`.
    pub(crate) fn substitute_transposed(&self, x: &mut [f64], work: &mut Workspace) {
        self.permuted(x, work, |factor, work| {
            for front in &factor.symbolic.tree.fronts {
                factor.at_front(front, work, forward_transposed);
            }
            for front in factor.symbolic.tree.fronts.iter().rev() {
                factor.at_front(front, work, backward_transposed);
            }
        });
    }

    pub(crate) fn permuted(&self, x: &mut [f64], work: &mut Workspace, solve: impl Fn(&Self, &mut Workspace)) {
        let order = &self.symbolic.tree.order;
        work.x.iter_mut().zip(order).for_each(|(permuted, &unknown)| *permuted = x[unknown as usize]);
        solve(self, work);
        work.x.iter().zip(order).for_each(|(permuted, &unknown)| x[unknown as usize] = *permuted);
    }

    /// The factors of a front.
    pub(crate) fn panels(&self, front: &Front) -> Panels<'_> {
        let (left, right) = self.factors[front.factor_range()].split_at(front.size() * front.pivots);
        let pivots = &self.pivots[front.pivot_range()];
        Panels { left, right, pivots, m: front.size(), p: front.pivots, symmetric: front.symmetric }
    }

    /// Gathers the unknowns of a front, pivots first, lets `step` work on them and scatters them.
    pub(crate) fn at_front(&self, front: &Front, work: &mut Workspace, step: impl Fn(&Panels, &mut [f64])) {
        let tree = &self.symbolic.tree;
        let panels = self.panels(front);
        for x in work.x.chunks_exact_mut(self.symbolic.pattern.len()) {
            let local = &mut work.local[..front.size()];
            let (top, border) = local.split_at_mut(front.pivots);
            top.copy_from_slice(&x[front.pivot_range()]);
            for (value, &row) in border.iter_mut().zip(tree.rows(front)) {
                *value = x[row as usize];
            }
            Arch::new().dispatch(|| step(&panels, local));
            let (top, border) = local.split_at(front.pivots);
            x[front.pivot_range()].copy_from_slice(top);
            for (value, &row) in border.iter().zip(tree.rows(front)) {
                x[row as usize] = *value;
            }
        }
    }
}

/// The factors of one front; `left` is `m` x `p`, `right` (U12 transposed) has `m - p` rows and is missing if
/// the matrix is symmetric.
pub(crate) struct Panels<'a> {
    pub left: &'a [f64],
    pub right: &'a [f64],
    pub pivots: &'a [crate::dense::Pivot],
    pub m: usize,
    pub p: usize,
    pub symmetric: bool,
}

impl Panels<'_> {
    fn left(&self, k: usize) -> &[f64] {
        &self.left[self.m * k..self.m * (k + 1)]
    }

    /// Row `k` of U12, as a factor and a column to be multiplied with it.
    fn right(&self, k: usize) -> (f64, &[f64]) {
        let border = self.m - self.p;
        match self.symmetric {
            true => (self.left(k)[k], &self.left(k)[self.p..]),
            false => (1.0, &self.right[border * k..border * (k + 1)]),
        }
    }
}

/// Columns taken together: the vectors they are combined with are then loaded and stored less often than they are.
const WIDTH: usize = 4;

/// `[L11; L21]` downwards.
#[inline(always)]
pub(crate) fn forward(panels: &Panels, x: &mut [f64]) {
    for (k, pivot) in panels.pivots.iter().enumerate() {
        x.swap(k, pivot.row as usize);
    }
    for start in (0..panels.p).step_by(WIDTH) {
        let end = (start + WIDTH).min(panels.p);
        let (done, rest) = x.split_at_mut(end);
        for k in start..end {
            let value = done[k];
            subtract(&mut done[k + 1..], value, &panels.left(k)[k + 1..end]);
        }
        subtract_columns(rest, &done[start..], |k| &panels.left(start + k)[end..]);
    }
}

/// `[U11 U12]` upwards.
#[inline(always)]
pub(crate) fn backward(panels: &Panels, x: &mut [f64]) {
    let (x, border) = x.split_at_mut(panels.p);
    for start in (0..panels.p).step_by(WIDTH) {
        let end = (start + WIDTH).min(panels.p);
        let sums = dot_columns(border, end - start, |k| panels.right(start + k).1);
        (start..end).for_each(|k| x[k] -= panels.right(k).0 * sums[k - start]);
    }
    for start in (0..panels.p).step_by(WIDTH).rev() {
        let end = (start + WIDTH).min(panels.p);
        for k in (start..end).rev() {
            let column = panels.left(k);
            x[k] /= column[k];
            let value = x[k];
            subtract(&mut x[start..k], value, &column[start..k]);
        }
        let (rest, done) = x.split_at_mut(start);
        subtract_columns(rest, &done[..end - start], |k| &panels.left(start + k)[..start]);
    }
}

/// `[U11 U12]^T` downwards.
#[inline(always)]
pub(crate) fn forward_transposed(panels: &Panels, x: &mut [f64]) {
    let (x, border) = x.split_at_mut(panels.p);
    for start in (0..panels.p).step_by(WIDTH) {
        let end = (start + WIDTH).min(panels.p);
        let sums = dot_columns(&x[..start], end - start, |k| &panels.left(start + k)[..start]);
        for k in start..end {
            let column = panels.left(k);
            x[k] = (x[k] - sums[k - start] - dot(&column[start..k], &x[start..k])) / column[k];
        }
        let mut scaled = [0.0; WIDTH];
        (start..end).for_each(|k| scaled[k - start] = panels.right(k).0 * x[k]);
        subtract_columns(border, &scaled[..end - start], |k| panels.right(start + k).1);
    }
}

/// `[L11; L21]^T` upwards.
#[inline(always)]
pub(crate) fn backward_transposed(panels: &Panels, x: &mut [f64]) {
    for start in (0..panels.p).step_by(WIDTH).rev() {
        let end = (start + WIDTH).min(panels.p);
        let sums = dot_columns(&x[end..], end - start, |k| &panels.left(start + k)[end..]);
        for k in (start..end).rev() {
            x[k] -= sums[k - start] + dot(&panels.left(k)[k + 1..end], &x[k + 1..end]);
        }
    }
    for (k, pivot) in panels.pivots.iter().enumerate().rev() {
        x.swap(k, pivot.row as usize);
    }
}

/// `y <- y - sum of factor times column`.
#[inline(always)]
fn subtract_columns<'a>(y: &mut [f64], factors: &[f64], column: impl Fn(usize) -> &'a [f64]) {
    match *factors {
        [a, b, c, d] => subtract_four(y, [a, b, c, d], [column(0), column(1), column(2), column(3)]),
        _ => factors.iter().enumerate().for_each(|(k, &factor)| subtract(y, factor, column(k))),
    }
}

/// Products of `count` columns with `y`.
#[inline(always)]
fn dot_columns<'a>(y: &[f64], count: usize, column: impl Fn(usize) -> &'a [f64]) -> [f64; WIDTH] {
    if count == WIDTH {
        return dot_four(y, [column(0), column(1), column(2), column(3)]);
    }
    let mut sums = [0.0; WIDTH];
    (0..count).for_each(|k| sums[k] = dot(column(k), y));
    sums
}
