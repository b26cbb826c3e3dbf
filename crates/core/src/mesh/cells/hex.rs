//! Hexahedra on `[-1, 1]^3`: corners of the bottom counter-clockwise seen from above, corners of the top, mid-edges of
//! the bottom, of the top, of the uprights, then the middles of the faces in the order of the face list, then the centre.

use super::rules::{X1, X2, X3, bubble, hat, lagrange, prism_points, prism_weights, product};
use super::{Cell, Face, QUAD4, QUAD8, QUAD9, Quadrature, quad};

/// One point.
pub static HEX_P1: Quadrature = Quadrature {
    degree: 1,
    points: &prism_points::<1, 1>(&quad::GAUSS1X1, &X1),
    weights: &prism_weights::<1, 1>(&quad::GAUSS1X1, &X1),
};
/// Two points along each direction, x running fastest.
pub static HEX_P8: Quadrature = Quadrature {
    degree: 3,
    points: &prism_points::<4, 8>(&quad::GAUSS2X2, &X2),
    weights: &prism_weights::<4, 8>(&quad::GAUSS2X2, &X2),
};
/// Three points along each direction, x running fastest.
pub static HEX_P27: Quadrature = Quadrature {
    degree: 5,
    points: &prism_points::<9, 27>(&quad::GAUSS3X3, &X3),
    weights: &prism_weights::<9, 27>(&quad::GAUSS3X3, &X3),
};

const NODES: [[f64; 3]; 27] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
    [0.0, -1.0, -1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, -1.0],
    [-1.0, 0.0, -1.0],
    [0.0, -1.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [-1.0, 0.0, 1.0],
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [-1.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, -1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, -1.0],
    [0.0, 0.0, 1.0],
    [0.0, 0.0, 0.0],
];

/// Eight nodes, trilinear.
pub static HEX8: Cell = Cell {
    name: "hex8",
    dimension: 3,
    degree: 1,
    linear: &HEX8,
    nodes: NODES.first_chunk::<8>().unwrap(),
    shape: |[x, y, z], n, dn| {
        for (i, &[a, b, c]) in NODES[..8].iter().enumerate() {
            let (value, gradient) = product([hat(a, x), hat(b, y), hat(c, z)]);
            (n[i], dn[i]) = (0.125 * value, gradient.map(|d| 0.125 * d));
        }
    },
    faces: &[
        Face { cell: &QUAD4, nodes: &[0, 4, 7, 3] },
        Face { cell: &QUAD4, nodes: &[1, 2, 6, 5] },
        Face { cell: &QUAD4, nodes: &[0, 1, 5, 4] },
        Face { cell: &QUAD4, nodes: &[3, 7, 6, 2] },
        Face { cell: &QUAD4, nodes: &[0, 3, 2, 1] },
        Face { cell: &QUAD4, nodes: &[4, 5, 6, 7] },
    ],
    full: &HEX_P8,
    reduced: Some(&HEX_P1),
    gauss: [None; 3],
    vtk: 12,
};

/// Twenty nodes, serendipity of second degree.
pub static HEX20: Cell = Cell {
    name: "hex20",
    dimension: 3,
    degree: 2,
    linear: &HEX8,
    nodes: NODES.first_chunk::<20>().unwrap(),
    shape: |[x, y, z], n, dn| {
        for (i, &[a, b, c]) in NODES[..8].iter().enumerate() {
            let (value, gradient) = product([hat(a, x), hat(b, y), hat(c, z)]);
            let sum = a * x + b * y + c * z - 2.0;
            n[i] = 0.125 * value * sum;
            dn[i] = [(a, gradient[0]), (b, gradient[1]), (c, gradient[2])].map(|(s, d)| 0.125 * (d * sum + value * s));
        }
        for (i, &[a, b, c]) in NODES[..20].iter().enumerate().skip(8) {
            let factor = |a: f64, x: f64| if a == 0.0 { bubble(x) } else { hat(a, x) };
            let (value, gradient) = product([factor(a, x), factor(b, y), factor(c, z)]);
            (n[i], dn[i]) = (0.25 * value, gradient.map(|d| 0.25 * d));
        }
    },
    faces: &[
        Face { cell: &QUAD8, nodes: &[0, 4, 7, 3, 16, 15, 19, 11] },
        Face { cell: &QUAD8, nodes: &[1, 2, 6, 5, 9, 18, 13, 17] },
        Face { cell: &QUAD8, nodes: &[0, 1, 5, 4, 8, 17, 12, 16] },
        Face { cell: &QUAD8, nodes: &[3, 7, 6, 2, 19, 14, 18, 10] },
        Face { cell: &QUAD8, nodes: &[0, 3, 2, 1, 11, 10, 9, 8] },
        Face { cell: &QUAD8, nodes: &[4, 5, 6, 7, 12, 13, 14, 15] },
    ],
    full: &HEX_P27,
    reduced: Some(&HEX_P8),
    gauss: [None; 3],
    vtk: 25,
};

/// Twenty-seven nodes, triquadratic.
pub static HEX27: Cell = Cell {
    name: "hex27",
    dimension: 3,
    degree: 2,
    linear: &HEX8,
    nodes: &NODES,
    shape: |[x, y, z], n, dn| {
        for (i, &[a, b, c]) in NODES.iter().enumerate() {
            (n[i], dn[i]) = product([lagrange(a, x), lagrange(b, y), lagrange(c, z)]);
        }
    },
    faces: &[
        Face { cell: &QUAD9, nodes: &[0, 4, 7, 3, 16, 15, 19, 11, 20] },
        Face { cell: &QUAD9, nodes: &[1, 2, 6, 5, 9, 18, 13, 17, 21] },
        Face { cell: &QUAD9, nodes: &[0, 1, 5, 4, 8, 17, 12, 16, 22] },
        Face { cell: &QUAD9, nodes: &[3, 7, 6, 2, 19, 14, 18, 10, 23] },
        Face { cell: &QUAD9, nodes: &[0, 3, 2, 1, 11, 10, 9, 8, 24] },
        Face { cell: &QUAD9, nodes: &[4, 5, 6, 7, 12, 13, 14, 15, 25] },
    ],
    full: &HEX_P27,
    reduced: Some(&HEX_P8),
    gauss: [None; 3],
    vtk: 29,
};
