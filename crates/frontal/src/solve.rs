//! Substitution with the factors: `P A = L U` front by front, and the transposed system.

use crate::assembly_tree::Front;
use crate::factor::Factor;
use crate::vector::{dot, subtract};
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
}

impl Factor {
    /// `x <- A^-1 x` for the equilibrated matrix as it was factorised, perturbed pivots included.
    pub(crate) fn substitute(&self, x: &mut [f64], work: &mut Workspace) {
        self.permuted(x, work, |factor, work| {
            for front in &factor.symbolic.tree.fronts {
                factor.at_front(front, work, forward);
            }
            for front in factor.symbolic.tree.fronts.iter().rev() {
                factor.at_front(front, work, backward);
            }
        });
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

    fn permuted(&self, x: &mut [f64], work: &mut Workspace, solve: impl Fn(&Self, &mut Workspace)) {
        let order = &self.symbolic.tree.order;
        for (permuted, &unknown) in work.x.iter_mut().zip(order) {
            *permuted = x[unknown as usize];
        }
        solve(self, work);
        for (permuted, &unknown) in work.x.iter().zip(order) {
            x[unknown as usize] = *permuted;
        }
    }

    /// Gathers the unknowns of a front, pivots first, lets `step` work on them and scatters them.
    fn at_front(&self, front: &Front, work: &mut Workspace, step: impl Fn(&Panels, &mut [f64])) {
        let tree = &self.symbolic.tree;
        let (left, right) = self.factors[front.factor_range()].split_at(front.size() * front.pivots);
        let pivots = &self.pivots[front.pivot_range()];
        let panels = Panels { left, right, pivots, m: front.size(), p: front.pivots, symmetric: front.symmetric };
        let local = &mut work.local[..front.size()];
        let (top, border) = local.split_at_mut(front.pivots);
        top.copy_from_slice(&work.x[front.pivot_range()]);
        for (value, &row) in border.iter_mut().zip(tree.rows(front)) {
            *value = work.x[row as usize];
        }
        Arch::new().dispatch(|| step(&panels, local));
        let (top, border) = local.split_at(front.pivots);
        work.x[front.pivot_range()].copy_from_slice(top);
        for (value, &row) in border.iter().zip(tree.rows(front)) {
            work.x[row as usize] = *value;
        }
    }
}

/// The factors of one front; `left` is `m` x `p`, `right` (U12 transposed) has `m - p` rows and is missing if
/// the matrix is symmetric.
struct Panels<'a> {
    left: &'a [f64],
    right: &'a [f64],
    pivots: &'a [crate::dense::Pivot],
    m: usize,
    p: usize,
    symmetric: bool,
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

/// `[L11; L21]` downwards.
#[inline(always)]
fn forward(panels: &Panels, x: &mut [f64]) {
    for (k, pivot) in panels.pivots.iter().enumerate() {
        x.swap(k, pivot.row as usize);
    }
    for k in 0..panels.p {
        let (done, rest) = x.split_at_mut(k + 1);
        subtract(rest, done[k], &panels.left(k)[k + 1..]);
    }
}

/// `[U11 U12]` upwards.
#[inline(always)]
fn backward(panels: &Panels, x: &mut [f64]) {
    let (x, border) = x.split_at_mut(panels.p);
    for k in (0..panels.p).rev() {
        let column = panels.left(k);
        let (scale, right) = panels.right(k);
        let value = (x[k] - scale * dot(right, border)) / column[k];
        x[k] = value;
        subtract(&mut x[..k], value, &column[..k]);
    }
}

/// `[U11 U12]^T` downwards.
#[inline(always)]
fn forward_transposed(panels: &Panels, x: &mut [f64]) {
    let (x, border) = x.split_at_mut(panels.p);
    for k in 0..panels.p {
        let column = panels.left(k);
        let value = (x[k] - dot(&column[..k], &x[..k])) / column[k];
        x[k] = value;
        let (scale, right) = panels.right(k);
        subtract(border, scale * value, right);
    }
}

/// `[L11; L21]^T` upwards.
#[inline(always)]
fn backward_transposed(panels: &Panels, x: &mut [f64]) {
    for k in (0..panels.p).rev() {
        x[k] -= dot(&panels.left(k)[k + 1..], &x[k + 1..]);
    }
    for (k, pivot) in panels.pivots.iter().enumerate().rev() {
        x.swap(k, pivot.row as usize);
    }
}
