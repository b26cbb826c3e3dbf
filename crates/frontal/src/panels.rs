//! What a substitution does at one front.

use crate::vector::{Number, dot, dot_four, subtract, subtract_four};

/// The factors of one front; `left` is `m` x `p`, `right` (U12 transposed) has `m - p` rows and is missing if
/// the matrix is symmetric.
pub(crate) struct Panels<'a, T> {
    pub left: &'a [T],
    pub right: &'a [T],
    pub pivots: &'a [crate::dense::Pivot],
    pub m: usize,
    pub p: usize,
    pub symmetric: bool,
}

impl<T: Number> Panels<'_, T> {
    #[inline(always)]
    fn left(&self, k: usize) -> &[T] {
        &self.left[self.m * k..self.m * (k + 1)]
    }

    /// Row `k` of U12, as a factor and a column to be multiplied with it.
    #[inline(always)]
    fn right(&self, k: usize) -> (f64, &[T]) {
        let border = self.m - self.p;
        match self.symmetric {
            true => (self.left(k)[k].into(), &self.left(k)[self.p..]),
            false => (1.0, &self.right[border * k..border * (k + 1)]),
        }
    }
}

/// What is done at a front. Not a closure, since only what is inlined into [`pulp::Arch::dispatch`] is compiled
/// for the processor at hand.
pub(crate) trait Step {
    fn run<T: Number>(panels: &Panels<T>, x: &mut [f64]);
}

pub(crate) struct Forward;
impl Step for Forward {
    #[inline(always)]
    fn run<T: Number>(panels: &Panels<T>, x: &mut [f64]) {
        forward(panels, x);
    }
}

/// [`Forward`] where most unknowns are zero.
pub(crate) struct SparseForward;
impl Step for SparseForward {
    #[inline(always)]
    fn run<T: Number>(panels: &Panels<T>, x: &mut [f64]) {
        if x[..panels.p].iter().any(|x| *x != 0.0) {
            forward(panels, x);
        }
    }
}

pub(crate) struct Backward;
impl Step for Backward {
    #[inline(always)]
    fn run<T: Number>(panels: &Panels<T>, x: &mut [f64]) {
        backward(panels, x);
    }
}

pub(crate) struct ForwardTransposed;
impl Step for ForwardTransposed {
    #[inline(always)]
    fn run<T: Number>(panels: &Panels<T>, x: &mut [f64]) {
        forward_transposed(panels, x);
    }
}

pub(crate) struct BackwardTransposed;
impl Step for BackwardTransposed {
    #[inline(always)]
    fn run<T: Number>(panels: &Panels<T>, x: &mut [f64]) {
        backward_transposed(panels, x);
    }
}

/// Columns taken together: the vectors they are combined with are then loaded and stored less often than they are.
const WIDTH: usize = 4;

/// `[L11; L21]` downwards.
#[inline(always)]
fn forward<T: Number>(panels: &Panels<T>, x: &mut [f64]) {
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
fn backward<T: Number>(panels: &Panels<T>, x: &mut [f64]) {
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
            x[k] /= column[k].into();
            let value = x[k];
            subtract(&mut x[start..k], value, &column[start..k]);
        }
        let (rest, done) = x.split_at_mut(start);
        subtract_columns(rest, &done[..end - start], |k| &panels.left(start + k)[..start]);
    }
}

/// `[U11 U12]^T` downwards.
#[inline(always)]
pub(crate) fn forward_transposed<T: Number>(panels: &Panels<T>, x: &mut [f64]) {
    let (x, border) = x.split_at_mut(panels.p);
    for start in (0..panels.p).step_by(WIDTH) {
        let end = (start + WIDTH).min(panels.p);
        let sums = dot_columns(&x[..start], end - start, |k| &panels.left(start + k)[..start]);
        for k in start..end {
            let column = panels.left(k);
            x[k] = (x[k] - sums[k - start] - dot(&column[start..k], &x[start..k])) / column[k].into();
        }
        let mut scaled = [0.0; WIDTH];
        (start..end).for_each(|k| scaled[k - start] = panels.right(k).0 * x[k]);
        subtract_columns(border, &scaled[..end - start], |k| panels.right(start + k).1);
    }
}

/// `[L11; L21]^T` upwards.
#[inline(always)]
pub(crate) fn backward_transposed<T: Number>(panels: &Panels<T>, x: &mut [f64]) {
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
fn subtract_columns<'a, T: Number + 'a>(y: &mut [f64], factors: &[f64], column: impl Fn(usize) -> &'a [T]) {
    match *factors {
        [a, b, c, d] => subtract_four(y, [a, b, c, d], [column(0), column(1), column(2), column(3)]),
        _ => factors.iter().enumerate().for_each(|(k, &factor)| subtract(y, factor, column(k))),
    }
}

/// Products of `count` columns with `y`.
#[inline(always)]
fn dot_columns<'a, T: Number + 'a>(y: &[f64], count: usize, column: impl Fn(usize) -> &'a [T]) -> [f64; WIDTH] {
    if count == WIDTH {
        return dot_four(y, [column(0), column(1), column(2), column(3)]);
    }
    let mut sums = [0.0; WIDTH];
    (0..count).for_each(|k| sums[k] = dot(column(k), y));
    sums
}
