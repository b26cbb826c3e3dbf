//! A term that a step does without.

use super::{Attempt, Branch, Local, Stencil, Stencils};
use crate::Failure;

/// An attempt without stencils.
#[derive(Debug)]
pub struct Idle;

impl Attempt for Idle {
    fn scratch(&self, _: usize) -> Vec<f64> {
        Vec::new()
    }
    fn stencils(&self, _: &[f64], _: &mut Stencils) -> Result<(), Failure> {
        Ok(())
    }
    fn evaluate(&self, _: usize, _: &Stencil, _: &mut [f64], _: &mut Local) -> Result<Branch, Failure> {
        Ok(0)
    }
}
