//! Both sides of a contact in place, and which part of a face sees which part of the target.

use super::arc::Arcs;
use super::contact::{FieldContact, FieldTarget};
use super::cover::{FaceInPlace, Patch, over_piece};
use super::dual::BLENDED;
use super::face::{PlacedFace, WHOLE};
use super::faces::{FaceRay, FacesInPlace, LEAST_COSINE};
use super::part::{FacePart, nearest, samples};
use super::point::smoothstep;
use super::space::{CutFace, SeenNodes, foot, nearby, whole};
use super::tool::ToolInPlace;
use crate::mesh::Mesh;
use crate::system::Dofs;
use crate::tensor::{BoundingBox, Vec3};
use std::sync::Arc;

/// Both sides of a contact at given unknowns.
pub struct Configuration<'a> {
    /// The contact.
    pub contact: &'a FieldContact,
    /// The faces of the surface.
    pub placed: Vec<PlacedFace>,
    /// Outward unit normals at the nodes of the field; none where nothing asks for them.
    pub normals: Vec<Vec3>,
    /// How far the smooth surfaces that faces of both sides stand for rise above them.
    pub arcs: Arc<Arcs>,
    /// Largest shares of dual functions at each node; none known are one.
    pub duals: &'a [[f64; 2]],
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

impl FieldTarget {
    /// At unknowns `u`.
    pub fn at<'a>(&'a self, site: (&'a Mesh, &Dofs), u: &[f64]) -> TargetInPlace<'a> {
        match self {
            Self::Tool(rigid) => TargetInPlace::Tool(rigid.at(u)),
            Self::Faces(faces) => TargetInPlace::Faces(faces.in_place(site, u)),
        }
    }
}

impl<'a> Configuration<'a> {
    /// At unknowns `u`.
    pub fn new(contact: &'a FieldContact, u: &[f64]) -> Self {
        Self::with(contact, u, contact.arcs(u))
    }

    /// The same with the arcs of another state.
    pub fn with(contact: &'a FieldContact, u: &[f64], arcs: Arc<Arcs>) -> Self {
        let (surface, site) = (contact.surface(), contact.site());
        let placed: Vec<PlacedFace> = surface.faces.iter().map(|face| face.placed(site.0, site.1, u)).collect();
        let normal = |node: usize| surface.normal(node, |f| placed[f]).unit;
        let normals = if contact.needs_normals() { (0..surface.nodes.len()).map(normal).collect() } else { Vec::new() };
        Self { contact, placed, normals, arcs, duals: &[], target: contact.parts.target.at(site, u) }
    }

    /// How far the smooth surface that a face of the target stands for rises above it at a place.
    pub(super) fn seen_rise(&self, face: usize, s: [f64; 2]) -> f64 {
        self.contact.parts.target.as_faces().map_or(0.0, |faces| faces.surface.rise(face, &self.arcs.seen, s).0)
    }

    /// A face of the surface.
    pub fn face(&self, number: usize) -> FaceInPlace<'_> {
        FaceInPlace::of(&self.contact.parts.surface, number, self.placed[number], &self.normals)
    }
}

/// Part of an edge by which an end of an interval may lie beside it, by rounding.
const BESIDE: f64 = 1e-6;

/// Part of a face from which on dual functions come in where it is covered; below two thirds they have no area of their own.
const COVERED: f64 = 0.8;

/// What a search finds on a face.
#[derive(Debug, Clone, Copy)]
pub struct SeenPart {
    /// The part of the face, and what it sees.
    pub patch: Patch,
    /// Least gap among its samples.
    pub least: f64,
    /// Gap in its middle,
    pub middle: f64,
    /// and the place of that.
    pub place: [f64; 2],
}

impl Configuration<'_> {
    /// Slots of nodes that a step holds, over places of a body that it holds too, beside faces that it does not hold: what touches there bears
    /// what the facets of both sides differ by, which no motion can relieve. As multipliers of the mortar method at nodes whose displacement
    /// is prescribed, theirs are left to the nodes beside them (Wohlmuth, SIAM J. Numer. Anal. 38, 2000).
    pub(super) fn held(&self, step: usize) -> Vec<bool> {
        let (contact, surface) = (self.contact, &self.contact.parts.surface);
        let mut out = vec![false; contact.slots()];
        let held = contact.held.get(step).filter(|held| !held.is_empty());
        let (Some(held), TargetInPlace::Faces(target), Some(faces)) =
            (held, &self.target, contact.parts.target.as_faces())
        else {
            return out;
        };
        let is_held = |nodes: &[usize]| nodes.iter().all(|node| held.contains(node));
        for (number, node) in surface.nodes.iter().enumerate().filter(|(_, node)| held.contains(&node.node)) {
            let moves = node.support.iter().any(|&(f, _)| !is_held(&surface.faces[f].nodes));
            let Some(&(f, corner)) = node.support.first().filter(|_| moves) else { continue };
            let face = self.face(f);
            let x = face.at(face.face.corner_place(corner)).x;
            let size = contact.size_at(contact.slot(number, 0));
            for n in [self.normals[number], -self.normals[number]] {
                target.meet(&FaceRay { x, n }, [0.0, size], |face, hit| {
                    let nodes = faces.surface.faces[face].nodes.iter().zip(hit.shape.n);
                    let free = nodes.filter(|(node, _)| !held.contains(node)).map(|(_, n)| n.abs()).fold(0.0, f64::max);
                    out[contact.slot(number, contact.piece_of(face))] |= free < BESIDE;
                });
            }
        }
        out
    }

    /// The patches of a face that look at it, within `reach` or nearly so: for each smooth piece of a tool those that see it, for each
    /// face of a body one.
    pub(super) fn patches(&self, number: usize, reach: f64, near: &mut Vec<usize>) -> Vec<SeenPart> {
        let (face, mut found) = (self.face(number), Vec::new());
        let patch = |target: usize| Patch::whole(number, target);
        match &self.target {
            TargetInPlace::Tool(tool) if face.plane => {
                for piece in 0..self.contact.pieces {
                    over_piece(&face, (tool, piece), |interval, ends| {
                        let mut part = Patch { near: interval, ends, ..patch(piece) };
                        if interval == WHOLE {
                            part.dual = self.dual_share(&part, 1.0);
                        }
                        found.extend(self.judge(&face, part, &samples(interval)));
                    });
                }
            }
            TargetInPlace::Tool(tool) => {
                let rule: Vec<[f64; 2]> = whole(face.face.corners()).map(|place| place.xi).collect();
                let corners: Vec<[f64; 2]> = (0..face.face.corners()).map(|c| face.face.corner_place(c)).collect();
                let look = |piece: usize| {
                    let all = patch(piece);
                    let sees = |xi: &[f64; 2]| tool.closest(piece, face.at(*xi).x).beyond.is_none();
                    if rule.iter().chain(&corners).all(sees) {
                        let dual = self.dual_share(&all, 1.0);
                        return self.judge(&face, Patch { dual, ..all }, &rule);
                    }
                    let focus = tool.middle(piece).and_then(|x| nearby(&face, foot(face.corners(), x)));
                    if !focus.iter().chain(&rule).chain(&corners).any(sees) {
                        return None;
                    }
                    let seen = SeenNodes::new(&face, (tool, piece), focus);
                    CutFace::new(&face, (tool, piece), seen)?;
                    self.judge(&face, Patch { seen: Some(seen), ..all }, &seen.places(&face))
                };
                found.extend((0..self.contact.pieces).filter_map(look));
            }
            TargetInPlace::Faces(faces) => {
                // Farther than the band, since a node has one and not each of its faces.
                faces.near(&BoundingBox::of(face.placed.nodes().iter().copied()), 2.0 * reach, near);
                let candidates = near.iter().filter(|&&target| self.contact.may_touch(number, target));
                let look = |&target: &usize| {
                    let part = FacePart::new(&face, faces.corners(target))?;
                    let (near, ends) =
                        if let FacePart::Interval(near, ends) = part { (near, ends) } else { (WHOLE, [None; 2]) };
                    let seen = self.judge(&face, Patch { near, ends, ..patch(target) }, &part.places())?;
                    Some((seen, part, seen.middle))
                };
                let all: Vec<_> = candidates.filter_map(look).collect();
                let parts: Vec<_> = nearest(&all).collect();
                found = parts.iter().map(|(seen, ..)| *seen).collect();
                for seen in &mut found {
                    seen.patch.dual = self.dual_share(&seen.patch, self.covered(&seen.patch, &parts));
                }
            }
        }
        if let TargetInPlace::Faces(faces) = &self.target {
            for SeenPart { patch, .. } in &mut found {
                patch.vertices = std::array::from_fn(|corner| self.sees_vertex((&face, faces), patch, corner));
            }
        }
        found
    }

    /// Part of the face of a patch that sees the same piece of a body, which is flat all over that where edges count; none of any
    /// face that has no dual functions.
    fn covered(&self, patch: &Patch, parts: &[&(SeenPart, FacePart, f64)]) -> f64 {
        let surface = &self.contact.parts.surface;
        if surface.duals[patch.face].is_none() {
            return 0.0;
        }
        let piece = |target: usize| self.contact.piece_of(target);
        let same = parts.iter().filter(|(other, ..)| piece(other.patch.target) == piece(patch.target));
        let area = |(other, part, _): &&(SeenPart, FacePart, f64)| {
            if self.contact.is_sharp(&other.patch) { part.area() } else { f64::NEG_INFINITY }
        };
        same.map(area).sum::<f64>() / surface.faces[patch.face].area()
    }

    /// Share of dual functions on a patch of whose face the part `covered` sees one piece of the target.
    fn dual_share(&self, patch: &Patch, covered: f64) -> f64 {
        if !self.contact.is_sharp(patch) {
            return 0.0;
        }
        let known =
            smoothstep((covered - COVERED) / (1.0 - COVERED))[0] * self.contact.dual_limit(patch.face, self.duals);
        known * self.contact.most_dual(patch)
    }

    /// Whether a corner of a face at which the surface ends sees a body within a patch, and is not held by dual functions of first degree.
    fn sees_vertex(&self, (face, faces): (&FaceInPlace, &FacesInPlace), patch: &Patch, corner: usize) -> bool {
        let surface = &self.contact.parts.surface;
        let is_vertex = || surface.nodes[surface.field[patch.face][corner]].is_vertex;
        let held = patch.dual > BLENDED && face.face.kind.degree == 1;
        if corner >= face.face.corners() || held || !is_vertex() {
            return false;
        }
        let at = face.at(face.face.corner_place(corner));
        let hit = faces.project(patch.target, &FaceRay { x: at.x, n: at.normal.unit() });
        hit.is_some_and(|hit| faces.holds(patch.target, hit.s, BESIDE))
    }

    /// Gaps of a patch at `places`, the last of them its middle; none if it does not look at the surface. What lies beyond the border
    /// of a piece of a tool in space is not seen.
    pub(super) fn judge(&self, face: &FaceInPlace, patch: Patch, places: &[[f64; 2]]) -> Option<SeenPart> {
        let (mut looks, mut least, mut middle, mut place) = (false, f64::INFINITY, f64::INFINITY, [0.0; 2]);
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
                    let hit = faces.project(patch.target, &ray)?;
                    // Normals of a hollow or, inward, of a bulge that cross before they come to a face pass its ends the other way round.
                    if self.contact.parts.surface.plane && !faces.holds(patch.target, hit.s, BESIDE) {
                        return None;
                    }
                    (hit.gap, -hit.normal().dot(ray.n))
                }
            };
            looks |= cosine > LEAST_COSINE;
            (least, middle, place) = (least.min(gap), gap, xi);
        }
        looks.then_some(SeenPart { patch, least, middle, place })
    }
}
