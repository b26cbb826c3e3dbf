//! Principal values of symmetric tensors, and isotropic functions of them over any scalar.
//!
//! An isotropic function has the axes of its argument: `h(A) = sum_a h_a(A_1, A_2, A_3) n_a n_a`. Its derivative in
//! those axes is `dh_a/dA_b` on the diagonal and the divided difference `(h_a - h_b)/(A_a - A_b)` off it (Daleckii and
//! Krein), whose limit at equal principal values is a difference of the derivatives; so repeated values are no
//! exception.

use super::{Dual, Scalar, Tensor2};
use crate::Failure;
use std::array::from_fn;

/// Sweeps of Jacobi's method; three or four suffice.
const SWEEPS: usize = 30;
/// An entry off the diagonal this small, as a ratio, changes no digit of it.
const NOTHING: f64 = 1e-20;
/// Principal values closer than this, as a ratio, are taken as equal in divided differences.
const EQUAL: f64 = 1e-6;

/// A function of three principal values, symmetric under their exchange.
pub trait Isotropic {
    /// The principal values of the result, in the order of the given ones.
    ///
    /// # Errors
    /// A [`Failure`] where the function has no value.
    fn principal<S: Scalar>(&self, values: [S; 3]) -> Result<[S; 3], Failure>;

    /// The function of a symmetric tensor.
    ///
    /// # Errors
    /// As [`principal`](Self::principal).
    fn of<T: Scalar>(&self, a: &Tensor2<T>) -> Result<Tensor2<T>, Failure> {
        Ok(Spectral::new(self, &a.re())?.near(a))
    }

    /// The same in plain numbers, and its derivatives along the components XX YY ZZ XY YZ XZ of the tensor, of which those
    /// off the diagonal stand in it twice.
    ///
    /// # Errors
    /// As [`principal`](Self::principal).
    fn with_slopes(&self, a: &Tensor2, slopes: &mut [[f64; 6]; 6]) -> Result<Tensor2, Failure> {
        let spectral = Spectral::new(self, a)?;
        spectral.slopes(slopes);
        Ok(spectral.near(a))
    }
}

/// An isotropic function at one tensor.
struct Spectral {
    /// Principal values of the tensor.
    values: [f64; 3],
    /// Its axes.
    axes: Tensor2,
    /// Principal values of the function with their derivatives.
    h: [Dual<3>; 3],
}

impl Spectral {
    fn new(function: &(impl Isotropic + ?Sized), a: &Tensor2) -> Result<Self, Failure> {
        let (values, axes) = principal(a);
        let h = function.principal::<Dual<3>>(from_fn(|i| Dual::variable(values[i], i)))?;
        Ok(Self { values, axes, h })
    }

    /// Divided difference of the function, or its limit.
    fn ratio(&self, i: usize, j: usize) -> f64 {
        let (values, h) = (&self.values, &self.h);
        let scale = values.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        match values[i] - values[j] {
            gap if gap.abs() > EQUAL * scale => (h[i].re - h[j].re) / gap,
            _ => 0.5 * (h[i].du[i] - h[i].du[j] + h[j].du[j] - h[j].du[i]),
        }
    }

    /// The function of the tensor `a`, which is that tensor but for rounding and derivatives.
    fn near<T: Scalar>(&self, a: &Tensor2<T>) -> Tensor2<T> {
        let turn = self.axes.lift::<T>();
        // Diagonal in value; what is off the diagonal carries the turning of the axes.
        let local = turn.transpose() * *a * turn;
        let along = |i: usize| {
            let mut sum = T::from(self.h[i].re);
            (0..3).for_each(|j| sum += (local[(j, j)] - self.values[j]) * self.h[i].du[j]);
            sum
        };
        let result = Tensor2::from_fn(|i, j| if i == j { along(i) } else { local[(i, j)] * self.ratio(i, j) });
        (turn * result * turn.transpose()).sym()
    }

    /// `dh_ij/dA_kl`: along the dyads of the axes with themselves and, by the divided differences, with each other.
    fn slopes(&self, slopes: &mut [[f64; 6]; 6]) {
        *slopes = [[0.0; 6]; 6];
        let n = &self.axes;
        let dyad = |i: usize, j: usize| PLACES.map(|(k, l)| 0.5 * (n[(k, i)] * n[(l, j)] + n[(l, i)] * n[(k, j)]));
        for (i, j) in PLACES {
            let (along, mut change) = (dyad(i, j), [0.0; 6]);
            if i == j {
                (0..3).for_each(|k| add(&mut change, self.h[i].du[k], &dyad(k, k)));
            } else {
                add(&mut change, 2.0 * self.ratio(i, j), &along);
            }
            change[3..].iter_mut().for_each(|change| *change *= 2.0);
            slopes.iter_mut().zip(along).for_each(|(slopes, along)| add(slopes, along, &change));
        }
    }
}

/// Places of the six components of a symmetric tensor.
const PLACES: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)];

/// `y += a x`.
fn add(y: &mut [f64; 6], a: f64, x: &[f64; 6]) {
    y.iter_mut().zip(x).for_each(|(y, x)| *y += a * x);
}

/// Principal values of a symmetric tensor, and its axes as the columns of a rotation (Jacobi's method).
pub fn principal(a: &Tensor2) -> ([f64; 3], Tensor2) {
    let (mut a, mut axes) = (*a, Tensor2::identity());
    for _ in 0..SWEEPS {
        let least = NOTHING * (a[(0, 0)].abs() + a[(1, 1)].abs() + a[(2, 2)].abs());
        let mut turned = false;
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            if a[(i, j)].abs() > least {
                turn(&mut a, &mut axes, (i, j));
                turned = true;
            }
        }
        if !turned {
            break;
        }
    }
    (from_fn(|i| a[(i, i)]), axes)
}

/// Turns in the plane of axes `i` and `j` so that `a[(i, j)]` becomes zero.
#[inline]
fn turn(a: &mut Tensor2, axes: &mut Tensor2, (i, j): (usize, usize)) {
    let (shear, other) = (a[(i, j)], 3 - i - j);
    let half = 0.5 * (a[(j, j)] - a[(i, i)]) / shear;
    // A square beyond all numbers leaves no angle.
    let tan = half.signum() / (half.abs() + (half * half + 1.0).sqrt());
    let cos = 1.0 / (tan * tan + 1.0).sqrt();
    let turned = |x: f64, y: f64| (cos * (x - tan * y), cos * (tan * x + y));
    a[(i, i)] -= tan * shear;
    a[(j, j)] += tan * shear;
    let (x, y) = turned(a[(other, i)], a[(other, j)]);
    ((a[(other, i)], a[(i, other)]), (a[(other, j)], a[(j, other)])) = ((x, x), (y, y));
    (a[(i, j)], a[(j, i)]) = (0.0, 0.0);
    axes.0.iter_mut().for_each(|row| (row[i], row[j]) = turned(row[i], row[j]));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_rebuild_the_tensor() {
        for v in [[3.0, -2.0, 1.5, 0.7, -0.4, 1.1], [1.0, 1.0, 1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0, 1e-9, 0.0]] {
            let a = Tensor2::from_voigt(v);
            let (values, axes) = principal(&a);
            let diagonal = Tensor2::from_fn(|i, j| if i == j { values[i] } else { 0.0 });
            let residue = axes * diagonal * axes.transpose() - a;
            assert!(residue.contract(residue).sqrt() < 1e-14);
            let unit = axes * axes.transpose() - Tensor2::identity();
            assert!(unit.contract(unit).sqrt() < 1e-14);
        }
    }

    /// The cube of a tensor, which is also a product of tensors.
    struct Cube;

    impl Isotropic for Cube {
        fn principal<S: Scalar>(&self, values: [S; 3]) -> Result<[S; 3], Failure> {
            Ok(values.map(|x| x * x * x))
        }
    }

    #[test]
    fn functions_and_derivatives_are_those_of_products() {
        let repeated = [2.0, 2.0, 2.0, 0.0, 0.0, 0.0];
        for v in [[3.0, -2.0, 1.5, 0.7, -0.4, 1.1], repeated, [2.0, 2.0, 5.0, 0.0, 0.0, 0.0], [0.0; 6]] {
            let a = Tensor2::from_voigt(from_fn(|i| Dual::<6>::variable(v[i], i)));
            let (spectral, product) = (Cube.of(&a).unwrap(), a * a * a);
            for (x, y) in spectral.to_voigt().iter().zip(product.to_voigt()) {
                assert!((x.re - y.re).abs() < 1e-12);
                x.du.iter().zip(y.du).for_each(|(x, y)| assert!((x - y).abs() < 1e-11, "{x} against {y}"));
            }
            let mut slopes = [[0.0; 6]; 6];
            let plain = Cube.with_slopes(&a.re(), &mut slopes).unwrap().to_voigt();
            for ((x, slopes), y) in plain.iter().zip(&slopes).zip(product.to_voigt()) {
                assert!((x - y.re).abs() < 1e-12);
                slopes.iter().zip(y.du).for_each(|(x, y)| assert!((x - y).abs() < 1e-11, "{x} against {y}"));
            }
        }
    }
}
