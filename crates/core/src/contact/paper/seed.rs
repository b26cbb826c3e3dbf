//! The numbers that a contact point is evaluated with: plain ones, and those that carry derivatives.

use crate::tensor::{Dual, Scalar};

/// Numbers that can be seeded as independent variables in `N` directions; trivially, `f64`.
pub trait Seed<const N: usize>: Scalar {
    /// The variable of a direction.
    fn seed(value: f64, direction: usize) -> Self;
    /// Derivatives along the directions.
    fn slopes(&self) -> [f64; N];
}

impl<const N: usize> Seed<N> for f64 {
    fn seed(value: f64, _: usize) -> f64 {
        value
    }
    fn slopes(&self) -> [f64; N] {
        [0.0; N]
    }
}

impl<const N: usize> Seed<N> for Dual<N> {
    fn seed(value: f64, direction: usize) -> Self {
        Dual::variable(value, direction)
    }
    fn slopes(&self) -> [f64; N] {
        self.du
    }
}
