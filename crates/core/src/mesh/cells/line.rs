//! Lines of first and second degree: the edges of plane cells. Reference interval `[-1, 1]`.

use super::rules::{X1, X2, X3, lagrange, line_points, line_weights};
use super::{Cell, Quadrature};

/// One Gauss point.
pub static GAUSS1: Quadrature = Quadrature { degree: 1, points: &line_points(&X1), weights: &line_weights(&X1) };
/// Two Gauss points.
pub static GAUSS2: Quadrature = Quadrature { degree: 3, points: &line_points(&X2), weights: &line_weights(&X2) };
/// Three Gauss points.
pub static GAUSS3: Quadrature = Quadrature { degree: 5, points: &line_points(&X3), weights: &line_weights(&X3) };

/// Two nodes, first degree.
pub static LINE2: Cell = Cell {
    name: "line2",
    dimension: 1,
    degree: 1,
    linear: &LINE2,
    nodes: &[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
    shape: |[x, _, _], n, dn| {
        (n[0], n[1]) = (0.5 * (1.0 - x), 0.5 * (1.0 + x));
        (dn[0], dn[1]) = ([-0.5, 0.0, 0.0], [0.5, 0.0, 0.0]);
    },
    faces: &[],
    full: &GAUSS1,
    reduced: None,
    gauss: [Some(&GAUSS1), Some(&GAUSS2), Some(&GAUSS3)],
    vtk: 3,
};

const NODES: [[f64; 3]; 3] = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]];

/// Three nodes, second degree: ends first, then the middle.
pub static LINE3: Cell = Cell {
    name: "line3",
    dimension: 1,
    degree: 2,
    linear: &LINE2,
    nodes: &NODES,
    shape: |[x, _, _], n, dn| {
        for (i, &[a, _, _]) in NODES.iter().enumerate() {
            let (value, slope) = lagrange(a, x);
            (n[i], dn[i]) = (value, [slope, 0.0, 0.0]);
        }
    },
    faces: &[],
    full: &GAUSS2,
    reduced: None,
    gauss: [Some(&GAUSS1), Some(&GAUSS2), Some(&GAUSS3)],
    vtk: 21,
};
