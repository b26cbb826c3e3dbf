//! Sums over vectors, in an order that depends on nothing but their length and the processor's vectors.

use faer::traits::RealField;
use pulp::{Arch, Simd, WithSimd};

/// A number of a factor, which may be stored in single precision.
pub(crate) trait Number: RealField + Copy + Into<f64> {
    /// The nearest one.
    fn round(x: f64) -> Self;

    /// Sum of products, to be inlined into what [`Arch::dispatch`] compiles.
    fn dot<S: Simd>(simd: S, x: &[Self], y: &[Self]) -> Self;
}

macro_rules! number {
    ($real:ty: $vectors:ident, $splat:ident, $add:ident, $multiply_add:ident, $sum:ident) => {
        impl Number for $real {
            fn round(x: f64) -> Self {
                x as Self
            }

            // Written out for each: compilers make a poor job of sums in many parts. Four of them hide the time an
            // addition takes.
            #[inline(always)]
            fn dot<S: Simd>(simd: S, x: &[Self], y: &[Self]) -> Self {
                let ((x, x_rest), (y, y_rest)) = (S::$vectors(x), S::$vectors(y));
                let ((x, x_last), (y, y_last)) = (x.as_chunks::<4>(), y.as_chunks::<4>());
                let mut sums = [simd.$splat(0.0); 4];
                for (x, y) in x.iter().zip(y) {
                    (0..4).for_each(|k| sums[k] = simd.$multiply_add(x[k], y[k], sums[k]));
                }
                for (k, (x, y)) in x_last.iter().zip(y_last).enumerate() {
                    sums[k] = simd.$multiply_add(*x, *y, sums[k]);
                }
                let sum = simd.$add(simd.$add(sums[0], sums[1]), simd.$add(sums[2], sums[3]));
                x_rest.iter().zip(y_rest).fold(simd.$sum(sum), |sum, (x, y)| sum + x * y)
            }
        }
    };
}

number!(f32: as_simd_f32s, splat_f32s, add_f32s, mul_add_e_f32s, reduce_sum_f32s);
number!(f64: as_simd_f64s, splat_f64s, add_f64s, mul_add_e_f64s, reduce_sum_f64s);

/// `y <- y - factor x`.
#[inline(always)]
pub(crate) fn subtract<T: Number>(y: &mut [T], factor: T, x: &[T]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y -= factor * *x;
    }
}

/// Sum of products.
pub(crate) fn dot(x: &[f64], y: &[f64]) -> f64 {
    Arch::new().dispatch(Dot { x, y })
}

struct Dot<'a> {
    x: &'a [f64],
    y: &'a [f64],
}

impl WithSimd for Dot<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        f64::dot(simd, self.x, self.y)
    }
}

pub(crate) fn norm(x: &[f64]) -> f64 {
    dot(x, x).sqrt()
}
