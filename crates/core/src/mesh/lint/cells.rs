//! Cells one by one: which way round they are, whether they have volume, whether a node stands in them twice.

use super::{LintFinding, LintKind, LintSeverity};
use crate::mesh::{Mesh, Side};
use rayon::prelude::*;

/// Below this share of the longest edge to the power of the dimension, a Jacobian is taken for zero.
const FLAT: f64 = 1e-12;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    Sound,
    Reversed,
    Inverted,
    Flat,
    /// A node is not a number; reported with the nodes.
    Unknown,
}

pub(super) fn check(mesh: &Mesh) -> Vec<LintFinding> {
    let states = states(mesh);
    let which = |state| (0..states.len()).filter(|&cell| states[cell] == state).collect::<Vec<_>>();
    let turn =
        "wrong way round (clockwise in the plane, inside out in space): their nodes must be listed the other way";
    let found = |kind, state, says: &str| LintFinding::of_cells(kind, LintSeverity::Error, mesh, which(state), says);
    let none = LintFinding {
        kind: LintKind::NoCells,
        severity: LintSeverity::Error,
        cells: vec![],
        nodes: vec![],
        text: "the mesh has no cells; save the plane or solid elements too".into(),
    };
    [
        (mesh.cell_count() == 0).then_some(none),
        found(LintKind::Reversed, State::Reversed, turn),
        found(LintKind::Inverted, State::Inverted, "folded: the Jacobian changes its sign inside; mend the mesh there"),
        found(LintKind::Flat, State::Flat, "without area or volume; remove them or mend the mesh there"),
        repeated_nodes(mesh),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn states(mesh: &Mesh) -> Vec<State> {
    (0..mesh.cell_count()).into_par_iter().map(|cell| state(mesh, cell)).collect()
}

fn state(mesh: &Mesh, cell: usize) -> State {
    let view = mesh.cell(cell);
    if view.nodes.iter().any(|&node| !mesh.points[node].is_finite()) {
        return State::Unknown;
    }
    let zero = FLAT * mesh.longest_edge(cell).powi(view.kind.dimension as i32);
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    for &xi in view.kind.full.points {
        let jacobian = view.jacobian(&mesh.points, xi);
        (least, most) = (least.min(jacobian), most.max(jacobian));
    }
    match (least, most) {
        _ if least > zero => State::Sound,
        _ if most < -zero => State::Reversed,
        _ if least >= -zero && most <= zero => State::Flat,
        _ if least < -zero => State::Inverted,
        _ => State::Flat,
    }
}

fn repeated_nodes(mesh: &Mesh) -> Option<LintFinding> {
    let repeats = |&cell: &usize| {
        let nodes = mesh.cell(cell).nodes;
        (1..nodes.len()).any(|i| nodes[..i].contains(&nodes[i]))
    };
    let cells = (0..mesh.cell_count()).filter(repeats).collect();
    let says = "with the same node at two corners: collapsed cells are stiff and inaccurate; use triangles, \
                tetrahedra or wedges";
    LintFinding::of_cells(LintKind::RepeatedNode, LintSeverity::Warning, mesh, cells, says)
}

/// Turns the reversed cells around; a face keeps its nodes but changes its place in the cell.
pub(super) fn orient(mesh: &mut Mesh) -> Option<LintFinding> {
    let states = states(mesh);
    let reversed: Vec<usize> = (0..states.len()).filter(|&cell| states[cell] == State::Reversed).collect();
    for &cell in &reversed {
        let old = mesh.cell(cell).nodes.to_vec();
        let start = mesh.starts[cell];
        for (i, from) in mesh.kinds[cell].mirror().into_iter().enumerate() {
            mesh.nodes[start + i] = old[from];
        }
    }
    let renumber = |kinds: &[&'static crate::mesh::Cell], side: &mut Side| {
        if states[side.cell] == State::Reversed {
            side.face = kinds[side.cell].mirrored_face(side.face);
        }
    };
    for group in mesh.groups.values_mut() {
        group.sides.iter_mut().for_each(|side| renumber(&mesh.kinds, side));
        group.inner.iter_mut().flatten().for_each(|side| renumber(&mesh.kinds, side));
        group.tidy();
    }
    let says = "ran the wrong way round (clockwise in the plane) and have been turned around";
    LintFinding::of_cells(LintKind::Reversed, LintSeverity::Note, mesh, reversed, says)
}
