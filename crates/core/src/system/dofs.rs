//! Numbering of the unknowns: displacements node by node, then the reference nodes of the tools.

use std::ops::Range;

/// The unknowns of a model. A node has `per_node` displacements (2 in the plane and in the axisymmetric case, 3 in
/// space); a tool has as many translations and then its rotations (1 or 3), in radians.
#[derive(Debug, Clone, PartialEq)]
pub struct Dofs {
    per_node: usize,
    nodes: usize,
    tools: usize,
}

/// What an unknown is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unknown {
    /// Displacement of a node along an axis.
    Node(usize, usize),
    /// Translation of a tool along an axis.
    ToolTranslation(usize, usize),
    /// Rotation of a tool about an axis (2 in the plane).
    ToolRotation(usize, usize),
}

impl Dofs {
    /// Numbering for a mesh and a number of tools.
    pub fn new(per_node: usize, nodes: usize, tools: usize) -> Self {
        Self { per_node, nodes, tools }
    }
    /// Displacements a node has.
    pub fn per_node(&self) -> usize {
        self.per_node
    }
    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.nodes
    }
    /// Number of tools.
    pub fn tools(&self) -> usize {
        self.tools
    }
    /// Unknowns of one tool: 3 in the plane, 6 in space.
    pub fn per_tool(&self) -> usize {
        if self.per_node == 2 { 3 } else { 6 }
    }
    /// Number of all unknowns, constrained ones included.
    pub fn count(&self) -> usize {
        self.per_node * self.nodes + self.per_tool() * self.tools
    }
    /// First unknown of a node.
    pub fn node(&self, node: usize) -> usize {
        node * self.per_node
    }
    /// The displacements of a node.
    pub fn displacements(&self, node: usize) -> Range<usize> {
        self.node(node)..self.node(node) + self.per_node
    }
    /// First unknown of a tool.
    pub fn tool(&self, tool: usize) -> usize {
        self.per_node * self.nodes + self.per_tool() * tool
    }
    /// First unknown of the node or tool that has this one.
    pub fn first_of_owner(&self, dof: usize) -> usize {
        match dof.checked_sub(self.tool(0)) {
            None => dof / self.per_node * self.per_node,
            Some(beyond) => self.tool(beyond / self.per_tool()),
        }
    }
    /// What unknown number `dof` is.
    pub fn describe(&self, dof: usize) -> Unknown {
        let first_tool = self.per_node * self.nodes;
        if dof < first_tool {
            return Unknown::Node(dof / self.per_node, dof % self.per_node);
        }
        let (tool, local) = ((dof - first_tool) / self.per_tool(), (dof - first_tool) % self.per_tool());
        match local.checked_sub(self.per_node) {
            None => Unknown::ToolTranslation(tool, local),
            Some(axis) => Unknown::ToolRotation(tool, if self.per_node == 2 { 2 } else { axis }),
        }
    }
    /// Whether unknown `dof` is an angle, whose conjugate is a moment.
    pub fn is_rotation(&self, dof: usize) -> bool {
        matches!(self.describe(dof), Unknown::ToolRotation(..))
    }
}
