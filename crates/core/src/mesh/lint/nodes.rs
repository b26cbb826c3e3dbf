//! Nodes one by one: whether they are numbers, lie in the plane, and are used.

use super::{LintFinding, LintKind, LintSeverity};
use crate::mesh::Mesh;

pub(super) fn check(mesh: &Mesh) -> Vec<LintFinding> {
    let which = |test: &dyn Fn(usize) -> bool| (0..mesh.points.len()).filter(|&node| test(node)).collect::<Vec<_>>();
    let lost = which(&|node| !mesh.points[node].is_finite());
    let flat = 1e-9 * mesh.size();
    let off = match mesh.dimension() {
        2 => which(&|node| mesh.points[node][2].abs() > flat),
        _ => vec![],
    };
    let adjacency = mesh.adjacency();
    let unused = which(&|node| adjacency.cells(node).is_empty());
    let finding = |kind, severity, nodes, says: &str| LintFinding::of_nodes(kind, severity, mesh, nodes, says);
    [
        finding(LintKind::NotFinite, LintSeverity::Error, lost, "with a coordinate that is not a finite number"),
        finding(
            LintKind::NotPlane,
            LintSeverity::Error,
            off,
            "off the plane z = 0, though all cells are plane ones; draw the part in x and y, or save its solid cells",
        ),
        finding(LintKind::Unused, LintSeverity::Note, unused, "used by no cell; they take no part in the computation"),
    ]
    .into_iter()
    .flatten()
    .collect()
}
