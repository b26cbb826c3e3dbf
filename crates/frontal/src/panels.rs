//! What a substitution does at one front.

use crate::stripes::Stripes;
use crate::vector::{Number, subtract};
use pulp::{Arch, Simd, WithSimd};
use std::marker::PhantomData;

/// The factors of one front; `left` is `m` x `p`, `right` (U12 transposed) has `m - p` rows. If the matrix is symmetric the
/// unit lower `L` and on its diagonal `D` are in `left`, in stripes, and `right` is missing.
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

    /// Column `k` of `left` from the diagonal on.
    #[inline(always)]
    pub fn column_below(&self, k: usize) -> &[T] {
        let start = if self.symmetric { Stripes::lower(self.m, self.p).place(k, k) } else { self.m * k + k };
        &self.left[start..start + self.m - k]
    }

    /// Row `k` of U12.
    #[inline(always)]
    fn right(&self, k: usize) -> &[T] {
        let border = self.m - self.p;
        &self.right[border * k..border * (k + 1)]
    }
}

/// What is done at a front, inlined into what [`Arch::dispatch`] compiles for the processor at hand.
pub(crate) trait Step {
    fn run<T: Number, S: Simd>(simd: S, panels: &Panels<T>, x: &mut [T]);
}

impl<T: Number> Panels<'_, T> {
    /// Takes a step on the unknowns of the front, pivots first.
    pub fn take<Taken: Step>(&self, x: &mut [T]) {
        Arch::new().dispatch(At { panels: self, x, step: PhantomData::<Taken> });
    }
}

/// Not a closure, which would not be told of the vectors.
struct At<'a, T, Taken> {
    panels: &'a Panels<'a, T>,
    x: &'a mut [T],
    step: PhantomData<Taken>,
}

impl<T: Number, Taken: Step> WithSimd for At<'_, T, Taken> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        Taken::run(simd, self.panels, self.x);
    }
}

// The columns of a front follow each other in memory: one after the other is how they are read fastest.

/// `[L11; L21]` downwards.
pub(crate) struct Forward;
impl Step for Forward {
    #[inline(always)]
    fn run<T: Number, S: Simd>(_: S, panels: &Panels<T>, x: &mut [T]) {
        if !panels.symmetric {
            for (k, pivot) in panels.pivots.iter().enumerate() {
                x.swap(k, pivot.row as usize);
            }
        }
        for k in 0..panels.p {
            let (done, rest) = x.split_at_mut(k + 1);
            subtract(rest, done[k], &panels.column_below(k)[1..]);
        }
    }
}

/// [`Forward`] where most unknowns are zero.
pub(crate) struct SparseForward;
impl Step for SparseForward {
    #[inline(always)]
    fn run<T: Number, S: Simd>(simd: S, panels: &Panels<T>, x: &mut [T]) {
        if x[..panels.p].iter().any(|x| *x != T::round(0.0)) {
            Forward::run(simd, panels, x);
        }
    }
}

/// `[U11 U12]` upwards; `D [L11; L21]^T` if the matrix is symmetric.
pub(crate) struct Backward;
impl Step for Backward {
    #[inline(always)]
    fn run<T: Number, S: Simd>(simd: S, panels: &Panels<T>, x: &mut [T]) {
        if panels.symmetric {
            for k in (0..panels.p).rev() {
                let column = panels.column_below(k);
                let (done, rest) = x.split_at_mut(k + 1);
                done[k] = done[k] / column[0] - T::dot(simd, &column[1..], rest);
            }
            return;
        }
        let (x, border) = x.split_at_mut(panels.p);
        for (k, x) in x.iter_mut().enumerate() {
            *x -= T::dot(simd, panels.right(k), border);
        }
        for k in (0..panels.p).rev() {
            let column = panels.left(k);
            x[k] /= column[k];
            let (rest, done) = x.split_at_mut(k);
            subtract(rest, done[0], column);
        }
    }
}

/// `[U11 U12]^T` downwards, not of a symmetric matrix.
pub(crate) struct ForwardTransposed;
impl Step for ForwardTransposed {
    #[inline(always)]
    fn run<T: Number, S: Simd>(simd: S, panels: &Panels<T>, x: &mut [T]) {
        let (x, border) = x.split_at_mut(panels.p);
        for k in 0..panels.p {
            let (column, right) = (panels.left(k), panels.right(k));
            x[k] = (x[k] - T::dot(simd, &column[..k], &x[..k])) / column[k];
            subtract(border, x[k], right);
        }
    }
}

/// `[L11; L21]^T` upwards, not of a symmetric matrix.
pub(crate) struct BackwardTransposed;
impl Step for BackwardTransposed {
    #[inline(always)]
    fn run<T: Number, S: Simd>(simd: S, panels: &Panels<T>, x: &mut [T]) {
        for k in (0..panels.p).rev() {
            let (done, rest) = x.split_at_mut(k + 1);
            done[k] -= T::dot(simd, &panels.left(k)[k + 1..], rest);
        }
        for (k, pivot) in panels.pivots.iter().enumerate().rev() {
            x.swap(k, pivot.row as usize);
        }
    }
}
