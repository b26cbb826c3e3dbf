//! Penetration between the contact points: what no point sees, as an edge of the target that stands between two of them.

use super::pair::Contact;
use super::point::triad;
use super::record::{PointStatus, entry};
use super::target::{Cast, Memory};
use crate::system::History;
use crate::tensor::Vec3;
use crate::tool::Ray;
use std::ops::Range;

/// Penetration at a place of the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// How deep the target is met, less the overlap that is still let stand; a length.
    pub penetration: f64,
    /// The edge or face.
    pub edge: usize,
    /// Where it stands.
    pub position: Vec3,
}

impl Sample {
    /// The deeper of two.
    pub(in crate::contact) fn deeper(self, other: Self) -> Self {
        if other.penetration > self.penetration { other } else { self }
    }
}

/// Where an edge is sampled: from just within its ends.
const PLACES: [f64; 5] = [-0.99, -0.5, 0.0, 0.5, 0.99];

/// Whether a face with these points is sampled: against a tool always, against bodies where one of its points is closed,
/// since rays from the corners of a body meet much that is no contact.
pub(in crate::contact) fn is_sampled(deforms: bool, history: &History, mut points: Range<usize>) -> bool {
    !deforms || points.any(|point| PointStatus::from_value(history.slot(point)[entry::STATUS]) != PointStatus::Open)
}

/// Overlap that is let stand at a point, from its history.
pub(in crate::contact) fn admitted(values: &[f64]) -> f64 {
    (-values[entry::CLOSURE]).max(0.0)
}

impl Contact {
    /// The deepest place of the surface in an accepted state, sought along rays between its points; none without penetration.
    pub fn sampled(&self, u: &[f64], history: &History) -> Option<Sample> {
        let depths = self.depths(u);
        let (standing, mut memory) = (self.target.stand(u), Memory::default());
        let mut sample = |edge: usize, xi: f64| {
            let index = self.surface.points_of(edge).next()?;
            let (position, tangent) = self.placed(edge, u).stand(&self.surface.moved(index, [xi, 1.0]));
            let ray = Ray { origin: position, direction: triad(tangent).1 };
            let hit = standing.cast(&Cast { ray, ..self.bounds(index, depths[index], f64::INFINITY) }, &mut memory)?;
            let penetration = hit.u - admitted(history.slot(index));
            (penetration > 0.0).then_some(Sample { penetration, edge, position })
        };
        let sampled = |edge: &usize| is_sampled(self.target.deforms(), history, self.surface.points_of(*edge));
        let places = (0..self.surface.edges.len()).filter(sampled).flat_map(|edge| PLACES.map(|xi| (edge, xi)));
        places.filter_map(|(edge, xi)| sample(edge, xi)).reduce(Sample::deeper)
    }
}
