//! History variables of laws, over any scalar.

use crate::tensor::{Scalar, Tensor2, Vec3};

/// History variables of a law, over any scalar so that sub-steps may carry derivatives.
pub trait Vars<T: Scalar>: Copy {
    /// From stored values, as constants.
    fn read(values: &[f64]) -> Self;
    /// To stored values, without derivatives.
    fn write(&self, values: &mut [f64]);
    /// Turned by `q`; scalars stay.
    fn rotate(self, _q: &Tensor2<T>) -> Self {
        self
    }
    /// `self + (other - self) weight`.
    fn blend(&self, other: &Self, weight: f64) -> Self;
}

impl<T: Scalar> Vars<T> for () {
    fn read(_: &[f64]) -> Self {}
    fn write(&self, _: &mut [f64]) {}
    fn blend(&self, (): &(), _: f64) -> Self {}
}

impl<T: Scalar, const N: usize> Vars<T> for [T; N] {
    fn read(values: &[f64]) -> Self {
        std::array::from_fn(|i| T::from(values[i]))
    }
    fn write(&self, values: &mut [f64]) {
        values.iter_mut().zip(self).for_each(|(value, x)| *value = x.re());
    }
    fn blend(&self, other: &Self, weight: f64) -> Self {
        std::array::from_fn(|i| self[i] + (other[i] - self[i]) * weight)
    }
}

/// `N` scalars and a symmetric tensor, which turns with the frame.
#[derive(Debug, Clone, Copy)]
pub struct ScalarsAndTensor<T, const N: usize> {
    /// The scalars, stored first.
    pub scalars: [T; N],
    /// The tensor.
    pub tensor: Tensor2<T>,
}

impl<T: Scalar, const N: usize> Vars<T> for ScalarsAndTensor<T, N> {
    fn read(values: &[f64]) -> Self {
        let tensor = Tensor2::from_voigt(std::array::from_fn(|i| T::from(values[N + i])));
        Self { scalars: Vars::<T>::read(values), tensor }
    }
    fn write(&self, values: &mut [f64]) {
        self.scalars.write(&mut values[..N]);
        self.tensor.to_voigt().write(&mut values[N..]);
    }
    fn rotate(self, q: &Tensor2<T>) -> Self {
        Self { tensor: *q * self.tensor * q.transpose(), ..self }
    }
    fn blend(&self, other: &Self, weight: f64) -> Self {
        let tensor = self.tensor + (other.tensor - self.tensor) * T::from(weight);
        Self { scalars: self.scalars.blend(&other.scalars, weight), tensor }
    }
}

/// `N` scalars and a vector, which turns with the frame.
#[derive(Debug, Clone, Copy)]
pub struct ScalarsAndVector<T, const N: usize> {
    /// The scalars, stored first.
    pub scalars: [T; N],
    /// The vector.
    pub vector: Vec3<T>,
}

impl<T: Scalar, const N: usize> Vars<T> for ScalarsAndVector<T, N> {
    fn read(values: &[f64]) -> Self {
        let vector = Vec3(std::array::from_fn(|i| T::from(values[N + i])));
        Self { scalars: Vars::<T>::read(values), vector }
    }
    fn write(&self, values: &mut [f64]) {
        self.scalars.write(&mut values[..N]);
        self.vector.0.write(&mut values[N..]);
    }
    fn rotate(self, q: &Tensor2<T>) -> Self {
        Self { vector: *q * self.vector, ..self }
    }
    fn blend(&self, other: &Self, weight: f64) -> Self {
        let vector = self.vector + (other.vector - self.vector) * T::from(weight);
        Self { scalars: self.scalars.blend(&other.scalars, weight), vector }
    }
}
