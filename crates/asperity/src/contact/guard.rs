//! The facets of a curved face: how far they stand off it, and what pressure that is worth.
//!
//! Two faces that are meshed differently disagree about where a curved interface lies by the larger sagitta of their
//! edges, `h^2 / (8 R)` for straight ones and `h^4 / (512 R^3)` for parabolas. A penalty `K` turns this `delta` into a
//! pressure `K delta`. With one pass it averages out; with two passes each side closes where it protrudes, and from
//! about half of the pressure that is carried they no longer agree.

use super::capture::positions;
use super::options::Loads;
use super::pair::Contact;
use super::record::{PointRecord, PointStatus};
use super::surface::Edge;
use crate::Error;
use crate::mesh::Mesh;
use crate::system::{Dofs, History};
use crate::tensor::Vec3;
use std::collections::BTreeMap;

/// What is done when facets bear too much of the pressure of a two-pass contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Guard {
    /// The run ends at the end of the step.
    Refuse,
    /// It is noted.
    Warn,
}

/// Part of the pressure from which facets are worth a note,
pub const NOTED: f64 = 0.1;
/// and from which two passes are refused.
pub const REFUSED: f64 = 0.5;

/// Edges that meet at a larger angle, in radians, form a corner and no facets of a curve.
pub(super) const CORNER: f64 = 0.7;
/// Nodes of the two sides that lie within this part of an edge of each other match.
pub(super) const MATCH: f64 = 1e-3;

/// Sagittas of a chain of edges at displacements `u`.
pub fn sagittas(mesh: &Mesh, dofs: &Dofs, edges: &[Edge], u: &[f64]) -> Vec<f64> {
    let ends: Vec<[Vec3; 2]> = edges.iter().map(|edge| ends(mesh, dofs, edge, u)).collect();
    let mut starting: BTreeMap<usize, usize> = BTreeMap::new();
    starting.extend(edges.iter().enumerate().map(|(i, edge)| (edge.nodes[0], i)));
    let mut turning = vec![0.0_f64; edges.len()];
    for (i, edge) in edges.iter().enumerate() {
        let Some(&next) = starting.get(&edge.nodes[1]) else { continue };
        let angle = angle(ends[i][1] - ends[i][0], ends[next][1] - ends[next][0]);
        if angle < CORNER {
            (turning[i], turning[next]) = (turning[i].max(angle), turning[next].max(angle));
        }
    }
    let sagitta = |(i, edge): (usize, &Edge)| {
        let chord = ends[i][1] - ends[i][0];
        let h = chord.norm();
        match edge.nodes.get(2) {
            None => h * turning[i] / 8.0,
            Some(_) => bow(mesh, dofs, edge, u).powi(3) / (h * h),
        }
    };
    edges.iter().enumerate().map(sagitta).collect()
}

/// The pressure that facets are worth over the pressure that is carried, `K delta A / F`, over closed points; `sagitta`
/// is that of an edge or face and of the segment it faces. Zero without pressure.
pub(super) fn facet_ratio(
    penalty: f64,
    points: impl IntoIterator<Item = PointRecord>,
    sagitta: impl Fn(usize, usize) -> f64,
) -> f64 {
    let (mut delta, mut force, mut area) = (0.0_f64, 0.0, 0.0);
    for point in points.into_iter().filter(|point| point.status != PointStatus::Open) {
        (force, area) = (force + point.pressure * point.area, area + point.area);
        delta = delta.max(point.segment.map_or(0.0, |hit| sagitta(point.edge, hit)));
    }
    if force > 0.0 { penalty * delta * area / force } else { 0.0 }
}

/// What must be said of a contact whose facets stand for a part of its pressure, and whether the state may not stand.
pub(super) fn said(title: &str, guard: Guard, ratio: f64) -> Option<(String, bool)> {
    let refused = ratio > REFUSED && guard == Guard::Refuse;
    (ratio > NOTED).then(|| {
        let text = format!(
            "contact '{title}': the facets of its curved faces stand for {ratio:.2} of its pressure, too much for two \
             passes above {REFUSED}; a finer mesh, edges of second degree, a softer penalty or passes = \"one\" \
             would help"
        );
        (text, refused)
    })
}

/// Ends a step on what was said, if the state may not stand.
///
/// # Errors
/// [`Error::NotConverged`] then.
pub(super) fn verdict(said: Option<(String, bool)>) -> Result<(), Error> {
    match said {
        Some((text, true)) => Err(Error::NotConverged(format!("{text}, or guard = \"warn\""))),
        _ => Ok(()),
    }
}

fn ends(mesh: &Mesh, dofs: &Dofs, edge: &Edge, u: &[f64]) -> [Vec3; 2] {
    let mut x = positions(mesh, dofs, &edge.nodes[..2], u);
    std::array::from_fn(|_| x.next().unwrap_or(Vec3::zero()))
}

/// Distance of the middle node from the chord.
fn bow(mesh: &Mesh, dofs: &Dofs, edge: &Edge, u: &[f64]) -> f64 {
    let x: Vec<Vec3> = positions(mesh, dofs, &edge.nodes, u).collect();
    let chord = (x[1] - x[0]).unit();
    (x[2] - x[0]).cross(chord).norm()
}

/// Between two vectors, in radians.
pub(super) fn angle(a: Vec3, b: Vec3) -> f64 {
    a.cross(b).norm().atan2(a.dot(b))
}

impl Contact {
    /// The pressure that facets are worth over the pressure that is carried, `K delta A / F`, over the closed points of
    /// an accepted state; zero without pressure, and where the nodes of the two sides match. A tool has no facets.
    pub fn facet_ratio(&self, u: &[f64], history: &History) -> f64 {
        let Some(faces) = self.target.as_faces() else { return 0.0 };
        let (mesh, dofs) = (&self.mesh, &self.dofs);
        let (own, other) = (sagittas(mesh, dofs, &self.surface.edges, u), sagittas(mesh, dofs, faces.edges(), u));
        facet_ratio(self.options.penalty, self.records(u, history), |edge, hit| {
            if self.matches(edge, &faces.edges()[hit], u) { 0.0 } else { own[edge].max(other[hit]) }
        })
    }

    /// How far the edges that are closed in an accepted state stand off the curve they stand for, over their lengths.
    pub fn facet_mismatch(&self, u: &[f64], history: &History) -> f64 {
        let (edges, mut largest) = (&self.surface.edges, 0.0_f64);
        let sagittas = sagittas(&self.mesh, &self.dofs, edges, u);
        for point in self.records(u, history).filter(|point| point.status != PointStatus::Open) {
            largest = largest.max(sagittas[point.edge] / edges[point.edge].chord(&self.mesh));
        }
        largest
    }

    /// Whether the nodes of an edge and of the edge it faces coincide.
    fn matches(&self, edge: usize, other: &Edge, u: &[f64]) -> bool {
        let [a, b] = ends(&self.mesh, &self.dofs, &self.surface.edges[edge], u);
        let [c, d] = ends(&self.mesh, &self.dofs, other, u);
        (a - d).norm().max((b - c).norm()) <= MATCH * (b - a).norm()
    }

    /// What must be said of the facets in an accepted state, and whether the state may not stand.
    pub fn facets(&self, u: &[f64], history: &History) -> Option<(String, bool)> {
        let ratio = if self.options.loads == Loads::Own { self.facet_ratio(u, history) } else { 0.0 };
        said(self.title(), self.options.guard, ratio)
    }
}
