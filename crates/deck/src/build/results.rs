//! What a run is to write: probes and tables, found in the mesh and checked against what the model reports.

use super::vector;
use crate::diagnose::Diagnostic;
use crate::keys::{Deck, PathKeys, PrintedOf, ProbeAt, ProbeKeys};
use crate::source::Spot;
use asperity_core::declare::nearest;
use asperity_core::mesh::Mesh;
use asperity_core::model::Model;
use asperity_core::solid::Body;
use asperity_core::system::Term;
use asperity_core::tensor::Vec3;
use asperity_results::output::probe::{At, ProbeSpot, Share, Take, shares, spot};
use asperity_results::output::{Frame, Parts, Printed, Probe, QuantityPlace, ResultOptions, Source, Units, Whose};
use std::sync::Arc;

/// The options of the results of a model, and what is wrong with them.
pub fn results(deck: &Deck, model: &Model) -> (ResultOptions, Vec<Diagnostic>) {
    let mut found = Vec::new();
    let mut options = ResultOptions {
        every: deck.output.every,
        checkpoint_every: deck.output.checkpoint_every,
        pictures: deck.output.pictures,
        keep: deck.output.checkpoints,
        export: deck.output.export.clone(),
        // What is wrong with them was reported when the deck was read.
        units: deck.units.as_ref().and_then(|units| Units::parse(units).ok()),
        ..ResultOptions::default()
    };
    if deck.probe.is_empty() && deck.output.print.is_empty() {
        return (options, found);
    }
    let state = model.problem.initial_state();
    let frame = match (Source { parts: &Parts::of(model), state: &state, step: 0 }).gather() {
        Ok(frame) => frame,
        Err(error) => return (options, vec![Diagnostic::error(error.to_string())]),
    };
    options.probes = probes(deck, model, &frame, &mut found);
    options.printed = printed(deck, &frame, &mut found);
    (options, found)
}

fn probes(deck: &Deck, model: &Model, frame: &Frame, found: &mut Vec<Diagnostic>) -> Vec<Probe> {
    let mut probes = Vec::new();
    for (name, keys) in &deck.probe {
        if !name.text.chars().all(|c| c.is_alphanumeric() || "_-".contains(c)) {
            let what = format!("a probe cannot be called `{name}`: its name is that of a file");
            found.push(Diagnostic::error(what).at(name.place).help("use letters, digits, _ and -"));
            continue;
        }
        let Some(at) = place(model, keys, found) else { continue };
        if let (Some(take), false) = (&keys.take, matches!(keys.at, ProbeAt::Group(_))) {
            let what = format!("`probe.{name}.take` has no meaning: there is one value at a point");
            found.push(Diagnostic::error(what).at(take.place).help("remove it, or read `at.group`"));
        }
        let quantities = keys.quantities.iter().map(|quantity| quantity.value.clone()).collect();
        let probe = Probe { name: name.text.clone(), at, quantities };
        for (i, fault) in probe.faults(frame, deck.space.dimension() == 2) {
            found.push(Diagnostic::error(fault).at(keys.quantities[i].place));
        }
        found.extend(uncarried(deck, keys, &probe.at, frame));
        probes.push(probe);
    }
    probes
}

/// What a contact would say on nodes of which none has its points: those of the side that does not carry it.
fn uncarried(deck: &Deck, keys: &ProbeKeys, at: &At, frame: &Frame) -> Option<Diagnostic> {
    let quantity = keys.quantities.iter().find(|quantity| quantity.value.starts_with("contact_"))?;
    let (At::Nodes(shares, _), Some(status)) = (at, frame.get(QuantityPlace::Node, "contact_status_averaged")) else {
        return None;
    };
    if shares.iter().any(|share| !status.values[share.node].is_nan()) {
        return None;
    }
    let what = format!("no contact has its points here, so there is no `{}`", quantity.value);
    let other = deck.contact.iter().find_map(|(name, contact)| {
        let ProbeAt::Group(group) = &keys.at else { return None };
        let sides = [(&contact.surface, &contact.target), (&contact.target, &contact.surface)];
        sides.into_iter().find(|(side, _)| side.text == group.text).map(|(_, other)| (name, other))
    });
    let help = other.map_or("read a side that carries a contact".to_owned(), |(name, other)| {
        format!("`{other}` carries contact `{name}`: read it there, or say `contact.{name}.roles = \"given\"` with the surface that is meant")
    });
    Some(Diagnostic::error(what).at(quantity.place).help(help))
}

/// Where a probe reads; what is wrong is reported.
fn place(model: &Model, keys: &ProbeKeys, found: &mut Vec<Diagnostic>) -> Option<At> {
    let mesh = &model.mesh;
    match &keys.at {
        ProbeAt::Group(name) => {
            let takes = keys.take.as_ref().map_or_else(|| vec![Take::Mean], |take| take.value.clone());
            Some(At::Nodes(shares(mesh, mesh.groups.get(&name.text)?, model.space), takes))
        }
        ProbeAt::Node(number) => {
            let node = (0..mesh.points.len()).find(|&node| mesh.node_number(node) == number.value as u64);
            if node.is_none() {
                let what = format!("there is no node {}", number.value);
                let numbers = (0..mesh.points.len()).map(|node| mesh.node_number(node));
                let range = numbers.fold([u64::MAX, 0], |[low, high], n| [low.min(n), high.max(n)]);
                let help = format!("nodes have numbers from {} to {}", range[0], range[1]);
                found.push(Diagnostic::error(what).at(number.place).help(help));
            }
            Some(At::Nodes(vec![Share { node: node?, part: 1.0 }], vec![Take::Mean]))
        }
        ProbeAt::Point(point) => {
            let x = coordinates(model, point, found)?;
            let Some(spot) = spot(mesh, cells(model), x) else {
                found
                    .push(Diagnostic::error("there is no material at this point").at(point.place).help(near(model, x)));
                return None;
            };
            found.extend(several(model, &spot).map(|warning| warning.at(point.place)));
            Some(At::Point(spot))
        }
        ProbeAt::Path(keys) => path(model, keys, found),
    }
}

fn path(model: &Model, keys: &PathKeys, found: &mut Vec<Diagnostic>) -> Option<At> {
    let (from, to) = (coordinates(model, &keys.from, found), coordinates(model, &keys.to, found));
    let (from, to) = (from?, to?);
    let mut spots = Vec::new();
    for i in 0..keys.points {
        let part = i as f64 / (keys.points - 1) as f64;
        let x = from * (1.0 - part) + to * part;
        match spot(&model.mesh, cells(model), x) {
            Some(spot) => spots.push(((x - from).norm(), spot)),
            None => {
                let what =
                    format!("point {} of the path lies at {}, where there is no material", i + 1, words(model, x));
                found.push(Diagnostic::error(what).at(keys.place).help(near(model, x)));
                return None;
            }
        }
    }
    let shared = spots.iter().find_map(|(_, spot)| several(model, spot));
    found.extend(shared.map(|warning| warning.at(keys.place)));
    Some(At::Path(spots))
}

/// What to say of a point that lies in several bodies, of which one is read.
fn several(model: &Model, read: &ProbeSpot) -> Option<Diagnostic> {
    let within = |(body, _): &(Arc<Body>, usize)| {
        let spot = spot(&model.mesh, body.cells().iter().copied(), read.point)?;
        Some((body.name().to_owned(), spot == *read))
    };
    let names: Vec<_> = model.bodies.iter().filter_map(within).collect();
    let (own, _) = names.iter().find(|(_, own)| *own)?;
    (names.len() > 1).then(|| {
        let all = names.iter().map(|(name, _)| format!("`{name}`")).collect::<Vec<_>>().join(" and ");
        let what = format!("the point at {} lies in {all}, and the probe reads `{own}`", words(model, read.point));
        Diagnostic::warning(what).help("a point inside one of them, or `at.node`, `at.group` of one")
    })
}

/// The cells of all bodies.
fn cells(model: &Model) -> impl Iterator<Item = usize> {
    model.bodies.iter().flat_map(|(body, _)| body.cells()).copied()
}

fn coordinates(model: &Model, point: &Spot<Vec<f64>>, found: &mut Vec<Diagnostic>) -> Option<Vec3> {
    let dimension = model.space.dimension();
    if point.len() != dimension {
        let what = format!("a point has {dimension} coordinates where space = \"{}\"", model.space.name());
        found.push(Diagnostic::error(what).at(point.place));
        return None;
    }
    Some(vector(point) - model.mesh.origin)
}

fn words(model: &Model, x: Vec3) -> String {
    let coordinates: Vec<String> =
        (x + model.mesh.origin).0[..model.space.dimension()].iter().map(f64::to_string).collect();
    format!("[{}]", coordinates.join(", "))
}

/// The node nearest to a place.
fn near(model: &Model, x: Vec3) -> String {
    let mesh: &Mesh = &model.mesh;
    let apart = |node: &usize| (mesh.points[*node] - x).norm();
    let node = (0..mesh.points.len()).min_by(|a, b| apart(a).total_cmp(&apart(b)));
    node.map_or(String::new(), |node| {
        format!("the nearest node is {} at {}", mesh.node_number(node), words(model, mesh.points[node]))
    })
}

fn printed(deck: &Deck, frame: &Frame, found: &mut Vec<Diagnostic>) -> Vec<Printed> {
    let mut all = Vec::new();
    for keys in &deck.output.print {
        let whose = match &keys.of {
            PrintedOf::Nodes(name) => Whose::Nodes(name.text.clone()),
            PrintedOf::Cells(name) => Whose::Cells(name.text.clone()),
            PrintedOf::Contact(name) => Whose::Contact(name.text.clone()),
        };
        let known = || frame.at(whose.place()).map(|quantity| quantity.name.as_str());
        for quantity in keys.quantities.iter().filter(|quantity| known().all(|name| name != quantity.value)) {
            let what = format!("there is no quantity `{}` here", quantity.value);
            let near =
                nearest(&quantity.value, known()).map_or(String::new(), |near| format!("did you mean `{near}`?"));
            let help = format!("there are {}", known().collect::<Vec<_>>().join(", "));
            found.push(Diagnostic::error(what).at(quantity.place).label(near).help(help));
        }
        let quantities = keys.quantities.iter().map(|quantity| quantity.value.clone()).collect();
        all.push(Printed { whose, quantities, totals: keys.totals });
    }
    all
}
