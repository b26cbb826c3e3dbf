//! A cantilever rolled up by a moment at a point whose load its end carries: the elastica under a couple, an arc of a circle.

mod support;

use support::{columns, model, run};

const LENGTH: f64 = 20.0;
const HEIGHT: f64 = 0.1;
const YOUNG: f64 = 1e5;

/// Mean displacement of the end and the clamp's reactions at the end of a run.
fn rolled(weights: &str, load: &str) -> ([f64; 2], [f64; 2]) {
    let deck = format!(
        r#"
version = 1
space = "plane-stress"
mesh.part.beam.rectangle = {{ from = [0.0, 0.0], to = [{LENGTH:?}, {HEIGHT:?}], cells = [40, 2], cell = "quad8" }}
material.steel.elastic = {{ young = {YOUNG:?}, poisson = 0.0 }}
body.beam = {{ material = "steel", integration = "reduced" }}
distributing.end = {{ group = "beam.right", weights = "{weights}" }}
solver.tolerance = 1e-9
[[step]]
increments = {{ count = 20 }}
displacement."beam.left" = {{ x = 0.0, y = 0.0 }}
load.end = {load}
"#
    );
    let model = model(&deck, &[]);
    let keep = run(&model);
    let (state, dofs) = (keep.states.last().unwrap(), &model.problem.dofs);
    let nodes = &model.mesh.groups["beam.right"].nodes;
    let mean = |axis: usize| {
        let ends = nodes.iter().filter(|&&n| [0.0, HEIGHT].iter().any(|y| (model.mesh.points[n][1] - y).abs() < 1e-9));
        ends.map(|&n| state.u[dofs.node(n) + axis]).sum::<f64>() / 2.0
    };
    let columns = columns(&model, &keep);
    let last = |name: &str| *columns[name].last().unwrap();
    ([mean(0), mean(1)], [last("reaction.beam.left.x"), last("reaction.beam.left.y")])
}

/// Turned by 180 degrees: radius L / pi. The moment does not change as the end turns.
#[test]
fn a_moment_rolls_a_strip_into_a_half_circle() {
    let moment = std::f64::consts::PI * YOUNG * HEIGHT.powi(3) / 12.0 / LENGTH;
    for weights in ["equal", "area"] {
        let (end, reaction) = rolled(weights, &format!("{{ torque = {moment:?} }}"));
        let wanted = [-LENGTH, 2.0 * LENGTH / std::f64::consts::PI];
        let apart = (end[0] - wanted[0]).hypot(end[1] - wanted[1]);
        assert!(apart < 2e-3 * LENGTH, "{weights}: {end:?} {wanted:?}");
        assert!(reaction[0].abs() < 1e-6 && reaction[1].abs() < 1e-6, "{reaction:?}");
    }
}

/// The force is carried whole, wherever its point lies.
#[test]
fn a_force_is_carried_whole() {
    let (_, reaction) = rolled("area", "{ x = 0.02, y = -0.01 }");
    assert!((reaction[0] + 0.02).abs() < 1e-8 && (reaction[1] - 0.01).abs() < 1e-8, "{reaction:?}");
}
