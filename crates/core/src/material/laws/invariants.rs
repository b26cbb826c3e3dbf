//! Mean and equivalent stress, for laws that depend on nothing else of the stress.

use crate::tensor::{Scalar, Tensor2};

/// A stress by its mean `p = tr/3` (tension positive), deviator `s` and equivalent `q = sqrt(3/2 s:s)`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Invariants<T> {
    pub p: T,
    pub s: Tensor2<T>,
    pub q: T,
}

impl<T: Scalar> Invariants<T> {
    #[inline]
    pub fn of(stress: &Tensor2<T>) -> Self {
        let s = stress.deviator();
        Self { p: stress.trace() * (1.0 / 3.0), s, q: (s.contract(s) * 1.5).sqrt() }
    }
    /// The stress with this mean and so much of the deviator.
    #[inline]
    pub fn scaled(&self, p: T, scale: T) -> Tensor2<T> {
        Tensor2::from_fn(|i, j| if i == j { self.s[(i, j)] * scale + p } else { self.s[(i, j)] * scale })
    }
    /// The stress with this mean and this equivalent stress along the same deviator.
    #[inline]
    pub fn with(&self, p: T, q: T) -> Tensor2<T> {
        let scale = if self.q.re() > 0.0 { q / self.q } else { T::zero() };
        self.scaled(p, scale)
    }
}
