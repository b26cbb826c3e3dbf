//! Faces of the surface that the target covers in part: the rule is laid on the covered part.
//!
//! The target ends along a border: edges of its faces behind which there is no other face, or one that no longer looks at
//! the surface. Seen along the normals of the face of the surface, that is by the feet `xi` of its vertices,
//! `(x(xi) - x_V).g_a(xi) = 0`, straight lines between them bound the covered part. Which vertices bound it is found by the
//! search and kept for one evaluation; where their feet lie, and so the places and weights of the points, is a function of
//! the nodes of both sides, differentiated by dual numbers.

use super::polygon::{Laid, Point, Polygon};
use super::surface::{Face, MAX_NODES, SurfacePoint};
use crate::system::Stencil;
use crate::tensor::{Dual, Scalar, Vec3};

/// Most vertices of a border over one face.
pub const VERTICES: usize = 4;
/// Directions of what a place depends on: the nodes of the face, then the vertices.
pub const RATES: usize = 3 * (MAX_NODES + VERTICES);

/// The border of the target over one face: nodes along it, the covered part on the left, in one chain or two.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Border {
    /// Numbers of its nodes and one; zero is none.
    pub nodes: [u32; VERTICES],
    /// Number of nodes of the first chain.
    pub first: u32,
    /// Whether it returns to its beginning.
    pub closed: bool,
}

impl Border {
    /// That of a stencil.
    pub fn of(stencil: &Stencil) -> Self {
        Self { nodes: stencil.border, first: stencil.also[0], closed: stencil.also[1] > 0 }
    }
    /// A stencil's words for it.
    pub fn choices(&self) -> ([u32; VERTICES], [u32; 2]) {
        (self.nodes, [self.first, u32::from(self.closed)])
    }
    /// Its nodes.
    pub fn list(&self) -> impl Iterator<Item = usize> {
        self.nodes.into_iter().filter(|&node| node > 0).map(|node| node as usize - 1)
    }
    /// Pairs of vertices, by their places in the list, that are joined by a line.
    pub fn lines(self) -> impl Iterator<Item = [usize; 2]> {
        let (count, first) = (self.list().count(), self.first as usize);
        let open = (1..count).filter(move |&k| k != first).map(|k| [k - 1, k]);
        open.chain((self.closed && count > 2).then(|| [count - 1, 0]))
    }
    /// The covered part for vertices whose feet are these.
    pub fn part<T: Scalar>(self, corners: usize, feet: &[Point<T>]) -> Polygon<T> {
        self.lines().fold(Polygon::whole(corners), |part, [a, b]| part.cut([feet[a], feet[b]]))
    }
}

impl Border {
    fn lay<T: Scalar>(self, face: &Face, feet: &[Point<T>]) -> Laid<T> {
        Laid::new(face.corners(), &self.part(face.corners(), feet))
    }
}

/// A face with its nodes in place.
#[derive(Clone, Copy)]
pub struct Placed<'a> {
    /// The face.
    pub face: &'a Face,
    /// Positions of its nodes.
    pub x: [Vec3; MAX_NODES],
}

impl Placed<'_> {
    fn sum<T: Scalar>(x: &[Vec3<T>; MAX_NODES], weights: &[f64; MAX_NODES]) -> Vec3<T> {
        x.iter().zip(weights).fold(Vec3::zero(), |sum, (&x, &weight)| sum + x * T::from(weight))
    }

    /// Position and the two tangents at `xi`.
    pub fn at(&self, xi: [f64; 2]) -> (Vec3, [Vec3; 2]) {
        let (n, dn) = self.face.natural(xi);
        (Self::sum(&self.x, &n), [0, 1].map(|a| Self::sum(&self.x, &dn.map(|dn| dn[a]))))
    }

    /// Second derivatives at `xi`: `d g_a / d xi_b` at `[a][b]`.
    pub fn bend(&self, xi: [f64; 2]) -> [[Vec3; 2]; 2] {
        let ddn = self.face.second(xi);
        [0, 1].map(|a| [0, 1].map(|b| Self::sum(&self.x, &ddn.map(|ddn| ddn[a][b]))))
    }

    /// The foot of the normal through a vertex.
    pub fn foot(&self, vertex: Vec3) -> Option<[f64; 2]> {
        let mut xi = self.face.middle();
        for _ in 0..25 {
            let step = self.step(xi, self.residual(xi, vertex), vertex);
            xi = [xi[0] - step[0], xi[1] - step[1]];
            if !xi.iter().all(|xi| xi.abs() < FAR) {
                return None;
            }
            if step[0].abs().max(step[1].abs()) < 1e-14 {
                break;
            }
        }
        Some(xi)
    }

    fn residual(&self, xi: [f64; 2], vertex: Vec3) -> [f64; 2] {
        let (x, tangents) = self.at(xi);
        tangents.map(|g| g.dot(x - vertex))
    }

    /// Newton's step for a residual of any numbers.
    fn step<T: Scalar>(&self, xi: [f64; 2], residual: [T; 2], vertex: Vec3) -> [T; 2] {
        let ((x, g), k) = (self.at(xi), self.bend(xi));
        let entry = |a: usize, b: usize| g[a].dot(g[b]) + k[a][b].dot(x - vertex);
        let [p, q, r] = [entry(0, 0), entry(0, 1), entry(1, 1)];
        let size = 1.0 / (p * r - q * q);
        [(residual[0] * r - residual[1] * q) * size, (residual[1] * p - residual[0] * q) * size]
    }

    /// The foot with its derivatives along the nodes of the face and the vertex, seeded from `first` on: one step of
    /// Newton's method from the solution.
    fn foot_rates(&self, vertex: Vec3, first: usize) -> Option<Point<Dual<RATES>>> {
        let xi = self.foot(vertex)?;
        let seeded = |v: Vec3, first: usize| Vec3(std::array::from_fn(|i| Dual::variable(v[i], first + i)));
        let mut x = [Vec3::zero(); MAX_NODES];
        x.iter_mut()
            .zip(&self.x)
            .take(self.face.nodes.len())
            .enumerate()
            .for_each(|(k, (x, at))| *x = seeded(*at, 3 * k));
        let (n, dn) = self.face.natural(xi);
        let to = Self::sum(&x, &n) - seeded(vertex, first);
        let residual = [0, 1].map(|a| Self::sum(&x, &dn.map(|dn| dn[a])).dot(to));
        let step = self.step(xi, residual, vertex);
        Some([0, 1].map(|a| -step[a] + Dual::from(xi[a])))
    }
}

/// Feet farther from the face than this, in `xi`, are none.
const FAR: f64 = 50.0;

/// Where a point of the rule stands, and the root of the part, with the rule laid within a border whose vertices are
/// these; None where there is no foot.
pub fn laid(placed: &Placed, border: Border, vertices: &[Vec3], point: &SurfacePoint) -> Option<([f64; 2], f64)> {
    let mut feet = [[0.0; 2]; VERTICES];
    for (foot, &vertex) in feet.iter_mut().zip(vertices) {
        *foot = placed.foot(vertex)?;
    }
    let laid = border.lay(placed.face, &feet[..vertices.len()]);
    Some((laid.place(point.rule), laid.scale()))
}

/// Derivatives of the two coordinates and of the root along the nodes of the face, and the vertices behind them.
pub fn rates(placed: &Placed, border: Border, vertices: &[Vec3], point: &SurfacePoint) -> Option<[[f64; RATES]; 3]> {
    let mut feet = [[Dual::default(); 2]; VERTICES];
    for (k, (foot, &vertex)) in feet.iter_mut().zip(vertices).enumerate() {
        *foot = placed.foot_rates(vertex, 3 * (MAX_NODES + k))?;
    }
    let laid = border.lay(placed.face, &feet[..vertices.len()]);
    let [xi, eta] = laid.place(point.rule);
    Some([xi.du, eta.du, laid.scale().du])
}
