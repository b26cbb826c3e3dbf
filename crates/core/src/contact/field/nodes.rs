//! Nodes of the mesh and a tool in place: what the points of a patch, and the stencil of a node of the field, depend on.

use super::arc::Arcs;
use super::column::PointColumn;
use super::contact::FieldContact;
use super::cover::Patch;
use super::face::{FieldFace, PlacedFace, moved};
use super::tool::ToolInPlace;
use crate::tensor::Vec3;

/// Some nodes of the mesh and the tool of a contact at values of their unknowns.
#[derive(Clone, Copy)]
pub struct NodesInPlace<'a> {
    /// The contact.
    pub contact: &'a FieldContact,
    /// The nodes, ascending.
    pub nodes: &'a [usize],
    /// Values of their unknowns, then those of the tool.
    pub u: &'a [f64],
    /// How far the smooth surfaces that faces of both sides stand for rise above them.
    pub arcs: &'a Arcs,
    /// The tool where these put it.
    pub tool: Option<ToolInPlace<'a>>,
}

impl<'a> NodesInPlace<'a> {
    /// Unknowns of a node.
    pub fn axes(&self) -> usize {
        self.contact.parts.dofs.per_node()
    }

    /// Place of a node of the mesh among them.
    pub fn place(&self, node: usize) -> Option<usize> {
        self.nodes.binary_search(&node).ok()
    }

    /// A face with its nodes in place.
    pub fn placed(&self, face: &FieldFace) -> PlacedFace {
        PlacedFace::new(face.nodes.iter().map(|&node| self.position(node)))
    }

    /// Where a node is.
    pub fn position(&self, node: usize) -> Vec3 {
        let (x, axes) = (self.contact.parts.mesh.points[node], self.axes());
        self.place(node).map_or(x, |place| moved(x, &self.u[place * axes..(place + 1) * axes]))
    }

    /// The unknowns of the tool.
    pub fn motion(&self) -> &'a [f64] {
        &self.u[self.nodes.len() * self.axes()..]
    }

    /// Nodes of a face of the target.
    pub fn seen_nodes(&self, face: usize) -> &'a [usize] {
        self.contact.parts.target.as_faces().map_or(&[], |faces| &faces.surface.faces[face].nodes)
    }

    /// Their unknowns, as the points of a patch depend on them.
    pub fn columns(&self, patch: &Patch) -> Vec<PointColumn> {
        let own = &self.contact.parts.surface.faces[patch.face].nodes;
        let seen = self.seen_nodes(patch.target);
        let place = |nodes: &[usize], node: usize| nodes.iter().position(|&other| other == node);
        let of = |&node: &usize| {
            let (own, seen) = (place(own, node), place(seen, node));
            (0..self.axes()).map(move |axis| PointColumn::Node { axis, own, seen, node })
        };
        self.nodes.iter().flat_map(of).chain((0..self.motion().len()).map(PointColumn::Tool)).collect()
    }
}
