//! Local equations `r(x; d) = 0` of a step of a law, in unknowns `x` and given data `d`.
//!
//! The unknowns are found in plain numbers: Newton's method with the exact Jacobian (duals along `x`), shortened when
//! the residual grows, or kept inside a bracket. One more Newton step over the caller's scalar,
//! `x - J^-1 r(x; d)`, adds the derivatives `dx = -J^-1 dr/dd dd`.

use crate::Failure;
use crate::tensor::{Dual, Scalar};
use std::array::from_fn;

/// Most iterations of a local problem.
const LIMIT: usize = 60;
/// Residuals (dimensionless by contract) below this are rounding.
const TINY: f64 = 1e-15;
/// A residual that no longer falls is accepted below this.
const SMALL: f64 = 1e-11;

/// `N` equations in `N` unknowns with `M` given numbers. Residuals must be of order one far from the solution.
pub trait System<const N: usize, const M: usize> {
    /// The residual.
    fn residual<S: Scalar>(&self, x: &[S; N], data: &[S; M]) -> [S; N];
}

/// Residual and Jacobian `j[row][column]` in plain numbers.
fn linearise<Q: System<N, M>, const N: usize, const M: usize>(
    system: &Q,
    x: &[f64; N],
    data: &[f64; M],
) -> ([f64; N], [[f64; N]; N]) {
    let unknowns = from_fn(|i| Dual::<N>::variable(x[i], i));
    let r = system.residual(&unknowns, &data.map(Dual::from));
    (r.map(|r| r.re), r.map(|r| r.du))
}

/// One Newton step over the caller's scalar: the derivatives of the solution along those of the data.
fn follow<T: Scalar, Q: System<N, M>, const N: usize, const M: usize>(
    system: &Q,
    x: &[f64; N],
    data: &[T; M],
) -> Option<[T; N]> {
    let (_, jacobian) = linearise(system, x, &data.map(T::re));
    let change = eliminate(jacobian, system.residual(&x.map(T::from), data))?;
    Some(from_fn(|i| T::from(x[i]) - change[i]))
}

/// Solves `a y = b` by elimination with row exchanges; nothing when the matrix is singular.
fn eliminate<T: Scalar, const N: usize>(mut a: [[f64; N]; N], mut b: [T; N]) -> Option<[T; N]> {
    for k in 0..N {
        let pivot = (k..N).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs()))?;
        a.swap(k, pivot);
        b.swap(k, pivot);
        if a[k][k] == 0.0 || !a[k][k].is_finite() {
            return None;
        }
        for i in k + 1..N {
            let factor = a[i][k] / a[k][k];
            let (upper, lower) = a.split_at_mut(i);
            lower[0].iter_mut().zip(&upper[k]).for_each(|(x, y)| *x -= factor * y);
            b[i] -= b[k] * factor;
        }
    }
    for k in (0..N).rev() {
        for j in k + 1..N {
            b[k] -= b[j] * a[k][j];
        }
        b[k] = b[k] / a[k][k];
    }
    Some(b)
}

fn size<const N: usize>(r: &[f64; N]) -> f64 {
    r.iter().fold(0.0, |m, x| if x.is_nan() { f64::INFINITY } else { m.max(x.abs()) })
}

/// The unknowns by Newton's method from `start`, with the derivatives of the data.
///
/// # Errors
/// A [`Failure`] that names `what` when the iteration does not converge.
pub fn solve<T: Scalar, Q: System<N, M>, const N: usize, const M: usize>(
    system: &Q,
    start: [f64; N],
    data: &[T; M],
    what: &str,
) -> Result<[T; N], Failure> {
    let failed = || Failure::new(format!("{what}: the local iteration does not converge"));
    let plain = data.map(T::re);
    let mut x = start;
    let (mut r, mut jacobian) = linearise(system, &x, &plain);
    for _ in 0..LIMIT {
        if size(&r) <= TINY {
            break;
        }
        let change = eliminate(jacobian, r).ok_or_else(failed)?;
        let Some((next, r_next, j_next)) = shorten(system, (&x, &plain), &change, size(&r)) else { break };
        (x, r, jacobian) = (next, r_next, j_next);
    }
    if size(&r) > SMALL {
        return Err(failed());
    }
    follow(system, &x, data).ok_or_else(failed)
}

/// A point, its residual and its Jacobian.
type Trial<const N: usize> = ([f64; N], [f64; N], [[f64; N]; N]);

/// The first of the points `x - change / 2^k` with a smaller residual.
fn shorten<Q: System<N, M>, const N: usize, const M: usize>(
    system: &Q,
    (x, data): (&[f64; N], &[f64; M]),
    change: &[f64; N],
    before: f64,
) -> Option<Trial<N>> {
    (0..24).map(|k| 0.5_f64.powi(k)).find_map(|part| {
        let next = from_fn(|i| x[i] - part * change[i]);
        let (r, jacobian) = linearise(system, &next, data);
        (size(&r) < before).then_some((next, r, jacobian))
    })
}

/// The root of one equation between `low` and `high`, where the residual changes its sign, with the derivatives of the
/// data: Newton's method that falls back on bisection.
///
/// # Errors
/// A [`Failure`] that names `what` when the residual does not change its sign.
pub fn root<T: Scalar, Q: System<1, M>, const M: usize>(
    system: &Q,
    [mut low, mut high]: [f64; 2],
    data: &[T; M],
    what: &str,
) -> Result<T, Failure> {
    let failed = || Failure::new(format!("{what}: the local iteration does not converge"));
    let plain = data.map(T::re);
    let value = |x: f64| system.residual(&[x], &plain)[0];
    let ends = [value(low), value(high)];
    let rising = ends[1] >= ends[0];
    if !ends.iter().all(|r| r.is_finite()) || ends[0].min(ends[1]) > 0.0 || ends[0].max(ends[1]) < 0.0 {
        return Err(failed());
    }
    let mut x = 0.5 * (low + high);
    for _ in 0..2 * LIMIT {
        let ([r], [[slope]]) = linearise(system, &[x], &plain);
        if r.abs() <= TINY {
            break;
        }
        *(if (r > 0.0) == rising { &mut high } else { &mut low }) = x;
        let newton = x - r / slope;
        let next = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
        let change = (next - x).abs();
        x = next;
        if change <= 2.0 * f64::EPSILON * x.abs() {
            break;
        }
    }
    follow(system, &[x], data).map(|[x]| x).filter(|x| x.re().is_finite()).ok_or_else(failed)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `x^2 + y^2 = a`, `x y = b`.
    struct Circle;

    impl System<2, 2> for Circle {
        fn residual<S: Scalar>(&self, [x, y]: &[S; 2], [a, b]: &[S; 2]) -> [S; 2] {
            [*x * *x + *y * *y - *a, *x * *y - *b]
        }
    }

    #[test]
    fn derivatives_follow_the_data() {
        let data = [Dual::<2>::variable(5.0, 0), Dual::variable(2.0, 1)];
        let [x, y] = solve(&Circle, [3.0, 0.5], &data, "circle").unwrap();
        assert!((x.re - 2.0).abs() < 1e-14 && (y.re - 1.0).abs() < 1e-14);
        // (x + y)^2 = a + 2 b: d(x + y) = (da + 2 db) / (2 (x + y)).
        assert!((x.du[0] + y.du[0] - 1.0 / 6.0).abs() < 1e-14);
        assert!((x.du[1] + y.du[1] - 1.0 / 3.0).abs() < 1e-14);
    }

    /// `x^n = a`.
    struct Power(f64);

    impl System<1, 1> for Power {
        fn residual<S: Scalar>(&self, [x]: &[S; 1], [a]: &[S; 1]) -> [S; 1] {
            [x.powf(self.0) - *a]
        }
    }

    #[test]
    fn a_bracketed_root_survives_steep_equations() {
        for n in [0.1, 1.0, 7.0, 80.0] {
            let x = root(&Power(n), [0.0, 3.0], &[Dual::<1>::variable(0.7, 0)], "power").unwrap();
            let exact = 0.7_f64.powf(1.0 / n);
            assert!((x.re / exact - 1.0).abs() < 1e-12, "n = {n}: {} against {exact}", x.re);
            assert!((x.du[0] / (exact / (0.7 * n)) - 1.0).abs() < 1e-10, "n = {n}");
        }
    }

    #[test]
    fn what_has_no_solution_fails() {
        assert!(root(&Power(2.0), [0.0, 0.5], &[0.7], "power").is_err());
        assert!(solve(&Circle, [1.0, 1.0], &[1.0, 2.0], "circle").is_err());
    }
}
