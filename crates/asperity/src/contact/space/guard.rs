//! The facets of curved faces in space: how far they stand off the surface, and what pressure that is worth. The sagitta
//! of a face of first degree follows from the angle at which it meets its neighbours, that of one of second degree from
//! the bow of its edges, as in the plane.

use super::pair::Contact;
use super::surface::Face;
use crate::contact::capture::positions;
use crate::contact::guard::{CORNER, MATCH, facet_ratio, said};
use crate::contact::record::PointStatus;
use crate::system::History;
use crate::tensor::Vec3;
use std::collections::BTreeMap;

/// A face with its nodes in place.
struct Placed<'a> {
    face: &'a Face,
    x: Vec<Vec3>,
}

impl Placed<'_> {
    fn corners(&self) -> usize {
        self.face.corners()
    }
    /// Ends of its edges, as positions among its nodes.
    fn edges(&self) -> impl Iterator<Item = [usize; 2]> {
        let n = self.corners();
        (0..n).map(move |k| [k, (k + 1) % n])
    }
    /// The sum of its normals at the corners, whose length is about twice or four times its area.
    fn normal(&self) -> Vec3 {
        let n = self.corners();
        let at = |k: usize| (self.x[(k + 1) % n] - self.x[k]).cross(self.x[(k + 2) % n] - self.x[(k + 1) % n]);
        (0..n).fold(Vec3::zero(), |sum, k| sum + at(k))
    }
    /// Its mean edge.
    fn length(&self) -> f64 {
        self.edges().map(|[a, b]| (self.x[b] - self.x[a]).norm()).sum::<f64>() / self.corners() as f64
    }
    /// Largest sagitta of its edges of second degree over those of the faces they stand for.
    fn bow(&self) -> f64 {
        let bow = |(k, [a, b]): (usize, [usize; 2])| {
            let chord = self.x[b] - self.x[a];
            let h = chord.norm();
            ((self.x[self.corners() + k] - self.x[a]).cross(chord).norm() / h).powi(3) / (h * h)
        };
        self.edges().enumerate().map(bow).fold(0.0, f64::max)
    }
}

/// The largest angle at which each face meets a neighbour smoothly.
fn turning(faces: &[Placed]) -> Vec<f64> {
    let mut beside: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
    for (i, placed) in faces.iter().enumerate() {
        for ends in placed.edges() {
            let [a, b] = ends.map(|k| placed.face.nodes[k]);
            beside.entry([a.min(b), a.max(b)]).or_default().push(i);
        }
    }
    let mut turning = vec![0.0_f64; faces.len()];
    for pair in beside.values() {
        let [i, j] = pair[..] else { continue };
        let (n, m) = (faces[i].normal(), faces[j].normal());
        let angle = n.cross(m).norm().atan2(n.dot(m));
        if angle < CORNER {
            (turning[i], turning[j]) = (turning[i].max(angle), turning[j].max(angle));
        }
    }
    turning
}

fn sagittas(faces: &[Placed]) -> Vec<f64> {
    let one = |(placed, turning): (&Placed, f64)| match placed.face.kind.degree {
        1 => placed.length() * turning / 8.0,
        _ => placed.bow(),
    };
    faces.iter().zip(turning(faces)).map(one).collect()
}

impl Contact {
    fn place<'a>(&self, faces: &'a [Face], u: &[f64]) -> Vec<Placed<'a>> {
        let x = |face: &Face| positions(&self.parts.mesh, &self.parts.dofs, &face.nodes, u).collect();
        faces.iter().map(|face| Placed { face, x: x(face) }).collect()
    }

    /// The pressure that facets are worth over the pressure that is carried over the closed points of an accepted state;
    /// zero without pressure, and where the nodes of the two sides match. A tool has no facets.
    pub fn facet_ratio(&self, u: &[f64], history: &History) -> f64 {
        let Some(faces) = self.parts.target.as_faces() else { return 0.0 };
        let (here, there) = (self.place(&self.parts.surface.faces, u), self.place(faces.list(), u));
        let (own, other) = (sagittas(&here), sagittas(&there));
        facet_ratio(self.parts.options.penalty, self.records(u, history), |face, hit| {
            if matches(&here[face], &there[hit]) { 0.0 } else { own[face].max(other[hit]) }
        })
    }

    /// How far the faces that are closed in an accepted state stand off the surface they stand for, over their sizes.
    pub fn facet_mismatch(&self, u: &[f64], history: &History) -> f64 {
        let (faces, mut largest) = (&self.parts.surface.faces, 0.0_f64);
        let sagittas = sagittas(&self.place(faces, u));
        for point in self.records(u, history).iter().filter(|point| point.status != PointStatus::Open) {
            largest = largest.max(sagittas[point.edge] / self.parts.length(&faces[point.edge]));
        }
        largest
    }

    /// What must be said of the facets in an accepted state, and whether the state may not stand.
    pub fn facets(&self, u: &[f64], history: &History) -> Option<(String, bool)> {
        let ratio = if self.loads_itself() { self.facet_ratio(u, history) } else { 0.0 };
        said(&self.parts.name, self.parts.options.guard, ratio)
    }
}

/// Whether the corners of a face and of the face it faces coincide.
fn matches(one: &Placed, other: &Placed) -> bool {
    let near = |a: &Vec3| other.x[..other.corners()].iter().any(|&b| (*a - b).norm() <= MATCH * one.length());
    one.corners() == other.corners() && one.x[..one.corners()].iter().all(near)
}
