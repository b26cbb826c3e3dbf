//! Tetrahedra on `r, s, t >= 0, r + s + t <= 1`: corners, then mid-edges of the base in turn, then those that rise to
//! the apex.

use super::{Cell, Face, Quadrature, TRI3, TRI6};

const A: f64 = 0.138_196_601_125_010_5;
const B: f64 = 1.0 - 3.0 * A;
const W: f64 = 1.0 / 24.0;

/// The centroid.
pub static TET_P1: Quadrature = Quadrature { degree: 1, points: &[[0.25, 0.25, 0.25]], weights: &[1.0 / 6.0] };
/// Four points, `(5 - sqrt(5)) / 20` from three of the faces.
pub static TET_P4: Quadrature =
    Quadrature { degree: 2, points: &[[A, A, A], [B, A, A], [A, B, A], [A, A, B]], weights: &[W, W, W, W] };

const NODES: [[f64; 3]; 10] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.5, 0.0, 0.0],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.0],
    [0.0, 0.0, 0.5],
    [0.5, 0.0, 0.5],
    [0.0, 0.5, 0.5],
];

/// The corners on either side of each mid-edge node.
const EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];

/// Volume coordinates and their gradients.
fn volume_coordinates([r, s, t]: [f64; 3]) -> [(f64, [f64; 3]); 4] {
    [(1.0 - r - s - t, [-1.0; 3]), (r, [1.0, 0.0, 0.0]), (s, [0.0, 1.0, 0.0]), (t, [0.0, 0.0, 1.0])]
}

/// Four nodes, linear.
pub static TET4: Cell = Cell {
    name: "tet4",
    dimension: 3,
    degree: 1,
    linear: &TET4,
    nodes: NODES.first_chunk::<4>().unwrap(),
    shape: |xi, n, dn| {
        for (i, (value, gradient)) in volume_coordinates(xi).into_iter().enumerate() {
            (n[i], dn[i]) = (value, gradient);
        }
    },
    faces: &[
        Face { cell: &TRI3, nodes: &[0, 2, 1] },
        Face { cell: &TRI3, nodes: &[0, 1, 3] },
        Face { cell: &TRI3, nodes: &[1, 2, 3] },
        Face { cell: &TRI3, nodes: &[2, 0, 3] },
    ],
    full: &TET_P1,
    reduced: None,
    gauss: [None; 3],
    vtk: 10,
};

/// Ten nodes, quadratic.
pub static TET10: Cell = Cell {
    name: "tet10",
    dimension: 3,
    degree: 2,
    linear: &TET4,
    nodes: &NODES,
    shape: |xi, n, dn| {
        let volume = volume_coordinates(xi);
        for (i, (a, da)) in volume.into_iter().enumerate() {
            (n[i], dn[i]) = (a * (2.0 * a - 1.0), da.map(|d| (4.0 * a - 1.0) * d));
        }
        for (i, [one, two]) in EDGES.into_iter().enumerate() {
            let ((a, da), (b, db)) = (volume[one], volume[two]);
            n[i + 4] = 4.0 * a * b;
            dn[i + 4] = std::array::from_fn(|x| 4.0 * (a * db[x] + b * da[x]));
        }
    },
    faces: &[
        Face { cell: &TRI6, nodes: &[0, 2, 1, 6, 5, 4] },
        Face { cell: &TRI6, nodes: &[0, 1, 3, 4, 8, 7] },
        Face { cell: &TRI6, nodes: &[1, 2, 3, 5, 9, 8] },
        Face { cell: &TRI6, nodes: &[2, 0, 3, 6, 7, 9] },
    ],
    full: &TET_P4,
    reduced: None,
    gauss: [None; 3],
    vtk: 24,
};
