//! Contacts: gaps, sides, penalties.

use super::{bodies_of, extent, sides};
use crate::build::{Made, backings};
use crate::keys::{Components, Contact};
use crate::reader::Name;
use crate::review::Seen;
use asperity_core::contact::{Backing, default_penalty};
use asperity_core::mesh::{Side, Space};
use asperity_core::system::Term;
use asperity_core::tensor::Vec3;
use asperity_results::diagnosis::ContactFacts;
use std::collections::BTreeSet;

/// Nodes that distances are looked for from, at most.
const SAMPLE: usize = 200;

/// What is known of the contacts, with what they see.
pub(super) fn facts(made: &Made, all: &[Seen]) -> Vec<ContactFacts> {
    let backings = backings(&made.model.mesh, &made.deck, made.model.bodies.iter().map(|(body, _)| body.as_ref()));
    made.deck.contact.iter().map(|(name, keys)| contact_facts(made, (name, keys), all, &backings)).collect()
}

fn contact_facts(made: &Made, (name, keys): (&Name, &Contact), all: &[Seen], backings: &[Backing]) -> ContactFacts {
    let (model, mesh) = (&made.model, &made.model.mesh);
    let tool = made.deck.tool.iter().position(|(tool, _)| tool.text == keys.target.text);
    let surface = sides(model, &keys.surface);
    let target = if tool.is_some() { &[] } else { sides(model, &keys.target) };
    let behind = |sides: &[Side]| sides.iter().map(|side| side.cell).collect::<Vec<_>>().into_iter();
    let mut bodies = bodies_of(model, behind(surface));
    for other in bodies_of(model, behind(target)) {
        if !bodies.contains(&other) {
            bodies.push(other);
        }
    }
    let nodes =
        |sides: &[Side]| sides.iter().flat_map(|side| mesh.side(*side).1.collect::<Vec<_>>()).collect::<BTreeSet<_>>();
    let own = sampled(&nodes(surface));
    let (inside, distance) = match tool {
        Some(tool) => {
            let audit = model.problem.audit.as_ref();
            let gap = |x: Vec3| audit.map_or(f64::INFINITY, |audit| audit.distance(tool, x));
            let of_body: BTreeSet<usize> = model
                .bodies
                .iter()
                .filter(|(body, _)| bodies.first().is_some_and(|name| name == body.name()))
                .flat_map(|(body, _)| body.cells())
                .flat_map(|&cell| mesh.cell(cell).nodes)
                .copied()
                .collect();
            let of_body = sampled(&of_body);
            let tiny = 1e-6 * mesh.size();
            let inside = of_body.iter().filter(|&&node| gap(mesh.points[node]) < -tiny).count();
            let distance = own.iter().map(|&node| gap(mesh.points[node]).abs()).fold(f64::INFINITY, f64::min);
            (inside as f64 / of_body.len().max(1) as f64, distance)
        }
        None => {
            let others = sampled(&nodes(target));
            let nearest = |&node: &usize| {
                let away = |&other: &usize| (mesh.points[node] - mesh.points[other]).norm();
                others.iter().filter(|other| **other != node).map(away).fold(f64::INFINITY, f64::min)
            };
            let itself = surface == target;
            (0.0, if itself { 0.0 } else { own.iter().map(nearest).fold(f64::INFINITY, f64::min) })
        }
    };
    let seen: Vec<&Seen> = Seen::of(all, name).collect();
    let found = || seen.iter().flat_map(|seen| &seen.found);
    let edges =
        surface.iter().map(|side| edge(mesh.side(*side).1.map(|node| mesh.points[node]).collect(), model.space));
    let both = [surface, target];
    let computed =
        default_penalty((mesh, model.space), if tool.is_some() { &both[..1] } else { &both }, |cell| backings[cell]);
    let friction = keys.law.entry.parameters.iter().position(|parameter| parameter.key == "friction");
    ContactFacts {
        name: name.text.clone(),
        bodies,
        tool: tool.map(|_| keys.target.text.clone()),
        points: seen.iter().map(|seen| seen.points).sum(),
        seeing: found().count(),
        gap: found().map(|(u, _)| -u).reduce(f64::min),
        inside,
        itself: surface == target,
        distance,
        edge: edges.fold(f64::INFINITY, f64::min),
        penalty: keys.penalty.map(|given| given / computed.value),
        friction: friction.and_then(|at| keys.law.values.get(at).copied()),
        slope: slope(made, surface),
    }
}

/// The part of the weight along a surface, as a mean, over that across it; none where the first step has another load, or no weight.
fn slope(made: &Made, surface: &[Side]) -> Option<f64> {
    let step = made.deck.step.first()?;
    let weight = Vec3(step.gravity.as_ref().filter(|_| !step.is_loaded())?.vector());
    let mesh = &made.model.mesh;
    let area = |side: &Side| mesh.frame(*side).1 * mesh.extent(*side);
    let normal = surface.iter().fold(Vec3::zero(), |sum, side| sum + area(side)).unit();
    let across = weight.dot(normal);
    (across != 0.0).then(|| (weight - normal * across).norm() / across.abs())
}

/// Length of an edge, or the root of the area of the box about a face.
fn edge(corners: Vec<Vec3>, space: Space) -> f64 {
    let mut sizes = extent(corners.into_iter()).0;
    sizes.sort_by(|a, b| b.total_cmp(a));
    if space == Space::Solid { (sizes[0] * sizes[1]).sqrt() } else { (sizes[0].powi(2) + sizes[1].powi(2)).sqrt() }
}

fn sampled(nodes: &BTreeSet<usize>) -> Vec<usize> {
    nodes.iter().copied().step_by(nodes.len() / SAMPLE + 1).collect()
}
