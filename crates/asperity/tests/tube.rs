//! The tube of `cases/tube`, coarse: forces against the figures of `cases/tube/reference.py`, equilibrium of contact,
//! and the certificate. The full figures come from `cargo run --release -p verify -- tube`.

mod support;

use asperity::contact::{ContactRecord, PointStatus};
use asperity::model::Model;
use asperity::system::State;
use support::{Keep, certificate, columns, run};

const DECK: &str = include_str!("../../../cases/tube/tube.toml");
const TRAVEL: f64 = 100.0;
const FRICTIONLESS: &str = "contact.bore.law.coulomb.friction=0.0";
const QUAD4: [&str; 3] =
    ["mesh.part.tube.rectangle.cell=quad4", "body.tube.formulation=f-bar", "body.tube.integration=full"];

/// The paper's own element: the seed of the project, and what these figures belong to.
fn model(deck: &str, sets: &[&str]) -> Model {
    support::model(deck, &[sets, &["contact.bore.form=paper"]].concat())
}

fn records(model: &Model, state: &State) -> Vec<ContactRecord> {
    model.contacts[0].records(&state.u, &state.histories[model.first_contact()])
}

/// Travel and force along the axis after each increment.
fn curve(model: &Model, keep: &Keep) -> Vec<(f64, f64)> {
    let along = model.problem.dofs.tool(0) + 1;
    keep.states.iter().map(|state| (TRAVEL * state.time, state.internal[along])).collect()
}

/// The force at a travel, linear between increments.
fn force_at(curve: &[(f64, f64)], travel: f64) -> f64 {
    let after = curve.iter().position(|point| point.0 >= travel).unwrap();
    let ((t0, f0), (t1, f1)) = (curve[after - 1], curve[after]);
    f0 + (f1 - f0) * (travel - t0) / (t1 - t0)
}

/// Without friction, the work of the far end is the energy stored in the expanded part: 15.135 kN. Integration points
/// that reach the cone one by one make the force ripple, hence the mean over whole pitches, here ten of 4 mm.
#[test]
fn frictionless_force_is_the_energy_of_expansion() {
    let sets = ["mesh.part.tube.rectangle.to=[55.0, 152.0]", "mesh.part.tube.rectangle.cells=[2, 38]"];
    let model = model(DECK, &[&sets[..], &[FRICTIONLESS, "step.push.increments.count=200"]].concat());
    let keep = run(&model);
    let steady: Vec<f64> = curve(&model, &keep).iter().filter(|p| p.0 > 45.1 && p.0 < 85.1).map(|p| p.1).collect();
    let mean = steady.iter().sum::<f64>() / steady.len() as f64;
    assert_eq!(steady.len(), 80);
    assert!((mean / 15135.0 - 1.0).abs() < 0.015, "mean force {mean}");
}

/// With friction the land carries 12 kN more for each of its millimetres, less what the thrust takes off the pressure.
#[test]
fn friction_makes_the_force_grow_with_the_land() {
    for cell in [&[][..], &QUAD4] {
        let sets = ["mesh.part.tube.rectangle.cells=[2, 50]", "step.push.increments.count=100"];
        let model = model(DECK, &[&sets, cell].concat());
        let keep = run(&model);
        let curve = curve(&model, &keep);
        let growth = force_at(&curve, 79.8) - force_at(&curve, 39.8);
        assert!((growth / 456.4e3 - 1.0).abs() < 0.05, "growth of force {growth}");
        arrows_balance(&model, &keep);
        certified(&model, &keep);
    }
}

/// The stress vectors over their areas sum to what the tool takes and to what the far end gives.
fn arrows_balance(model: &Model, keep: &Keep) {
    let dofs = &model.problem.dofs;
    let (tool, top) = (dofs.tool(0) + 1, &model.mesh.groups["tube.top"].nodes);
    let columns = columns(model, keep);
    for (i, state) in keep.states.iter().enumerate() {
        let arrows: f64 = records(model, state).iter().map(|record| record.traction()[1] * record.area).sum();
        let taken = state.internal[tool];
        let given: f64 = top.iter().map(|&node| -state.internal[dofs.node(node) + 1]).sum();
        assert!((arrows - columns["contact.bore.force.y"][i]).abs() <= 1e-12 * arrows.abs());
        assert!((arrows - taken).abs() <= 1e-12 * arrows.abs(), "{arrows} {taken}");
        // The free nodes in between are in balance to the tolerance of the iterations.
        assert!((arrows - given).abs() <= 1e-5 * arrows.abs().max(1e3), "{arrows} {given}");
    }
}

fn certified(model: &Model, keep: &Keep) {
    let certificate = certificate(model, keep);
    let figure = |name: &str| certificate.figure(name).unwrap();
    let stiffness = model.contacts[0].options().penalty;
    let pressure = columns(model, keep)["contact.bore.max_pressure"].iter().fold(0.0, |m: f64, &p| m.max(p));
    let penetration = figure("max_penetration");
    assert!((penetration / (pressure / stiffness) - 1.0).abs() < 1e-9, "{penetration} {pressure}");
    assert!(figure("max_penetration_relative") < 1e-3);
    assert!(figure("equilibrium_error") < 1e-5, "{certificate:?}");
    // The first touch of a point at the ridge lasts a small part of its increment, of which alone the slip counts: what
    // is missing falls with the increments: 0.31, 0.06 and 0.01 at 50, 200 and 400 with quad8.
    assert!(figure("energy_balance") < 0.2, "{certificate:?}");
    assert!(figure("coulomb_violation") < 1e-12, "{certificate:?}");
    assert!(figure("least_dissipation") >= 0.0, "{certificate:?}");
}

/// A tube that has not reached the step moves as a whole: gaps are no stress, and stress is nowhere.
#[test]
fn nothing_acts_before_touch() {
    let sets = [
        "mesh.part.tube.rectangle.from=[50.01, 5.0]",
        "mesh.part.tube.rectangle.to=[55.01, 155.0]",
        "mesh.part.tube.rectangle.cells=[2, 50]",
        "step.push.displacement.tube\\.top.y=-8.0",
        "step.push.increments.count=16",
    ];
    let sets = sets.map(|set| set.replace("tube\\.top", "'tube.top'"));
    let model = model(DECK, &sets.each_ref().map(String::as_str));
    let keep = run(&model);
    let touches: Vec<bool> = keep.states.iter().map(|state| touched(&model, state)).collect();
    let first = touches.iter().position(|&touches| touches).unwrap();
    // The lowest point meets the arc where that has left r = 50.01: sqrt(2 x 10 x 0.01) below the tangent point.
    let start = records(&model, &model.problem.initial_state());
    let lowest = start.iter().map(|record| record.position[1]).fold(f64::INFINITY, f64::min);
    assert_eq!(first, (2.0 * (lowest + 0.2_f64.sqrt())) as usize, "touch after travel {}", 0.5 * (first as f64 + 1.0));
    assert!(touches[first..].iter().all(|&touches| touches));
}

/// Whether any contact point is closed; if none is, nothing must act.
fn touched(model: &Model, state: &State) -> bool {
    let records = records(model, state);
    let closed = records.iter().any(|record| record.status != PointStatus::Open);
    if !closed {
        assert!(records.iter().all(|record| record.traction().norm() == 0.0));
        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        // Rounding of the strains, 1e-14, in the stresses.
        assert!(largest(&state.histories[0].data) < 1e-8 * 210e3, "{}", largest(&state.histories[0].data));
        assert!(largest(&state.internal) < 1e-3);
    }
    closed
}
