//! Edges of the surface that the target covers in part: Gauss' rule is laid on the covered part.
//!
//! The target ends at a vertex V, or turns a corner there beyond which its faces no longer look at the surface. The
//! covered part of an edge begins or ends at the place whose normal passes through V, `(x(xi) - x_V).x'(xi) = 0`, and
//! moves with the nodes of both sides. A pressure that fills the covered part to its end then loads the nodes exactly,
//! and the contact patch test holds. The vertex is found by the search and kept for one evaluation; where its foot lies,
//! and how that moves, is part of the stencil's function.

use super::faces::Standing;
use super::known::Known;
use super::placed::{Frame, Placed};
use super::point::triad;
use super::target::{Cast, Memory};
use crate::tensor::Vec3;
use crate::tool::{Ray, Rules};

/// A vertex of the target, as a stencil keeps it: twice the segment and its end, and one more; zero is none.
pub type Vertex = u32;

/// Feet of vertices nearer to an end of the edge than this, in `xi`, cut nothing off.
const END: f64 = 1e-9;

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
        let (a, b) = (self.placed.x[0], self.placed.x[1]);
        // Each vertex ends two edges.
        let (mut near, mut feet) = (Vec::new(), Known::default());
        self.standing.vertices_near([a, b], (b - a).norm(), &mut near);
        for vertex in near {
            let Some((side, xi)) = self.border(vertex, &mut feet) else { continue };
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
    fn border(&self, vertex: Vertex, feet: &mut Known<f64>) -> Option<(usize, f64)> {
        let (position, (outward, away), beyond) = self.standing.faces_at(vertex);
        let foot = feet.of(self.standing.node_of(vertex), || self.placed.foot_place(position));
        if !(END - 1.0..=1.0 - END).contains(&foot) {
            return None;
        }
        let Frame { x, tangent, .. } = self.placed.frame(foot);
        let (along, inward, _) = triad(tangent);
        let gap = inward.dot(position - x);
        let looks = |outward: Vec3| inward.dot(outward) > Rules::LEAST_COSINE;
        let within = gap >= -self.cast.reach && gap <= self.cast.depth;
        let last = looks(outward) && !beyond.is_some_and(|(outward, _)| looks(outward));
        (within && last).then(|| (usize::from(along.dot(away) < 0.0), foot))
    }

    fn sees(&self, xi: f64, memory: &mut Memory) -> bool {
        let Frame { x: origin, tangent, .. } = self.placed.frame(xi);
        let (_, direction, _) = triad(tangent);
        self.standing.select(&Cast { ray: Ray { origin, direction }, ..self.cast }, memory).is_some()
    }
}
