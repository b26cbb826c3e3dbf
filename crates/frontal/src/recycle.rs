//! Directions kept from one iterative solution to the next: matrices that differ from the factorised one in the same
//! few places share most of what makes the preconditioner imperfect, so the old directions `U` solve the new system in
//! part before the first substitution. With `C = A U` orthonormal, FGMRES works on `(I - C C^T) A` (de Sturler, J.
//! Comput. Appl. Math. 67, 1996; Parks et al., SIAM J. Sci. Comput. 28, 2006). A direction costs one product with the
//! matrix, about a tenth of a substitution in space.

use crate::krylov::System;
use crate::vector::{dot, norm, subtract};

/// Directions kept at the most, the latest ones.
const MOST: usize = 12;
/// An image that keeps less than this of its length next to the others adds nothing.
const DEPENDENT: f64 = 1e-8;

/// Preconditioned directions of earlier solutions, oldest first.
#[derive(Debug, Default)]
pub(crate) struct Recycled(Vec<Vec<f64>>);

impl Recycled {
    pub fn keep(&mut self, directions: Vec<Vec<f64>>) {
        self.0.extend(directions);
        self.0.drain(..self.0.len().saturating_sub(MOST));
    }

    pub fn clear(&mut self) {
        self.0.clear();
    }
}

/// Directions `u` and their orthonormal images `c = A u` under the matrix at hand.
#[derive(Default)]
pub(crate) struct Outer {
    u: Vec<Vec<f64>>,
    c: Vec<Vec<f64>>,
}

impl Outer {
    pub fn new(system: &mut impl System, recycled: &Recycled) -> Self {
        let mut outer = Outer::default();
        for direction in recycled.0.iter().rev() {
            let (mut u, mut c) = (direction.clone(), vec![0.0; direction.len()]);
            system.multiply(&u, &mut c);
            let before = norm(&c);
            let parts = outer.take_out(&mut c);
            let length = norm(&c);
            if length > DEPENDENT * before {
                outer.put_back(&parts, 1.0, &mut u);
                u.iter_mut().chain(&mut c).for_each(|x| *x /= length);
                outer.u.push(u);
                outer.c.push(c);
            }
        }
        outer
    }

    /// Adds to `x` what makes the residual orthogonal to all images.
    pub fn correct(&self, residual: &[f64], x: &mut [f64]) {
        for (u, c) in self.u.iter().zip(&self.c) {
            subtract(x, -dot(c, residual), u);
        }
    }

    /// Takes the parts along the images out of `w`, and returns them.
    pub fn take_out(&self, w: &mut [f64]) -> Vec<f64> {
        self.c.iter().map(|c| orthogonalise(w, c)).collect()
    }

    /// `x <- x - y U parts`: the directions whose images were taken out.
    pub fn put_back(&self, parts: &[f64], y: f64, x: &mut [f64]) {
        for (u, part) in self.u.iter().zip(parts) {
            subtract(x, y * part, u);
        }
    }
}

/// Takes the part along `v` out of `w`, and returns it.
pub(crate) fn orthogonalise(w: &mut [f64], v: &[f64]) -> f64 {
    let part = dot(w, v);
    subtract(w, part, v);
    part
}
