//! Small fits that the measurements share.

/// Intercept and slope of the straight line through points, by least squares.
pub fn line(points: &[(f64, f64)]) -> (f64, f64) {
    let n = points.len() as f64;
    let mean = |value: fn(&(f64, f64)) -> f64| points.iter().map(value).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let (mut xx, mut xy) = (0.0, 0.0);
    for p in points {
        xx += (p.0 - x) * (p.0 - x);
        xy += (p.0 - x) * (p.1 - y);
    }
    (y - xy / xx * x, xy / xx)
}

/// A curve of points `(x, y)` with growing x, at some x, by straight lines; the last y beyond its end.
pub fn at(curve: &[(f64, f64)], x: f64) -> f64 {
    let end = curve.last().map_or(f64::NAN, |point| point.1);
    let piece = curve.windows(2).find(|two| two[0].0 <= x && x <= two[1].0);
    piece.map_or(end, |two| two[0].1 + (two[1].1 - two[0].1) * (x - two[0].0) / (two[1].0 - two[0].0))
}

/// Order of convergence of errors on meshes of which each halves the cells of the one before.
pub fn order(errors: &[f64]) -> f64 {
    line(&errors.iter().enumerate().map(|(level, error)| (-(level as f64), error.log2())).collect::<Vec<_>>()).1
}

/// The limit of values on meshes of which each halves the cells of the one before: their differences go on as those of
/// the last three (Aitken).
pub fn extrapolate([coarse, middle, fine]: [f64; 3]) -> f64 {
    let (first, second) = (middle - coarse, fine - middle);
    fine + second * second / (first - second)
}

/// Half width `a` and largest pressure of a Hertzian contact: `p^2 = p0^2 (1 - x^2/a^2)` by least squares over the
/// points `(x, p)` with a pressure above a fifth of the largest, as status of points at the edge must not decide.
pub fn hertz(points: &[(f64, f64)]) -> (f64, f64) {
    // The largest pressure of the fit itself, so that one point that stands out does not choose the others.
    let mut largest = points.iter().map(|point| point.1).fold(0.0, f64::max);
    let mut width = f64::NAN;
    for _ in 0..3 {
        let fitted = points.iter().filter(|point| point.1 > 0.2 * largest).map(|&(x, p)| (x * x, p * p));
        let (square, slope) = line(&fitted.collect::<Vec<_>>());
        (width, largest) = ((-square / slope).sqrt(), square.sqrt());
    }
    (width, largest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_order_is_found_again() {
        assert!((order(&[0.4, 0.1, 0.025]) - 2.0).abs() < 1e-12);
    }

    #[test]
    fn a_curve_is_read_between_its_points() {
        let curve = [(0.0, 1.0), (1.0, 3.0), (3.0, -1.0)];
        assert!((at(&curve, 0.5) - 2.0).abs() < 1e-15 && (at(&curve, 2.0) - 1.0).abs() < 1e-15);
        assert_eq!(at(&curve, 1.0), 3.0);
        assert_eq!(at(&curve, 3.0 + 1e-12), -1.0);
    }

    #[test]
    fn a_limit_is_found_again() {
        let value = |h: f64| 3.0 - 0.7 * h.powf(1.3);
        assert!((extrapolate([value(0.4), value(0.2), value(0.1)]) - 3.0).abs() < 1e-12);
    }

    #[test]
    fn a_hertzian_pressure_is_found_again() {
        let p = |x: f64| 7.0 * (1.0 - x * x / 9.0).max(0.0).sqrt();
        let (a, p0) = hertz(&(0..40).map(|i| (0.1 * i as f64, p(0.1 * i as f64))).collect::<Vec<_>>());
        assert!((a - 3.0).abs() < 1e-12 && (p0 - 7.0).abs() < 1e-12);
    }
}
