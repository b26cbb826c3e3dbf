//! A face of a body's boundary: an edge in the plane, a face in space, with its nodes in place.

use crate::mesh::cells::{Cell, QUAD4, TRI3};
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

/// Corners of the pieces of faces with six, eight and nine nodes, by the numbers of these (Puso, Laursen & Solberg, CMAME 197, 2008;
/// Popp, Wohlmuth, Gee & Wall, SIAM J. Sci. Comput. 34, 2012).
const SIX: [&[usize]; 4] = [&[0, 3, 5], &[3, 1, 4], &[5, 4, 2], &[3, 4, 5]];
const EIGHT: [&[usize]; 5] = [&[0, 4, 7], &[4, 1, 5], &[5, 2, 6], &[7, 6, 3], &[4, 5, 6, 7]];
const NINE: [&[usize]; 4] = [&[0, 4, 8, 7], &[4, 1, 5, 8], &[8, 5, 2, 6], &[7, 8, 6, 3]];

/// What of a side a face is.
#[derive(Debug, Clone, Copy, PartialEq)]
enum SidePart {
    /// All of it.
    Whole,
    /// Half of an edge, in reference coordinates of that.
    Half([f64; 2]),
    /// What lies between these of its nodes.
    Piece(&'static [usize]),
}

/// A face of the boundary, or of one of second degree a part whose corners are nodes.
#[derive(Debug, Clone)]
pub struct FieldFace {
    /// Where it lies in the mesh.
    pub side: Side,
    /// Its reference cell.
    pub kind: &'static Cell,
    /// The nodes of that, its corners first.
    pub nodes: Vec<usize>,
    part: SidePart,
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
    /// All of one value.
    pub fn constant(value: f64) -> Self {
        Self { n: [value; MOST], dn: [[0.0; 2]; MOST] }
    }

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
        Self { side, kind, nodes: nodes.collect(), part: SidePart::Whole }
    }

    /// The parts between its nodes of an edge or face of second degree: a mean over all of that would not feel what its middle touches, and leave
    /// the nodes there free to come through what it lies on.
    pub fn pieces(self) -> impl Iterator<Item = Self> {
        let of = |pieces: &[&'static [usize]]| pieces.iter().map(|piece| SidePart::Piece(piece)).collect();
        let parts = match self.nodes.len() {
            3 if self.corners() == 2 => vec![SidePart::Half([-1.0, 0.0]), SidePart::Half([0.0, 1.0])],
            6 => of(&SIX),
            8 => of(&EIGHT),
            9 => of(&NINE),
            _ => vec![SidePart::Whole],
        };
        parts.into_iter().map(move |part| Self { part, ..self.clone() })
    }

    /// Whether it is one of the parts of a face in space.
    pub fn is_piece(&self) -> bool {
        matches!(self.part, SidePart::Piece(_))
    }

    /// The cell of first degree that it is.
    fn linear(&self) -> &'static Cell {
        match self.part {
            SidePart::Piece([_, _, _]) => &TRI3,
            SidePart::Piece(_) => &QUAD4,
            _ => self.kind.linear,
        }
    }

    /// The cell whose quadrature has its reference coordinates.
    pub fn cell(&self) -> &'static Cell {
        if let SidePart::Piece(_) = self.part { self.linear() } else { self.kind }
    }

    /// Number among the nodes of that at a corner.
    fn corner(&self, corner: usize) -> usize {
        match self.part {
            SidePart::Half(part) if part[corner] == 0.0 => 2,
            SidePart::Piece(corners) => corners[corner],
            _ => corner,
        }
    }

    /// The node at a corner.
    pub fn corner_node(&self, corner: usize) -> usize {
        self.nodes[self.corner(corner)]
    }

    /// The corner at which a node is, by its number.
    pub fn corner_at(&self, node: usize) -> Option<usize> {
        (0..self.corners()).find(|&corner| self.corner(corner) == node)
    }

    /// Where its corners are, with all nodes placed.
    pub fn corner_positions(&self, placed: &PlacedFace) -> PlacedFace {
        PlacedFace::new((0..self.corners()).map(|corner| placed.nodes()[self.corner(corner)]))
    }

    /// The corner of a half of an edge that is an end of the edge.
    pub fn end(&self) -> Option<usize> {
        if let SidePart::Half(part) = self.part { Some(usize::from(part[0] == 0.0)) } else { None }
    }

    /// Number of its corners.
    pub fn corners(&self) -> usize {
        self.linear().nodes.len()
    }

    /// Reference coordinates of the side at those of the face, and their derivatives along these: the map is affine.
    pub fn on_side(&self, xi: [f64; 2]) -> ([f64; 2], [[f64; 2]; 2]) {
        match self.part {
            SidePart::Whole => (xi, [[1.0, 0.0], [0.0, 1.0]]),
            SidePart::Half([from, to]) => {
                let half = 0.5 * (to - from);
                ([0.5 * (from + to) + half * xi[0], xi[1]], [[half, 0.0], [0.0, 1.0]])
            }
            SidePart::Piece(corners) => {
                let (functions, mut at, mut slopes) = (self.corner_functions(xi), [0.0; 2], [[0.0; 2]; 2]);
                for (&node, (n, dn)) in corners.iter().zip(functions.n.iter().zip(&functions.dn)) {
                    for i in 0..2 {
                        at[i] += n * self.kind.nodes[node][i];
                        (0..2).for_each(|a| slopes[i][a] += dn[a] * self.kind.nodes[node][i]);
                    }
                }
                (at, slopes)
            }
        }
    }

    /// Reference coordinates of a node.
    pub fn place(&self, node: usize) -> [f64; 2] {
        let ([x, y, _], middle) = (self.kind.nodes[node], self.middle());
        let (at, [[a, b], [c, d]]) = self.on_side(middle);
        let (x, y, det) = (x - at[0], y - at[1], a * d - b * c);
        [middle[0] + (d * x - b * y) / det, middle[1] + (a * y - c * x) / det]
    }

    /// Reference coordinates of a corner.
    pub fn corner_place(&self, corner: usize) -> [f64; 2] {
        let [a, b, _] = self.linear().nodes[corner];
        [a, b]
    }

    /// Reference coordinates of its middle.
    pub fn middle(&self) -> [f64; 2] {
        let [a, b, _] = self.linear().center();
        [a, b]
    }

    /// Its shape functions, those of the side.
    pub fn shape(&self, xi: [f64; 2]) -> ShapeFunctions {
        if self.part == SidePart::Whole {
            return ShapeFunctions::of(self.kind, xi);
        }
        let (at, slopes) = self.on_side(xi);
        let mut shape = ShapeFunctions::of(self.kind, at);
        shape.dn.iter_mut().for_each(|dn| *dn = [0, 1].map(|a| dn[0] * slopes[0][a] + dn[1] * slopes[1][a]));
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
        ShapeFunctions::of(self.linear(), xi)
    }

    /// Where its nodes are before any motion.
    pub fn at_rest(&self, mesh: &Mesh) -> PlacedFace {
        PlacedFace::new(self.nodes.iter().map(|&node| mesh.points[node]))
    }

    /// Where its nodes are at unknowns `u`.
    pub fn placed(&self, mesh: &Mesh, dofs: &Dofs, u: &[f64]) -> PlacedFace {
        PlacedFace::new(self.nodes.iter().map(|&node| moved(mesh.points[node], &u[dofs.displacements(node)])))
    }

    /// Its area in reference coordinates.
    pub fn area(&self) -> f64 {
        [2.0, 0.5, 4.0][self.corners() - 2]
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
