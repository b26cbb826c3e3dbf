//! What the cells share: Gauss points of the interval, their products, and the one-dimensional factors of shape
//! functions.

use super::Quadrature;

/// Gauss points and weights of the interval `[-1, 1]`.
pub(super) type Gauss<const N: usize> = [[f64; 2]; N];

const A2: f64 = 0.577_350_269_189_625_8;
const A3: f64 = 0.774_596_669_241_483_4;

pub(super) const X1: Gauss<1> = [[0.0, 2.0]];
pub(super) const X2: Gauss<2> = [[-A2, 1.0], [A2, 1.0]];
pub(super) const X3: Gauss<3> = [[-A3, 5.0 / 9.0], [0.0, 8.0 / 9.0], [A3, 5.0 / 9.0]];

/// Points of a rule on the line.
pub(super) const fn line_points<const N: usize>(x: &Gauss<N>) -> [[f64; 3]; N] {
    let mut points = [[0.0; 3]; N];
    let mut i = 0;
    while i < N {
        points[i][0] = x[i][0];
        i += 1;
    }
    points
}

/// Weights of a rule on the line.
pub(super) const fn line_weights<const N: usize>(x: &Gauss<N>) -> [f64; N] {
    let mut weights = [0.0; N];
    let mut i = 0;
    while i < N {
        weights[i] = x[i][1];
        i += 1;
    }
    weights
}

/// Points of the product rule on the square; x runs fastest. `M` is `N * N`.
pub(super) const fn square_points<const N: usize, const M: usize>(x: &Gauss<N>) -> [[f64; 3]; M] {
    let mut points = [[0.0; 3]; M];
    let mut i = 0;
    while i < M {
        points[i] = [x[i % N][0], x[i / N][0], 0.0];
        i += 1;
    }
    points
}

/// Weights of the product rule on the square.
pub(super) const fn square_weights<const N: usize, const M: usize>(x: &Gauss<N>) -> [f64; M] {
    let mut weights = [0.0; M];
    let mut i = 0;
    while i < M {
        weights[i] = x[i % N][1] * x[i / N][1];
        i += 1;
    }
    weights
}

/// Points of the product of a plane rule of `N` points (running fastest) with a rule on the line. `M` is their product.
pub(super) const fn prism_points<const N: usize, const M: usize>(
    plane: &Quadrature,
    line: &[[f64; 2]],
) -> [[f64; 3]; M] {
    let mut points = [[0.0; 3]; M];
    let mut i = 0;
    while i < M {
        let [x, y, _] = plane.points[i % N];
        points[i] = [x, y, line[i / N][0]];
        i += 1;
    }
    points
}

/// Weights of the product of a plane rule with a rule on the line.
pub(super) const fn prism_weights<const N: usize, const M: usize>(plane: &Quadrature, line: &[[f64; 2]]) -> [f64; M] {
    let mut weights = [0.0; M];
    let mut i = 0;
    while i < M {
        weights[i] = plane.weights[i % N] * line[i / N][1];
        i += 1;
    }
    weights
}

/// The factor of first degree that is 2 at `a` and 0 at `-a` (`a` is -1 or 1), and its slope.
#[inline]
pub(super) fn hat(a: f64, x: f64) -> (f64, f64) {
    (1.0 + a * x, a)
}

/// The factor of second degree that vanishes at both ends, and its slope.
#[inline]
pub(super) fn bubble(x: f64) -> (f64, f64) {
    (1.0 - x * x, -2.0 * x)
}

/// The second degree Lagrange polynomial that is 1 at `a` and 0 at the other two of -1, 0, 1; and its slope.
#[inline]
pub(super) fn lagrange(a: f64, x: f64) -> (f64, f64) {
    if a == 0.0 { bubble(x) } else { (0.5 * x * (x + a), x + 0.5 * a) }
}

/// A product of three factors and its gradient.
#[inline]
pub(super) fn product([f, g, h]: [(f64, f64); 3]) -> (f64, [f64; 3]) {
    (f.0 * g.0 * h.0, [f.1 * g.0 * h.0, f.0 * g.1 * h.0, f.0 * g.0 * h.1])
}

/// Area coordinates of the triangle at a reference point, and their gradients.
#[inline]
pub(super) fn area_coordinates(r: f64, s: f64) -> [(f64, [f64; 2]); 3] {
    [(1.0 - r - s, [-1.0, -1.0]), (r, [1.0, 0.0]), (s, [0.0, 1.0])]
}
