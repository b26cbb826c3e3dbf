//! What a field is made of: its surface, what that may touch, the law and how it is computed.

use super::cover::Patch;
use super::faces::TargetFaces;
use super::surface::{FieldNode, FieldSurface};
use super::tool::RigidTool;
use crate::contact::ContactOptions;
use crate::contact::increment::CLOSED;
use crate::contact::record::largest_penetration;
use crate::interface::{Interface, Rule};
use crate::mesh::{Mesh, Side, Space};
use crate::system::{Dofs, History};
use crate::tensor::{Vec3, legendre};
use crate::tool::{self, ProfileTool, Tip};
use std::collections::BTreeMap;
use std::sync::{Arc, LazyLock};

/// What the field may touch.
#[derive(Debug)]
pub enum FieldTarget {
    /// A rigid tool.
    Tool(RigidTool),
    /// Faces of bodies.
    Faces(TargetFaces),
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
        Self::Faces(TargetFaces::new(surface, mesh))
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

/// What a field is made of.
pub struct FieldParts {
    /// The user's name for it.
    pub name: String,
    /// The mesh.
    pub mesh: Arc<Mesh>,
    /// The numbering of the unknowns.
    pub dofs: Dofs,
    /// What the coordinates mean.
    pub space: Space,
    /// The faces that carry the field.
    pub surface: FieldSurface,
    /// The whole outer boundary of the bodies behind the surface.
    pub boundary: Vec<Side>,
    /// What they may touch.
    pub target: FieldTarget,
    /// Whether that is the surface itself.
    pub itself: bool,
    /// Whether the user calls the target the surface: forces are reported on that.
    pub swapped: bool,
    /// The law of the interface.
    pub law: Rule,
    /// How it is computed.
    pub options: ContactOptions,
}

/// Contact whose stress is a field of nodal values.
pub struct FieldContact {
    pub(super) parts: FieldParts,
    pub(super) boundary: TargetFaces,
    /// Penetration from which a node counts as closed.
    pub(super) least: f64,
    /// For each face of a target its smooth piece, counted from zero.
    labels: Vec<usize>,
    /// Number of smooth pieces of the target.
    pub(super) pieces: usize,
    pub(super) longest: f64,
    sizes: Vec<f64>,
}

impl FieldContact {
    /// A contact of these parts.
    pub fn new(mut parts: FieldParts) -> Self {
        let FieldParts { mesh, surface, .. } = &parts;
        let boundary = TargetFaces::new(FieldSurface::whole(mesh, &parts.boundary, parts.space, 1.0), mesh);
        let [mut shortest, mut longest] = surface.sizes(mesh);
        let size =
            |node: &FieldNode| node.support.iter().map(|&(f, _)| surface.size(f, mesh)).fold(f64::INFINITY, f64::min);
        let sizes = surface.nodes.iter().map(size).collect();
        let (labels, pieces) = match &mut parts.target {
            FieldTarget::Tool(rigid) => {
                rigid.sharpen([SMALL * shortest, longest]);
                (Vec::new(), rigid.pieces())
            }
            FieldTarget::Faces(faces) => {
                let [least, most] = faces.surface.sizes(&parts.mesh);
                (shortest, longest) = (shortest.min(least), longest.max(most));
                labels(&faces.surface.pieces)
            }
        };
        Self { parts, boundary, least: CLOSED * shortest, labels, pieces, longest, sizes }
    }

    /// The user's name for it.
    pub fn title(&self) -> &str {
        &self.parts.name
    }
    /// The surface.
    pub fn surface(&self) -> &FieldSurface {
        &self.parts.surface
    }
    /// What it may touch.
    pub fn target(&self) -> &FieldTarget {
        &self.parts.target
    }
    /// The law of the interface.
    pub fn law(&self) -> &dyn Interface {
        self.parts.law.first()
    }
    /// The largest penetration of a closed node in an accepted state.
    pub fn largest_penetration(&self, history: &History) -> f64 {
        largest_penetration(history, self.slots())
    }
    /// How it is computed.
    pub fn options(&self) -> &ContactOptions {
        &self.parts.options
    }
    /// Where moments are taken about: the present place of a tool's reference point, or the origin.
    pub fn pole(&self, u: &[f64]) -> Vec3 {
        self.parts.target.as_tool().map_or(Vec3::zero(), |rigid| rigid.at(u).reference())
    }

    /// Number of stencils: those of the nodes, then those of the tool's tips.
    pub(super) fn slots(&self) -> usize {
        self.nodal_slots() + self.tips().len()
    }
    /// Tips of the tool.
    pub(super) fn tips(&self) -> &[Tip] {
        self.parts.target.as_tool().map_or(&[], RigidTool::tips)
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
    /// The stencil of a node of the field and a piece of the target.
    pub(super) fn slot(&self, node: usize, piece: usize) -> usize {
        node * self.pieces + piece
    }
    /// The smooth piece of a target's segment.
    pub(super) fn piece_of(&self, target: usize) -> usize {
        self.labels.get(target).copied().unwrap_or(target)
    }
    /// Whether the averaged normals of the surface matter.
    pub(super) fn needs_normals(&self) -> bool {
        matches!(self.parts.target, FieldTarget::Faces(_))
    }
    /// Number of coordinates of a node: penetration and slips.
    pub(super) fn coordinates(&self) -> usize {
        self.parts.dofs.per_node()
    }
    /// Degree of the rule on overlaps: functions of second degree on both sides are products of those of their corners.
    pub(super) fn overlap_degree(&self, patch: &Patch) -> usize {
        let own = self.parts.surface.faces[patch.face].kind.degree;
        own.max(self.parts.target.as_faces().map_or(1, |faces| faces.surface.faces[patch.target].kind.degree))
    }
    /// Size of the faces at the node of a slot, a length.
    pub(super) fn size_at(&self, slot: usize) -> f64 {
        self.node_of(slot).map_or(self.longest, |node| self.sizes[node])
    }

    /// Whether a face of the surface may touch a face of the target. Where a surface touches itself, of two faces the one
    /// that comes first carries the stress (unique roles: Yang & Laursen, Comput. Mech. 41, 2008).
    pub(super) fn may_touch(&self, face: usize, target: usize) -> bool {
        let Some(faces) = self.parts.target.as_faces() else { return true };
        let (own, other) = (&self.parts.surface.faces[face], &faces.surface.faces[target]);
        (!self.parts.itself || own.side < other.side) && !own.nodes.iter().any(|node| other.nodes.contains(node))
    }
}

/// Largest radius of a tip over the length of the shortest face: a larger one is felt by the faces around it.
const SMALL: f64 = 1.0;

/// Labels counted from zero, in the order of their first use.
fn labels(roots: &[usize]) -> (Vec<usize>, usize) {
    let mut numbers = BTreeMap::new();
    for &root in roots {
        let next = numbers.len();
        numbers.entry(root).or_insert(next);
    }
    (roots.iter().map(|root| numbers[root]).collect(), numbers.len())
}

/// Four Gauss points in the plane: the integrals of linear functions times those of second degree over a density of first.
pub static RULE: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| legendre(4));
