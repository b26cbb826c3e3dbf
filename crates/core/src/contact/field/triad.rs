//! The two tangents along which a node of the field has its shears.
//!
//! They follow one line of the surface's material: with `d` the edge from the node to its neighbour on its first face, and `n`
//! the direction of the gap at a point, `e_1 = P d / |P d|` with `P = 1 - n n`, and `e_2 = n x e_1`. They turn with the
//! body, so that shears kept by their components are objective, and carry the shears of the node into the tangent plane of
//! each of its points without changing their length.

use crate::tensor::Vec3;

/// The line of the surface's material, and the nodes of the mesh between which it runs.
#[derive(Debug, Clone, Copy)]
pub struct MaterialLine {
    /// From the first node to the second.
    pub d: Vec3,
    /// The nodes.
    pub nodes: [usize; 2],
}

impl MaterialLine {
    /// The two tangents across `n`.
    pub fn tangents(&self, n: Vec3) -> [Vec3; 2] {
        let e = (self.d - n * n.dot(self.d)).unit();
        [e, n.cross(e)]
    }

    /// Their derivatives along an unknown along which `n` turns by `dn`: the displacement of a node along an axis, or of the tool.
    pub fn rates(&self, of: Option<(usize, usize)>, (n, dn): (Vec3, Vec3), e: &[Vec3; 2]) -> [Vec3; 2] {
        let dd = match of {
            Some((node, axis)) if node == self.nodes[0] => -Vec3::axis(axis),
            Some((node, axis)) if node == self.nodes[1] => Vec3::axis(axis),
            _ => Vec3::zero(),
        };
        let m = self.d - n * n.dot(self.d);
        let dm = dd - dn * n.dot(self.d) - n * (dn.dot(self.d) + n.dot(dd));
        let de = m.turned(dm);
        [de, dn.cross(e[0]) + n.cross(de)]
    }
}
