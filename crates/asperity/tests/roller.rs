//! The free roller of `cases/roller`: held by a force, driven by a torque through 200 degrees in ten increments.

mod support;

use asperity::tensor::Vec3;
use asperity::tool::Pose;
use support::{Keep, model, run};

const DECK: &str = include_str!("../../../cases/roller/roller.toml");
const TORQUE: f64 = 34.906_585_0;
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
    assert_eq!(turning.count(), 10);
    let [across, _, angle] = *poses(&model, &keep).last().unwrap();
    assert_eq!(across, 0.0);
    assert!(angle.to_degrees() > 200.0, "turned by {} degrees", angle.to_degrees());
    // The spring's force at the lever of the radius is the torque, and the strip has gone as far as the spring gave way.
    // The dent, 0.2 deep, shortens the lever; the force of 20 may stand off the middle by a tenth of the distance of two
    // contact points, 0.5, which is a lever of 0.3.
    let last = keep.states.last().unwrap();
    let corner = model.mesh.groups["strip.bottom_left"].nodes[0];
    let drawn = last.u[model.problem.dofs.node(corner)];
    let lever = TORQUE / (SPRING * drawn);
    assert!((lever - 0.98 * RADIUS).abs() < 0.03 * RADIUS, "lever {lever}");
    // Creep of the film: the roller turns more than the strip follows, by a few per cent and never less.
    let creep = RADIUS * angle / drawn - 1.0;
    assert!(creep > 0.0 && creep < 0.06, "creep {creep}");
}

#[test]
fn the_rotation_stays_a_rotation() {
    let model = model(DECK, &[]);
    for [x, y, angle] in poses(&model, &run(&model)) {
        let pose = Pose::new(x, y, angle);
        let (a, b) = (pose.rotate(Vec3::new(1.0, 0.0, 0.0)), pose.rotate(Vec3::new(0.0, 1.0, 0.0)));
        for drift in [a.dot(a) - 1.0, b.dot(b) - 1.0, a.dot(b)] {
            assert!(drift.abs() < 1e-14, "{drift:e} at {angle}");
        }
    }
}

/// The exact tangent and the one by perturbation lead to the same end by about as many iterations: the first of 20 degrees
/// throws the roller about, where rounding counts.
#[test]
fn the_tangent_agrees_with_perturbation() {
    let runs = ["solver.tangent=exact", "solver.tangent=perturbation"].map(|tangent| {
        let model = model(DECK, &[tangent]);
        let keep = run(&model);
        let solutions: usize = keep.attempts.iter().map(|attempt| attempt.solutions()).sum();
        (solutions, poses(&model, &keep))
    });
    let [(exact, a), (perturbed, b)] = runs;
    assert!(10 * exact.abs_diff(perturbed) <= exact, "{exact} and {perturbed} iterations");
    for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
        assert!((a - b).abs() < 1e-6, "{a} {b}");
    }
}

/// Under stiff films a roller on few points rests in notches, and the torque throws it from one into the next: no
/// equilibrium lies near, and cutting increments ends in nothing. Relaxed, it rolls on.
#[test]
fn a_roller_is_thrown_from_notch_to_notch() {
    let stiff: String =
        DECK.lines().filter(|line| !line.contains("penalty =")).map(|line| format!("{line}\n")).collect();
    let coarse = ["mesh.part.strip.rectangle.cells=[60, 2]", "step.turn.load.roller.torque=10.0"];
    let relaxed = model(&stiff, &coarse);
    let keep = run(&relaxed);
    let last = keep.states.last().unwrap();
    assert!(last.jumps > 0 && last.released > 0.0, "{} jumps, {:e} set free", last.jumps, last.released);
    // The strip follows the torque but for what a notch carries: the force of 20 stands off by part of the points' distance, 1.
    let corner = relaxed.mesh.groups["strip.bottom_left"].nodes[0];
    let drawn = last.u[relaxed.problem.dofs.node(corner)];
    assert!((drawn * SPRING * RADIUS - 10.0).abs() < 0.25 * 20.0, "drawn by {drawn}");
    let cut = model(&stiff, &[&coarse[..], &["solver.relax=false"]].concat());
    let mut stuck = cut.run(cut.problem.initial_state());
    let end = stuck.run(&asperity::solve::RunOptions::default(), &mut asperity::solve::Silent);
    assert!(matches!(end, Err(asperity::Error::NotConverged(_))), "{end:?}");
    assert_eq!(stuck.state.jumps, 0);
}
