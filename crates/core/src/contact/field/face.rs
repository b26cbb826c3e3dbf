//! A face of a body's boundary: an edge in the plane, a face in space, with its nodes in place.

use crate::mesh::cells::Cell;
use crate::mesh::{Mesh, Side};
use crate::system::Dofs;
use crate::tensor::Vec3;

/// Most nodes of a face.
pub const MOST: usize = 9;
/// Most corners of a face.
pub const CORNERS: usize = 4;

/// The part that is the whole of an edge.
pub const WHOLE: [f64; 2] = [-1.0, 1.0];

/// Step of differences of shape functions, in reference coordinates.
const STEP: f64 = 1e-3;

/// A face of the boundary, or half of an edge of second degree.
#[derive(Debug, Clone)]
pub struct FieldFace {
    /// Where it lies in the mesh.
    pub side: Side,
    /// Its reference cell.
    pub kind: &'static Cell,
    /// Its nodes, the corners first.
    pub nodes: Vec<usize>,
    /// The part of an edge that it is, in reference coordinates of the edge.
    part: [f64; 2],
}

/// Shape functions and their derivatives at a place of a face.
#[derive(Debug, Clone, Copy)]
pub struct ShapeFunctions {
    /// Values.
    pub n: [f64; MOST],
    /// Derivatives along the two reference coordinates.
    pub dn: [[f64; 2]; MOST],
}

impl ShapeFunctions {
    /// Those of a reference cell at `xi`.
    pub fn of(kind: &Cell, xi: [f64; 2]) -> Self {
        let (mut n, mut dn) = ([0.0; MOST], [[0.0; 3]; MOST]);
        let count = kind.nodes.len();
        (kind.shape)([xi[0], xi[1], 0.0], &mut n[..count], &mut dn[..count]);
        Self { n, dn: dn.map(|[a, b, _]| [a, b]) }
    }

    /// The value of a field with nodal values `x`.
    pub fn value(&self, x: &[Vec3]) -> Vec3 {
        x.iter().zip(&self.n).fold(Vec3::zero(), |sum, (&x, &n)| sum + x * n)
    }

    /// Its derivatives along the reference coordinates; in the plane the second is `e_z`.
    pub fn tangents(&self, x: &[Vec3], plane: bool) -> [Vec3; 2] {
        let along = |a: usize| x.iter().zip(&self.dn).fold(Vec3::zero(), |sum, (&x, dn)| sum + x * dn[a]);
        [along(0), if plane { Vec3::new(0.0, 0.0, 1.0) } else { along(1) }]
    }

    /// Derivatives of the area vector of the tangents `a`, `b` along the three displacements of a node.
    pub fn area_rates(&self, node: usize, [a, b]: [Vec3; 2]) -> [Vec3; 3] {
        let [da, db] = self.dn[node];
        [0, 1, 2].map(Vec3::axis).map(|axis| axis.cross(b) * da + a.cross(axis) * db)
    }
}

impl FieldFace {
    /// A side of the mesh.
    pub fn new(mesh: &Mesh, side: Side) -> Self {
        let (kind, nodes) = mesh.side(side);
        Self { side, kind, nodes: nodes.collect(), part: WHOLE }
    }

    /// Both halves of an edge of second degree; else itself.
    pub fn halves(self) -> impl Iterator<Item = Self> {
        let parts =
            if self.kind.degree > 1 && self.corners() == 2 { vec![[-1.0, 0.0], [0.0, 1.0]] } else { vec![WHOLE] };
        parts.into_iter().map(move |part| Self { part, ..self.clone() })
    }

    /// The node at a corner, that of the middle where a half ends there.
    pub fn corner_node(&self, corner: usize) -> usize {
        let middle = self.corners() == 2 && self.part[corner] == 0.0;
        self.nodes[if middle { 2 } else { corner }]
    }

    /// The corner of a half of an edge that is an end of the edge.
    pub fn end(&self) -> Option<usize> {
        (self.part != WHOLE).then(|| usize::from(self.part[0] == 0.0))
    }

    /// Number of its corners.
    pub fn corners(&self) -> usize {
        self.kind.linear.nodes.len()
    }

    /// Reference coordinates of a node.
    pub fn place(&self, node: usize) -> [f64; 2] {
        let [a, b, _] = self.kind.nodes[node];
        let [from, to] = self.part;
        if self.part == WHOLE { [a, b] } else { [(2.0 * a - from - to) / (to - from), b] }
    }

    /// Reference coordinates of a corner.
    pub fn corner_place(&self, corner: usize) -> [f64; 2] {
        let [a, b, _] = self.kind.nodes[corner];
        [a, b]
    }

    /// Reference coordinates of its middle.
    pub fn middle(&self) -> [f64; 2] {
        let [a, b, _] = self.kind.center();
        [a, b]
    }

    /// Its shape functions.
    pub fn shape(&self, xi: [f64; 2]) -> ShapeFunctions {
        if self.part == WHOLE {
            return ShapeFunctions::of(self.kind, xi);
        }
        let [from, to] = self.part;
        let half = 0.5 * (to - from);
        let mut shape = ShapeFunctions::of(self.kind, [0.5 * (from + to) + half * xi[0], xi[1]]);
        shape.dn.iter_mut().for_each(|dn| dn[0] *= half);
        shape
    }

    /// Those of a face in space carried on straight beyond its edges, where functions of second degree would turn back.
    pub fn extended_shape(&self, xi: [f64; 2]) -> ShapeFunctions {
        if self.kind.degree == 1 || self.corners() < 3 || self.holds(xi, 0.0) {
            return self.shape(xi);
        }
        let beyond = [0, 1].map(|i| xi[i] - self.nearest(xi)[i]);
        let along = |shape: &ShapeFunctions, k: usize| shape.dn[k][0] * beyond[0] + shape.dn[k][1] * beyond[1];
        // Slopes of functions of second degree have a degree of two at most, of which a central difference is exact.
        let near =
            |a: usize, step: f64| self.shape(self.nearest([0, 1].map(|i| if i == a { xi[i] + step } else { xi[i] })));
        let (mut shape, near) = (self.shape(self.nearest(xi)), [0, 1].map(|a| [near(a, STEP), near(a, -STEP)]));
        for k in 0..self.nodes.len() {
            shape.n[k] += along(&shape, k);
            (0..2).for_each(|a| shape.dn[k][a] += (along(&near[a][0], k) - along(&near[a][1], k)) / (2.0 * STEP));
        }
        shape
    }

    /// The place of the face that is nearest in reference coordinates.
    pub fn nearest(&self, [a, b]: [f64; 2]) -> [f64; 2] {
        let (least, beyond) = if self.corners() == 3 { (0.0, 0.5 * (a + b - 1.0).max(0.0)) } else { (-1.0, 0.0) };
        [a, b].map(|x| (x - beyond).clamp(least, 1.0))
    }

    /// The functions of first degree of its corners.
    pub fn corner_functions(&self, xi: [f64; 2]) -> ShapeFunctions {
        ShapeFunctions::of(self.kind.linear, xi)
    }

    /// Where its nodes are before any motion.
    pub fn at_rest(&self, mesh: &Mesh) -> PlacedFace {
        PlacedFace::new(self.nodes.iter().map(|&node| mesh.points[node]))
    }

    /// Where its nodes are at unknowns `u`.
    pub fn placed(&self, mesh: &Mesh, dofs: &Dofs, u: &[f64]) -> PlacedFace {
        PlacedFace::new(self.nodes.iter().map(|&node| moved(mesh.points[node], &u[dofs.displacements(node)])))
    }

    /// Whether reference coordinates lie on it, up to a part `beyond` past its edges.
    pub fn holds(&self, [a, b]: [f64; 2], beyond: f64) -> bool {
        match self.corners() {
            3 => a >= -beyond && b >= -beyond && a + b <= 1.0 + beyond,
            _ => a.abs() <= 1.0 + beyond && b.abs() <= 1.0 + beyond,
        }
    }
}

/// A point and its displacements.
pub fn moved(mut x: Vec3, u: &[f64]) -> Vec3 {
    x.0.iter_mut().zip(u).for_each(|(x, u)| *x += u);
    x
}

/// The nodes of a face in place.
#[derive(Debug, Clone, Copy)]
pub struct PlacedFace {
    x: [Vec3; MOST],
    count: usize,
}

impl PlacedFace {
    /// From positions.
    pub fn new(positions: impl Iterator<Item = Vec3>) -> Self {
        let mut placed = Self { x: [Vec3::zero(); MOST], count: 0 };
        for (x, here) in placed.x.iter_mut().zip(positions) {
            *x = here;
            placed.count += 1;
        }
        placed
    }
    /// The positions.
    pub fn nodes(&self) -> &[Vec3] {
        &self.x[..self.count]
    }
}
