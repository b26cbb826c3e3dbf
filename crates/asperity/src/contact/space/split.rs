//! Faces of the surface that the target covers in part: the rule is laid on the covered part.
//!
//! The target ends along a border: edges of its faces behind which there is no other face, or one that no longer looks at
//! the surface. Seen along the normals of the face of the surface, that is by the feet `xi` of its vertices,
//! `(x(xi) - x_V).g_a(xi) = 0` for its own normals, straight lines between them bound the covered part. Which vertices bound it is found by the
//! search and kept for one evaluation; where their feet lie, and so the places and weights of the points, is a function of
//! the nodes of both sides.

use super::placed::Placed;
use super::polygon::{Laid, Point, Polygon};
use super::surface::{Face, SurfacePoint};
use crate::system::Stencil;
use crate::tensor::{Dual, Scalar, Vec3};

/// Most vertices of a border over one face.
pub const VERTICES: usize = 4;
/// Directions of what a place depends on: the coordinates of the feet.
const FEET: usize = 2 * VERTICES;

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

/// Derivatives of the two coordinates and of the root along the unknowns of the nodes of the face, of those around that
/// turn its normals, and of the vertices.
pub fn rates(placed: &Placed, border: Border, vertices: &[Vec3], point: &SurfacePoint) -> Option<Vec<[f64; 3]>> {
    let (mut feet, mut moving) = ([[Dual::<FEET>::default(); 2]; VERTICES], Vec::new());
    for (k, (foot, &vertex)) in feet.iter_mut().zip(vertices).enumerate() {
        let xi = placed.foot(vertex)?;
        *foot = [0, 1].map(|i| Dual::variable(xi[i], 2 * k + i));
        moving.push(placed.foot_rates(xi, vertex));
    }
    let laid = border.lay(placed.face, &feet[..vertices.len()]);
    let [xi, eta] = laid.place(point.rule);
    let rows = [xi, eta, laid.scale()];
    let own = moving.first().map_or(0, |foot| foot.own.len());
    let mut rates = vec![[0.0; 3]; own + 3 * vertices.len()];
    for (k, foot) in moving.iter().enumerate() {
        let vertex = foot.vertex.iter().enumerate().map(|(i, change)| (own + 3 * k + i, change));
        for (unknown, [p, q]) in foot.own.iter().enumerate().chain(vertex) {
            rates[unknown].iter_mut().zip(&rows).for_each(|(rate, y)| *rate += y.du[2 * k] * p + y.du[2 * k + 1] * q);
        }
    }
    Some(rates)
}
