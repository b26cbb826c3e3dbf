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
    fn blend(&self, other: &Self, weight: T) -> Self;
}

impl<T: Scalar> Vars<T> for () {
    fn read(_: &[f64]) -> Self {}
    fn write(&self, _: &mut [f64]) {}
    fn blend(&self, (): &(), _: T) -> Self {}
}

impl<T: Scalar, const N: usize> Vars<T> for [T; N] {
    fn read(values: &[f64]) -> Self {
        std::array::from_fn(|i| T::from(values[i]))
    }
    fn write(&self, values: &mut [f64]) {
        values.iter_mut().zip(self).for_each(|(value, x)| *value = x.re());
    }
    fn blend(&self, other: &Self, weight: T) -> Self {
        std::array::from_fn(|i| self[i] + (other[i] - self[i]) * weight)
    }
}

/// `N` scalars and `K` symmetric tensors, which turn with the frame.
#[derive(Debug, Clone, Copy)]
pub struct ScalarsAndTensors<T, const N: usize, const K: usize> {
    /// The scalars, stored first.
    pub scalars: [T; N],
    /// The tensors.
    pub tensors: [Tensor2<T>; K],
}

impl<T: Scalar, const N: usize, const K: usize> Vars<T> for ScalarsAndTensors<T, N, K> {
    fn read(values: &[f64]) -> Self {
        let tensor = |k: usize| Tensor2::from_voigt(std::array::from_fn(|i| T::from(values[N + 6 * k + i])));
        Self { scalars: Vars::<T>::read(values), tensors: std::array::from_fn(tensor) }
    }
    fn write(&self, values: &mut [f64]) {
        self.scalars.write(&mut values[..N]);
        for (k, tensor) in self.tensors.iter().enumerate() {
            tensor.to_voigt().write(&mut values[N + 6 * k..N + 6 * k + 6]);
        }
    }
    fn rotate(self, q: &Tensor2<T>) -> Self {
        Self { tensors: self.tensors.map(|tensor| *q * tensor * q.transpose()), ..self }
    }
    fn blend(&self, other: &Self, weight: T) -> Self {
        let tensor = |k: usize| self.tensors[k] + (other.tensors[k] - self.tensors[k]) * weight;
        Self { scalars: self.scalars.blend(&other.scalars, weight), tensors: std::array::from_fn(tensor) }
    }
}

/// `N` scalars and `K` vectors, which turn with the frame.
#[derive(Debug, Clone, Copy)]
pub struct ScalarsAndVectors<T, const N: usize, const K: usize> {
    /// The scalars, stored first.
    pub scalars: [T; N],
    /// The vectors.
    pub vectors: [Vec3<T>; K],
}

impl<T: Scalar, const N: usize, const K: usize> Vars<T> for ScalarsAndVectors<T, N, K> {
    fn read(values: &[f64]) -> Self {
        let vector = |k: usize| Vec3(std::array::from_fn(|i| T::from(values[N + 3 * k + i])));
        Self { scalars: Vars::<T>::read(values), vectors: std::array::from_fn(vector) }
    }
    fn write(&self, values: &mut [f64]) {
        self.scalars.write(&mut values[..N]);
        for (k, vector) in self.vectors.iter().enumerate() {
            vector.0.write(&mut values[N + 3 * k..N + 3 * k + 3]);
        }
    }
    fn rotate(self, q: &Tensor2<T>) -> Self {
        Self { vectors: self.vectors.map(|vector| *q * vector), ..self }
    }
    fn blend(&self, other: &Self, weight: T) -> Self {
        let vector = |k: usize| self.vectors[k] + (other.vectors[k] - self.vectors[k]) * weight;
        Self { scalars: self.scalars.blend(&other.scalars, weight), vectors: std::array::from_fn(vector) }
    }
}
