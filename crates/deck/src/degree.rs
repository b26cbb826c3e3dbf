//! Which cells of first degree a deck raises to second degree: those of bodies that say so, and simplices that are too few through
//! a body to bend.

use super::diagnose::Diagnostic;
use super::keys::BodyKeys;
use super::reader::{Name, Reader};
use asperity_core::mesh::{Cell, Group, Mesh};
use asperity_core::solid::{Formulation, Integration, too_stiff};
use std::collections::BTreeSet;

/// Nodes up to which a mesh is raised unasked.
const MOST: usize = 100_000;

/// The cells to raise, always all of a connected whole, so that neighbours go on sharing all their nodes; what was raised unasked is noted.
pub fn raised(bodies: &[(Name, BodyKeys)], mesh: &Mesh, reader: &mut Reader) -> Vec<usize> {
    let whole = mesh.wholes();
    let count = whole.iter().max().map_or(0, |last| last + 1);
    let mut cells = vec![Vec::new(); count];
    whole.iter().enumerate().for_each(|(cell, &whole)| cells[whole].push(cell));
    let mut owners = vec![BTreeSet::new(); count];
    for (number, (name, _)) in bodies.iter().enumerate() {
        let own = mesh.groups.get(&name.text).map_or(&[][..], |group| &group.cells);
        own.iter().for_each(|&cell| _ = owners[whole[cell]].insert(number));
    }
    for (name, body) in bodies {
        kept(name, body, mesh, reader);
    }
    let wholes = cells.into_iter().zip(owners).filter(|(cells, owners)| {
        let owners: Vec<_> = owners.iter().map(|&number| &bodies[number]).collect();
        asked(&owners, reader) || unasked(&owners, cells, mesh, reader)
    });
    wholes.flat_map(|(cells, _)| cells).filter(|&cell| mesh.kinds[cell].degree == 1).collect()
}

fn degree(body: &BodyKeys) -> Option<usize> {
    body.degree.map(|degree| degree.value)
}

/// Cells of second degree are not made ones of first.
fn kept(name: &Name, body: &BodyKeys, mesh: &Mesh, reader: &mut Reader) {
    let Some(said) = body.degree.filter(|degree| degree.value == 1) else { return };
    let cells = mesh.groups.get(&name.text).map_or(&[][..], |group: &Group| &group.cells);
    if let Some(kind) = cells.iter().map(|&cell| mesh.kinds[cell]).find(|kind| kind.degree == 2) {
        let what =
            format!("`body.{name}.degree` is 1, but the body has {} cells, which are of second degree", kind.name);
        reader
            .report(Diagnostic::error(what).at(said.place).help("leave the key out, or mesh the body in first degree"));
    }
}

/// Whether a body of a whole says second degree; then none may say first.
fn asked(owners: &[&(Name, BodyKeys)], reader: &mut Reader) -> bool {
    let Some((name, _)) = owners.iter().find(|(_, body)| degree(body) == Some(2)) else { return false };
    for (other, said) in
        owners.iter().filter_map(|(other, body)| Some((other, body.degree.filter(|degree| degree.value == 1)?)))
    {
        let what = format!("`body.{other}.degree` is 1 and `body.{name}.degree` 2, but the two share nodes");
        reader.report(
            Diagnostic::error(what)
                .at(said.place)
                .help("bodies that share nodes have one degree; say 2 for both, or for neither"),
        );
    }
    true
}

/// Whether a whole of first degree, of whose bodies nothing is said, is too stiff in bending by its simplices (or prisms).
fn unasked(owners: &[&(Name, BodyKeys)], cells: &[usize], mesh: &Mesh, reader: &mut Reader) -> bool {
    let silent = |body: &BodyKeys| {
        body.degree.is_none() && *body.formulation == Formulation::Auto && *body.integration == Integration::Auto
    };
    let Some((name, _)) = owners.first().filter(|_| owners.iter().all(|(_, body)| silent(body))) else { return false };
    let Some(stiff) = too_stiff(mesh, cells) else { return false };
    // Each node has about three edges of its own in the plane and seven in space.
    let dimension = mesh.kinds[cells[0]].dimension;
    let (own, edges) = (cells.iter().flat_map(|&cell| mesh.cell(cell).nodes).collect::<BTreeSet<_>>().len(), [3, 7]);
    if own * (1 + edges[dimension - 2]) > MOST {
        return false;
    }
    let others = match owners.len() {
        1 => String::new(),
        more => format!(" and {} that share its nodes", more - 1),
    };
    let kinds: BTreeSet<&str> = cells.iter().map(|&cell| mesh.kinds[cell].name).collect();
    let kinds: Vec<&Cell> = kinds.into_iter().filter_map(Cell::named).collect();
    let named = |kinds: &mut dyn Iterator<Item = &Cell>| kinds.map(|kind| kind.name).collect::<Vec<_>>().join(" and ");
    let second = named(&mut kinds.iter().filter_map(|kind| kind.raised()));
    let what = format!(
        "`{name}`{others}: where it bends, {} cells as few as these through it are too stiff, by some {:.0} %: they became {second}, with a node \
         in the middle of each edge, on the boundary where it is curved; degree = 1 keeps them",
        named(&mut kinds.iter().copied()),
        100.0 * stiff
    );
    reader.report(Diagnostic::change(what).at(name.place));
    true
}
