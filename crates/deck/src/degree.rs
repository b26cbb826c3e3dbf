//! Which cells of first degree a deck raises to second degree: those of bodies that say so, simplices that are too few through
//! a body to bend, and what meets these in a curved joint.

use super::diagnose::Diagnostic;
use super::keys::{BodyKeys, Contact};
use super::reader::{Name, Reader};
use asperity_core::mesh::{Cell, Group, Mesh, Side, is_curved};
use asperity_core::solid::{Formulation, Integration, too_stiff};
use std::collections::BTreeSet;

/// Nodes up to which a mesh is raised unasked.
const MOST: usize = 100_000;

/// What becomes of a connected whole of cells.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Raise {
    /// It keeps its degree.
    No,
    /// A body of it says second degree.
    Asked,
    /// Nothing is said of it, and it is too stiff in bending by this part.
    Stiff(f64),
    /// Nothing is said of it, and in the contact of this number its curved face meets cells that are raised unasked.
    Partner(usize),
}

/// The cells to raise, always all of a connected whole, so that neighbours go on sharing all their nodes, and on both sides of a curved
/// joint or on neither: facets would stand off edges that bend, or in them. What was raised unasked is noted.
pub fn raised(
    bodies: &[(Name, BodyKeys)],
    contacts: &[(Name, Contact)],
    mesh: &Mesh,
    reader: &mut Reader,
) -> Vec<usize> {
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
    let owners: Vec<Vec<_>> = owners.iter().map(|own| own.iter().map(|&number| &bodies[number]).collect()).collect();
    let may = |i: usize| is_silent(&owners[i]) && is_affordable(&cells[i], mesh);
    let begin = |i: usize, reader: &mut Reader| match asked(&owners[i], reader) {
        true => Raise::Asked,
        false if !is_silent(&owners[i]) => Raise::No,
        false => too_stiff(mesh, &cells[i]).filter(|_| is_affordable(&cells[i], mesh)).map_or(Raise::No, Raise::Stiff),
    };
    let begun: Vec<Raise> = (0..count).map(|i| begin(i, reader)).collect();
    let unasked = |raise: Raise| matches!(raise, Raise::Stiff(_) | Raise::Partner(_));
    let joints = if begun.iter().any(|&raise| unasked(raise)) { joints(contacts, mesh, &whole) } else { Vec::new() };
    let (mut raise, mut stays) = (begun.clone(), BTreeSet::new());
    // Each round raises one more partner, or has one more whole stay as it is and begins anew.
    loop {
        let one_sided = |&&(_, [from, to]): &&Joint| {
            unasked(raise[from]) && raise[to] == Raise::No && cells[to].iter().any(|&cell| mesh.kinds[cell].degree == 1)
        };
        let Some(&(contact, [from, to])) = joints.iter().find(one_sided) else { break };
        if may(to) && !stays.contains(&to) {
            raise[to] = Raise::Partner(contact);
        } else {
            stays.insert(from);
            raise.clone_from(&begun);
            stays.iter().for_each(|&whole| raise[whole] = Raise::No);
        }
    }
    for ((owners, cells), raise) in owners.iter().zip(&cells).zip(&raise) {
        note((owners, cells), *raise, (contacts, mesh), reader);
    }
    let wholes = cells.into_iter().zip(raise).filter(|(_, raise)| *raise != Raise::No);
    wholes.flat_map(|(cells, _)| cells).filter(|&cell| mesh.kinds[cell].degree == 1).collect()
}

/// The number of a contact whose surface or target is curved, and two wholes that meet there, either way round.
type Joint = (usize, [usize; 2]);

/// Those of all contacts.
fn joints(contacts: &[(Name, Contact)], mesh: &Mesh, whole: &[usize]) -> Vec<Joint> {
    let mut joints = Vec::new();
    for (number, (_, contact)) in contacts.iter().enumerate() {
        let sides =
            [&contact.surface, &contact.target].map(|name| mesh.groups.get(&name.text).map(|group| &group.sides));
        let [Some(surface), Some(target)] = sides else { continue };
        if !is_curved(mesh, surface) && !is_curved(mesh, target) {
            continue;
        }
        let wholes = |sides: &[Side]| sides.iter().map(|side| whole[side.cell]).collect::<BTreeSet<_>>();
        let targets = wholes(target);
        let pairs = wholes(surface).into_iter().flat_map(|a| targets.iter().flat_map(move |&b| [[a, b], [b, a]]));
        joints.extend(pairs.filter(|[a, b]| a != b).map(|pair| (number, pair)));
    }
    joints
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

/// Whether nothing is said of how the bodies of a whole are computed.
fn is_silent(owners: &[&(Name, BodyKeys)]) -> bool {
    let silent = |body: &BodyKeys| {
        body.degree.is_none() && *body.formulation == Formulation::Auto && *body.integration == Integration::Auto
    };
    !owners.is_empty() && owners.iter().all(|(_, body)| silent(body))
}

/// Whether a whole is not too large to be raised unasked.
fn is_affordable(cells: &[usize], mesh: &Mesh) -> bool {
    // Each node has about three edges of its own in the plane and seven in space.
    let dimension = mesh.kinds[cells[0]].dimension;
    let (own, edges) = (cells.iter().flat_map(|&cell| mesh.cell(cell).nodes).collect::<BTreeSet<_>>().len(), [3, 7]);
    own * (1 + edges[dimension - 2]) <= MOST
}

/// Notes what was raised unasked.
fn note(
    (owners, cells): (&[&(Name, BodyKeys)], &[usize]),
    raise: Raise,
    (contacts, mesh): (&[(Name, Contact)], &Mesh),
    reader: &mut Reader,
) {
    let Some((name, _)) = owners.first() else { return };
    let others = match owners.len() {
        1 => String::new(),
        more => format!(" and {} that share its nodes", more - 1),
    };
    let kinds: BTreeSet<&str> = cells.iter().map(|&cell| mesh.kinds[cell].name).collect();
    let kinds: Vec<&Cell> = kinds.into_iter().filter_map(Cell::named).filter(|kind| kind.degree == 1).collect();
    let named = |kinds: &mut dyn Iterator<Item = &Cell>| kinds.map(|kind| kind.name).collect::<Vec<_>>().join(" and ");
    let [first, second] =
        [named(&mut kinds.iter().copied()), named(&mut kinds.iter().filter_map(|kind| kind.raised()))];
    let what = match raise {
        Raise::No | Raise::Asked => return,
        Raise::Stiff(stiff) => format!(
            "`{name}`{others}: where it bends, {first} cells as few as these through it are too stiff, by some {:.0} %: they became {second}, with a \
             node in the middle of each edge, on the boundary where it is curved; degree = 1 keeps them",
            100.0 * stiff
        ),
        Raise::Partner(contact) => format!(
            "`{name}`{others}: in `contact.{}` its curved face meets cells that became ones of second degree, and facets would stand in these or \
             off them: its {first} cells became {second} too; degree = 1 for both keeps them",
            contacts[contact].0
        ),
    };
    reader.report(Diagnostic::change(what).at(name.place));
}
