//! Integration points of an edge or face.
//!
//! With `g1`, `g2` the derivatives of the position along the reference directions, `g1 x g2` is the outward normal
//! times the area of a face of a solid cell; on an edge, with the cell on its left, `g2 = e_z` gives the same.

use super::Site;
use crate::Error;
use crate::mesh::cells::Cell;
use crate::mesh::{Mesh, Side, Space};
use crate::tensor::{Scalar, Vec3};
use std::collections::BTreeMap;

/// Most nodes of an edge or face (quad9).
pub(super) const MAX_FACE_NODES: usize = 9;

/// One edge or face with its integration points.
#[derive(Debug)]
pub(super) struct Face {
    pub(super) side: Side,
    pub(super) nodes: Vec<usize>,
    pub(super) points: Vec<FacePoint>,
}

/// Shape functions, their gradients along the face and the weight of one point.
#[derive(Debug)]
pub(super) struct FacePoint {
    pub(super) n: [f64; MAX_FACE_NODES],
    pub(super) dn: [[f64; 2]; MAX_FACE_NODES],
    pub(super) weight: f64,
}

impl Face {
    /// One side of a mesh, with points enough for `N_L (g1 x g2) r` of an edge and `N_L (g1 x g2)` of a face.
    ///
    /// # Errors
    /// An input error, naming the load, if the cell's kind has no such face.
    pub(super) fn new(load: &str, mesh: &Mesh, side: Side) -> Result<Self, Error> {
        let (kind, nodes) = mesh.side(side);
        let rule = kind.gauss[kind.degree.min(2)].ok_or_else(|| {
            Error::input(format!("load '{load}': a face {} of cell {} cannot carry a load", kind.name, side.cell))
        })?;
        let points = rule.points.iter().zip(rule.weights).map(|(&xi, &weight)| FacePoint::new(kind, xi, weight));
        Ok(Self { side, points: points.collect(), nodes: nodes.collect() })
    }
    /// Words for it under a pressure.
    pub(super) fn under(&self, pressure: &str) -> String {
        format!("face {} of cell {} under pressure '{pressure}'", self.side.face, self.side.cell)
    }
    /// Undeformed positions of its nodes.
    pub(super) fn undeformed<'a>(&'a self, mesh: &'a Mesh) -> impl Iterator<Item = Vec3> + 'a {
        self.nodes.iter().map(|&node| mesh.points[node])
    }
}

impl FacePoint {
    fn new(kind: &Cell, xi: [f64; 3], weight: f64) -> Self {
        let (mut n, mut gradient) = ([0.0; MAX_FACE_NODES], [[0.0; 3]; MAX_FACE_NODES]);
        (kind.shape)(xi, &mut n[..kind.nodes.len()], &mut gradient[..kind.nodes.len()]);
        Self { n, dn: gradient.map(|[a, b, _]| [a, b]), weight }
    }
    /// Position, `g1` and `g2` for nodes at `x`.
    pub(super) fn place(&self, x: impl IntoIterator<Item = Vec3>, space: Space) -> [Vec3; 3] {
        let [mut at, mut g1, mut g2] = [Vec3::zero(); 3];
        for (k, x) in x.into_iter().enumerate() {
            at += x * self.n[k];
            g1 += x * self.dn[k][0];
            g2 += x * self.dn[k][1];
        }
        [at, g1, if space == Space::Solid { g2 } else { Vec3::new(0.0, 0.0, 1.0) }]
    }
}

/// Outward normal times area for a unit of the reference face, thickness and circumference included.
pub(super) fn area<T: Scalar>(site: &Site, [x, g1, g2]: [Vec3<T>; 3]) -> Vec3<T> {
    g1.cross(g2) * site.depth(x)
}

/// The undeformed area around each node of some sides: the integrals of its shape functions.
///
/// # Errors
/// An input error, naming the load, if a side cannot carry one.
pub fn areas(load: &str, site: &Site, sides: &[Side]) -> Result<Vec<(usize, f64)>, Error> {
    let mut areas = BTreeMap::<usize, f64>::new();
    for &side in sides {
        let face = Face::new(load, &site.mesh, side)?;
        for point in &face.points {
            let size = point.weight * area(site, point.place(face.undeformed(&site.mesh), site.space)).norm();
            face.nodes.iter().zip(&point.n).for_each(|(&node, n)| *areas.entry(node).or_default() += n * size);
        }
    }
    Ok(areas.into_iter().collect())
}
