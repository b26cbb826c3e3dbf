//! Second-order tensors of space.

use super::{Scalar, Vec3};
use std::array::from_fn;
use std::ops::{Add, Index, IndexMut, Mul, Sub};

/// A 3 x 3 tensor, stored by rows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tensor2<T = f64>(pub [[T; 3]; 3]);

impl<T: Scalar> Tensor2<T> {
    /// The zero tensor.
    pub fn zero() -> Self {
        Self([[T::zero(); 3]; 3])
    }
    /// The unit tensor.
    pub fn identity() -> Self {
        Self::from_fn(|i, j| T::from(f64::from(i == j)))
    }
    /// From a function of row and column.
    #[inline]
    pub fn from_fn(mut f: impl FnMut(usize, usize) -> T) -> Self {
        // Written in place: arrays made by `std::array::from_fn` are copied row by row, which dominates for duals.
        let mut out = Self::zero();
        for i in 0..3 {
            for j in 0..3 {
                out.0[i][j] = f(i, j);
            }
        }
        out
    }
    /// A symmetric tensor from XX YY ZZ XY YZ XZ, the order of every file and history.
    #[inline]
    pub fn from_voigt(v: [T; 6]) -> Self {
        Self([[v[0], v[3], v[5]], [v[3], v[1], v[4]], [v[5], v[4], v[2]]])
    }
    /// The components XX YY ZZ XY YZ XZ of a symmetric tensor.
    #[inline]
    pub fn to_voigt(self) -> [T; 6] {
        let m = self.0;
        [m[0][0], m[1][1], m[2][2], m[0][1], m[1][2], m[0][2]]
    }
    /// Transpose.
    #[inline]
    pub fn transpose(self) -> Self {
        Self::from_fn(|i, j| self.0[j][i])
    }
    /// Trace.
    #[inline]
    pub fn trace(self) -> T {
        self.0[0][0] + self.0[1][1] + self.0[2][2]
    }
    /// Determinant.
    #[inline]
    pub fn det(self) -> T {
        let m = self.0;
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
            + m[0][1] * (m[1][2] * m[2][0] - m[1][0] * m[2][2])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    }
    /// Cofactors: the transpose of the inverse times the determinant.
    #[inline]
    pub fn cofactors(self) -> Self {
        let m = self.0;
        Self::from_fn(|i, j| {
            let (a, b, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
            m[a][c] * m[b][d] - m[a][d] * m[b][c]
        })
    }
    /// Inverse; not a number when the determinant is zero.
    #[inline]
    pub fn inverse(self) -> Self {
        let (m, c) = (self.0, self.cofactors().0);
        let scale = (m[0][0] * c[0][0] + m[0][1] * c[0][1] + m[0][2] * c[0][2]).recip();
        Self::from_fn(|i, j| c[j][i] * scale)
    }
    /// Symmetric part.
    #[inline]
    pub fn sym(self) -> Self {
        Self::from_fn(|i, j| if i == j { self.0[i][i] } else { (self.0[i][j] + self.0[j][i]) * 0.5 })
    }
    /// Skew part.
    #[inline]
    pub fn skew(self) -> Self {
        Self::from_fn(|i, j| (self.0[i][j] - self.0[j][i]) * 0.5)
    }
    /// Deviator.
    #[inline]
    pub fn deviator(self) -> Self {
        let mean = self.trace() * (1.0 / 3.0);
        Self::from_fn(|i, j| if i == j { self.0[i][i] - mean } else { self.0[i][j] })
    }
    /// Full contraction `A : B`.
    #[inline]
    pub fn contract(self, other: Self) -> T {
        let mut sum = T::zero();
        for i in 0..3 {
            for j in 0..3 {
                sum += self.0[i][j] * other.0[i][j];
            }
        }
        sum
    }
    /// The values without derivatives.
    pub fn re(self) -> Tensor2<f64> {
        Tensor2(self.0.map(|row| row.map(T::re)))
    }
}

impl Tensor2<f64> {
    /// The same tensor over another scalar, as a constant.
    #[inline]
    pub fn lift<T: Scalar>(self) -> Tensor2<T> {
        Tensor2::from_fn(|i, j| T::from(self.0[i][j]))
    }
}

impl<T> Index<(usize, usize)> for Tensor2<T> {
    type Output = T;
    #[inline]
    fn index(&self, (i, j): (usize, usize)) -> &T {
        &self.0[i][j]
    }
}

impl<T> IndexMut<(usize, usize)> for Tensor2<T> {
    #[inline]
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut T {
        &mut self.0[i][j]
    }
}

impl<T: Scalar> Add for Tensor2<T> {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        Self::from_fn(|i, j| self.0[i][j] + o.0[i][j])
    }
}

impl<T: Scalar> Sub for Tensor2<T> {
    type Output = Self;
    #[inline]
    fn sub(self, o: Self) -> Self {
        Self::from_fn(|i, j| self.0[i][j] - o.0[i][j])
    }
}

impl<T: Scalar> Mul<T> for Tensor2<T> {
    type Output = Self;
    #[inline]
    fn mul(self, s: T) -> Self {
        Self::from_fn(|i, j| self.0[i][j] * s)
    }
}

impl<T: Scalar> Mul for Tensor2<T> {
    type Output = Self;
    #[inline]
    fn mul(self, o: Self) -> Self {
        Self::from_fn(|i, j| self.0[i][0] * o.0[0][j] + self.0[i][1] * o.0[1][j] + self.0[i][2] * o.0[2][j])
    }
}

impl<T: Scalar> Mul<Vec3<T>> for Tensor2<T> {
    type Output = Vec3<T>;
    #[inline]
    fn mul(self, v: Vec3<T>) -> Vec3<T> {
        Vec3(from_fn(|i| self.0[i][0] * v[0] + self.0[i][1] * v[1] + self.0[i][2] * v[2]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_times_itself_is_identity() {
        let a = Tensor2([[2.0, -1.0, 0.3], [0.5, 1.7, -0.2], [0.1, 0.4, 3.0]]);
        let residue = a * a.inverse() - Tensor2::identity();
        assert!(residue.contract(residue).sqrt() < 1e-15);
        assert!((a.det() * a.inverse().det() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn voigt_round_trip() {
        let v = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        assert_eq!(Tensor2::from_voigt(v).to_voigt(), v);
    }
}
