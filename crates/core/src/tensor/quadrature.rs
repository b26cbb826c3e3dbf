//! Gauss quadrature (Abramowitz & Stegun, Handbook of Mathematical Functions, 1964, 25.4.29).

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

#[cfg(test)]
mod tests {
    use super::legendre;

    #[test]
    fn the_rule_integrates_what_it_should() {
        for power in 0..16 {
            let sum: f64 = legendre(8).iter().map(|(x, weight)| weight * x.powi(power)).sum();
            let exact = if power % 2 == 0 { 2.0 / f64::from(power + 1) } else { 0.0 };
            assert!((sum - exact).abs() < 1e-14, "{power}: {sum}");
        }
    }
}
