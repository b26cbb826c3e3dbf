//! A surface with Gauss points and its target.

use super::neighbours::Neighbours;
use super::point::Triad;
use super::surface::{GaussPoint, gauss_points, points_of};
use crate::contact::field::FieldSurface;
use crate::contact::field::face::FieldFace;
use crate::contact::record::largest_penetration;
use crate::contact::{ContactParts, ContactSides, LoadedSides};
use crate::system::History;
use crate::tensor::Vec3;
use std::collections::BTreeMap;
use std::ops::{Deref, Range};

/// Contact whose stress lives at Gauss points.
pub struct PaperContact {
    sides: ContactSides,
    /// The points, face by face.
    pub(super) points: Vec<GaussPoint>,
    /// For each face the segments of the target that share a node with it.
    pub(super) relatives: Vec<Vec<usize>>,
    /// The points around each point, where the law is not local.
    pub(super) neighbours: Neighbours,
}

impl Deref for PaperContact {
    type Target = ContactSides;

    fn deref(&self) -> &ContactSides {
        &self.sides
    }
}

impl PaperContact {
    /// A contact of these parts with `gauss` points along an edge or each side of a face, or as many as `gauss_points` finds good.
    pub fn new(parts: ContactParts, gauss: Option<usize>) -> Self {
        let (sides, neighbours) = (ContactSides::new(parts), Neighbours::default());
        let points = gauss_points(sides.mesh(), sides.surface(), gauss);
        let relatives = relatives(sides.surface(), sides.target().as_faces().map(|faces| &faces.surface));
        let mut contact = Self { sides, points, relatives, neighbours };
        let radius = contact.law().radius();
        if radius > 0.0 {
            let still = vec![0.0; contact.parts.dofs.count()];
            let places: Vec<Vec3> = (0..contact.points.len()).map(|i| contact.triad(i, &still).0).collect();
            let face = |i: usize| contact.points[i].face;
            contact.neighbours = Neighbours::new(&places, face, radius, |i| contact.area(i, &still));
        }
        contact
    }

    /// The points.
    pub fn points(&self) -> &[GaussPoint] {
        &self.points
    }
    /// Numbers of the points of a face, which follow each other.
    pub fn points_of(&self, face: usize) -> Range<usize> {
        points_of(&self.points, face)
    }
    /// The face of a point.
    pub fn face(&self, point: usize) -> &FieldFace {
        &self.parts.surface.faces[self.points[point].face]
    }
    /// Whether its points load their own side alone: one of two passes.
    pub fn loads_itself(&self) -> bool {
        self.parts.options.loads == LoadedSides::Own
    }
    /// The largest penetration at a closed point, from the history of a state; a length.
    pub fn largest_penetration(&self, history: &History) -> f64 {
        largest_penetration(history, self.points.len())
    }

    /// Size of the face of a point, a length.
    pub fn face_size(&self, point: usize) -> f64 {
        self.surface().size(self.points[point].face, self.mesh())
    }

    /// Position and triad of a point at unknowns `u`.
    pub(super) fn triad(&self, index: usize, u: &[f64]) -> (Vec3, Triad<f64>) {
        let (point, face) = (&self.points[index], self.face(index));
        let (placed, plane) = (face.placed(&self.parts.mesh, &self.parts.dofs, u), self.surface().plane);
        let tangents = point.shape.tangents(placed.nodes(), plane);
        (point.shape.value(placed.nodes()), Triad::new(tangents, plane))
    }

    /// Area that a point stands for at unknowns `u`.
    pub(super) fn area(&self, index: usize, u: &[f64]) -> f64 {
        let (point, face) = (&self.points[index], self.face(index));
        let placed = face.placed(&self.parts.mesh, &self.parts.dofs, u);
        self.surface().density_at(face, &placed, point.xi) * point.weight
    }
}

/// For each face of the surface the segments of the target that share a node with it.
fn relatives(surface: &FieldSurface, target: Option<&FieldSurface>) -> Vec<Vec<usize>> {
    let mut behind: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (segment, face) in target.into_iter().flat_map(|target| target.faces.iter().enumerate()) {
        face.nodes.iter().for_each(|&node| behind.entry(node).or_default().push(segment));
    }
    let of = |nodes: &Vec<usize>| nodes.iter().filter_map(|node| behind.get(node)).flatten().copied().collect();
    surface.faces.iter().map(|face| of(&face.nodes)).collect()
}
