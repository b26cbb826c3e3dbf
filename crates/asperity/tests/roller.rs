//! The free roller of `cases/roller`: held by a force, driven by a torque through 40 degrees to set out and 200 in ten
//! increments.

mod support;

use asperity::solve::RunOptions;
use asperity::tensor::Vec3;
use asperity::tool::Pose;
use support::{Keep, model, run};

const DECK: &str = include_str!("../../../cases/roller/roller.toml");
const TORQUE: f64 = 41.887_902;
const SPRING: f64 = 0.1;
const RADIUS: f64 = 10.0;

/// Translation and rotation of the roller after each increment.
fn poses(deck: &asperity::model::Model, keep: &Keep) -> Vec<[f64; 3]> {
    let first = deck.problem.dofs.tool(0);
    keep.states.iter().map(|state| [0, 1, 2].map(|k| state.u[first + k])).collect()
}

#[test]
fn a_torque_turns_the_roller_and_draws_the_strip() {
    let model = model(DECK, &[]);
    let keep = run(&model);
    assert!(keep.attempts.iter().all(|attempt| attempt.failure.is_none()));
    let turning = keep.attempts.iter().filter(|attempt| attempt.step == 2);
    assert_eq!(turning.count(), 14);
    let poses = poses(&model, &keep);
    let ([across, _, angle], [_, _, before]) = (poses[poses.len() - 1], poses[poses.len() - 11]);
    assert_eq!(across, 0.0);
    assert!((angle - before).to_degrees() > 200.0, "turned by {} degrees", (angle - before).to_degrees());
    // The spring's force at the lever of the radius is the torque, and the strip has gone as far as the spring gave way.
    // The dent, 0.2 deep, shortens the lever; the force of 20 may stand off the middle by a tenth of the distance of two
    // contact points, 0.5, which is a lever of 0.3. Where in its notch the roller rests is another thing after each of the ten
    // turns, over which a sixth of the torque becomes all of it: their mean is looked at.
    let corner = model.problem.dofs.node(model.mesh.groups["strip.bottom_left"].nodes[0]);
    let turns = keep.states[keep.states.len() - 10..].iter().zip(1..);
    let lever =
        turns.map(|(state, i)| TORQUE * (1.0 + 0.5 * f64::from(i)) / 6.0 / (SPRING * state.u[corner])).sum::<f64>()
            / 10.0;
    assert!((lever - 0.98 * RADIUS).abs() < 0.03 * RADIUS, "lever {lever}");
    let drawn = keep.states.last().unwrap().u[corner];
    // Creep of the film: the roller turns more than the strip follows, by a few per cent and never less.
    let creep = RADIUS * angle / drawn - 1.0;
    assert!(creep > 0.0 && creep < 0.06, "creep {creep}");
}

#[test]
fn the_rotation_stays_a_rotation() {
    let model = model(DECK, &[]);
    for [x, y, angle] in poses(&model, &run(&model)) {
        let pose = Pose::new(&[x, y, angle]);
        let (a, b) = (pose.rotate(Vec3::new(1.0, 0.0, 0.0)), pose.rotate(Vec3::new(0.0, 1.0, 0.0)));
        for drift in [a.dot(a) - 1.0, b.dot(b) - 1.0, a.dot(b)] {
            assert!(drift.abs() < 1e-14, "{drift:e} at {angle}");
        }
    }
}

/// The exact tangent and the one by perturbation lead to the same end while the roller turns little. Far off, the stresses
/// that an iteration meets on its way are no one's, and only a tangent that leaves them out stays on the way.
#[test]
fn the_tangent_agrees_with_perturbation() {
    let [a, b] = ["solver.tangent=exact", "solver.tangent=perturbation"].map(|tangent| {
        let model = model(DECK, &[tangent, "step.turn.load.roller.torque=2.0"]);
        poses(&model, &run(&model))
    });
    assert_eq!(a.len(), b.len());
    for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
        assert!((a - b).abs() < 1e-6, "{a} {b}");
    }
}

/// Bare of what settles contact, a stiff film lets points close and open in turn: the message says which, and on what.
#[test]
fn points_that_go_round_in_circles_are_named() {
    let bare = ["relax=false", "piecewise=false", "line_search=false"].map(|key| format!("solver.{key}"));
    let stiff = ["penalty", "tangential_penalty"].map(|key| format!("contact.nip.{key}=1e4"));
    let sets: Vec<&str> = bare.iter().chain(&stiff).map(String::as_str).collect();
    let (model, mut keep) = (model(DECK, &sets), Keep::default());
    let ended = model.run(model.problem.initial_state()).run(&RunOptions::default(), &mut keep);
    assert!(ended.is_err(), "the run is meant to give up");
    let failures = || keep.attempts.iter().filter_map(|attempt| attempt.failure.as_deref());
    let named = failures().filter(|failure| failure.contains("contact states repeat every 2 iterations: point "));
    assert!(named.clone().count() > 0, "{:?}", failures().collect::<Vec<_>>());
    for failure in named {
        assert!(failure.contains("of contact 'nip'") && failure.contains("on segment "), "{failure}");
    }
}
