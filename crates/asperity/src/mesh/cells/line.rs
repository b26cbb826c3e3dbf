//! Lines of first and second degree: the edges of plane cells.

use super::{Cell, Rule};

const G2: f64 = 0.577_350_269_189_625_8;
const G3: f64 = 0.774_596_669_241_483_4;

/// One Gauss point: exact to degree 1.
pub static GAUSS1: Rule = Rule { points: &[[0.0, 0.0, 0.0]], weights: &[2.0] };
/// Two Gauss points: exact to degree 3.
pub static GAUSS2: Rule = Rule { points: &[[-G2, 0.0, 0.0], [G2, 0.0, 0.0]], weights: &[1.0, 1.0] };
/// Three Gauss points: exact to degree 5.
pub static GAUSS3: Rule =
    Rule { points: &[[-G3, 0.0, 0.0], [0.0, 0.0, 0.0], [G3, 0.0, 0.0]], weights: &[5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0] };

/// Two nodes, first degree.
pub static LINE2: Cell = Cell {
    name: "line2",
    dimension: 1,
    degree: 1,
    linear: &LINE2,
    nodes: &[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
    shape: |xi, n, dn| {
        let x = xi[0];
        (n[0], n[1]) = (0.5 * (1.0 - x), 0.5 * (1.0 + x));
        (dn[0], dn[1]) = ([-0.5, 0.0, 0.0], [0.5, 0.0, 0.0]);
    },
    faces: &[],
    full: &GAUSS1,
    reduced: None,
    gauss: [Some(&GAUSS1), Some(&GAUSS2), Some(&GAUSS3)],
    vtk: 3,
};

/// Three nodes, second degree: ends first, then the middle.
pub static LINE3: Cell = Cell {
    name: "line3",
    dimension: 1,
    degree: 2,
    linear: &LINE2,
    nodes: &[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
    shape: |xi, n, dn| {
        let x = xi[0];
        (n[0], n[1], n[2]) = (0.5 * x * (x - 1.0), 0.5 * x * (x + 1.0), 1.0 - x * x);
        (dn[0], dn[1], dn[2]) = ([x - 0.5, 0.0, 0.0], [x + 0.5, 0.0, 0.0], [-2.0 * x, 0.0, 0.0]);
    },
    faces: &[],
    full: &GAUSS2,
    reduced: None,
    gauss: [Some(&GAUSS1), Some(&GAUSS2), Some(&GAUSS3)],
    vtk: 21,
};
