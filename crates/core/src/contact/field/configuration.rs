//! Both sides of a contact in place, and which part of a face sees which part of the target.

use super::contact::{FieldContact, FieldTarget};
use super::cover::{FaceInPlace, Patch, between_vertices, over_piece};
use super::face::{CORNERS, PlacedFace};
use super::faces::{FaceRay, FacesInPlace, LEAST_COSINE};
use super::tool::ToolInPlace;
use crate::tensor::Vec3;
use crate::tool::BoundingBox;

/// Both sides of a contact at given unknowns.
pub struct Configuration<'a> {
    /// The contact.
    pub contact: &'a FieldContact,
    /// The faces of the surface.
    pub placed: Vec<PlacedFace>,
    /// Outward unit normals at the nodes of the field; none where nothing asks for them.
    pub normals: Vec<Vec3>,
    /// The target.
    pub target: TargetInPlace<'a>,
}

/// A target at given unknowns.
pub enum TargetInPlace<'a> {
    /// A tool.
    Tool(ToolInPlace<'a>),
    /// Faces of bodies.
    Faces(FacesInPlace<'a>),
}

impl<'a> Configuration<'a> {
    /// At unknowns `u`.
    pub fn new(contact: &'a FieldContact, u: &[f64]) -> Self {
        let (surface, site) = (&contact.parts.surface, (&*contact.parts.mesh, &contact.parts.dofs));
        let placed: Vec<PlacedFace> = surface.faces.iter().map(|face| face.placed(site.0, site.1, u)).collect();
        let normal = |node: usize| surface.normal(node, |f| placed[f]).unit;
        let normals = if contact.needs_normals() { (0..surface.nodes.len()).map(normal).collect() } else { Vec::new() };
        let target = match &contact.parts.target {
            FieldTarget::Tool(rigid) => TargetInPlace::Tool(rigid.at(u)),
            FieldTarget::Faces(faces) => TargetInPlace::Faces(faces.in_place(site, u)),
        };
        Self { contact, placed, normals, target }
    }

    /// A face of the surface.
    pub fn face(&self, number: usize) -> FaceInPlace<'_> {
        let surface = &self.contact.parts.surface;
        let mut normals = [Vec3::zero(); CORNERS];
        for (normal, node) in normals.iter_mut().zip(surface.field[number]) {
            *normal = self.normals.get(node).copied().unwrap_or(Vec3::zero());
        }
        FaceInPlace { face: &surface.faces[number], placed: self.placed[number], normals, plane: surface.plane }
    }
}

/// What a search finds on a face.
#[derive(Debug, Clone, Copy)]
pub struct SeenPart {
    /// The part of the face, and what it sees.
    pub patch: Patch,
    /// Least gap among its samples.
    pub least: f64,
    /// Gap in its middle.
    pub middle: f64,
}

impl Configuration<'_> {
    /// The patches of a face that look at it, within `reach` or nearly so.
    pub(super) fn patches(&self, number: usize, reach: f64, near: &mut Vec<usize>) -> Vec<SeenPart> {
        if !self.contact.parts.surface.plane {
            return self.patches_in_space(number, reach, near);
        }
        let (face, mut found) = (self.face(number), Vec::new());
        match &self.target {
            TargetInPlace::Tool(tool) => {
                for piece in 0..self.contact.pieces {
                    over_piece(&face, (tool, piece), |interval, ends| {
                        let patch = Patch { face: number, target: piece, ends, near: interval, tip: None };
                        found.extend(self.judge(&face, patch, &samples(interval)));
                    });
                }
            }
            TargetInPlace::Faces(faces) => {
                let all = BoundingBox::of(face.placed.nodes().iter().copied());
                // Farther than the band, since a node has one and not each of its faces.
                faces.near(&all, 2.0 * reach, near);
                for &target in near.iter().filter(|&&target| self.contact.may_touch(number, target)) {
                    let nodes = faces.placed(target).nodes();
                    let Some((interval, bounded)) = between_vertices(&face, [nodes[1], nodes[0]]) else { continue };
                    let ends = [bounded[0].then_some(1), bounded[1].then_some(0)];
                    let patch = Patch { face: number, target, ends, near: interval, tip: None };
                    found.extend(self.judge(&face, patch, &samples(interval)));
                }
                keep_nearest(&mut found);
            }
        }
        found
    }

    /// Gaps of a patch at `places`, the last of them its middle; none if it does not look at the surface. What lies beyond the border
    /// of a piece of a tool in space is not seen.
    pub(super) fn judge(&self, face: &FaceInPlace, patch: Patch, places: &[[f64; 2]]) -> Option<SeenPart> {
        let (mut looks, mut least, mut middle) = (false, f64::INFINITY, f64::INFINITY);
        for &xi in places {
            let at = face.at(xi);
            let (gap, cosine) = match &self.target {
                TargetInPlace::Tool(tool) => {
                    let foot = tool.closest(patch.target, at.x);
                    if foot.beyond.is_some() && !self.contact.parts.surface.plane {
                        continue;
                    }
                    (foot.gap, -foot.normal.dot(face.own_normal(xi)))
                }
                TargetInPlace::Faces(faces) => {
                    let ray = FaceRay { x: at.x, n: at.normal.unit() };
                    let target = self.contact.parts.target.as_faces()?;
                    let hit = target.project(patch.target, faces.placed(patch.target), &ray)?;
                    (hit.gap, -hit.normal().dot(ray.n))
                }
            };
            looks |= cosine > LEAST_COSINE;
            (least, middle) = (least.min(gap), gap);
        }
        looks.then_some(SeenPart { patch, least, middle })
    }
}

/// Ends and middle of an interval.
fn samples([from, to]: [f64; 2]) -> [[f64; 2]; 3] {
    [from, to, 0.5 * (from + to)].map(|xi| [xi, 0.0])
}

/// Of patches of one face that lie over each other, keeps the nearest.
fn keep_nearest(found: &mut Vec<SeenPart>) {
    let overlap =
        |a: &SeenPart, b: &SeenPart| a.patch.near[1].min(b.patch.near[1]) - a.patch.near[0].max(b.patch.near[0]) > 1e-6;
    let nearer = |a: &SeenPart, b: &SeenPart| (a.middle.abs(), a.patch.target) < (b.middle.abs(), b.patch.target);
    let all = found.clone();
    found.retain(|seen| !all.iter().any(|other| overlap(seen, other) && nearer(other, seen)));
}
