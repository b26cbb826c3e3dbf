//! Gauss quadrature (Abramowitz & Stegun, Handbook of Mathematical Functions, 1964, 25.4.29).

use std::sync::LazyLock;

/// Gauss points and weights of the interval from -1 to 1, by Newton's method on the Legendre polynomial of degree `n`.
pub fn legendre(n: usize) -> Vec<(f64, f64)> {
    let point = |k: usize| {
        let mut x = (std::f64::consts::PI * (k as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 0.0;
        for _ in 0..20 {
            let (mut before, mut value) = (1.0, x);
            for m in 2..=n {
                let m = m as f64;
                (before, value) = (value, ((2.0 * m - 1.0) * x * value - (m - 1.0) * before) / m);
            }
            slope = n as f64 * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(point).collect()
}

/// The integral over an interval by five Gauss points, halving until two halves agree with their whole.
pub fn integral(f: &dyn Fn(f64) -> f64, all: [f64; 2]) -> f64 {
    fn halved(f: &dyn Fn(f64) -> f64, [a, b]: [f64; 2], whole: f64, depth: u8) -> f64 {
        let middle = 0.5 * (a + b);
        let [left, right] = [[a, middle], [middle, b]].map(|half| gauss(f, half));
        if depth == 30 || (left + right - whole).abs() <= 1e-14 * whole {
            return left + right;
        }
        halved(f, [a, middle], left, depth + 1) + halved(f, [middle, b], right, depth + 1)
    }
    halved(f, all, gauss(f, all), 0)
}

/// Five Gauss points on an interval.
fn gauss(f: &dyn Fn(f64) -> f64, [a, b]: [f64; 2]) -> f64 {
    static POINTS: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| legendre(5));
    let (half, middle) = (0.5 * (b - a), 0.5 * (a + b));
    POINTS.iter().map(|&(x, w)| w * f(middle + half * x)).sum::<f64>() * half
}

#[cfg(test)]
mod tests {
    use super::{integral, legendre};

    #[test]
    fn the_rule_integrates_what_it_should() {
        for power in 0..16 {
            let sum: f64 = legendre(8).iter().map(|(x, weight)| weight * x.powi(power)).sum();
            let exact = if power % 2 == 0 { 2.0 / f64::from(power + 1) } else { 0.0 };
            assert!((sum - exact).abs() < 1e-14, "{power}: {sum}");
        }
    }

    #[test]
    fn an_integral_is_exact_where_one_rule_is_not() {
        let found = integral(&|x| 1.0 / (0.01 + x * x), [-1.0, 1.0]);
        assert!((found - 20.0 * 10.0_f64.atan()).abs() < 1e-12 * found, "{found}");
    }
}
