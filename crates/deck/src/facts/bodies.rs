//! Bodies: stiffness, strength, what holds them and how far they are pressed together.

use super::extent;
use crate::build::Made;
use asperity_core::material::Material;
use asperity_core::mesh::Space;
use asperity_core::model::Model;
use asperity_core::solid::{Body, Strain};
use asperity_core::solve::Course;
use asperity_core::system::{Row, Term};
use asperity_core::tensor::Tensor2;
use asperity_results::diagnosis::BodyFacts;
use std::collections::{BTreeMap, BTreeSet};

/// What is known of a body.
pub(super) fn facts(made: &Made, body: &Body, material: usize) -> BodyFacts {
    let (model, mesh) = (&made.model, &made.model.mesh);
    let [confined, shear] = body.material().moduli();
    let bulk = confined - 4.0 / 3.0 * shear;
    let keys = made.deck.body.iter().find(|(name, _)| name.text == body.name()).map(|(_, keys)| keys);
    let law = made.deck.material.get(material).map_or("", |(_, law)| law.name());
    let plastic = ["von_mises", "perzyna", "gurson"].iter().any(|known| law.starts_with(known));
    let nodes: BTreeSet<usize> = body.cells().iter().flat_map(|&cell| mesh.cell(cell).nodes).copied().collect();
    let [yield_stress, strength] = if plastic { yields(body.material().as_ref(), shear) } else { [None; 2] };
    // What is glued to it is held with it.
    let wholes = model.problem.wholes.iter().filter(|whole| whole.nodes().any(|node| nodes.contains(&node)));
    let together: BTreeSet<usize> = wholes.flat_map(|whole| whole.nodes()).collect();
    let held = model.supports.iter().any(|(_, held)| held.iter().any(|node| together.contains(node)));
    let springs = made.deck.step.iter().flat_map(|step| &step.spring);
    let sprung = springs
        .filter_map(|(name, _)| mesh.groups.get(&name.text))
        .any(|g| g.nodes.iter().any(|n| together.contains(n)));
    BodyFacts {
        name: body.name().into(),
        material: made.model.materials.get(material).cloned().unwrap_or_default(),
        law: made.deck.material.get(material).map_or_else(Default::default, |(_, law)| (law.name(), law.numbers())),
        prestressed: keys.is_some_and(|keys| keys.initial_stress.is_some()),
        driven_whole: driven_whole(made, body),
        size: extent(nodes.iter().map(|&node| mesh.points[node])).norm(),
        cell: body
            .cells()
            .iter()
            .map(|&cell| mesh.measure(cell).powf(1.0 / model.space.dimension() as f64))
            .fold(f64::INFINITY, f64::min),
        young: if shear > 0.0 { 9.0 * bulk * shear / (3.0 * bulk + shear) } else { confined },
        bulk_ratio: bulk / shear.max(f64::MIN_POSITIVE),
        yield_stress,
        strength,
        density: keys.and_then(|keys| keys.density).map(|density| density.value),
        locks: body.choices().iter().any(|choice| choice.kind.degree == 1 && choice.locks),
        hourglass: body.unseen() > 0,
        small_strain: keys.is_some_and(|keys| *keys.strain == Strain::Small),
        left: if fills(model, body, &nodes) { left(model, &nodes) } else { 1.0 },
        unheld: if sprung { Vec::new() } else { unheld(model, &together) },
        held: held || sprung,
    }
}

/// The first step that moves the group of a body of several cells, all of its nodes, and not one of its sides.
fn driven_whole(made: &Made, body: &Body) -> Option<String> {
    let moves = |step: &&crate::keys::StepKeys| step.displacement.iter().any(|(group, _)| group.text == body.name());
    let step = made.deck.step.iter().position(|step| moves(&step)).filter(|_| body.cells().len() > 1)?;
    Some(made.model.problem.steps[step].name.clone())
}

/// Axes along which no step constrains any of some nodes.
fn unheld(model: &Model, nodes: &BTreeSet<usize>) -> Vec<&'static str> {
    let dofs = &model.problem.dofs;
    let glued: BTreeSet<usize> = model.ties.iter().flat_map(|(_, tie)| tie.nodes[0].iter().copied()).collect();
    let free = |dof: usize| {
        let follows = |row: &Row| matches!(row, Row::Combined(_)) && glued.contains(&(dof / dofs.per_node()));
        model
            .problem
            .steps
            .iter()
            .all(|step| matches!(step.constraints.row(dof), Row::Free(_)) || follows(step.constraints.row(dof)))
    };
    let axes = (0..dofs.per_node()).filter(|axis| nodes.iter().all(|&node| free(dofs.node(node) + axis)));
    axes.filter(|&axis| model.space != Space::Axisymmetric || axis != 0).map(|axis| ["x", "y", "z"][axis]).collect()
}

/// Part of the box about a body from which on its ends cannot come together without crushing it.
const MASSIVE: f64 = 0.5;

fn fills(model: &Model, body: &Body, nodes: &BTreeSet<usize>) -> bool {
    let sizes = extent(nodes.iter().map(|&node| model.mesh.points[node]));
    let space: f64 = sizes.0[..model.space.dimension()].iter().product();
    body.cells().iter().map(|&cell| model.mesh.measure(cell)).sum::<f64>() > MASSIVE * space
}

/// Part of the distance of the ends of some nodes along any axis that prescribed motions leave, at the least.
fn left(model: &Model, nodes: &BTreeSet<usize>) -> f64 {
    (0..model.problem.dofs.per_node()).map(|axis| left_along(model, nodes, axis)).fold(1.0, f64::min)
}

fn left_along(model: &Model, nodes: &BTreeSet<usize>, axis: usize) -> f64 {
    let (dofs, place) = (&model.problem.dofs, |node: usize| model.mesh.points[node][axis]);
    let ends = nodes
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &node| [low.min(place(node)), high.max(place(node))]);
    let (length, mut driven, mut least) = (ends[1] - ends[0], BTreeMap::new(), 1.0_f64);
    for step in &model.problem.steps {
        for prescribed in step.prescribed.iter().filter(|prescribed| prescribed.others.is_empty()) {
            if let Course::To(way, _) = prescribed.course {
                driven.insert(prescribed.dof, way);
            }
        }
        // Mean prescribed motion of the nodes at each end; what is held and not driven stays.
        let mut ways = [(0.0, 0.0); 2];
        for &node in nodes {
            let (dof, place) = (dofs.node(node) + axis, place(node));
            let end = ends.iter().position(|end| (place - end).abs() < 1e-6 * length);
            if let (Some(end), Row::Fixed) = (end, step.constraints.row(dof)) {
                let way = driven.get(&dof).copied().unwrap_or(0.0);
                ways[end] = (ways[end].0 + way, ways[end].1 + 1.0);
            }
        }
        let [(low, below), (high, above)] = ways;
        if below > 0.0 && above > 0.0 {
            least = least.min((length + high / above - low / below) / length);
        }
    }
    least
}

/// Shears that a law is tried at: from where everything is elastic to where little is, in equal ratios.
const SHEARS: [f64; 2] = [1e-7, 1.0];
const RATIO: f64 = 1.3;
/// Part of the elastic stress below which a law has yielded, and time in which it does so at rest.
const YIELDED: f64 = 0.97;
const SLOWLY: f64 = 1e9;

/// Equivalent stress at first yield in shear, and at a shear of one.
fn yields(material: &dyn Material, shear: f64) -> [Option<f64>; 2] {
    let mut old = vec![0.0; material.state_len()];
    material.initialise(&mut old);
    let mut new = old.clone();
    let mut stress = |gamma: f64| {
        let mut f = Tensor2::identity();
        f[(0, 1)] = gamma;
        material.update(&f, SLOWLY.into(), &old, &mut new).ok().map(|()| new[3].abs())
    };
    let mut gamma = SHEARS[0];
    while gamma < SHEARS[1] {
        match stress(gamma) {
            Some(tau) if tau < YIELDED * shear * gamma => {
                let root = 3.0_f64.sqrt();
                return [Some(root * tau), stress(SHEARS[1]).map(|tau| root * tau)];
            }
            Some(_) => gamma *= RATIO,
            None => return [None; 2],
        }
    }
    [None; 2]
}
