//! Small sums over vectors of the processor at hand, to be inlined into what [`pulp::Arch::dispatch`] compiles for it.

use pulp::Simd;

/// `y += a x`.
#[inline(always)]
pub fn add_multiple<S: Simd, const N: usize>(simd: S, a: f64, x: &[f64; N], y: &mut [f64; N]) {
    let ((x, x_rest), (y, y_rest)) = (S::as_simd_f64s(x), S::as_mut_simd_f64s(y));
    let all = simd.splat_f64s(a);
    y.iter_mut().zip(x).for_each(|(y, x)| *y = simd.mul_add_e_f64s(all, *x, *y));
    y_rest.iter_mut().zip(x_rest).for_each(|(y, x)| *y += a * x);
}

/// `x . y`.
#[inline(always)]
pub fn dot<S: Simd, const N: usize>(simd: S, x: &[f64; N], y: &[f64; N]) -> f64 {
    let ((x, x_rest), (y, y_rest)) = (S::as_simd_f64s(x), S::as_simd_f64s(y));
    let mut sum = simd.splat_f64s(0.0);
    x.iter().zip(y).for_each(|(x, y)| sum = simd.mul_add_e_f64s(*x, *y, sum));
    x_rest.iter().zip(y_rest).fold(simd.reduce_sum_f64s(sum), |sum, (x, y)| sum + x * y)
}

/// `row_L += sum_j x_jL y_j` over the first `COUNT` of the `j`.
#[inline(always)]
pub fn add_dyads<S: Simd, const N: usize, const COUNT: usize>(
    simd: S,
    x: &[[f64; N]; 3],
    y: &[[f64; N]; 3],
    rows: &mut [[f64; N]],
) {
    let y = [0, 1, 2].map(|j| S::as_simd_f64s(&y[j]).0);
    for (node, row) in rows.iter_mut().enumerate() {
        let x = [0, 1, 2].map(|j| simd.splat_f64s(x[j][node]));
        for (k, row) in S::as_mut_simd_f64s(row).0.iter_mut().enumerate() {
            (0..COUNT).for_each(|j| *row = simd.mul_add_e_f64s(x[j], y[j][k], *row));
        }
    }
}
