//! Directions: unit vectors, the common normal of a flat group of sides, and whether a group is curved.

use super::smooth::CREASE;
use super::{CellView, Mesh, Side};
use crate::tensor::Vec3;
use std::collections::BTreeMap;

/// A component of a unit vector below this is rounding.
pub const ROUNDING: f64 = 1e-9;
/// Normals of a flat group differ by no more than this.
const FLAT: f64 = 1e-6;
/// Normals of sides that meet on a curved surface differ by more than this.
const BENT: f64 = 1e-3;

/// A vector over its length.
pub fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = v.iter().fold(0.0, |length: f64, x| length.hypot(*x));
    v.map(|x| x / length)
}

/// The common normal of sides, if they have one: at every node of every side.
pub fn flat_normal(mesh: &Mesh, sides: &[Side]) -> Option<[f64; 3]> {
    let mut normals = sides.iter().flat_map(|&side| side_normals(mesh, side));
    let first = normals.next()?;
    let same = |n: [f64; 3]| (0..3).all(|i| (n[i] - first[i]).abs() <= FLAT);
    normals.all(same).then(|| first.map(|x| if x.abs() < ROUNDING { 0.0 } else { x })).map(unit)
}

/// Whether sides meet at angles that are no creases: they stand for a curved surface.
pub fn is_curved(mesh: &Mesh, sides: &[Side]) -> bool {
    let mut known: BTreeMap<usize, Vec<Vec3>> = BTreeMap::new();
    let mut bends = |(node, normal): (usize, [f64; 3])| {
        let (normal, others) = (Vec3(normal), known.entry(node).or_default());
        let found = others.iter().any(|m| m.dot(normal) > CREASE.cos() && (*m - normal).norm() > BENT);
        others.push(normal);
        found
    };
    sides.iter().any(|&side| mesh.side(side).1.zip(side_normals(mesh, side)).any(&mut bends))
}

/// Unit normals of a side at its nodes, outward.
fn side_normals(mesh: &Mesh, side: Side) -> Vec<[f64; 3]> {
    let (kind, nodes) = mesh.side(side);
    let nodes: Vec<usize> = nodes.collect();
    let plane = kind.dimension == 1;
    let normal = |&xi: &[f64; 3]| {
        let (_, tangents) = CellView { kind, nodes: &nodes }.map(&mesh.points, xi);
        let across = if plane { Vec3::new(0.0, 0.0, 1.0) } else { tangents[1] };
        unit(tangents[0].cross(across).0)
    };
    kind.nodes.iter().map(normal).collect()
}
