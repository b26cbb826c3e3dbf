//! What a law may do with a number.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A real number or a [`Dual`](super::Dual) one. Comparisons and branches look at [`re`](Scalar::re) only.
pub trait Scalar:
    Copy
    + Debug
    + Default
    + PartialEq
    + Send
    + Sync
    + 'static
    + From<f64>
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + AddAssign
    + SubAssign
{
    /// The value without its derivatives.
    fn re(self) -> f64;

    /// The number with value `value` whose derivatives are `slope` times those of `self`: the chain rule for any
    /// function of one variable.
    fn chain(self, value: f64, slope: f64) -> Self;

    /// Zero.
    fn zero() -> Self {
        Self::from(0.0)
    }
    /// One.
    fn one() -> Self {
        Self::from(1.0)
    }
    /// Square root; the slope at zero is taken as zero, so that a norm at rest stays finite.
    fn sqrt(self) -> Self {
        let root = self.re().sqrt();
        self.chain(root, if root > 0.0 { 0.5 / root } else { 0.0 })
    }
    /// Cube root.
    fn cbrt(self) -> Self {
        let root = self.re().cbrt();
        self.chain(root, 1.0 / (3.0 * root * root))
    }
    /// Reciprocal.
    fn recip(self) -> Self {
        let inverse = 1.0 / self.re();
        self.chain(inverse, -inverse * inverse)
    }
    /// Exponential.
    fn exp(self) -> Self {
        let value = self.re().exp();
        self.chain(value, value)
    }
    /// Natural logarithm.
    fn ln(self) -> Self {
        self.chain(self.re().ln(), 1.0 / self.re())
    }
    /// Sine.
    fn sin(self) -> Self {
        self.chain(self.re().sin(), self.re().cos())
    }
    /// Cosine.
    fn cos(self) -> Self {
        self.chain(self.re().cos(), -self.re().sin())
    }
    /// Tangent.
    fn tan(self) -> Self {
        let value = self.re().tan();
        self.chain(value, 1.0 + value * value)
    }
    /// Arc tangent.
    fn atan(self) -> Self {
        self.chain(self.re().atan(), 1.0 / (1.0 + self.re() * self.re()))
    }
    /// Hyperbolic tangent.
    fn tanh(self) -> Self {
        let value = self.re().tanh();
        self.chain(value, 1.0 - value * value)
    }
    /// Inverse hyperbolic sine.
    fn asinh(self) -> Self {
        self.chain(self.re().asinh(), 1.0 / (1.0 + self.re() * self.re()).sqrt())
    }
    /// Hyperbolic cosine.
    fn cosh(self) -> Self {
        self.chain(self.re().cosh(), self.re().sinh())
    }
    /// Hyperbolic sine.
    fn sinh(self) -> Self {
        self.chain(self.re().sinh(), self.re().cosh())
    }
    /// Power with a fixed exponent.
    fn powf(self, exponent: f64) -> Self {
        let (base, value) = (self.re(), self.re().powf(exponent));
        self.chain(value, exponent * if base == 0.0 { base.powf(exponent - 1.0) } else { value / base })
    }
    /// Absolute value; at zero the right-hand slope is taken.
    fn abs(self) -> Self {
        if self.re() < 0.0 { -self } else { self }
    }
    /// The larger of two numbers, with its own derivatives.
    fn max(self, other: Self) -> Self {
        if self.re() >= other.re() { self } else { other }
    }
    /// The smaller of two numbers, with its own derivatives.
    fn min(self, other: Self) -> Self {
        if self.re() <= other.re() { self } else { other }
    }
}

impl Scalar for f64 {
    fn re(self) -> f64 {
        self
    }
    fn chain(self, value: f64, _slope: f64) -> f64 {
        value
    }
}
