//! Names: each one that is referred to must name something, in the deck or in the mesh.

use super::diagnose::Diagnostic;
use super::reader::{Mention, Name, Reader};
use super::schema::Names;
use asperity_core::mesh::{Group, Mesh};

/// Reports names of nothing, with the nearest name of something, and things that nobody names. Without a mesh, groups
/// are not looked for: its own fault is reported already.
pub fn resolve(mesh: Option<&Mesh>, reader: &mut Reader) {
    let mentions = std::mem::take(&mut reader.mentions);
    for mention in mentions.iter().filter(|mention| !mention.defines) {
        reader.diagnostics.extend(dangling(mention, &mentions, mesh));
    }
    // While there are errors, what seems idle may just be misspelt where it is used.
    if reader.errors() == 0 {
        let defined = mentions.iter().filter(|mention| mention.defines);
        reader.diagnostics.extend(defined.filter_map(|mention| idle(mention, &mentions)));
    }
    reader.mentions = mentions;
}

fn defined(mentions: &[Mention], names: Names) -> Vec<&str> {
    mentions.iter().filter(|m| m.defines && m.names == names).map(|m| m.name.text.as_str()).collect()
}

fn dangling(mention: &Mention, mentions: &[Mention], mesh: Option<&Mesh>) -> Option<Diagnostic> {
    let Mention { names, name, .. } = mention;
    match names {
        Names::Condition => None,
        Names::Target => target(mention, mentions, mesh),
        Names::Movable => movable(mention, mentions, mesh),
        // Whether a group of cells is a body is seen when contacts are looked for.
        Names::Removable if mesh.is_some_and(|mesh| has_cells(mesh, name)) => None,
        Names::Removable | Names::Loadable => {
            let first = if *names == Names::Loadable { Names::Distributing } else { Names::Contact };
            let valid = [defined(mentions, first), defined(mentions, Names::Tool)].concat();
            (!valid.contains(&name.text.as_str()))
                .then(|| otherwise(nothing(name, *names, &valid), name, mentions, mesh))
        }
        Names::Group | Names::Cells | Names::Sides => {
            let found = group(name, *names, mesh?).map(|diagnostic| otherwise(diagnostic, name, mentions, mesh))?;
            let tool = *names == Names::Group && defined(mentions, Names::Tool).contains(&name.text.as_str());
            Some(if tool { found.help("a tool is moved by `motion`") } else { found })
        }
        _ => {
            let valid = defined(mentions, *names);
            (!valid.contains(&name.text.as_str()))
                .then(|| otherwise(nothing(name, *names, &valid), name, mentions, mesh))
        }
    }
}

fn has_cells(mesh: &Mesh, name: &Name) -> bool {
    mesh.groups.get(&name.text).is_some_and(|group| !group.cells.is_empty())
}

/// A tool or a group with nodes.
fn movable(Mention { names, name, .. }: &Mention, mentions: &[Mention], mesh: Option<&Mesh>) -> Option<Diagnostic> {
    let mut valid = defined(mentions, Names::Tool);
    if valid.contains(&name.text.as_str()) {
        return None;
    }
    let mesh = mesh?;
    if mesh.groups.contains_key(&name.text) {
        return group(name, Names::Group, mesh);
    }
    valid.extend(mesh.groups.iter().filter(|(_, group)| !group.nodes.is_empty()).map(|(name, _)| name.as_str()));
    Some(otherwise(nothing(name, *names, &valid), name, mentions, Some(mesh)))
}

/// A tool or a group of sides, and not both.
fn target(Mention { names, name, .. }: &Mention, mentions: &[Mention], mesh: Option<&Mesh>) -> Option<Diagnostic> {
    let mut valid = defined(mentions, Names::Tool);
    if !valid.contains(&name.text.as_str()) {
        let mesh = mesh?;
        let Some(known) = mesh.groups.get(&name.text) else {
            valid
                .extend(mesh.groups.iter().filter(|(_, group)| !group.sides.is_empty()).map(|(name, _)| name.as_str()));
            return Some(otherwise(nothing(name, *names, &valid), name, mentions, Some(mesh)));
        };
        let whole = !known.cells.is_empty() && known.sides.is_empty();
        let help = "a body is touched at its surface: name a group of its sides";
        return group(name, Names::Sides, mesh).map(|found| if whole { found.help(help) } else { found });
    }
    mesh?.groups.contains_key(&name.text).then(|| {
        Diagnostic::error(format!("`{name}` is both a tool and a group")).at(name.place).help("rename the tool")
    })
}

fn nothing(name: &Name, names: Names, valid: &[&str]) -> Diagnostic {
    let noun = names.noun();
    let diagnostic = Diagnostic::error(format!("there is no {noun} `{name}`")).at(name.place);
    match valid {
        [] => diagnostic.help(format!("there is no {noun} at all")),
        _ => diagnostic.suggest(&name.text, valid.iter().copied()),
    }
}

/// Says what a name means instead, where it names something of another kind.
fn otherwise(diagnostic: Diagnostic, name: &Name, mentions: &[Mention], mesh: Option<&Mesh>) -> Diagnostic {
    let kinds = [Names::Tool, Names::Material, Names::Contact, Names::Distributing];
    let other = kinds.into_iter().find(|&kind| defined(mentions, kind).contains(&name.text.as_str()));
    let group = mesh.is_some_and(|mesh| mesh.groups.contains_key(&name.text)).then_some(Names::Group);
    match other.map(Names::noun).or(group.filter(|_| diagnostic.what.starts_with("there is no")).map(Names::noun)) {
        Some(noun) if diagnostic.label.is_empty() => diagnostic.label(format!("this is the name of a {noun}")),
        _ => diagnostic,
    }
}

/// What is wrong with the name of a group.
fn group(name: &Name, names: Names, mesh: &Mesh) -> Option<Diagnostic> {
    let fits = |group: &Group| match names {
        Names::Cells => !group.cells.is_empty(),
        Names::Sides => !group.sides.is_empty(),
        _ => !group.nodes.is_empty(),
    };
    let valid = || {
        let groups = mesh.groups.iter().filter(|(_, group)| fits(group));
        groups.map(|(name, _)| name.as_str()).collect::<Vec<_>>()
    };
    let inside = |group: &Group| matches!(names, Names::Sides) && !group.inner.is_empty();
    match mesh.groups.get(&name.text) {
        Some(group) if inside(group) => {
            mesh.surface(&name.text).err().map(|e| Diagnostic::error(e.to_string()).at(name.place))
        }
        Some(group) if fits(group) => None,
        Some(group) => {
            let what = format!("the group `{name}` has no {}", if names == Names::Cells { "cells" } else { "sides" });
            let what = if group.nodes.is_empty() { format!("the group `{name}` is empty") } else { what };
            Some(Diagnostic::error(what).at(name.place).suggest(&name.text, valid()))
        }
        None => Some(nothing(name, names, &valid())),
    }
}

/// A material or a tool that nothing uses is most likely a slip.
fn idle(mention: &Mention, mentions: &[Mention]) -> Option<Diagnostic> {
    let Mention { names, name, .. } = mention;
    let also = match names {
        Names::Tool => &[Names::Target, Names::Loadable][..],
        _ => &[Names::Loadable],
    };
    let kind = |other: &Mention| other.names == *names || also.contains(&other.names);
    let uses = |other: &Mention| kind(other) && !other.defines && other.name.text == name.text;
    let watched = matches!(names, Names::Material | Names::Tool | Names::Distributing);
    (watched && !mentions.iter().any(uses))
        .then(|| Diagnostic::warning(format!("nothing uses the {} `{name}`", names.noun())).at(name.place))
}
