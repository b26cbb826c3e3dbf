//! What a diagnosis asks of a model: stiffness and strength of its bodies, gaps, sides and penalties of its contacts, sizes of
//! motions and loads.

mod bodies;
mod contacts;
mod steps;

use super::build::Made;
use super::reader::Name;
use super::review::Seen;
use asperity_core::mesh::Side;
use asperity_core::mesh::lint::{self, LintFinding, LintKind};
use asperity_core::model::Model;
use asperity_core::solid::Body;
use asperity_core::system::Term;
use asperity_core::tensor::Vec3;
use asperity_results::diagnosis::{Facts, ToolFacts};
use std::collections::BTreeSet;

/// What is known of a model before it runs.
pub fn facts(made: &Made) -> Facts {
    facts_seen(made, &Seen::all(made))
}

/// The same where it is known what contacts see.
pub(super) fn facts_seen(made: &Made, seen: &[Seen]) -> Facts {
    let (model, solver) = (&made.model, &made.deck.solver);
    let off = [("`solver.piecewise = false`", solver.piecewise), ("`solver.line_search = false`", solver.line_search)];
    Facts {
        size: model.mesh.size(),
        bodies: model.bodies.iter().map(|(body, material)| bodies::facts(made, body, *material)).collect(),
        contacts: contacts::facts(made, seen),
        tools: tools(model),
        steps: steps::facts(made),
        tolerance: solver.tolerance,
        iterations: solver.iterations,
        seams: seams(made),
        length_unit: made
            .deck
            .units
            .as_ref()
            .and_then(|units| units.value.split(',').nth(1))
            .map(|unit| unit.trim().into()),
        switched_off: off.iter().filter(|(_, on)| !on).map(|(key, _)| *key).collect(),
    }
}

/// Faces and nodes of the mesh that lie on one another and are not joined.
fn seams(made: &Made) -> Vec<String> {
    let open = |finding: &LintFinding| matches!(finding.kind, LintKind::Crack | LintKind::Touching | LintKind::Hanging);
    let found = lint::check(&made.model.mesh).into_iter().filter(open);
    found.map(|finding| finding.text).collect()
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
