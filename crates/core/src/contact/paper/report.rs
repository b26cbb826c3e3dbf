//! What outputs ask of a contact of Gauss points: its points, the penetration between them, what its facets are worth; and what
//! takes nodes out of the target before the first increment.

use super::attempt::touched;
use super::contact::PaperContact;
use super::point::Triad;
use crate::contact::record::{ContactRecord, PointStatus, entry};
use crate::contact::{Borne, Move};
use crate::system::History;
use crate::tensor::Vec3;
use crate::tool::{ProfileRay, Rejected};
use std::collections::BTreeMap;

/// Penetration at a place of the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// How deep the target is met, less the overlap that is still let stand; a length.
    pub penetration: f64,
    /// The face.
    pub edge: usize,
    /// Where it stands.
    pub position: Vec3,
}

/// Where a face with so many corners is sampled: in its middle and from just within its corners.
fn places(corners: usize) -> &'static [[f64; 2]] {
    match corners {
        2 => &[[-0.99, 0.0], [-0.5, 0.0], [0.0, 0.0], [0.5, 0.0], [0.99, 0.0]],
        3 => &[[1.0 / 3.0, 1.0 / 3.0], [0.01, 0.01], [0.98, 0.01], [0.01, 0.98]],
        _ => &[[0.0, 0.0], [-0.98, -0.98], [0.98, -0.98], [0.98, 0.98], [-0.98, 0.98]],
    }
}

/// Nodes of the two sides that lie within this part of an edge of each other match.
const MATCH: f64 = 1e-3;

fn is_closed(values: &[f64]) -> bool {
    PointStatus::from_value(values[entry::STATUS]) != PointStatus::Open
}

impl PaperContact {
    /// All points in an accepted state, with this term's lane of its history.
    pub fn records(&self, u: &[f64], history: &History) -> Vec<ContactRecord> {
        (0..self.points.len()).map(|index| self.record(index, u, history.slot(index))).collect()
    }

    /// What its closed points bear.
    pub fn borne(&self, u: &[f64], history: &History) -> Vec<Borne> {
        let still = vec![0.0; u.len()];
        let bears = |index: usize| {
            let (values, area) = (history.slot(index), self.area(index, &still));
            let seen = self.parts.target.as_faces().filter(|_| !self.loads_itself()).zip(touched(values));
            let seen = seen.map(|(faces, (face, _))| &faces.surface.faces[face]);
            let faces = [Some(self.face(index)), seen].into_iter().flatten();
            (values[entry::PRESSURE], faces.map(|face| (face.side, face.nodes[0], area)).collect())
        };
        (0..self.points.len()).filter(|&index| is_closed(history.slot(index))).map(bears).collect()
    }

    fn record(&self, index: usize, u: &[f64], values: &[f64]) -> ContactRecord {
        let (position, Triad { inward, along, .. }) = self.triad(index, u);
        let plane = self.surface().plane;
        let record = ContactRecord::of(values, plane);
        let [s, t] = [entry::SHEAR, entry::SHEAR2].map(|shear| values[shear]);
        let sheared = !plane && record.shear > 0.0;
        ContactRecord {
            position,
            inward,
            thrust: inward,
            facing: self.facing(values, u, &ProfileRay { origin: position, direction: inward }),
            along: if sheared { (along[0] * s + along[1] * t) * record.shear.recip() } else { along[0] },
            area: self.area(index, u),
            segment: touched(values).map(|(segment, _)| segment),
            edge: self.points[index].face,
            ..record
        }
    }

    /// Outward normal of the target where the ray of a closed point meets it; the direction of the ray elsewhere.
    fn facing(&self, values: &[f64], u: &[f64], ray: &ProfileRay) -> Vec3 {
        let touched = touched(values).filter(|_| is_closed(values));
        let hit = touched.and_then(|(segment, s)| {
            let own: Vec<f64> =
                self.parts.target.unknowns(segment, &self.parts.dofs).into_iter().map(|dof| u[dof]).collect();
            self.parts.target.segment(segment, self.site(), &own).meet(ray, s)
        });
        hit.map_or(ray.direction, |hit| hit.normal)
    }

    /// The deepest place of the surface in an accepted state, sought along rays between its points; none without penetration.
    /// Against a tool all faces are sampled, against bodies those with a closed point, since rays from the corners of a body meet
    /// much that is no contact.
    pub fn sampled(&self, u: &[f64], history: &History) -> Option<Sample> {
        let (depths, target, surface) = (self.depths(u), self.target_at(u), self.surface());
        let sample = |face: usize, xi: [f64; 2]| {
            let index = self.points_of(face).next()?;
            let (shape, placed) =
                (surface.faces[face].shape(xi), surface.faces[face].placed(&self.parts.mesh, &self.parts.dofs, u));
            let direction = Triad::new(shape.tangents(placed.nodes(), surface.plane), surface.plane).inward;
            let ray = ProfileRay { origin: shape.value(placed.nodes()), direction };
            let hit = target.see(&self.cast(index, ray, (depths[index], f64::INFINITY)), &mut Rejected::default())?;
            let penetration = hit.u - (-history.slot(index)[entry::CLOSURE]).max(0.0);
            (penetration > 0.0).then_some(Sample { penetration, edge: face, position: ray.origin })
        };
        let touches = |&face: &usize| {
            let mut points = self.points_of(face);
            !self.parts.target.deforms() || points.any(|point| is_closed(history.slot(point)))
        };
        let faces = (0..surface.faces.len()).filter(touches);
        let found = faces.flat_map(|face| places(surface.faces[face].corners()).iter().map(move |&xi| (face, xi)));
        found.filter_map(|(face, xi)| sample(face, xi)).reduce(|a, b| if b.penetration > a.penetration { b } else { a })
    }

    /// The pressure that facets are worth over the pressure that is carried, over the closed points of an accepted state: two faces of
    /// first degree that are meshed differently disagree by their sagitta `delta` about where a curved interface lies, which a penalty `K` turns into
    /// `K delta A / F`. Zero without pressure, and where the nodes of the two sides match. A tool has no facets.
    pub fn facet_ratio(&self, u: &[f64], history: &History) -> Option<f64> {
        let (faces, mesh, surface) = (self.parts.target.as_faces()?, &self.parts.mesh, self.surface());
        let sagitta = |side: &crate::contact::field::FieldSurface, face: usize| {
            let nodes = side.field[face].iter().filter(|node| **node < side.nodes.len());
            nodes.map(|&node| side.sagitta(node, mesh)).fold(0.0, f64::max)
        };
        let (mut delta, mut force, mut area) = (0.0_f64, 0.0, 0.0);
        for point in self.records(u, history).into_iter().filter(|point| point.status != PointStatus::Open) {
            (force, area) = (force + point.pressure * point.area, area + point.area);
            if let Some(hit) = point.segment.filter(|&hit| !self.matches(point.edge, hit, u)) {
                delta = delta.max(sagitta(surface, point.edge)).max(sagitta(&faces.surface, hit));
            }
        }
        Some(if force > 0.0 { self.parts.options.penalty * delta * area / force } else { 0.0 })
    }

    /// Whether the corners of a face and of the segment it faces coincide.
    fn matches(&self, face: usize, segment: usize, u: &[f64]) -> bool {
        let Some(target) = self.parts.target.as_faces() else { return false };
        let corners = |face: &crate::contact::field::face::FieldFace| {
            face.placed(&self.parts.mesh, &self.parts.dofs, u).nodes()[..face.corners()].to_vec()
        };
        let (own, other) = (corners(&self.surface().faces[face]), corners(&target.surface.faces[segment]));
        let near = MATCH * (own[1] - own[0]).norm();
        own.iter().all(|x| other.iter().any(|y| (*x - *y).norm() <= near))
    }

    /// What takes the nodes of the undeformed surface out of the target: a node is moved along the mean normal of the points
    /// around it to where that ray leaves the target. Between the nodes a curved target may still be penetrated by what the faces do
    /// not follow.
    pub fn moves(&self) -> Vec<Move> {
        let still = vec![0.0; self.parts.dofs.count()];
        let mut normals: BTreeMap<usize, (Vec3, usize)> = BTreeMap::new();
        for index in 0..self.points.len() {
            let inward = self.triad(index, &still).1.inward;
            for &node in &self.face(index).nodes {
                normals.entry(node).or_insert((Vec3::zero(), index)).0 += inward;
            }
        }
        let rays = normals.iter().map(|(&node, &(sum, index))| (self.parts.mesh.points[node], sum.unit(), index));
        let moved = normals.iter().zip(self.penetrations(rays)).filter_map(|((&node, &(sum, index)), u)| {
            let (u, cell) = (u?, self.face(index).side.cell);
            (u > self.least).then(|| Move { node, by: sum.unit() * u, cell })
        });
        moved.collect()
    }
}
