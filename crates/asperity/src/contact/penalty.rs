//! The penalty that needs no guess: `K = 50 min(M / h)` over the faces of both sides, with `M` the lesser of `lambda + 2 G`
//! and `4 G` of the undeformed law and `h` the size of the cell behind the face (its volume over the area of the face).

use crate::mesh::{CellView, Mesh, Side};

/// Ratio of the penalty to the stiffness of the cell behind a face.
const RATIO: f64 = 50.0;

/// Part of it that serves with two passes: each side answers the other with a penalty of its own, and what a stiffer pair
/// disagrees about from point to point, friction least of all, leaves Newton's method without an end.
pub const TWO_PASSES: f64 = 0.2;

/// Default penalty for faces `sides`, with `modulus` that of a cell's material.
pub fn default_penalty(mesh: &Mesh, sides: &[Side], modulus: impl Fn(usize) -> f64) -> f64 {
    let stiffness = |side: &Side| modulus(side.cell) / depth(mesh, *side);
    RATIO * sides.iter().map(stiffness).fold(f64::INFINITY, f64::min)
}

/// Volume of the cell behind a side over the area of the side.
pub fn depth(mesh: &Mesh, side: Side) -> f64 {
    let (kind, nodes) = mesh.side(side);
    let nodes: Vec<usize> = nodes.collect();
    mesh.measure(side.cell) / CellView { kind, nodes: &nodes }.extent(&mesh.points)
}
