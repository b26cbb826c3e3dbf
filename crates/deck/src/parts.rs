//! The mesh of a deck: its file, its generated parts, its chosen groups.

use super::degree;
use super::diagnose::Diagnostic;
use super::form::{Form, map, refers, table_of};
use super::keys::{BodyKeys, Contact, Generator, MeshKeys, RunKeys, Selection};
use super::reader::{Name, Reader};
use super::schema::Names;
use super::source::{Place, SourceText, Spot};
use super::tree::{Node, Value};
use asperity_core::error::Error;
use asperity_core::mesh::generate::{self, Grade, Spacing};
use asperity_core::mesh::{Group, Mesh, Side, formats, lint};
use std::path::Path;

/// A longer line of a mesh file is shown only so far.
const LINE_SHOWN: usize = 160;

/// The mesh that a tree asks for, even where the rest of the deck is in error; faults of the mesh go to `reader`. A mesh
/// that is `given` stands for the file.
pub fn mesh(tree: &Node, folder: &Path, given: Option<Mesh>, reader: &mut Reader) -> Option<Mesh> {
    // The keys were read and judged with the deck; here only their values are wanted.
    let mut quiet = Reader::default();
    let keys = table_of::<MeshKeys>().read(entry(tree, "mesh")?, &mut quiet)?;
    let mut mesh = Mesh::new();
    if let Some(file) = &keys.file {
        let part = given.map_or_else(|| read(file, folder, reader), Some)?;
        append(&mut mesh, part, file.place, reader)?;
    }
    for (name, part) in &keys.part {
        let part = generated(&name.text, part).map_err(|error| refuse(&error, name.place, reader)).ok()?;
        append(&mut mesh, part, name.place, reader)?;
    }
    lint(&mut mesh, keys.file.as_ref().map_or(keys.place, |file| file.place), reader)?;
    let selections = map(refers(Names::Group), table_of::<Selection>());
    let selections = entry(tree, "group").and_then(|node| selections.read(node, &mut quiet)).unwrap_or_default();
    let bodies = map(refers(Names::Cells), table_of::<BodyKeys>());
    let bodies = entry(tree, "body").and_then(|node| bodies.read(node, &mut quiet)).unwrap_or_default();
    choose_all(&selections, &mut mesh, reader);
    let contacts = map(refers(Names::Contact), table_of::<Contact>());
    let contacts = entry(tree, "contact").and_then(|node| contacts.read(node, &mut quiet)).unwrap_or_default();
    let raised = degree::raised(&bodies, &contacts, &mesh, reader);
    if raised.is_empty() {
        return Some(mesh);
    }
    // Chosen once more, so that new nodes within the ranges are among them.
    selections.iter().for_each(|(name, _)| _ = mesh.groups.remove(&name.text));
    let mut mesh = mesh.raised(&raised);
    choose_all(&selections, &mut mesh, &mut quiet);
    Some(mesh)
}

/// Adds all chosen groups; one may be chosen from another that is written later.
fn choose_all(selections: &[(Name, Selection)], mesh: &mut Mesh, reader: &mut Reader) {
    let mut waiting: Vec<_> = selections.iter().collect();
    let ready =
        |selection: &Selection, mesh: &Mesh| selection.groups().all(|name| mesh.groups.contains_key(&name.text));
    while let Some(next) = waiting.iter().position(|(_, selection)| ready(selection, mesh)) {
        let (name, selection) = waiting.remove(next);
        choose(name, selection, mesh, reader);
    }
}

fn entry<'a>(tree: &'a Node, key: &str) -> Option<&'a Node> {
    match &tree.value {
        Value::Table(entries) => entries.iter().find(|entry| entry.key == key).map(|entry| &entry.node),
        _ => None,
    }
}

fn append(mesh: &mut Mesh, part: Mesh, place: Place, reader: &mut Reader) -> Option<()> {
    mesh.append(part).map_err(|error| refuse(&error, place, reader)).ok()
}

fn refuse(error: &Error, place: Place, reader: &mut Reader) {
    reader.report(Diagnostic::error(error.to_string()).at(place));
}

/// Reads a mesh file; its fault is shown at its own line, and the deck's line that names the file beside it.
fn read(file: &Spot<String>, folder: &Path, reader: &mut Reader) -> Option<Mesh> {
    let path = folder.join(&file.value);
    match formats::read(&path) {
        Ok((mesh, notes)) => {
            let note = |note: &formats::Note| Diagnostic::note(note.to_string()).at(file.place);
            reader.diagnostics.extend(notes.iter().map(note));
            Some(mesh)
        }
        Err(error) => {
            refuse_file(&path, &error.to_string(), file.place, reader);
            None
        }
    }
}

/// `PATH:LINE: WHAT` is shown at that line of the file, anything else at the deck's key.
fn refuse_file(path: &Path, error: &str, key: Place, reader: &mut Reader) {
    let name = path.display().to_string();
    let at_line = error.strip_prefix(&format!("{name}:")).and_then(|rest| rest.split_once(": "));
    let numbered = at_line.and_then(|(line, what)| Some((line.parse::<usize>().ok().filter(|&n| n > 0)?, what)));
    let Some((line, what)) = numbered else {
        let diagnostic = Diagnostic::error(error).at(key);
        let lost = || diagnostic.clone().help("a mesh file is looked for from the folder of the deck");
        return reader.report(if path.is_file() { diagnostic } else { lost() });
    };
    let bytes = asperity_core::files::read(path).unwrap_or_default();
    let text = bytes.split(|&byte| byte == b'\n').nth(line - 1).unwrap_or_default();
    let text: String = String::from_utf8_lossy(text).trim_end().chars().take(LINE_SHOWN).collect();
    let place = Place::new(reader.sources.len(), 0..text.len());
    reader.sources.push(SourceText { name, text, first_line: line });
    reader.report(Diagnostic::error(what).at(place));
}

/// Turns cells the right way round and reports what is wrong with the mesh or worth knowing. Nothing comes of a mesh
/// with errors.
fn lint(mesh: &mut Mesh, place: Place, reader: &mut Reader) -> Option<()> {
    let before = reader.errors();
    let turned = mesh.orient();
    for finding in turned.into_iter().chain(lint::check(mesh)) {
        let diagnostic = match finding.severity {
            lint::LintSeverity::Error => Diagnostic::error(finding.text),
            lint::LintSeverity::Warning => Diagnostic::warning(finding.text),
            lint::LintSeverity::Note => Diagnostic::note(finding.text),
        };
        reader.report(diagnostic.at(place));
    }
    (reader.errors() == before).then_some(())
}

fn generated(name: &str, part: &Generator) -> Result<Mesh, Error> {
    match part {
        Generator::Rectangle(p) => {
            let [x, y] = spacings(
                &p.from,
                (p.to.as_deref(), p.cells.as_deref(), p.ratio.as_deref().map(Vec::as_slice)),
                [&p.along_x, &p.along_y],
            );
            generate::Rectangle { x, y, cell: *p.cell }.mesh(name)
        }
        Generator::Annulus(p) => {
            let runs = [&p.along_radius, &p.along_angle];
            let [radius, angle] =
                spacings(&p.from, (p.to.as_deref(), p.cells.as_deref(), p.ratio.as_deref().map(Vec::as_slice)), runs);
            generate::Annulus { centre: [p.centre[0], p.centre[1]], radius, angle, cell: *p.cell }.mesh(name)
        }
        Generator::Block(p) => {
            let runs = [&p.along_x, &p.along_y, &p.along_z];
            let [x, y, z] =
                spacings(&p.from, (p.to.as_deref(), p.cells.as_deref(), p.ratio.as_deref().map(Vec::as_slice)), runs);
            generate::Block { x, y, z, cell: *p.cell }.mesh(name)
        }
    }
}

/// The keys `to`, `cells` and `ratio` of a part, one value of each for each direction.
type Even<'k> = (Option<&'k [f64]>, Option<&'k [usize]>, Option<&'k [f64]>);

/// Stations along each direction: graded between two ends, or by runs.
fn spacings<const N: usize>(from: &[f64], (to, cells, ratio): Even<'_>, runs: [&Vec<RunKeys>; N]) -> [Spacing; N] {
    std::array::from_fn(|a| match (to, cells) {
        (Some(to), Some(cells)) => Spacing::graded(from[a], to[a], cells[a], ratio.map_or(1.0, |ratio| ratio[a])),
        _ => runs[a].iter().fold(Spacing::from(from[a]), |spacing, run| {
            let ratio = run.ratio.map_or(1.0, |ratio| ratio.value);
            let grade = if run.smooth { Grade::Smooth } else { Grade::Ratio(ratio) };
            spacing.run(run.to, run.cells, grade)
        }),
    })
}

/// Adds a group of what lies within ranges.
fn choose(name: &Name, selection: &Selection, mesh: &mut Mesh, reader: &mut Reader) {
    if mesh.groups.contains_key(&name.text) {
        let what = format!("the mesh has a group `{name}` already");
        return reader.report(Diagnostic::error(what).at(name.place).help("choose another name"));
    }
    let parts: Vec<&Group> = selection.groups().filter_map(|name| mesh.groups.get(&name.text)).collect();
    let of = union(&parts, mesh);
    let group = within(&of, selection, mesh);
    if group.nodes.is_empty() {
        let what = format!("no node of `{}` lies within the ranges of `{name}`", selection.of);
        let help = format!("widen the ranges; the nodes of `{}` lie {}", selection.of, extent(&of, mesh));
        return reader.report(Diagnostic::error(what).at(selection.place).help(help));
    }
    mesh.groups.insert(name.text.clone(), group);
}

/// What lies in any of some groups.
fn union(parts: &[&Group], mesh: &Mesh) -> Group {
    let cells = parts.iter().flat_map(|part| part.cells.iter().copied()).collect();
    let sides = parts.iter().flat_map(|part| part.sides.iter().copied()).collect();
    Group::new(mesh, cells, sides, parts.iter().flat_map(|part| part.nodes.iter().copied()).collect())
}

fn within(of: &Group, selection: &Selection, mesh: &Mesh) -> Group {
    let slack = 1e-9 * size(mesh);
    let ranges = [&selection.x, &selection.y, &selection.z];
    let inside = |node: usize| {
        ranges.iter().enumerate().all(|(axis, range)| {
            let x = mesh.points[node][axis];
            range.as_ref().is_none_or(|range| x >= range[0] - slack && x <= range[1] + slack)
        })
    };
    // The middles of raised cells are where their corners are.
    let fits = |node: usize| mesh.before_raised.is_some_and(|count| node >= count) || inside(node);
    let cells = of.cells.iter().copied().filter(|&cell| mesh.cell(cell).nodes.iter().all(|&node| fits(node)));
    let sides = of.sides.iter().copied().filter(|&side: &Side| mesh.side(side).1.into_iter().all(fits));
    let nodes = of.nodes.iter().copied().filter(|&node| inside(node));
    Group::new(mesh, cells.collect(), sides.collect(), nodes.collect())
}

/// Where the nodes of a group lie: `in x from 0 to 1, in y from 0 to 0`.
fn extent(group: &Group, mesh: &Mesh) -> String {
    let range = |axis: usize| {
        let x = group.nodes.iter().map(|&node| mesh.points[node][axis]);
        let (least, most) = x.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        format!("in {} from {least} to {most}", ["x", "y", "z"][axis])
    };
    let axes = if mesh.points.iter().all(|point| point[2] == 0.0) { 2 } else { 3 };
    (0..axes).map(range).collect::<Vec<_>>().join(", ")
}

/// Largest extent of the mesh.
fn size(mesh: &Mesh) -> f64 {
    (0..3).fold(0.0, |size, axis| {
        let x = mesh.points.iter().map(|point| point[axis]);
        let (low, high) = x.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        f64::max(size, high - low)
    })
}
