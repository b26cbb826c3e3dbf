//! The numbers that a contact point is evaluated with: plain ones, and those that carry derivatives.

use crate::Failure;
use crate::interface::{Interface, Motion, Past, Response};
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

/// Numbers that a law answers.
pub trait Ask<const N: usize>: Seed<N> {
    /// What the law answers to a motion.
    ///
    /// # Errors
    /// As the law.
    fn ask(
        law: &dyn Interface,
        motion: &Motion<Self>,
        past: &Past,
        vars: &mut [f64],
    ) -> Result<Response<Self>, Failure>;
}

impl<const N: usize> Ask<N> for f64 {
    fn ask(law: &dyn Interface, motion: &Motion<f64>, past: &Past, vars: &mut [f64]) -> Result<Response<f64>, Failure> {
        law.respond(motion, past, vars)
    }
}

impl Ask<8> for Dual<8> {
    fn ask(
        law: &dyn Interface,
        motion: &Motion<Self>,
        past: &Past,
        vars: &mut [f64],
    ) -> Result<Response<Self>, Failure> {
        law.respond_plane(motion, past, vars)
    }
}

impl Ask<15> for Dual<15> {
    fn ask(
        law: &dyn Interface,
        motion: &Motion<Self>,
        past: &Past,
        vars: &mut [f64],
    ) -> Result<Response<Self>, Failure> {
        law.respond_space(motion, past, vars)
    }
}
