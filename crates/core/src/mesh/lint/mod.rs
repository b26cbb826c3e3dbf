//! What may be wrong with a mesh, found before anything is computed: cells turned around or inside out or without
//! volume, nodes that are not numbers, double or unused, cracks, neighbours that do not fit, groups without content.
//!
//! Every finding names the nodes and cells by the numbers of their file and says what to do. All tolerances are
//! ratios to the edges nearby.

mod cells;
mod coincident;
mod groups;
mod hanging;
mod nodes;
mod sides;
mod words;

use super::Mesh;

/// One thing found wrong, or worth knowing.
#[derive(Debug, Clone, PartialEq)]
pub struct LintFinding {
    /// What it is.
    pub kind: LintKind,
    /// How bad it is.
    pub severity: LintSeverity,
    /// The cells concerned, as indices into the mesh.
    pub cells: Vec<usize>,
    /// The nodes concerned, as indices into the mesh.
    pub nodes: Vec<usize>,
    /// A sentence for the user, with the numbers of the file, and what to do.
    pub text: String,
}

/// What a finding is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum LintKind {
    /// A mesh without cells.
    NoCells,
    /// Coordinates that are not finite numbers.
    NotFinite,
    /// A plane mesh that leaves the plane z = 0.
    NotPlane,
    /// Cells whose nodes run the wrong way round: clockwise in the plane.
    Reversed,
    /// Cells with a negative Jacobian at some points of quadrature only.
    Inverted,
    /// Cells without area or volume.
    Flat,
    /// Cells that use a node twice.
    RepeatedNode,
    /// Cells with the same corners as another.
    RepeatedCell,
    /// Nodes that no cell uses.
    Unused,
    /// Nodes at one place that are not joined.
    Duplicate,
    /// Faces of one body at one place that are not joined.
    Crack,
    /// Faces of separate bodies at one place; only contact holds them apart.
    Touching,
    /// Nodes in the middle of an edge or face of a neighbour that does not have them.
    Hanging,
    /// Neighbours that share the corners of a face but not its mid-side nodes.
    Mismatched,
    /// Faces shared by more than two cells.
    Overlap,
    /// Groups without content.
    EmptyGroup,
    /// Groups with faces that have a cell on either side.
    InnerFaces,
}

/// How bad a finding is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum LintSeverity {
    /// Worth knowing.
    Note,
    /// Most likely not meant.
    Warning,
    /// Nothing can be computed on it.
    Error,
}

/// Everything found in a mesh, the gravest first.
pub fn check(mesh: &Mesh) -> Vec<LintFinding> {
    let mut findings = nodes::check(mesh);
    findings.extend(cells::check(mesh));
    findings.extend(sides::check(mesh));
    findings.extend(groups::check(mesh));
    if findings.iter().all(|finding| finding.severity < LintSeverity::Error) {
        findings.extend(sides::hanging(mesh));
    }
    findings.sort_by_key(|finding| (std::cmp::Reverse(finding.severity), finding.kind));
    findings
}

impl Mesh {
    /// Turns around the cells whose nodes run the wrong way (clockwise in the plane), and reports them. The groups
    /// keep their sides.
    pub fn orient(&mut self) -> Option<LintFinding> {
        cells::orient(self)
    }
}

#[cfg(test)]
mod tests;
