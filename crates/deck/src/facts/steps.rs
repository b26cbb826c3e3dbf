//! Steps: how far they move things, and the stresses that their loads amount to.

use super::{bodies_of, extent, sides};
use crate::build::Made;
use crate::keys::{Components, Displacement, StepKeys};
use crate::reader::Name;
use asperity_core::amplitude::Amplitude;
use asperity_core::mesh::Space;
use asperity_core::model::Model;
use asperity_core::solid::Body;
use asperity_core::solve::Course;
use asperity_core::system::Term;
use asperity_core::tensor::Vec3;
use asperity_results::diagnosis::{Load, StepFacts};
use std::collections::{BTreeMap, BTreeSet};

/// What is known of the steps.
pub(super) fn facts(made: &Made) -> Vec<StepFacts> {
    let dofs = &made.model.problem.dofs;
    let (bodies, mut last) = (dofs.node(dofs.nodes()), BTreeMap::new());
    let solved = made.model.problem.steps.iter().zip(&made.deck.step);
    let fact = |(step, keys): (&asperity_core::solve::Step, &StepKeys)| {
        let mut facts = StepFacts {
            name: step.name.clone(),
            follows: step.arc_length.is_some(),
            first: step.increments.first,
            largest: step.increments.largest,
            smallest: step.increments.smallest,
            most: step.increments.most,
            loads: loads(made, keys),
            gravity: keys.gravity.as_ref().map(size),
            ..StepFacts::default()
        };
        for prescribed in &step.prescribed {
            let Course::To(end, _) = &prescribed.course else { continue };
            let before = last.insert(prescribed.dof, *end).unwrap_or(0.0);
            let (way, dof) = ((end - before).abs(), prescribed.dof);
            if dof < bodies {
                facts.moved = facts.moved.max(way);
            } else if !dofs.is_rotation(dof) {
                facts.driven = facts.driven.max(way);
            }
        }
        facts
    };
    let mut all: Vec<StepFacts> = solved.map(fact).collect();
    for (facts, two) in all.iter_mut().skip(1).zip(made.deck.step.windows(2)) {
        facts.repeats = facts.loads.is_empty() && repeats(&two[0], &two[1]);
    }
    all
}

/// Whether all that a step says are displacements that the step before led to already.
fn repeats(before: &StepKeys, step: &StepKeys) -> bool {
    let others = [&step.hold, &step.remove, &step.add, &step.release].iter().all(|names| names.is_empty())
        && step.motion.is_empty()
        && step.temperature.is_empty()
        && step.friction.is_empty()
        && step.spring.is_empty()
        && step.gravity.is_none();
    let values = |keys: &Displacement| [keys.x, keys.y, keys.z.map(|z| z.value), keys.value];
    let said = |(name, keys): &(Name, Displacement)| {
        let known = before.displacement.iter().find(|(other, _)| other.text == name.text);
        known.is_some_and(|(_, known)| values(known) == values(keys)) && keys.amplitude == Amplitude::ramp()
    };
    let moves = |(_, keys): &(Name, Displacement)| values(keys).into_iter().flatten().any(|value| value != 0.0);
    others && step.displacement.iter().all(said) && step.displacement.iter().any(moves)
}

/// The loads that a step says, as stresses.
fn loads(made: &Made, step: &StepKeys) -> Vec<Load> {
    let model = &made.model;
    let of_sides = |name: &Name| bodies_of(model, sides(model, name).iter().map(|side| side.cell));
    let of_cells = |name: &Name| {
        let group = model.mesh.groups.get(&name.text);
        bodies_of(model, group.into_iter().flat_map(|group| group.cells.iter().copied()))
    };
    let load = |kind: &str, name: &Name, bodies: Vec<String>, stress: f64| Load {
        name: format!("{kind}.{name}"),
        bodies,
        stress,
    };
    let mut all: Vec<Load> = Vec::new();
    all.extend(step.pressure.iter().map(|(name, keys)| load("pressure", name, of_sides(name), keys.value.abs())));
    all.extend(step.traction.iter().map(|(name, keys)| load("traction", name, of_sides(name), size(keys))));
    for (name, keys) in &step.force {
        let Some(group) = model.mesh.groups.get(&name.text) else { continue };
        let loaded = of_nodes(model, name);
        let section = loaded.first().map_or(f64::INFINITY, |body| section(model, body, keys.vector()));
        let stress = size(keys) * group.nodes.len() as f64 / section;
        all.push(load("force", name, loaded, stress));
    }
    for (name, keys) in &step.load {
        let force = [keys.x, keys.y, keys.z.map(|z| z.value)].map(Option::unwrap_or_default);
        let met = made.deck.contact.iter().find(|(_, contact)| contact.target.text == name.text);
        let rigid = made.deck.rigid.iter().find(|(rigid, _)| rigid.text == name.text).map(|(_, keys)| &keys.group);
        let spread =
            made.deck.distributing.iter().find(|(point, _)| point.text == name.text).map(|(_, keys)| &keys.group);
        let bodies = match rigid.or(spread) {
            Some(group) => of_nodes(model, group),
            None => met.map(|(_, contact)| of_sides(&contact.surface)).unwrap_or_default(),
        };
        let section = bodies.first().map_or(f64::INFINITY, |body| section(model, body, force));
        let stress = force.into_iter().map(f64::abs).fold(0.0, f64::max) / section;
        all.push(load("load", name, bodies, stress));
    }
    for (name, keys) in &step.body_force {
        let bodies = of_cells(name);
        let length = bodies.first().map_or(0.0, |body| length(model, body));
        all.push(load("body_force", name, bodies, size(keys) * length));
    }
    if let Some(gravity) = &step.gravity {
        for (name, keys) in &made.deck.body {
            let Some(density) = keys.density else { continue };
            let stress = density.value * size(gravity) * length(model, &name.text);
            all.push(Load { name: "gravity".into(), bodies: vec![name.text.clone()], stress });
        }
    }
    all.retain(|load| load.stress > 0.0 && load.stress.is_finite());
    all
}

/// Names of the bodies of the nodes of a group.
fn of_nodes(model: &Model, group: &Name) -> Vec<String> {
    let nodes: BTreeSet<usize> =
        model.mesh.groups.get(&group.text).into_iter().flat_map(|group| group.nodes.iter().copied()).collect();
    let touches =
        |body: &Body| body.cells().iter().any(|&c| model.mesh.cell(c).nodes.iter().any(|n| nodes.contains(n)));
    model.bodies.iter().filter(|(body, _)| touches(body)).map(|(body, _)| body.name().to_owned()).collect()
}

fn size(load: &impl Components) -> f64 {
    Vec3(load.vector()).norm()
}

/// The box about a body.
fn bounds(model: &Model, name: &str) -> Vec3 {
    let body = model.bodies.iter().find(|(body, _)| body.name() == name);
    let nodes = body.into_iter().flat_map(|(body, _)| body.cells()).flat_map(|&cell| model.mesh.cell(cell).nodes);
    extent(nodes.map(|&node| model.mesh.points[node]))
}

fn length(model: &Model, body: &str) -> f64 {
    bounds(model, body).0.into_iter().fold(0.0, f64::max)
}

/// Section of the box about a body across the axis along which most of a load acts.
fn section(model: &Model, body: &str, load: [f64; 3]) -> f64 {
    let along = (0..3).max_by(|&i, &j| load[i].abs().total_cmp(&load[j].abs())).unwrap_or(0);
    let [x, y, z] = bounds(model, body).0;
    let section = match (model.space, along) {
        (Space::Solid, _) => [y * z, z * x, x * y][along],
        (Space::Axisymmetric, 0) => 2.0 * std::f64::consts::PI * model.mesh.bounds().max[0] * y,
        (Space::Axisymmetric, _) => 2.0 * std::f64::consts::PI * model.mesh.bounds().max[0] * x,
        (_, along) => [y, x, x][along] * model.thickness,
    };
    section.max(f64::MIN_POSITIVE)
}
