//! The words of findings.

use super::{LintFinding, LintKind, LintSeverity};
use crate::mesh::Mesh;

/// How many numbers a sentence lists before it says "and so many more".
const LISTED: usize = 5;

/// `1 cell`, `3 cells`.
pub(super) fn count(number: usize, noun: &str) -> String {
    format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
}

/// `cell 7`, `cells 7, 8 and 12 more`.
pub(super) fn cells(mesh: &Mesh, cells: &[usize]) -> String {
    listed("cell", cells.iter().map(|&cell| mesh.cell_number(cell).to_string()))
}

/// `node 7`, `nodes 7, 8 and 12 more`.
pub(super) fn nodes(mesh: &Mesh, nodes: &[usize]) -> String {
    listed("node", nodes.iter().map(|&node| mesh.node_number(node).to_string()))
}

/// `noun A`, `nouns A, B and 12 more`.
pub(super) fn listed(noun: &str, items: impl ExactSizeIterator<Item = String>) -> String {
    let total = items.len();
    let plural = if total == 1 { "" } else { "s" };
    let shown = items.take(LISTED).collect::<Vec<_>>().join(", ");
    let rest = if total > LISTED { format!(" and {} more", total - LISTED) } else { String::new() };
    format!("{noun}{plural} {shown}{rest}")
}

impl LintFinding {
    /// A finding about cells; none if there are none. The sentence begins with their numbers.
    pub(super) fn of_cells(
        kind: LintKind,
        severity: LintSeverity,
        mesh: &Mesh,
        cells: Vec<usize>,
        says: &str,
    ) -> Option<LintFinding> {
        let text = format!("{} {says}", self::cells(mesh, &cells));
        (!cells.is_empty()).then_some(LintFinding { kind, severity, cells, nodes: vec![], text })
    }

    /// A finding about nodes; none if there are none. The sentence begins with their numbers.
    pub(super) fn of_nodes(
        kind: LintKind,
        severity: LintSeverity,
        mesh: &Mesh,
        nodes: Vec<usize>,
        says: &str,
    ) -> Option<LintFinding> {
        let text = format!("{} {says}", self::nodes(mesh, &nodes));
        (!nodes.is_empty()).then_some(LintFinding { kind, severity, cells: vec![], nodes, text })
    }
}
