//! The factors once more in single precision. A substitution takes as long as reading the factors; where it only
//! preconditions an iterative solution, half the bytes do, as long as what rounding spoils is little: for a matrix `A`
//! with rounded factors `M` that is `|b - A M^-1 b|`, of the order of the condition number times the round-off.

use crate::diagnose;
use crate::factor::{Factor, LARGE};
use crate::huge;
use crate::solve::{Halves, Workspace};

use crate::vector::{norm, subtract};

/// Part of a right-hand side that rounding may spoil.
const SPOILT: f64 = 0.01;

/// Rounded factors, if they are those of the factor there is, and whether they are fit for use: found out once for a factor, with a
/// right-hand side that is always the same, so that nothing shows in what is solved with it but itself.
#[derive(Debug, Default)]
pub(crate) struct Rounded {
    entries: Vec<f32>,
    current: bool,
    fit: bool,
}

impl Rounded {
    /// There will be other factors, whose making needs the memory if that is large.
    pub fn forget(&mut self) {
        (self.current, self.fit) = (false, false);
        if size_of_val(&*self.entries) > LARGE {
            self.entries = Vec::new();
        }
    }

    /// Whether it is settled if the rounded factors of the factor there is serve.
    pub fn settled(&self) -> bool {
        self.current
    }

    /// Settles whether the rounded factors of the factor there is serve: unless rounding spoils them, or there is not the
    /// memory.
    pub fn settle(&mut self, factor: &Factor) {
        if !self.current {
            self.current = true;
            self.fit = self.round(factor) && self.spoils_little(factor);
        }
    }

    /// The rounded factors, where they serve.
    pub fn known<'a>(&'a self, factor: &'a Factor) -> Option<Halves<'a, f32>> {
        (self.current && self.fit).then_some(Halves { factor, entries: &self.entries })
    }

    fn round(&mut self, factor: &Factor) -> bool {
        let (bytes, limit) = (factor.symbolic.prediction.bytes, factor.symbolic.options.memory_limit);
        if limit.is_some_and(|limit| bytes + size_of_val(&*factor.factors) / 2 > limit) {
            return false;
        }
        if self.entries.capacity() < factor.factors.len() {
            self.entries = Vec::new();
            self.entries = vec![0.0; factor.factors.len()];
            huge::ask(&self.entries);
        }
        self.entries.resize(factor.factors.len(), 0.0);
        self.entries.iter_mut().zip(&factor.factors).for_each(|(single, double)| *single = *double as f32);
        true
    }

    fn spoils_little(&self, factor: &Factor) -> bool {
        // What is smooth as well as what is not: a soft motion answers to the former.
        let mut residual: Vec<f64> = (0..factor.pivots.len()).map(|k| 1.0 + diagnose::start(k, 0)).collect();
        let size = norm(&residual).max(f64::MIN_POSITIVE);
        // Of length one, as all that is preconditioned: single precision has less range.
        residual.iter_mut().for_each(|r| *r /= size);
        let mut x = residual.clone();
        Halves { factor, entries: &self.entries }.substitute(&mut x, &mut Workspace::new(factor));
        subtract(&mut residual, 1.0, &factor.times(&x));
        norm(&residual) <= SPOILT
    }
}
