//! What a field is made of: its surface, what that may touch, the law and how it is computed.

use super::arc::{Arcs, Chords};
use super::corners::{BodyCorner, WAYS};
use super::cover::{FEET, Patch};
use super::face::{FieldFace, moved};
use super::faces::TargetFaces;
use super::surface::{BodyEdge, FieldNode, FieldSurface};
use super::tool::RigidTool;
use crate::contact::record::largest_penetration;
use crate::contact::{ContactParts, ContactSides};
use crate::mesh::Mesh;
use crate::system::{Constraints, Dofs, History, Row};
use crate::tool::{self, ProfileTool, Tip};
use std::collections::BTreeSet;
use std::ops::{Deref, Range};
use std::sync::Arc;

/// What the field may touch.
#[derive(Debug)]
pub enum FieldTarget {
    /// A rigid tool.
    Tool(RigidTool),
    /// Faces of bodies.
    Faces(Box<TargetFaces>),
}

impl FieldTarget {
    /// A rigid tool, number `number` in the numbering of the unknowns.
    pub fn tool(tool: Arc<ProfileTool>, number: usize, dofs: &Dofs) -> Self {
        Self::Tool(RigidTool::new(tool, number, dofs))
    }
    /// A rigid tool in space.
    pub fn solid_tool(tool: Arc<tool::space::SpaceTool>, number: usize, dofs: &Dofs) -> Self {
        Self::Tool(RigidTool::in_space(tool, number, dofs))
    }
    /// Faces of bodies.
    pub fn faces(surface: FieldSurface, mesh: &Mesh) -> Self {
        Self::Faces(Box::new(TargetFaces::new(surface, mesh)))
    }
    /// The faces, if it is made of faces.
    pub fn as_faces(&self) -> Option<&TargetFaces> {
        match self {
            Self::Tool(_) => None,
            Self::Faces(faces) => Some(faces),
        }
    }
    /// The tool, if it is one.
    pub fn as_tool(&self) -> Option<&RigidTool> {
        match self {
            Self::Tool(rigid) => Some(rigid),
            Self::Faces(_) => None,
        }
    }
}

/// How a field stands to its surface and its target.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct FieldRoles {
    /// Whether the target is the surface itself.
    pub itself: bool,
    /// Whether the user calls the target the surface: forces are reported on that.
    pub swapped: bool,
}

/// Contact whose stress is a field of nodal values.
pub struct FieldContact {
    sides: ContactSides,
    pub(super) roles: FieldRoles,
    /// Number of smooth pieces of the target.
    pub(super) pieces: usize,
    /// Which of these are round all over.
    round: Vec<bool>,
    /// Convex edges of a target of bodies,
    pub(super) edges: Vec<BodyEdge>,
    /// and convex corners of both sides.
    pub(super) corners: Vec<BodyCorner>,
    /// Chords of its surface and of the bodies that are its target,
    chords: [Chords; 2],
    /// and how far the smooth surfaces for which they stand rise above them before any motion.
    pub(super) rest: Arc<Arcs>,
    /// Nodes of both sides all of whose displacements are prescribed, step by step.
    pub(super) held: Vec<BTreeSet<usize>>,
    sizes: Vec<f64>,
    /// Undeformed areas of the nodes.
    pub(super) areas: Vec<f64>,
}

impl Deref for FieldContact {
    type Target = ContactSides;

    fn deref(&self) -> &ContactSides {
        &self.sides
    }
}

impl FieldContact {
    /// A contact of these parts.
    pub fn new(parts: ContactParts, roles: FieldRoles) -> Self {
        let mut sides = ContactSides::new(parts);
        let ContactParts { mesh, surface, target, .. } = &mut sides.parts;
        let size =
            |node: &FieldNode| node.support.iter().map(|&(f, _)| surface.size(f, mesh)).fold(f64::INFINITY, f64::min);
        let sizes = surface.nodes.iter().map(size).collect();
        let area = |&(f, corner): &(usize, usize)| {
            surface.corner_area(&surface.faces[f], &surface.faces[f].at_rest(mesh), corner).0
        };
        let areas = surface.nodes.iter().map(|node| node.support.iter().map(area).sum()).collect();
        let round: Vec<bool> = match target {
            FieldTarget::Tool(rigid) => {
                let [shortest, longest] = surface.sizes(mesh);
                rigid.sharpen([SMALL * shortest, LARGE * surface.mean_size(mesh)], longest);
                (0..rigid.pieces()).map(|piece| !rigid.is_straight(piece)).collect()
            }
            FieldTarget::Faces(faces) => faces.surface.round_pieces(),
        };
        let (mut edges, mut corners) = (Vec::new(), Vec::new());
        if let Some(faces) = target.as_faces() {
            edges = faces.surface.edges(mesh);
            let [own, other] = [&*surface, &faces.surface].map(|surface| surface.sizes(mesh)[0]);
            corners = BodyCorner::all(surface, mesh, true, other);
            if !roles.itself {
                corners.extend(BodyCorner::all(&faces.surface, mesh, false, own));
            }
        }
        let chords = Chords::of(surface, mesh);
        let mirrors = chords.mirrors(surface, mesh);
        surface.nodes.iter_mut().zip(mirrors).for_each(|(node, mirrors)| node.mirrors = mirrors);
        let seen = target.as_faces().map(|faces| Chords::of(&faces.surface, mesh)).unwrap_or_default();
        let rest = Arc::new(Arcs { own: chords.at_rest(), seen: seen.at_rest() });
        Self {
            sides,
            roles,
            pieces: round.len(),
            round,
            edges,
            corners,
            chords: [chords, seen],
            rest,
            held: Vec::new(),
            sizes,
            areas,
        }
    }

    /// How far the smooth surfaces that faces of both sides stand for rise above them at unknowns `u`.
    pub(super) fn arcs(&self, u: &[f64]) -> Arc<Arcs> {
        let [own, seen] = &self.chords;
        if !own.bend() && !seen.bend() {
            return self.rest.clone();
        }
        let position = |node: usize| moved(self.parts.mesh.points[node], &u[self.parts.dofs.displacements(node)]);
        Arc::new(Arcs { own: own.heights(&position), seen: seen.heights(&position) })
    }

    /// Tells it which unknowns the steps prescribe.
    pub fn know_steps<'a>(&mut self, steps: impl Iterator<Item = &'a Constraints>) {
        let (dofs, target) = (&self.parts.dofs, self.parts.target.as_faces().map(|faces| &faces.surface));
        let faces = self.parts.surface.faces.iter().chain(target.into_iter().flat_map(|surface| &surface.faces));
        let nodes: BTreeSet<usize> = faces.flat_map(|face| face.nodes.iter().copied()).collect();
        let held = |constraints: &Constraints| {
            let is_held =
                |node: &&usize| dofs.displacements(**node).all(|dof| matches!(constraints.row(dof), Row::Fixed));
            nodes.iter().filter(is_held).copied().collect()
        };
        self.held = steps.map(held).collect();
    }

    /// The largest penetration of a closed node in an accepted state.
    pub fn largest_penetration(&self, history: &History) -> f64 {
        largest_penetration(history, self.slots())
    }
    /// Number of stencils: those of the nodes, then those of the feet of a tool's tips, or of corners of bodies.
    pub(super) fn slots(&self) -> usize {
        self.tip_slots().end + WAYS * self.corners.len()
    }
    /// Tips of the tool.
    pub(super) fn tips(&self) -> &[Tip] {
        self.parts.target.as_tool().map_or(&[], RigidTool::tips)
    }
    /// Stencils of the feet of tips.
    pub(super) fn tip_slots(&self) -> Range<usize> {
        self.nodal_slots()..self.nodal_slots() + FEET * self.tips().len()
    }
    /// Number of stencils of nodes.
    pub(super) fn nodal_slots(&self) -> usize {
        self.parts.surface.nodes.len() * self.pieces
    }
    /// The node of the mesh that a record stands for; none for that of a tip.
    pub fn node_at(&self, record: usize) -> Option<usize> {
        self.node_of(record).map(|node| self.parts.surface.nodes[node].node)
    }
    /// The node of a stencil; none for that of a tip.
    pub(super) fn node_of(&self, slot: usize) -> Option<usize> {
        (slot < self.nodal_slots()).then(|| slot / self.pieces)
    }
    /// The tip of the tool, by number, that a stencil is a foot of.
    pub(super) fn tip_of(&self, slot: usize) -> usize {
        (slot - self.nodal_slots()) / FEET
    }
    /// The stencil of a node of the field and a piece of the target.
    pub(super) fn slot(&self, node: usize, piece: usize) -> usize {
        node * self.pieces + piece
    }
    /// The smooth piece of a target's segment.
    pub(super) fn piece_of(&self, target: usize) -> usize {
        self.parts.target.as_faces().map_or(target, |faces| faces.surface.pieces[target])
    }
    /// Convex edges at which a piece of a target of bodies meets others.
    pub(super) fn edges_of(&self, piece: usize) -> impl Iterator<Item = &BodyEdge> {
        self.edges.iter().filter(move |edge| edge.faces.iter().any(|&face| self.piece_of(face) == piece))
    }
    /// Whether a piece of the target is round all over.
    pub(super) fn is_round(&self, piece: usize) -> bool {
        self.round[piece]
    }
    /// Whether the averaged normals of the surface matter.
    pub(super) fn needs_normals(&self) -> bool {
        matches!(self.parts.target, FieldTarget::Faces(_))
    }
    /// Number of coordinates of a node: penetration and slips.
    pub(super) fn coordinates(&self) -> usize {
        self.parts.dofs.per_node()
    }
    /// Whether functions on an overlap are of third degree, as those of quadrilaterals with eight nodes.
    pub(super) fn is_cubic(&self, patch: &Patch) -> bool {
        let third = |face: &FieldFace| face.kind.degree > 1 && face.kind.linear.nodes.len() > 3;
        let faces = self.parts.target.as_faces();
        third(&self.parts.surface.faces[patch.face])
            || faces.is_some_and(|faces| third(&faces.surface.faces[patch.target]))
    }
    /// Size of the faces at the node of a slot, a length.
    pub(super) fn size_at(&self, slot: usize) -> f64 {
        let beside = || self.corner_of(slot).map_or(self.longest, |corner| corner.size);
        self.node_of(slot).map_or_else(beside, |node| self.sizes[node])
    }

    /// Whether a face of the surface may touch a face of the target. Where a surface touches itself, of two faces the one
    /// that comes first carries the stress (unique roles: Yang & Laursen, Comput. Mech. 41, 2008).
    pub(super) fn may_touch(&self, face: usize, target: usize) -> bool {
        let Some(faces) = self.parts.target.as_faces() else { return true };
        let first = || self.parts.surface.faces[face].side < faces.surface.faces[target].side;
        (!self.roles.itself || first()) && self.may_meet(face, target)
    }

    /// Whether they may touch by a corner of one of them: where a surface touches itself either carries.
    pub(super) fn may_meet(&self, face: usize, target: usize) -> bool {
        let Some(faces) = self.parts.target.as_faces() else { return false };
        let (own, other) = (&self.parts.surface.faces[face], &faces.surface.faces[target]);
        !own.nodes.iter().any(|node| other.nodes.contains(node))
    }
}

/// Largest radius of a rounding over the length of the shortest face at which the tool's piece is parted there as at an edge.
const SMALL: f64 = 1.0;
/// Largest radius of a rounding that has a tip over the mean length of the faces: of a larger one the gap of the nodes is right to a
/// two-hundred-and-fortieth of that, and where increments press it in by much more than that a tip only comes to go again.
const LARGE: f64 = 20.0;
