//! The surface that carries the contact points: faces of a body with their integration points.

use crate::contact::capture::positions;
use crate::mesh::cells::Cell;
use crate::mesh::{Mesh, Side};
use crate::system::Dofs;
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

    /// Number of its corners, which are the first of its nodes.
    pub fn corners(&self) -> usize {
        self.kind.linear.nodes.len()
    }

    /// Ends of its edges, counter-clockwise seen from outside.
    pub fn edges(&self) -> impl Iterator<Item = [usize; 2]> {
        let n = self.corners();
        (0..n).map(move |k| [self.nodes[k], self.nodes[(k + 1) % n]])
    }

    /// Its middle in its own coordinates.
    pub fn middle(&self) -> [f64; 2] {
        if self.corners() == 3 { [1.0 / 3.0; 2] } else { [0.0; 2] }
    }

    /// Shape functions at `xi` in its own coordinates, and their derivatives.
    pub fn natural(&self, xi: [f64; 2]) -> ([f64; MAX_NODES], [[f64; 2]; MAX_NODES]) {
        natural(self.kind, xi)
    }

    /// Second derivatives of the shape functions, `[a][b]` along `xi_a` and `xi_b`. Along one coordinate the first ones
    /// are of second degree at most, so that their central differences are exact.
    pub fn second(&self, xi: [f64; 2]) -> [[[f64; 2]; 2]; MAX_NODES] {
        let mut second = [[[0.0; 2]; 2]; MAX_NODES];
        for b in 0..2 {
            let at = |step: f64| self.natural(std::array::from_fn(|i| if i == b { xi[i] + step } else { xi[i] })).1;
            let (back, ahead) = (at(-0.5), at(0.5));
            for (k, second) in second[..self.nodes.len()].iter_mut().enumerate() {
                (0..2).for_each(|a| second[a][b] = ahead[k][a] - back[k][a]);
            }
        }
        second
    }

    /// Positions of its nodes at displacements `u` of all.
    pub fn placed(&self, (mesh, dofs): (&Mesh, &Dofs), u: &[f64]) -> [Vec3; MAX_NODES] {
        let mut x = [Vec3::zero(); MAX_NODES];
        x.iter_mut().zip(positions(mesh, dofs, &self.nodes, u)).for_each(|(x, here)| *x = here);
        x
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
    /// Its place in the rule, in the face's own coordinates.
    pub rule: [f64; 2],
    /// Its place on the face: that in the rule, unless the rule is laid on a part of the face.
    pub xi: [f64; 2],
    /// Root of that part, at most 1.
    pub scale: f64,
    /// Shape functions there.
    pub n: [f64; MAX_NODES],
    /// Their derivatives along the two coordinates of the face, times `scale`.
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

    /// A point where it stands when the rule is laid on a part of its face: at `xi`, the root of the part `scale`.
    pub fn moved(&self, point: usize, xi: [f64; 2], scale: f64) -> SurfacePoint {
        let point = self.points[point];
        if xi == point.xi && scale == point.scale {
            return point;
        }
        let (n, dn) = self.faces[point.face].natural(xi);
        SurfacePoint { xi, scale, n, dn: dn.map(|dn| dn.map(|slope| slope * scale)), ..point }
    }

    /// The points of a face, which follow each other.
    pub fn points_of(&self, face: usize) -> std::ops::Range<usize> {
        let place = |face: usize| self.points.partition_point(|point| point.face < face);
        place(face)..place(face + 1)
    }

    /// Nodes of the face a point lies on.
    pub fn nodes(&self, point: &SurfacePoint) -> &[usize] {
        &self.faces[point.face].nodes
    }
}

fn point_at(kind: &Cell, [xi, eta, _]: [f64; 3], weight: f64, face: usize) -> SurfacePoint {
    let (n, dn) = natural(kind, [xi, eta]);
    SurfacePoint { face, rule: [xi, eta], xi: [xi, eta], scale: 1.0, n, dn, weight }
}

/// Shape functions of a kind of face at `xi` in its own coordinates, and their derivatives.
pub fn natural(kind: &Cell, [xi, eta]: [f64; 2]) -> ([f64; MAX_NODES], [[f64; 2]; MAX_NODES]) {
    let (mut n, mut gradient) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
    (kind.shape)([xi, eta, 0.0], &mut n[..kind.nodes.len()], &mut gradient[..kind.nodes.len()]);
    (n, gradient.map(|[a, b, _]| [a, b]))
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
