//! Zeros: of a function with its slope in a bracket, of a quadratic, and of polynomials of low degree in an interval.
//!
//! Between two neighbouring roots of its derivative a polynomial is monotone, so that a change of sign there is one
//! root in a bracket. Degree by degree from the constant up, this finds all of them without a formula that
//! could lose digits, and without allocation.

/// The zero of a function with its slope between two places where it has different signs: Newton's method that falls back on bisection where it
/// leaves them, or does not halve its step, as to and fro across a kink.
pub fn root([mut from, mut to]: [f64; 2], f: impl Fn(f64) -> [f64; 2]) -> f64 {
    let below = f(from)[0] < 0.0;
    let (mut x, mut last) = (0.5 * (from + to), to - from);
    for _ in 0..100 {
        let [value, slope] = f(x);
        if value == 0.0 {
            break;
        }
        *(if (value < 0.0) == below { &mut from } else { &mut to }) = x;
        let newton = x - value / slope;
        let (step, within) = ((newton - x).abs(), (from..=to).contains(&newton));
        if within && step <= 1e-17 + 4e-16 * x.abs() {
            return newton;
        }
        let next = if within && 2.0 * step <= last { newton } else { 0.5 * (from + to) };
        (x, last) = (next, (next - x).abs());
        if to - from <= 1e-17 + 1e-16 * x.abs() {
            break;
        }
    }
    x
}

/// The roots of `a x^2 + b x + c`, without cancellation; the one that does not exist is not finite.
pub fn quadratic(a: f64, b: f64, c: f64) -> [f64; 2] {
    let root = (b * b - 4.0 * a * c).sqrt();
    let q = -0.5 * (b + root.copysign(b));
    [q / a, c / q]
}

/// Largest degree.
const DEGREE: usize = 4;
/// An extremum this near to zero, as a part of the polynomial's size, is a double root.
const TOUCH: f64 = 1e-14;

/// Up to four roots, rising.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Roots {
    values: [f64; DEGREE + 1],
    count: usize,
}

impl Roots {
    const NONE: Self = Self { values: [0.0; DEGREE + 1], count: 0 };

    fn push(&mut self, x: f64) {
        if self.count < DEGREE && (self.count == 0 || x > self.values[self.count - 1]) {
            self.values[self.count] = x;
            self.count += 1;
        }
    }
    /// The roots.
    pub fn as_slice(&self) -> &[f64] {
        &self.values[..self.count]
    }
}

/// The roots of `sum c_i x^i` in `[from, to]`.
pub fn roots(c: [f64; DEGREE + 1], [from, to]: [f64; 2]) -> Roots {
    let mut inner = Roots::NONE;
    // Derivatives from the last one up: the k-th has the coefficients c_i i! / (i - k)!.
    for order in (0..DEGREE).rev() {
        let mut d = [0.0; DEGREE + 1];
        for i in order..=DEGREE {
            d[i - order] = (i - order + 1..=i).fold(c[i], |product, factor| product * factor as f64);
        }
        inner = between(&d, inner.as_slice(), [from, to], order == 0);
    }
    inner
}

fn value(c: &[f64; DEGREE + 1], x: f64) -> f64 {
    c.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

fn slope(c: &[f64; DEGREE + 1], x: f64) -> f64 {
    c.iter().enumerate().skip(1).rev().fold(0.0, |sum, (i, c)| sum * x + c * i as f64)
}

/// Roots of a polynomial whose extrema are known; where it only touches zero, that counts if it is `wanted`.
fn between(c: &[f64; DEGREE + 1], extrema: &[f64], [from, to]: [f64; 2], touching: bool) -> Roots {
    let reach = from.abs().max(to.abs()).max(1.0);
    let size: f64 = c.iter().enumerate().map(|(i, c)| c.abs() * reach.powi(i as i32)).sum();
    let mut found = Roots::NONE;
    let mut left = (from, value(c, from));
    for &x in extrema.iter().chain(&[to]) {
        let right = (x, value(c, x));
        if left.1 == 0.0 {
            found.push(left.0);
        }
        if left.1 * right.1 < 0.0 {
            found.push(root([left.0, right.0], |x| [value(c, x), slope(c, x)]));
        } else if touching && x < to && right.1.abs() <= TOUCH * size && right.1 != 0.0 {
            found.push(x);
        }
        left = right;
    }
    if left.1 == 0.0 {
        found.push(left.0);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `k (x - a)(x - b)(x - c)(x - d)`.
    fn product(k: f64, zeros: [f64; 4]) -> [f64; 5] {
        let mut c = [k, 0.0, 0.0, 0.0, 0.0];
        for (n, zero) in zeros.iter().enumerate() {
            for i in (0..=n + 1).rev() {
                c[i] = if i > 0 { c[i - 1] } else { 0.0 } - zero * c[i];
            }
        }
        c
    }

    #[test]
    fn all_roots_of_products_are_found() {
        for zeros in [[-0.9, -0.3, 0.1, 0.8], [-0.5, -0.4999, 0.2, 0.21], [-5.0, -0.1, 0.7, 3.0]] {
            let found = roots(product(-2.0, zeros), [-1.0, 1.0]);
            let inside: Vec<f64> = zeros.into_iter().filter(|x| x.abs() < 1.0).collect();
            assert_eq!(found.as_slice().len(), inside.len(), "{zeros:?} {found:?}");
            for (a, b) in found.as_slice().iter().zip(&inside) {
                assert!((a - b).abs() < 1e-11, "{zeros:?} {found:?}");
            }
        }
    }

    #[test]
    fn a_bracket_keeps_newtons_method() {
        let steep = root([-1.0, 4.0], |x| [(9.0 * x).tanh() - 0.5, 9.0 / (9.0 * x).cosh().powi(2)]);
        assert!((steep - 0.5_f64.atanh() / 9.0).abs() < 1e-15, "{steep}");
        assert_eq!(root([-1.0, 4.0], |x| [2.0 - x, -1.0]), 2.0);
        // To and fro between both ends, by a slope that is none.
        let kink = root([0.0, 1.0], |x| if x < 0.97 { [x - 1.0, 1.0] } else { [15.0 * (x - 0.985), 7.0] });
        assert!((kink - 0.985).abs() < 1e-14, "{kink}");
    }

    #[test]
    fn double_roots_and_lower_degrees() {
        let double = roots(product(1.0, [0.25, 0.25, 2.0, -2.0]), [-1.0, 1.0]);
        assert!(double.as_slice().iter().all(|x| (x - 0.25).abs() < 1e-7) && !double.as_slice().is_empty());
        assert_eq!(roots([-1.0, 2.0, 0.0, 0.0, 0.0], [-1.0, 1.0]).as_slice(), [0.5]);
        assert_eq!(roots([1.0, 0.0, 1.0, 0.0, 0.0], [-1.0, 1.0]).as_slice(), [] as [f64; 0]);
        assert_eq!(roots([0.0, 1.0, 0.0, 0.0, 0.0], [0.0, 1.0]).as_slice(), [0.0]);
        assert_eq!(roots([0.0; 5], [-1.0, 1.0]).as_slice().len(), 2);
    }
}
