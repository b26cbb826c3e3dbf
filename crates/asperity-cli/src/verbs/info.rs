//! `asperity info`: what a mesh file holds, and what is wrong with it.

use super::{Outcome, print, translate};
use crate::arguments::Info;
use crate::exit::{Exit, tell};
use asperity::mesh::lint::{self, LintSeverity};
use asperity::mesh::{Mesh, formats};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Prints counts, extents, groups and findings. Of an input deck with parts or steps those of the mesh that they make.
pub fn info(arguments: &Info) -> Outcome {
    let (mut mesh, notes) = match translate::has_model(&arguments.mesh) {
        true => {
            let translated = translate::translated(&arguments.mesh, &arguments.mesh)?;
            tell(&translated.notes());
            (translated.load(&[])?.mesh, vec![])
        }
        false => formats::read(&arguments.mesh)?,
    };
    let findings: Vec<_> = mesh.orient().into_iter().chain(lint::check(&mesh)).collect();
    let mut text = format!("{}\n{}\n{}", arguments.mesh.display(), size(&mesh), groups(&mesh));
    for note in &notes {
        let _ = writeln!(text, "note: {note}");
    }
    for finding in &findings {
        let word = match finding.severity {
            LintSeverity::Error => "error",
            LintSeverity::Warning => "warning",
            LintSeverity::Note => "note",
        };
        let _ = writeln!(text, "{word}: {}", finding.text);
    }
    print(&text)?;
    let problems = findings.iter().any(|finding| finding.severity != LintSeverity::Note);
    Ok(if problems { Exit::Problems } else { Exit::Done })
}

fn size(mesh: &Mesh) -> String {
    let mut kinds: BTreeMap<&str, usize> = BTreeMap::new();
    for kind in &mesh.kinds {
        *kinds.entry(kind.name).or_default() += 1;
    }
    let kinds = kinds.iter().map(|(kind, count)| format!("{count} {kind}")).collect::<Vec<_>>().join(", ");
    let mut text = format!("{} nodes, {} cells ({kinds})\n", mesh.points.len(), mesh.cell_count());
    for (axis, name) in ["x", "y", "z"].iter().enumerate() {
        let x = mesh.points.iter().map(|point| point[axis]);
        let (low, high) = x.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        let _ = writeln!(text, "{name} from {low} to {high}");
    }
    text
}

fn groups(mesh: &Mesh) -> String {
    let widest = mesh.groups.keys().map(String::len).max().unwrap_or(0).max("group".len());
    let mut text = format!("{:widest$}  {:>8}  {:>8}  {:>8}\n", "group", "cells", "sides", "nodes");
    for (name, group) in &mesh.groups {
        let (cells, sides, nodes) = (group.cells.len(), group.sides.len(), group.nodes.len());
        let _ = writeln!(text, "{name:widest$}  {cells:>8}  {sides:>8}  {nodes:>8}");
    }
    text
}
