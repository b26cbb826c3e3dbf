//! Directions kept from one iterative solution to the next: matrices that differ from the factorised one in the same
//! few places share most of what makes the preconditioner imperfect, so the old directions `U` solve the new system in
//! part before the first substitution. With `C = A U` orthonormal, FGMRES works on `(I - C C^T) A` (de Sturler, J.
//! Comput. Appl. Math. 67, 1996; Parks et al., SIAM J. Sci. Comput. 28, 2006). For another right-hand side of the same
//! matrix that costs two products of vectors a direction, for another matrix one product with it, about a tenth of a
//! substitution in space.

use crate::krylov::System;
use crate::vector::{dot, norm, subtract};

/// Directions kept for another matrix at the most, the latest ones,
const OTHER: usize = 12;
/// and for the same.
const SAME: usize = 40;
/// An image that keeps less than this of its length next to the others adds nothing.
const DEPENDENT: f64 = 1e-8;

/// Directions `u` and their orthonormal images `c = A u` under the matrix at hand, oldest first.
#[derive(Debug, Default)]
pub(crate) struct Outer {
    u: Vec<Vec<f64>>,
    c: Vec<Vec<f64>>,
}

impl Outer {
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// The same directions with their images under another matrix.
    pub fn carry_over(&mut self, system: &mut impl System) {
        let old = std::mem::take(self).u;
        for mut u in old.into_iter().rev().take(OTHER) {
            let mut c = vec![0.0; u.len()];
            system.multiply(&u, &mut c);
            let before = norm(&c);
            let parts = self.take_out(&mut c);
            let length = norm(&c);
            if length > DEPENDENT * before {
                self.put_back(&parts, 1.0, &mut u);
                u.iter_mut().chain(&mut c).for_each(|x| *x /= length);
                self.add(u, c);
            }
        }
        self.u.reverse();
        self.c.reverse();
    }

    /// Takes in a direction and its image, of unit length and orthogonal to the others.
    pub fn add(&mut self, u: Vec<f64>, c: Vec<f64>) {
        self.u.push(u);
        self.c.push(c);
    }

    /// Drops the oldest directions beyond those to keep.
    pub fn trim(&mut self) {
        let beyond = self.u.len().saturating_sub(SAME);
        self.u.drain(..beyond);
        self.c.drain(..beyond);
    }

    /// Adds to `x` the directions from `first` on as far as they make the residual orthogonal to their images.
    pub fn correct(&self, first: usize, residual: &mut [f64], x: &mut [f64]) {
        for (u, c) in self.u.iter().zip(&self.c).skip(first) {
            let part = orthogonalise(residual, c);
            subtract(x, -part, u);
        }
    }

    /// Number of directions.
    pub fn len(&self) -> usize {
        self.u.len()
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
