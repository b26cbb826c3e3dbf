//! Groups: those without content, and those whose faces lie inside the mesh.

use super::{LintFinding, LintKind, LintSeverity, words};
use crate::mesh::{Group, Mesh};

pub(super) fn check(mesh: &Mesh) -> Vec<LintFinding> {
    let which = |test: &dyn Fn(&Group) -> bool| -> Vec<String> {
        mesh.groups.iter().filter(|(_, group)| test(group)).map(|(name, _)| format!("'{name}'")).collect()
    };
    let empty = which(&|group| group.nodes.is_empty());
    let inner = which(&|group| !group.inner.is_empty());
    [
        finding(LintKind::EmptyGroup, LintSeverity::Warning, empty, "without cells, sides or nodes"),
        finding(LintKind::InnerFaces, LintSeverity::Note, inner, "with faces inside the mesh, which can be no surface"),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn finding(kind: LintKind, severity: LintSeverity, names: Vec<String>, says: &str) -> Option<LintFinding> {
    let text = format!("{} {says}", words::listed("group", names.iter().cloned()));
    (!names.is_empty()).then_some(LintFinding { kind, severity, cells: vec![], nodes: vec![], text })
}
