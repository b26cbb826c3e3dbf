//! Wedges, a triangle `r, s >= 0, r + s <= 1` times the interval `[-1, 1]`: corners of the bottom counter-clockwise
//! seen from above, corners of the top, mid-edges of the bottom, of the top, of the uprights.

use super::rules::{X2, X3, area_coordinates, bubble, hat, prism_points, prism_weights};
use super::{Cell, Face, QUAD4, QUAD8, Quadrature, TRI3, TRI6, tri};

/// The centroid of the triangle times two Gauss points.
pub static WEDGE_P2: Quadrature = Quadrature {
    degree: 1,
    points: &prism_points::<1, 2>(&tri::TRI_P1, &X2),
    weights: &prism_weights::<1, 2>(&tri::TRI_P1, &X2),
};
/// Three points of the triangle times two Gauss points.
pub static WEDGE_P6: Quadrature = Quadrature {
    degree: 2,
    points: &prism_points::<3, 6>(&tri::TRI_P3, &X2),
    weights: &prism_weights::<3, 6>(&tri::TRI_P3, &X2),
};
/// Three points of the triangle times three Gauss points.
pub static WEDGE_P9: Quadrature = Quadrature {
    degree: 2,
    points: &prism_points::<3, 9>(&tri::TRI_P3, &X3),
    weights: &prism_weights::<3, 9>(&tri::TRI_P3, &X3),
};
/// Six points of the triangle times three Gauss points.
pub static WEDGE_P18: Quadrature = Quadrature {
    degree: 4,
    points: &prism_points::<6, 18>(&tri::TRI_P6, &X3),
    weights: &prism_weights::<6, 18>(&tri::TRI_P6, &X3),
};

const NODES: [[f64; 3]; 15] = [
    [0.0, 0.0, -1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, -1.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [0.5, 0.0, -1.0],
    [0.5, 0.5, -1.0],
    [0.0, 0.5, -1.0],
    [0.5, 0.0, 1.0],
    [0.5, 0.5, 1.0],
    [0.0, 0.5, 1.0],
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
];

/// Six nodes: linear in the triangle times linear along the uprights.
pub static WEDGE6: Cell = Cell {
    name: "wedge6",
    dimension: 3,
    degree: 1,
    linear: &WEDGE6,
    nodes: NODES.first_chunk::<6>().unwrap(),
    shape: |[r, s, z], n, dn| {
        for (i, (a, [dr, ds])) in area_coordinates(r, s).into_iter().enumerate() {
            for (node, end) in [(i, -1.0), (i + 3, 1.0)] {
                let (h, dh) = hat(end, z);
                (n[node], dn[node]) = (0.5 * a * h, [0.5 * dr * h, 0.5 * ds * h, 0.5 * a * dh]);
            }
        }
    },
    faces: &[
        Face { cell: &TRI3, nodes: &[0, 2, 1] },
        Face { cell: &TRI3, nodes: &[3, 4, 5] },
        Face { cell: &QUAD4, nodes: &[0, 1, 4, 3] },
        Face { cell: &QUAD4, nodes: &[1, 2, 5, 4] },
        Face { cell: &QUAD4, nodes: &[2, 0, 3, 5] },
    ],
    full: &WEDGE_P6,
    reduced: Some(&WEDGE_P2),
    gauss: [None; 3],
    vtk: 13,
};

/// Fifteen nodes, serendipity of second degree.
pub static WEDGE15: Cell = Cell {
    name: "wedge15",
    dimension: 3,
    degree: 2,
    linear: &WEDGE6,
    nodes: &NODES,
    shape: |[r, s, z], n, dn| {
        let area = area_coordinates(r, s);
        let (u, du) = bubble(z);
        for (i, &(a, da)) in area.iter().enumerate() {
            let (b, db) = area[(i + 1) % 3];
            for (corner, middle, end) in [(i, i + 6, -1.0), (i + 3, i + 9, 1.0)] {
                let (h, dh) = hat(end, z);
                let slope = 0.5 * ((4.0 * a - 1.0) * h - u);
                n[corner] = 0.5 * a * ((2.0 * a - 1.0) * h - u);
                dn[corner] = [slope * da[0], slope * da[1], 0.5 * a * ((2.0 * a - 1.0) * dh - du)];
                n[middle] = 2.0 * a * b * h;
                let along = |x: usize| 2.0 * h * (a * db[x] + b * da[x]);
                dn[middle] = [along(0), along(1), 2.0 * a * b * dh];
            }
            (n[i + 12], dn[i + 12]) = (a * u, [da[0] * u, da[1] * u, a * du]);
        }
    },
    faces: &[
        Face { cell: &TRI6, nodes: &[0, 2, 1, 8, 7, 6] },
        Face { cell: &TRI6, nodes: &[3, 4, 5, 9, 10, 11] },
        Face { cell: &QUAD8, nodes: &[0, 1, 4, 3, 6, 13, 9, 12] },
        Face { cell: &QUAD8, nodes: &[1, 2, 5, 4, 7, 14, 10, 13] },
        Face { cell: &QUAD8, nodes: &[2, 0, 3, 5, 8, 12, 11, 14] },
    ],
    full: &WEDGE_P18,
    reduced: Some(&WEDGE_P9),
    gauss: [None; 3],
    vtk: 26,
};
