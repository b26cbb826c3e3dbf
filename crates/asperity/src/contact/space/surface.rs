//! The surface that carries the contact points: faces of a body with their integration points.

use crate::mesh::cells::Cell;
use crate::mesh::{Mesh, Side};
use crate::tensor::{Scalar, Vec3};
use crate::tool::Bounds;

/// Most nodes of a face.
pub const MAX_NODES: usize = 9;

/// One face of the surface.
#[derive(Debug, Clone)]
pub struct Face {
    /// Where it lies in the mesh.
    pub side: Side,
    /// Its reference cell.
    pub kind: &'static Cell,
    /// Its nodes.
    pub nodes: Vec<usize>,
}

impl Face {
    /// A side of the mesh.
    pub fn new(mesh: &Mesh, side: Side) -> Self {
        let (kind, nodes) = mesh.side(side);
        Self { side, kind, nodes: nodes.collect() }
    }

    /// Its nodes with displacements `u`, three a node.
    pub fn moved(&self, mesh: &Mesh, u: &[f64]) -> [Vec3; MAX_NODES] {
        let mut x = [Vec3::zero(); MAX_NODES];
        for ((x, u), &node) in x.iter_mut().zip(u.chunks_exact(3)).zip(&self.nodes) {
            *x = mesh.points[node] + Vec3::new(u[0], u[1], u[2]);
        }
        x
    }

    /// Diagonal of the box around its undeformed nodes.
    pub fn size(&self, mesh: &Mesh) -> f64 {
        Bounds::of(self.nodes.iter().map(|&node| mesh.points[node])).size()
    }
}

/// One integration point of the surface.
#[derive(Debug, Clone, Copy)]
pub struct SurfacePoint {
    /// The face it lies on.
    pub face: usize,
    /// Its place on it.
    pub xi: [f64; 2],
    /// Shape functions there.
    pub n: [f64; MAX_NODES],
    /// Their derivatives along the two coordinates of the face.
    pub dn: [[f64; 2]; MAX_NODES],
    /// Quadrature weight.
    pub weight: f64,
}

/// Faces and integration points, in a fixed order.
#[derive(Debug, Clone)]
pub struct Surface {
    /// The faces.
    pub faces: Vec<Face>,
    /// The integration points, face by face.
    pub points: Vec<SurfacePoint>,
}

impl Surface {
    /// The surface made of `sides`, with Gauss' rule of order `gauss` (1, 2 or 3) on each face: as many points along
    /// each side of a quadrilateral, and 1, 3 or 6 points on a triangle. By default the degree of the face.
    pub fn new(mesh: &Mesh, sides: &[Side], gauss: Option<usize>) -> Self {
        let mut surface = Self { faces: Vec::new(), points: Vec::new() };
        for &side in sides {
            let face = Face::new(mesh, side);
            let order = gauss.unwrap_or(face.kind.degree).clamp(1, 3);
            let Some(rule) = face.kind.gauss[order - 1].filter(|_| face.kind.dimension == 2) else { continue };
            for (&xi, &weight) in rule.points.iter().zip(rule.weights) {
                surface.points.push(point_at(face.kind, xi, weight, surface.faces.len()));
            }
            surface.faces.push(face);
        }
        surface
    }

    /// Nodes of the face a point lies on.
    pub fn nodes(&self, point: &SurfacePoint) -> &[usize] {
        &self.faces[point.face].nodes
    }
}

fn point_at(kind: &Cell, xi: [f64; 3], weight: f64, face: usize) -> SurfacePoint {
    let (mut n, mut gradient) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
    (kind.shape)(xi, &mut n[..kind.nodes.len()], &mut gradient[..kind.nodes.len()]);
    SurfacePoint { face, xi: [xi[0], xi[1]], n, dn: gradient.map(|[a, b, _]| [a, b]), weight }
}

impl SurfacePoint {
    /// Position and the two tangents `dx/dxi` for face nodes at `x`.
    pub fn place<T: Scalar>(&self, x: &[Vec3<T>]) -> (Vec3<T>, [Vec3<T>; 2]) {
        let (mut a, mut tangents) = (Vec3::zero(), [Vec3::zero(); 2]);
        for (k, &x) in x.iter().enumerate() {
            a += x * T::from(self.n[k]);
            tangents[0] += x * T::from(self.dn[k][0]);
            tangents[1] += x * T::from(self.dn[k][1]);
        }
        (a, tangents)
    }
}
