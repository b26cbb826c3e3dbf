//! What a diagnosis asks of a model: stiffness and strength of its bodies, gaps, sides and penalties of its contacts, sizes of
//! motions and loads.

use super::build::{Made, backings};
use super::keys::{Components, Contact, Step};
use super::reader::Name;
use super::review::Seen;
use crate::contact::{Backing, default_penalty};
use crate::diagnosis::{BodyFacts, ContactFacts, Facts, Load, StepFacts, ToolFacts};
use crate::material::Material;
use crate::mesh::cells::Cell;
use crate::mesh::{Side, Space};
use crate::model::Model;
use crate::solid::{Body, Formulation, Integration, Strain};
use crate::solve::Course;
use crate::system::{Row, Term};
use crate::tensor::{Tensor2, Vec3};
use std::collections::{BTreeMap, BTreeSet};

/// Nodes that distances are looked for from, at most.
const SAMPLE: usize = 200;

/// What is known of a model before it runs.
pub fn facts(made: &Made) -> Facts {
    let (model, solver) = (&made.model, &made.deck.solver);
    let off = [("`solver.piecewise = false`", solver.piecewise), ("`solver.line_search = false`", solver.line_search)];
    Facts {
        size: model.mesh.size(),
        bodies: model.bodies.iter().map(|(body, material)| body_facts(made, body, *material)).collect(),
        contacts: contacts(made),
        tools: tools(model),
        steps: steps(made),
        tolerance: solver.tolerance,
        iterations: solver.iterations,
        switched_off: off.iter().filter(|(_, on)| !on).map(|(key, _)| *key).collect(),
    }
}

fn body_facts(made: &Made, body: &Body, material: usize) -> BodyFacts {
    let (model, mesh) = (&made.model, &made.model.mesh);
    let [confined, shear] = body.material().moduli();
    let bulk = confined - 4.0 / 3.0 * shear;
    let keys = made.deck.body.iter().find(|(name, _)| name.text == body.name()).map(|(_, keys)| keys);
    let law = made.deck.material.get(material).map_or("", |(_, law)| law.entry.name);
    let plastic = ["von_mises", "perzyna", "gurson"].iter().any(|known| law.starts_with(known));
    let nodes: BTreeSet<usize> = body.cells().iter().flat_map(|&cell| mesh.cell(cell).nodes).copied().collect();
    let [yield_stress, strength] = if plastic { yields(body.material().as_ref(), shear) } else { [None; 2] };
    let standard = keys.is_some_and(|keys| *keys.formulation == Formulation::Standard);
    let full = keys.is_some_and(|keys| *keys.integration == Integration::Full);
    let locks = |kind: &'static Cell| kind.degree == 1 && standard && (full || kind.reduced.is_none());
    let held = model.supports.iter().any(|(_, held)| held.iter().any(|node| nodes.contains(node)));
    let springs = made.deck.step.iter().flat_map(|step| &step.spring);
    let sprung =
        springs.filter_map(|(name, _)| mesh.groups.get(&name.text)).any(|g| g.nodes.iter().any(|n| nodes.contains(n)));
    BodyFacts {
        name: body.name().into(),
        material: made.model.materials.get(material).cloned().unwrap_or_default(),
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
        locks: body.cells().iter().any(|&cell| locks(mesh.cell(cell).kind)),
        hourglass: body.unseen() > 0,
        small_strain: keys.is_some_and(|keys| *keys.strain == Strain::Small),
        left: left(model, &nodes),
        unheld: if sprung { Vec::new() } else { unheld(model, &nodes) },
        held: held || sprung,
    }
}

/// Axes along which no step constrains any of some nodes.
fn unheld(model: &Model, nodes: &BTreeSet<usize>) -> Vec<&'static str> {
    let dofs = &model.problem.dofs;
    let free = |dof: usize| model.problem.steps.iter().all(|step| matches!(step.constraints.row(dof), Row::Free(_)));
    let axes = (0..dofs.per_node()).filter(|axis| nodes.iter().all(|&node| free(dofs.node(node) + axis)));
    axes.filter(|&axis| model.space != Space::Axisymmetric || axis != 0).map(|axis| ["x", "y", "z"][axis]).collect()
}

/// Part of the distance of the ends of some nodes along an axis that prescribed motions leave, at the least.
fn left(model: &Model, nodes: &BTreeSet<usize>) -> f64 {
    let (dofs, points) = (&model.problem.dofs, &model.mesh.points);
    let mut least = 1.0_f64;
    for axis in 0..dofs.per_node() {
        let place = |node: usize| points[node][axis];
        let ends = nodes.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &node| {
            [low.min(place(node)), high.max(place(node))]
        });
        let (length, mut driven) = (ends[1] - ends[0], BTreeMap::new());
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
        material.update(&f, SLOWLY, &old, &mut new).ok().map(|()| new[3].abs())
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

fn extent(points: impl Iterator<Item = Vec3>) -> Vec3 {
    let mut ends = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for point in points {
        for axis in 0..3 {
            ends[0][axis] = ends[0][axis].min(point[axis]);
            ends[1][axis] = ends[1][axis].max(point[axis]);
        }
    }
    Vec3(std::array::from_fn(|axis| (ends[1][axis] - ends[0][axis]).max(0.0)))
}

fn sides<'a>(model: &'a Model, group: &Name) -> &'a [Side] {
    model.mesh.groups.get(&group.text).map_or(&[], |group| &group.sides)
}

/// Names of the bodies of some cells.
fn bodies_of(model: &Model, cells: impl Iterator<Item = usize>) -> Vec<String> {
    let cells: BTreeSet<usize> = cells.collect();
    let has = |body: &Body| body.cells().iter().any(|cell| cells.contains(cell));
    model.bodies.iter().filter(|(body, _)| has(body)).map(|(body, _)| body.name().to_owned()).collect()
}

fn contacts(made: &Made) -> Vec<ContactFacts> {
    let all = Seen::all(made);
    let backings = backings(&made.model.mesh, made.model.bodies.iter().map(|(body, _)| body.as_ref()));
    made.deck.contact.iter().map(|(name, keys)| contact_facts(made, (name, keys), &all, &backings)).collect()
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
            let gap = signed_distance(model, tool);
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
        distance,
        edge: edges.fold(f64::INFINITY, f64::min),
        penalty: keys.penalty.map(|given| given / computed),
        friction: friction.and_then(|at| keys.law.values.get(at).copied()),
    }
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

/// Distance from a tool where it stands first, negative in its material.
fn signed_distance(model: &Model, number: usize) -> Box<dyn Fn(Vec3) -> f64 + '_> {
    let nearer = |a: f64, b: f64| if b.abs() < a.abs() { b } else { a };
    if let Some(tool) = model.tools.get(number) {
        let pieces = tool.smooth_pieces();
        return Box::new(move |x| {
            let gap = |piece| {
                let foot = tool.closest(piece, x);
                (x - foot.point).norm().copysign(foot.gap)
            };
            pieces.iter().map(gap).fold(f64::INFINITY, nearer)
        });
    }
    let Some(tool) = model.solid_tools.get(number) else { return Box::new(|_| f64::INFINITY) };
    let pieces = tool.smooth_pieces();
    Box::new(move |x| {
        let gap = |piece| {
            let foot = tool.closest(&pieces, piece, x);
            (x - foot.point).norm().copysign(foot.gap)
        };
        (0..pieces.count()).map(gap).fold(f64::INFINITY, nearer)
    })
}

fn tools(model: &Model) -> Vec<ToolFacts> {
    let dofs = &model.problem.dofs;
    let names = model.tools.iter().map(|tool| (tool.name(), tool.size()));
    let all = names.chain(model.solid_tools.iter().map(|tool| (tool.name(), tool.size()))).enumerate();
    let fact = |(number, (name, size)): (usize, (&str, f64))| {
        let first = dofs.tool(number);
        let free = |dof: usize| model.problem.steps.iter().any(|step| step.constraints.free().contains(&dof));
        ToolFacts { name: name.into(), size, driven: !(first..first + dofs.per_tool()).any(free) }
    };
    all.map(fact).collect()
}

fn steps(made: &Made) -> Vec<StepFacts> {
    let dofs = &made.model.problem.dofs;
    let (bodies, mut last) = (dofs.node(dofs.nodes()), BTreeMap::new());
    let solved = made.model.problem.steps.iter().zip(&made.deck.step);
    let fact = |(step, keys): (&crate::solve::Step, &Step)| {
        let mut facts = StepFacts {
            name: step.name.clone(),
            first: step.increments.first,
            largest: step.increments.largest,
            smallest: step.increments.smallest,
            loads: loads(made, keys),
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
    solved.map(fact).collect()
}

/// The loads that a step says, as stresses.
fn loads(made: &Made, step: &Step) -> Vec<Load> {
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
        let nodes: BTreeSet<usize> = group.nodes.iter().copied().collect();
        let touches =
            |body: &Body| body.cells().iter().any(|&c| model.mesh.cell(c).nodes.iter().any(|n| nodes.contains(n)));
        let loaded = model.bodies.iter().filter(|(body, _)| touches(body)).map(|(body, _)| body.name().to_owned());
        let loaded: Vec<String> = loaded.collect();
        let stress =
            size(keys) * nodes.len() as f64 / loaded.first().map_or(f64::INFINITY, |body| section(model, body));
        all.push(load("force", name, loaded, stress));
    }
    for (name, keys) in &step.load {
        let force = [keys.x, keys.y, keys.z.map(|z| z.value)].into_iter().flatten().map(f64::abs).fold(0.0, f64::max);
        let met = made.deck.contact.iter().find(|(_, contact)| contact.target.text == name.text);
        let bodies = met.map(|(_, contact)| of_sides(&contact.surface)).unwrap_or_default();
        let stress = force / bodies.first().map_or(f64::INFINITY, |body| section(model, body));
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

fn size(load: &impl Components) -> f64 {
    load.components().into_iter().flatten().map(|x| x * x).sum::<f64>().sqrt()
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

/// Section of the box about a body across its longest side.
fn section(model: &Model, body: &str) -> f64 {
    let mut sizes = bounds(model, body).0;
    sizes.sort_by(|a, b| b.total_cmp(a));
    let section = match model.space {
        Space::Solid => sizes[1] * sizes[2],
        Space::Axisymmetric => std::f64::consts::PI * model.mesh.bounds()[1][0] * sizes[1],
        _ => sizes[1] * model.thickness,
    };
    section.max(f64::MIN_POSITIVE)
}
