//! Quadrilaterals: corners counter-clockwise, then mid-sides in the same turn.

use super::{Cell, Face, LINE2, LINE3, Rule};

const G2: f64 = 0.577_350_269_189_625_8;
const G3: f64 = 0.774_596_669_241_483_4;

/// One point.
pub static GAUSS1X1: Rule = Rule { points: &[[0.0, 0.0, 0.0]], weights: &[4.0] };
/// Two by two points.
pub static GAUSS2X2: Rule =
    Rule { points: &[[-G2, -G2, 0.0], [G2, -G2, 0.0], [G2, G2, 0.0], [-G2, G2, 0.0]], weights: &[1.0, 1.0, 1.0, 1.0] };
/// Three by three points.
pub static GAUSS3X3: Rule = Rule {
    points: &[
        [-G3, -G3, 0.0],
        [0.0, -G3, 0.0],
        [G3, -G3, 0.0],
        [-G3, 0.0, 0.0],
        [0.0, 0.0, 0.0],
        [G3, 0.0, 0.0],
        [-G3, G3, 0.0],
        [0.0, G3, 0.0],
        [G3, G3, 0.0],
    ],
    weights: &[
        25.0 / 81.0,
        40.0 / 81.0,
        25.0 / 81.0,
        40.0 / 81.0,
        64.0 / 81.0,
        40.0 / 81.0,
        25.0 / 81.0,
        40.0 / 81.0,
        25.0 / 81.0,
    ],
};

const NODES: [[f64; 3]; 8] = [
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [0.0, -1.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [-1.0, 0.0, 0.0],
];

/// Four nodes, bilinear.
pub static QUAD4: Cell = Cell {
    name: "quad4",
    dimension: 2,
    degree: 1,
    linear: &QUAD4,
    nodes: NODES.first_chunk::<4>().unwrap(),
    shape: |xi, n, dn| {
        for (i, &[a, b, _]) in NODES[..4].iter().enumerate() {
            let (x, y) = (1.0 + a * xi[0], 1.0 + b * xi[1]);
            n[i] = 0.25 * x * y;
            dn[i] = [0.25 * a * y, 0.25 * b * x, 0.0];
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
    nodes: &NODES,
    shape: |[x, y, _], n, dn| {
        for (i, &[a, b, _]) in NODES.iter().enumerate() {
            if i < 4 {
                n[i] = 0.25 * (1.0 + a * x) * (1.0 + b * y) * (a * x + b * y - 1.0);
                dn[i] = [
                    0.25 * a * (1.0 + b * y) * (2.0 * a * x + b * y),
                    0.25 * b * (1.0 + a * x) * (a * x + 2.0 * b * y),
                    0.0,
                ];
            } else if a == 0.0 {
                n[i] = 0.5 * (1.0 - x * x) * (1.0 + b * y);
                dn[i] = [-x * (1.0 + b * y), 0.5 * b * (1.0 - x * x), 0.0];
            } else {
                n[i] = 0.5 * (1.0 + a * x) * (1.0 - y * y);
                dn[i] = [0.5 * a * (1.0 - y * y), -y * (1.0 + a * x), 0.0];
            }
        }
    },
    faces: &[
        Face { cell: &LINE3, nodes: &[0, 1, 4] },
        Face { cell: &LINE3, nodes: &[1, 2, 5] },
        Face { cell: &LINE3, nodes: &[2, 3, 6] },
        Face { cell: &LINE3, nodes: &[3, 0, 7] },
    ],
    full: &GAUSS3X3,
    reduced: Some(&GAUSS2X2),
    gauss: [Some(&GAUSS1X1), Some(&GAUSS2X2), Some(&GAUSS3X3)],
    vtk: 23,
};
