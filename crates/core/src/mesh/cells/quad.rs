//! Quadrilaterals on `[-1, 1]^2`: corners counter-clockwise, then mid-sides in the same turn, then the centre.

use super::rules::{X1, X2, X3, bubble, hat, lagrange, square_points, square_weights};
use super::{Cell, Face, LINE2, LINE3, Quadrature};

/// One point.
pub static GAUSS1X1: Quadrature =
    Quadrature { degree: 1, points: &square_points::<1, 1>(&X1), weights: &square_weights::<1, 1>(&X1) };
/// Two by two points, x running fastest.
pub static GAUSS2X2: Quadrature =
    Quadrature { degree: 3, points: &square_points::<2, 4>(&X2), weights: &square_weights::<2, 4>(&X2) };
/// Three by three points, x running fastest.
pub static GAUSS3X3: Quadrature =
    Quadrature { degree: 5, points: &square_points::<3, 9>(&X3), weights: &square_weights::<3, 9>(&X3) };

const NODES: [[f64; 3]; 9] = [
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [0.0, -1.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [-1.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
];

const EDGES: &[Face] = &[
    Face { cell: &LINE3, nodes: &[0, 1, 4] },
    Face { cell: &LINE3, nodes: &[1, 2, 5] },
    Face { cell: &LINE3, nodes: &[2, 3, 6] },
    Face { cell: &LINE3, nodes: &[3, 0, 7] },
];

/// Four nodes, bilinear.
pub static QUAD4: Cell = Cell {
    name: "quad4",
    dimension: 2,
    degree: 1,
    linear: &QUAD4,
    nodes: NODES.first_chunk::<4>().unwrap(),
    shape: |[x, y, _], n, dn| {
        for (i, &[a, b, _]) in NODES[..4].iter().enumerate() {
            let ((f, df), (g, dg)) = (hat(a, x), hat(b, y));
            (n[i], dn[i]) = (0.25 * f * g, [0.25 * df * g, 0.25 * f * dg, 0.0]);
        }
    },
    faces: &[
        Face { cell: &LINE2, nodes: &[0, 1] },
        Face { cell: &LINE2, nodes: &[1, 2] },
        Face { cell: &LINE2, nodes: &[2, 3] },
        Face { cell: &LINE2, nodes: &[3, 0] },
    ],
    full: &GAUSS2X2,
    reduced: Some(&GAUSS1X1),
    gauss: [Some(&GAUSS1X1), Some(&GAUSS2X2), Some(&GAUSS3X3)],
    vtk: 9,
};

/// Eight nodes, serendipity of second degree.
pub static QUAD8: Cell = Cell {
    name: "quad8",
    dimension: 2,
    degree: 2,
    linear: &QUAD4,
    nodes: NODES.first_chunk::<8>().unwrap(),
    shape: |[x, y, _], n, dn| {
        for (i, &[a, b, _]) in NODES[..4].iter().enumerate() {
            let ((f, df), (g, dg), h) = (hat(a, x), hat(b, y), a * x + b * y - 1.0);
            (n[i], dn[i]) = (0.25 * f * g * h, [0.25 * df * g * (f + h), 0.25 * f * dg * (g + h), 0.0]);
        }
        for (i, &[a, b, _]) in NODES[..8].iter().enumerate().skip(4) {
            let (f, df) = if a == 0.0 { bubble(x) } else { hat(a, x) };
            let (g, dg) = if b == 0.0 { bubble(y) } else { hat(b, y) };
            (n[i], dn[i]) = (0.5 * f * g, [0.5 * df * g, 0.5 * f * dg, 0.0]);
        }
    },
    faces: EDGES,
    full: &GAUSS3X3,
    reduced: Some(&GAUSS2X2),
    gauss: [Some(&GAUSS1X1), Some(&GAUSS2X2), Some(&GAUSS3X3)],
    vtk: 23,
};

/// Nine nodes, biquadratic.
pub static QUAD9: Cell = Cell {
    name: "quad9",
    dimension: 2,
    degree: 2,
    linear: &QUAD4,
    nodes: &NODES,
    shape: |[x, y, _], n, dn| {
        for (i, &[a, b, _]) in NODES.iter().enumerate() {
            let ((f, df), (g, dg)) = (lagrange(a, x), lagrange(b, y));
            (n[i], dn[i]) = (f * g, [df * g, f * dg, 0.0]);
        }
    },
    faces: EDGES,
    full: &GAUSS3X3,
    reduced: Some(&GAUSS2X2),
    gauss: [Some(&GAUSS1X1), Some(&GAUSS2X2), Some(&GAUSS3X3)],
    vtk: 28,
};
