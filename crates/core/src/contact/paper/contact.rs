//! A surface with Gauss points and its target.

use super::neighbours::Neighbours;
use super::point::Triad;
use super::surface::PointSurface;
use crate::contact::field::faces::TargetFaces;
use crate::contact::field::{FieldSurface, FieldTarget};
use crate::contact::increment::CLOSED;
use crate::contact::record::largest_penetration;
use crate::contact::{ContactOptions, LoadedSides};
use crate::interface::{Interface, Rule};
use crate::mesh::{Mesh, Side, Space};
use crate::system::{Dofs, History};
use crate::tensor::Vec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// What a contact of Gauss points is made of.
pub struct PaperParts {
    /// The user's name for it.
    pub name: String,
    /// The mesh.
    pub mesh: Arc<Mesh>,
    /// The numbering of the unknowns.
    pub dofs: Dofs,
    /// What the coordinates mean.
    pub space: Space,
    /// The faces that carry the points.
    pub surface: PointSurface,
    /// The whole outer boundary of the bodies behind the surface.
    pub boundary: Vec<Side>,
    /// What they may touch.
    pub target: FieldTarget,
    /// The law of the interface.
    pub law: Rule,
    /// How it is computed.
    pub options: ContactOptions,
}

/// Contact whose stress lives at Gauss points.
pub struct PaperContact {
    pub(super) parts: PaperParts,
    pub(super) boundary: TargetFaces,
    /// Penetration from which a point counts as closed.
    pub(super) least: f64,
    /// The longest edge of both sides, a length.
    pub(super) longest: f64,
    /// For each face the segments of the target that share a node with it.
    pub(super) relatives: Vec<Vec<usize>>,
    /// The points around each point, where the law is not local.
    pub(super) neighbours: Neighbours,
}

impl PaperContact {
    /// A contact of these parts.
    pub fn new(parts: PaperParts) -> Self {
        let boundary =
            TargetFaces::new(FieldSurface::whole(&parts.mesh, &parts.boundary, parts.space, 1.0), &parts.mesh);
        let [mut shortest, mut longest] = parts.surface.faces.sizes(&parts.mesh);
        // Common to both sides: else one would be pressed a little harder than the other.
        if let Some(faces) = parts.target.as_faces() {
            let [least, most] = faces.surface.sizes(&parts.mesh);
            (shortest, longest) = (shortest.min(least), longest.max(most));
        }
        let relatives = relatives(&parts.surface.faces, parts.target.as_faces().map(|faces| &faces.surface));
        let (least, neighbours) = (CLOSED * shortest, Neighbours::default());
        let mut contact = Self { parts, boundary, least, longest, relatives, neighbours };
        let radius = contact.parts.law.first().radius();
        if radius > 0.0 {
            let still = vec![0.0; contact.parts.dofs.count()];
            let points = 0..contact.parts.surface.points.len();
            let places: Vec<Vec3> = points.map(|i| contact.triad(i, &still).0).collect();
            let face = |i: usize| contact.parts.surface.points[i].face;
            contact.neighbours = Neighbours::new(&places, face, radius, |i| contact.area(i, &still));
        }
        contact
    }

    /// The user's name for it.
    pub fn title(&self) -> &str {
        &self.parts.name
    }
    /// The faces that carry the points.
    pub fn surface(&self) -> &FieldSurface {
        &self.parts.surface.faces
    }
    /// The points.
    pub fn points(&self) -> &PointSurface {
        &self.parts.surface
    }
    /// The target.
    pub fn target(&self) -> &FieldTarget {
        &self.parts.target
    }
    /// Whether its points load their own side alone: one of two passes.
    pub fn loads_itself(&self) -> bool {
        self.parts.options.loads == LoadedSides::Own
    }
    /// The law of the interface.
    pub fn law(&self) -> &dyn Interface {
        self.parts.law.first()
    }
    /// The largest penetration at a closed point, from the history of a state; a length.
    pub fn largest_penetration(&self, history: &History) -> f64 {
        largest_penetration(history, self.parts.surface.points.len())
    }
    /// How it is computed.
    pub fn options(&self) -> &ContactOptions {
        &self.parts.options
    }
    /// Where moments are taken about: the present place of a tool's reference point, or the origin.
    pub fn pole(&self, u: &[f64]) -> Vec3 {
        self.parts.target.as_tool().map_or(Vec3::zero(), |rigid| rigid.at(u).reference())
    }

    /// Size of the face of a point, a length.
    pub fn face_size(&self, point: usize) -> f64 {
        self.surface().size(self.parts.surface.points[point].face, &self.parts.mesh)
    }

    /// The mesh.
    pub fn mesh(&self) -> &Mesh {
        &self.parts.mesh
    }

    /// Mesh and numbering.
    pub(super) fn site(&self) -> (&Mesh, &Dofs) {
        (&self.parts.mesh, &self.parts.dofs)
    }

    /// Position and triad of a point at unknowns `u`.
    pub(super) fn triad(&self, index: usize, u: &[f64]) -> (Vec3, Triad<f64>) {
        let (point, face) = (&self.parts.surface.points[index], self.parts.surface.face(index));
        let (placed, plane) = (face.placed(&self.parts.mesh, &self.parts.dofs, u), self.surface().plane);
        let tangents = point.shape.tangents(placed.nodes(), plane);
        (point.shape.value(placed.nodes()), Triad::new(tangents, plane))
    }

    /// Area that a point stands for at unknowns `u`.
    pub(super) fn area(&self, index: usize, u: &[f64]) -> f64 {
        let (point, face) = (&self.parts.surface.points[index], self.parts.surface.face(index));
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
