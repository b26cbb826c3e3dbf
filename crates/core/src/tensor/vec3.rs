//! Vectors of space. Plane problems use the first two components, axisymmetric ones (r, z).

use super::Scalar;
use std::ops::{Add, AddAssign, Index, IndexMut, Mul, Neg, Sub, SubAssign};

/// A vector of three components.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vec3<T = f64>(pub [T; 3]);

impl<T: Scalar> Vec3<T> {
    /// From components.
    pub fn new(x: T, y: T, z: T) -> Self {
        Self([x, y, z])
    }
    /// The zero vector.
    pub fn zero() -> Self {
        Self([T::zero(); 3])
    }
    /// Inner product.
    #[inline]
    pub fn dot(self, other: Self) -> T {
        self.0[0] * other.0[0] + self.0[1] * other.0[1] + self.0[2] * other.0[2]
    }
    /// Vector product.
    #[inline]
    pub fn cross(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([b * z - c * y, c * x - a * z, a * y - b * x])
    }
    /// Euclidean length.
    pub fn norm(self) -> T {
        self.dot(self).sqrt()
    }
    /// The vector of unit length along `self`; not a number for a zero vector.
    pub fn unit(self) -> Self {
        self * self.norm().recip()
    }
    /// The vector turned by a quarter turn in the plane, counter-clockwise: the left normal of a direction.
    #[inline]
    pub fn left(self) -> Self {
        Self([-self.0[1], self.0[0], T::zero()])
    }
    /// The values without derivatives.
    pub fn re(self) -> Vec3<f64> {
        Vec3(self.0.map(T::re))
    }
}

impl Vec3<f64> {
    /// The same vector over another scalar, as a constant.
    pub fn lift<T: Scalar>(self) -> Vec3<T> {
        Vec3(self.0.map(T::from))
    }
    /// The unit vector along an axis.
    pub fn axis(axis: usize) -> Self {
        Self(std::array::from_fn(|k| f64::from(u8::from(k == axis))))
    }
    /// The axis along which a direction is least.
    pub fn least_axis(self) -> usize {
        (0..3).fold(0, |i, j| if self[j].abs() < self[i].abs() { j } else { i })
    }
    /// Derivative of [`unit`](Self::unit) for a derivative `change` of the vector.
    pub fn turned(self, change: Self) -> Self {
        let size = self.norm().recip();
        let n = self * size;
        (change - n * n.dot(change)) * size
    }
    /// Whether every component is a finite number.
    pub fn is_finite(self) -> bool {
        self.0.iter().all(|x| x.is_finite())
    }
}

impl<T> Index<usize> for Vec3<T> {
    type Output = T;
    #[inline]
    fn index(&self, i: usize) -> &T {
        &self.0[i]
    }
}

impl<T> IndexMut<usize> for Vec3<T> {
    #[inline]
    fn index_mut(&mut self, i: usize) -> &mut T {
        &mut self.0[i]
    }
}

impl<T: Scalar> Add for Vec3<T> {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        Self([self.0[0] + o.0[0], self.0[1] + o.0[1], self.0[2] + o.0[2]])
    }
}

impl<T: Scalar> Sub for Vec3<T> {
    type Output = Self;
    #[inline]
    fn sub(self, o: Self) -> Self {
        Self([self.0[0] - o.0[0], self.0[1] - o.0[1], self.0[2] - o.0[2]])
    }
}

impl<T: Scalar> Neg for Vec3<T> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(self.0.map(|x| -x))
    }
}

impl<T: Scalar> Mul<T> for Vec3<T> {
    type Output = Self;
    #[inline]
    fn mul(self, s: T) -> Self {
        Self(self.0.map(|x| x * s))
    }
}

impl<T: Scalar> AddAssign for Vec3<T> {
    #[inline]
    fn add_assign(&mut self, o: Self) {
        for i in 0..3 {
            self.0[i] += o.0[i];
        }
    }
}

impl<T: Scalar> SubAssign for Vec3<T> {
    #[inline]
    fn sub_assign(&mut self, o: Self) {
        for i in 0..3 {
            self.0[i] -= o.0[i];
        }
    }
}
