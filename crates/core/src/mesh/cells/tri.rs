//! Triangles on `r, s >= 0, r + s <= 1`: corners counter-clockwise, then mid-sides in the same turn.
//!
//! The rule of six points is the one of degree 4 in Strang and Fix (1973), "An analysis of the finite element method";
//! its positions are `(8 - sqrt(10) +- sqrt(38 - 44 sqrt(2/5))) / 18`.

use super::rules::area_coordinates;
use super::{Cell, Face, LINE2, LINE3, Quadrature};

const T: f64 = 1.0 / 3.0;
const S: f64 = 1.0 / 6.0;
const A: f64 = 0.445_948_490_915_964_9;
const B: f64 = 0.091_576_213_509_770_74;
const WA: f64 = 0.111_690_794_839_005_73;
const WB: f64 = 0.054_975_871_827_660_93;

/// The centroid.
pub static TRI_P1: Quadrature = Quadrature { degree: 1, points: &[[T, T, 0.0]], weights: &[0.5] };
/// Three points inside.
pub static TRI_P3: Quadrature = Quadrature {
    degree: 2,
    points: &[[S, S, 0.0], [1.0 - 2.0 * S, S, 0.0], [S, 1.0 - 2.0 * S, 0.0]],
    weights: &[S, S, S],
};
/// Six points inside.
pub static TRI_P6: Quadrature = Quadrature {
    degree: 4,
    points: &[
        [A, A, 0.0],
        [1.0 - 2.0 * A, A, 0.0],
        [A, 1.0 - 2.0 * A, 0.0],
        [B, B, 0.0],
        [1.0 - 2.0 * B, B, 0.0],
        [B, 1.0 - 2.0 * B, 0.0],
    ],
    weights: &[WA, WA, WA, WB, WB, WB],
};

const NODES: [[f64; 3]; 6] =
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.0, 0.0], [0.5, 0.5, 0.0], [0.0, 0.5, 0.0]];

/// Three nodes, linear.
pub static TRI3: Cell = Cell {
    name: "tri3",
    dimension: 2,
    degree: 1,
    linear: &TRI3,
    nodes: NODES.first_chunk::<3>().unwrap(),
    shape: |[r, s, _], n, dn| {
        for (i, (value, [dr, ds])) in area_coordinates(r, s).into_iter().enumerate() {
            (n[i], dn[i]) = (value, [dr, ds, 0.0]);
        }
    },
    faces: &[
        Face { cell: &LINE2, nodes: &[0, 1] },
        Face { cell: &LINE2, nodes: &[1, 2] },
        Face { cell: &LINE2, nodes: &[2, 0] },
    ],
    full: &TRI_P1,
    reduced: None,
    gauss: [Some(&TRI_P1), Some(&TRI_P3), Some(&TRI_P6)],
    vtk: 5,
};

/// Six nodes, quadratic.
pub static TRI6: Cell = Cell {
    name: "tri6",
    dimension: 2,
    degree: 2,
    linear: &TRI3,
    nodes: &NODES,
    shape: |[r, s, _], n, dn| {
        let area = area_coordinates(r, s);
        for i in 0..3 {
            let ((a, da), (b, db)) = (area[i], area[(i + 1) % 3]);
            n[i] = a * (2.0 * a - 1.0);
            dn[i] = [(4.0 * a - 1.0) * da[0], (4.0 * a - 1.0) * da[1], 0.0];
            n[i + 3] = 4.0 * a * b;
            dn[i + 3] = [4.0 * (a * db[0] + b * da[0]), 4.0 * (a * db[1] + b * da[1]), 0.0];
        }
    },
    faces: &[
        Face { cell: &LINE3, nodes: &[0, 1, 3] },
        Face { cell: &LINE3, nodes: &[1, 2, 4] },
        Face { cell: &LINE3, nodes: &[2, 0, 5] },
    ],
    full: &TRI_P3,
    reduced: None,
    gauss: [Some(&TRI_P1), Some(&TRI_P3), Some(&TRI_P6)],
    vtk: 22,
};
