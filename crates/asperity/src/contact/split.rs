//! Edges of the surface that the target covers in part: Gauss' rule is laid on the covered part.
//!
//! The target ends at a vertex V, or turns a corner there beyond which its faces no longer look at the surface. The
//! covered part of an edge begins or ends at the place whose normal passes through V, `(x(xi) - x_V).x'(xi) = 0`, and
//! moves with the nodes of both sides. A pressure that fills the covered part to its end then loads the nodes exactly,
//! and the contact patch test holds. The vertex is found by the search and kept for one evaluation; where its foot lies,
//! and how that moves, is part of the stencil's function.

use super::faces::Standing;
use super::point::triad;
use super::surface::{Edge, MAX_EDGE_NODES};
use super::target::{Cast, MAX_UNKNOWNS, Memory};
use crate::tensor::Vec3;
use crate::tool::{Ray, Rules};

/// A vertex of the target, as a stencil keeps it: twice the segment and its end, and one more; zero is none.
pub type Vertex = u32;

/// Feet of vertices nearer to an end of the edge than this, in `xi`, cut nothing off.
const END: f64 = 1e-9;

/// One end of the covered part, and how it moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct End {
    /// Its place on the edge, from -1 to 1.
    pub xi: f64,
    /// Derivatives along the unknowns of the edge's own nodes.
    pub own: [f64; MAX_UNKNOWNS],
    /// Derivatives along the position of the vertex.
    pub vertex: [f64; 2],
}

/// An edge with its nodes in place.
#[derive(Clone, Copy)]
pub struct Placed<'a> {
    /// The edge.
    pub edge: &'a Edge,
    /// Positions of its nodes.
    pub x: [Vec3; MAX_EDGE_NODES],
}

impl Placed<'_> {
    /// Position, tangent and second derivative at `xi`.
    pub fn at(&self, xi: f64) -> [Vec3; 3] {
        let ((n, dn), ddn) = (self.edge.shape_at(xi), self.edge.curvature());
        let sum = |weights: [f64; MAX_EDGE_NODES]| {
            self.x.iter().zip(weights).fold(Vec3::zero(), |sum, (&x, weight)| sum + x * weight)
        };
        [sum(n), sum(dn), sum(ddn)]
    }

    /// The foot of the normal through `vertex`.
    pub fn foot(&self, vertex: Vec3) -> End {
        let mut xi = 0.0;
        // A straight edge needs one step; a parabola that bends little, a few.
        for _ in 0..20 {
            let [x, t, k] = self.at(xi);
            let to = x - vertex;
            let step = to.dot(t) / (t.dot(t) + to.dot(k));
            xi -= step;
            if step.abs() < 1e-15 || !step.is_finite() {
                break;
            }
        }
        let ([x, t, k], (n, dn)) = (self.at(xi), self.edge.shape_at(xi));
        let to = x - vertex;
        let slope = -1.0 / (t.dot(t) + to.dot(k));
        let mut own = [0.0; MAX_UNKNOWNS];
        for (j, rate) in own[..2 * self.edge.nodes.len()].iter_mut().enumerate() {
            *rate = slope * (n[j / 2] * t[j % 2] + dn[j / 2] * to[j % 2]);
        }
        End { xi, own, vertex: [-slope * t[0], -slope * t[1]] }
    }
}

/// A search on behalf of one edge.
pub struct Seeker<'a> {
    /// Its target in place.
    pub standing: &'a Standing<'a>,
    /// The edge.
    pub placed: Placed<'a>,
    /// Any ray of the edge: its bounds and relatives hold for all.
    pub cast: Cast<'a>,
}

impl Seeker<'_> {
    /// The vertices at which the covered part of the edge begins and ends.
    pub fn vertices(&self, memory: &mut Memory) -> [Vertex; 2] {
        let (mut found, mut limits) = ([0; 2], [-1.0, 1.0]);
        let (a, b) = (self.placed.at(-1.0)[0], self.placed.at(1.0)[0]);
        let mut near = Vec::new();
        self.standing.vertices_near([a, b], (b - a).norm(), &mut near);
        for vertex in near {
            let Some((side, xi)) = self.border(vertex) else { continue };
            // The innermost of several on one side; beyond it there must be nothing to be seen.
            let (inner, outside) = match side {
                0 => (xi > limits[0], 0.5 * (xi - 1.0)),
                _ => (xi < limits[1], 0.5 * (xi + 1.0)),
            };
            if inner && !self.sees(outside, memory) {
                (found[side], limits[side]) = (vertex, xi);
            }
        }
        if limits[0] < limits[1] { found } else { [0; 2] }
    }

    /// Whether the target as the edge sees it begins (0) or ends (1) at a vertex, and where on the edge.
    fn border(&self, vertex: Vertex) -> Option<(usize, f64)> {
        let (position, (outward, away), beyond) = self.standing.faces_at(vertex);
        let foot = self.placed.foot(position);
        if !(END - 1.0..=1.0 - END).contains(&foot.xi) {
            return None;
        }
        let [x, tangent, _] = self.placed.at(foot.xi);
        let (along, inward, _) = triad(tangent);
        let gap = inward.dot(position - x);
        let looks = |outward: Vec3| inward.dot(outward) > Rules::LEAST_COSINE;
        let within = gap >= -self.cast.reach && gap <= self.cast.depth;
        let last = looks(outward) && !beyond.is_some_and(|(outward, _)| looks(outward));
        (within && last).then(|| (usize::from(along.dot(away) < 0.0), foot.xi))
    }

    fn sees(&self, xi: f64, memory: &mut Memory) -> bool {
        let [origin, tangent, _] = self.placed.at(xi);
        let (_, direction, _) = triad(tangent);
        self.standing.select(&Cast { ray: Ray { origin, direction }, ..self.cast }, memory).is_some()
    }
}
