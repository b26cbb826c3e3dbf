//! The surface that carries the contact points: edges of a body with their integration points.

use crate::mesh::cells::Cell;
use crate::mesh::{Mesh, Side};
use crate::tensor::{Scalar, Vec3};

/// Most nodes of an edge.
pub const MAX_EDGE_NODES: usize = 3;

/// One edge of the surface.
#[derive(Debug, Clone)]
pub struct Edge {
    /// Where it lies in the mesh.
    pub side: Side,
    /// Its reference cell.
    pub kind: &'static Cell,
    /// Its nodes.
    pub nodes: Vec<usize>,
}

/// One integration point of the surface.
#[derive(Debug, Clone, Copy)]
pub struct SurfacePoint {
    /// The edge it lies on.
    pub edge: usize,
    /// Shape functions there.
    pub n: [f64; MAX_EDGE_NODES],
    /// Their derivatives along the edge.
    pub dn: [f64; MAX_EDGE_NODES],
    /// Quadrature weight.
    pub weight: f64,
}

/// Edges and integration points, in a fixed order.
#[derive(Debug, Clone)]
pub struct Surface {
    /// The edges.
    pub edges: Vec<Edge>,
    /// The integration points, edge by edge.
    pub points: Vec<SurfacePoint>,
}

impl Surface {
    /// The surface made of `sides`, with `gauss` points an edge (1, 2 or 3); by default as many as the degree of the
    /// edge. More points than the edge adds nodes enforce more conditions than it can meet: on a curved target the
    /// pressure then oscillates, and the force on a tool ripples as edges pass.
    pub fn new(mesh: &Mesh, sides: &[Side], gauss: Option<usize>) -> Self {
        let mut surface = Self { edges: Vec::new(), points: Vec::new() };
        for &side in sides {
            let (kind, nodes) = mesh.side(side);
            let order = gauss.unwrap_or(kind.degree).clamp(1, 3);
            let Some(rule) = kind.gauss[order - 1] else { continue };
            for (&xi, &weight) in rule.points.iter().zip(rule.weights) {
                surface.points.push(point_at(kind, xi, weight, surface.edges.len()));
            }
            surface.edges.push(Edge { side, kind, nodes: nodes.collect() });
        }
        surface
    }

    /// Nodes of the edge a point lies on.
    pub fn nodes(&self, point: &SurfacePoint) -> &[usize] {
        &self.edges[point.edge].nodes
    }
}

fn point_at(kind: &Cell, xi: [f64; 3], weight: f64, edge: usize) -> SurfacePoint {
    let (mut n, mut gradient) = ([0.0; MAX_EDGE_NODES], [[0.0; 3]; MAX_EDGE_NODES]);
    (kind.shape)(xi, &mut n[..kind.nodes.len()], &mut gradient[..kind.nodes.len()]);
    SurfacePoint { edge, n, dn: gradient.map(|g| g[0]), weight }
}

impl SurfacePoint {
    /// Position and tangent `dx/dxi` for edge nodes at `x`.
    pub fn place<T: Scalar>(&self, x: &[Vec3<T>]) -> (Vec3<T>, Vec3<T>) {
        let (mut a, mut tangent) = (Vec3::zero(), Vec3::zero());
        for (k, &x) in x.iter().enumerate() {
            a += x * T::from(self.n[k]);
            tangent += x * T::from(self.dn[k]);
        }
        (a, tangent)
    }
}
