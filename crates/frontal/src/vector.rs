//! Sums over vectors, in an order that depends on nothing but their length.

use faer::traits::RealField;

/// A number of a factor, which may be stored in single precision.
pub(crate) trait Number: RealField + Copy + Into<f64> {
    /// The nearest one.
    fn round(x: f64) -> Self;
}

impl Number for f64 {
    fn round(x: f64) -> Self {
        x
    }
}

impl Number for f32 {
    fn round(x: f64) -> Self {
        x as f32
    }
}

/// `y <- y - factor x`.
#[inline(always)]
pub(crate) fn subtract<T: Number>(y: &mut [f64], factor: f64, x: &[T]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y -= factor * (*x).into();
    }
}

/// `y <- y - sum of factor times x`, with one load and one store of `y`.
#[inline(always)]
pub(crate) fn subtract_four<T: Number>(y: &mut [f64], factors: [f64; 4], columns: [&[T]; 4]) {
    let [a, b, c, d] = columns.map(|column| &column[..y.len()]);
    for (i, y) in y.iter_mut().enumerate() {
        *y -= (factors[0] * a[i].into() + factors[1] * b[i].into())
            + (factors[2] * c[i].into() + factors[3] * d[i].into());
    }
}

/// Sums of products with four vectors.
#[inline(always)]
pub(crate) fn dot_four<T: Number>(y: &[f64], columns: [&[T]; 4]) -> [f64; 4] {
    const LANES: usize = 8;
    let columns = columns.map(|column| &column[..y.len()]);
    let mut sums = [[0.0; LANES]; 4];
    let whole = y.len() / LANES * LANES;
    for start in (0..whole).step_by(LANES) {
        let y = &y[start..start + LANES];
        for (sums, column) in sums.iter_mut().zip(columns) {
            let column = &column[start..start + LANES];
            (0..LANES).for_each(|lane| sums[lane] += column[lane].into() * y[lane]);
        }
    }
    let mut totals = [0.0; 4];
    for ((total, sums), column) in totals.iter_mut().zip(&sums).zip(columns) {
        let tail = column[whole..].iter().zip(&y[whole..]).map(|(&x, y)| x.into() * y).sum::<f64>();
        *total = add_lanes(sums) + tail;
    }
    totals
}

/// Sum of products, in eight interleaved parts so that it vectorises.
#[inline(always)]
pub(crate) fn dot<T: Number>(x: &[T], y: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (x_parts, y_parts) = (x.chunks_exact(8), y.chunks_exact(8));
    let tail = x_parts.remainder().iter().zip(y_parts.remainder()).map(|(&x, y)| x.into() * y).sum::<f64>();
    for (x, y) in x_parts.zip(y_parts) {
        for lane in 0..8 {
            sums[lane] += x[lane].into() * y[lane];
        }
    }
    add_lanes(&sums) + tail
}

#[inline(always)]
fn add_lanes(sums: &[f64; 8]) -> f64 {
    let half = [sums[0] + sums[4], sums[1] + sums[5], sums[2] + sums[6], sums[3] + sums[7]];
    (half[0] + half[2]) + (half[1] + half[3])
}

pub(crate) fn norm(x: &[f64]) -> f64 {
    dot(x, x).sqrt()
}
