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
        let (values, axes) = principal(&a.re());
        let turn = axes.lift::<T>();
        // Diagonal in value; what is off the diagonal carries the turning of the axes.
        let local = turn.transpose() * *a * turn;
        let h = self.principal::<Dual<3>>(from_fn(|i| Dual::variable(values[i], i)))?;
        let scale = values.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let along = |i: usize| {
            let mut sum = T::from(h[i].re);
            (0..3).for_each(|j| sum += (local[(j, j)] - values[j]) * h[i].du[j]);
            sum
        };
        let ratio = |i: usize, j: usize| match values[i] - values[j] {
            gap if gap.abs() > EQUAL * scale => (h[i].re - h[j].re) / gap,
            _ => 0.5 * (h[i].du[i] - h[i].du[j] + h[j].du[j] - h[j].du[i]),
        };
        let result = Tensor2::from_fn(|i, j| if i == j { along(i) } else { local[(i, j)] * ratio(i, j) });
        Ok((turn * result * turn.transpose()).sym())
    }
}

/// Principal values of a symmetric tensor, and its axes as the columns of a rotation (Jacobi's method).
pub fn principal(a: &Tensor2) -> ([f64; 3], Tensor2) {
    let (mut a, mut axes) = (*a, Tensor2::identity());
    for _ in 0..SWEEPS {
        let off = a[(0, 1)].abs() + a[(0, 2)].abs() + a[(1, 2)].abs();
        if off <= f64::MIN_POSITIVE || !off.is_finite() {
            break;
        }
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            let turn = rotation(&a, i, j);
            a = (turn.transpose() * a * turn).sym();
            (a[(i, j)], a[(j, i)]) = (0.0, 0.0);
            axes = axes * turn;
        }
    }
    (from_fn(|i| a[(i, i)]), axes)
}

/// The rotation in the plane of axes `i` and `j` that makes `a[(i, j)]` zero.
fn rotation(a: &Tensor2, i: usize, j: usize) -> Tensor2 {
    let mut turn = Tensor2::identity();
    if a[(i, j)] != 0.0 {
        let half = 0.5 * (a[(j, j)] - a[(i, i)]) / a[(i, j)];
        let tan = half.signum() / (half.abs() + half.hypot(1.0));
        let cos = 1.0 / tan.hypot(1.0);
        (turn[(i, i)], turn[(j, j)]) = (cos, cos);
        (turn[(i, j)], turn[(j, i)]) = (tan * cos, -tan * cos);
    }
    turn
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
        }
    }
}
