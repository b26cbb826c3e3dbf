//! The frame of small strain, which never turns.

use super::{Frame, Turning};
use crate::tensor::Tensor2;

/// A frame whose strain is the symmetric part of the displacement gradient.
pub struct Still {
    strain: Tensor2,
    stress: Tensor2,
}

impl Still {
    /// Of a deformation and an old stress.
    pub fn new(f: &Tensor2, old: &Tensor2) -> Self {
        Self { strain: (*f - Tensor2::identity()).sym(), stress: *old }
    }
}

impl Turning for Still {
    fn values(&self) -> Frame<f64> {
        Frame { de: self.strain, q: Tensor2::identity(), stress: self.stress }
    }

    fn slope(&self, (m, n): (usize, usize)) -> Frame<f64> {
        let mut along = Tensor2::zero();
        along[(m, n)] = 1.0;
        Frame { de: along.sym(), q: Tensor2::zero(), stress: Tensor2::zero() }
    }
}
