//! The unknowns of a stencil.

use super::tool::{MOST, ToolInPlace};
use crate::tensor::Vec3;

/// One unknown of a stencil, and where its node is in what a patch depends on.
#[derive(Debug, Clone, Copy)]
pub enum PointColumn {
    /// A displacement of a node.
    Node {
        /// Axis.
        axis: usize,
        /// Its number on the face of the surface.
        own: Option<usize>,
        /// Its number on the face that is seen.
        seen: Option<usize>,
        /// The node of the mesh.
        node: usize,
    },
    /// An unknown of the tool.
    Tool(usize),
}

/// Velocity of the tool's material at a place, and its spin, along an unknown.
pub fn tool_motion(tool: &ToolInPlace, column: &PointColumn, at: Vec3) -> (Vec3, Vec3) {
    match column {
        PointColumn::Tool(j) if *j < MOST => (tool.rates(at)[*j], tool.spins()[*j]),
        _ => (Vec3::zero(), Vec3::zero()),
    }
}
