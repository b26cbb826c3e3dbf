//! Forward-mode dual numbers: a value and its derivatives along `N` directions.

use super::Scalar;
use std::array::from_fn;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// `re + sum_i du[i] e_i` with `e_i e_j = 0`: arithmetic on it is differentiation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<const N: usize> {
    /// The value.
    pub re: f64,
    /// Its derivatives along the `N` directions.
    pub du: [f64; N],
}

impl<const N: usize> Dual<N> {
    /// The independent variable of direction `direction`.
    pub fn variable(value: f64, direction: usize) -> Self {
        let mut du = [0.0; N];
        du[direction] = 1.0;
        Self { re: value, du }
    }
}

/// `a x + b y`.
#[inline]
fn combine<const N: usize>((a, x): (&[f64; N], f64), (b, y): (&[f64; N], f64)) -> [f64; N] {
    from_fn(|i| a[i] * x + b[i] * y)
}

impl<const N: usize> Default for Dual<N> {
    fn default() -> Self {
        Self { re: 0.0, du: [0.0; N] }
    }
}

impl<const N: usize> From<f64> for Dual<N> {
    fn from(re: f64) -> Self {
        Self { re, du: [0.0; N] }
    }
}

impl<const N: usize> Scalar for Dual<N> {
    fn re(self) -> f64 {
        self.re
    }
    #[inline]
    fn chain(self, value: f64, slope: f64) -> Self {
        Self { re: value, du: self.du.map(|d| d * slope) }
    }
}

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self { re: -self.re, du: self.du.map(|d| -d) }
    }
}

impl<const N: usize> Add for Dual<N> {
    type Output = Self;
    #[inline]
    fn add(mut self, other: Self) -> Self {
        self += other;
        self
    }
}

impl<const N: usize> Sub for Dual<N> {
    type Output = Self;
    #[inline]
    fn sub(mut self, other: Self) -> Self {
        self -= other;
        self
    }
}

impl<const N: usize> Mul for Dual<N> {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        Self { re: self.re * other.re, du: combine((&self.du, other.re), (&other.du, self.re)) }
    }
}

impl<const N: usize> Div for Dual<N> {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        let (inverse, re) = (1.0 / other.re, self.re / other.re);
        Self { re, du: combine((&self.du, inverse), (&other.du, -re * inverse)) }
    }
}

impl<const N: usize> Add<f64> for Dual<N> {
    type Output = Self;
    #[inline]
    fn add(mut self, other: f64) -> Self {
        self.re += other;
        self
    }
}

impl<const N: usize> Sub<f64> for Dual<N> {
    type Output = Self;
    #[inline]
    fn sub(mut self, other: f64) -> Self {
        self.re -= other;
        self
    }
}

impl<const N: usize> Mul<f64> for Dual<N> {
    type Output = Self;
    #[inline]
    fn mul(self, other: f64) -> Self {
        Self { re: self.re * other, du: self.du.map(|d| d * other) }
    }
}

impl<const N: usize> Div<f64> for Dual<N> {
    type Output = Self;
    #[inline]
    fn div(self, other: f64) -> Self {
        Self { re: self.re / other, du: self.du.map(|d| d / other) }
    }
}

impl<const N: usize> AddAssign for Dual<N> {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        self.re += other.re;
        for i in 0..N {
            self.du[i] += other.du[i];
        }
    }
}

impl<const N: usize> SubAssign for Dual<N> {
    #[inline]
    fn sub_assign(&mut self, other: Self) {
        self.re -= other.re;
        for i in 0..N {
            self.du[i] -= other.du[i];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each function against central differences, at a point where all are smooth.
    #[test]
    fn derivatives_match_central_differences() {
        type F = (&'static str, fn(Dual<2>) -> Dual<2>, fn(f64) -> f64);
        let functions: [F; 14] = [
            ("sqrt", Scalar::sqrt, f64::sqrt),
            ("cbrt", Scalar::cbrt, f64::cbrt),
            ("recip", Scalar::recip, f64::recip),
            ("exp", Scalar::exp, f64::exp),
            ("ln", Scalar::ln, f64::ln),
            ("sin", Scalar::sin, f64::sin),
            ("cos", Scalar::cos, f64::cos),
            ("tan", Scalar::tan, f64::tan),
            ("atan", Scalar::atan, f64::atan),
            ("tanh", Scalar::tanh, f64::tanh),
            ("asinh", Scalar::asinh, f64::asinh),
            ("sinh", Scalar::sinh, f64::sinh),
            ("cosh", Scalar::cosh, f64::cosh),
            ("powf", |x| x.powf(2.3), |x| x.powf(2.3)),
        ];
        let (x, h) = (0.7, 1e-5);
        for (name, dual, plain) in functions {
            let d = dual(Dual::variable(x, 1));
            let slope = (plain(x + h) - plain(x - h)) / (2.0 * h);
            assert_eq!(d.re, plain(x), "{name}");
            assert!((d.du[1] - slope).abs() < 1e-8 * slope.abs().max(1.0), "{name}: {} against {slope}", d.du[1]);
            assert_eq!(d.du[0], 0.0, "{name}");
        }
    }

    #[test]
    fn quotient_and_product_rules() {
        let (x, y) = (Dual::<2>::variable(3.0, 0), Dual::<2>::variable(2.0, 1));
        assert_eq!((x * y).du, [2.0, 3.0]);
        assert_eq!((x / y).du, [0.5, -0.75]);
        assert_eq!((x - y).du, [1.0, -1.0]);
        assert_eq!((-x * 2.0 + 1.0).re, -5.0);
    }
}
