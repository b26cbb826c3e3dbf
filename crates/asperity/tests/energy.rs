//! The balance of energy of contact without friction: what the work of the supports misses of the energy that is stored,
//! by the form of the contact and by the law of the solid.

mod support;

use support::{columns, model, run};

const BLOCK: &str = include_str!("../../../cases/energy-balance/block.toml");

/// What drawing the tool misses, over the strain energy, with so many times more increments.
fn missing(sets: &[&str], times: usize) -> f64 {
    let count = format!("step.draw.increments.count={}", 10 * times);
    let model = model(BLOCK, &[sets, &[&count]].concat());
    let columns = columns(&model, &run(&model));
    let (missing, stored) = (&columns["energy.missing"], &columns["energy.strain"]);
    let pushed = missing.len() - 10 * times - 1;
    (missing.last().unwrap() - missing[pushed]) / stored.last().unwrap()
}

/// Value for infinitely many increments, and the order at which it is approached.
fn limit(sets: &[&str]) -> (f64, f64) {
    let [a, b, c] = [1, 2, 4].map(|times| missing(sets, times));
    (c + (c - b) / 3.0, ((b - a) / (c - b)).log2())
}

#[test]
fn a_field_keeps_the_energy() {
    let (left, order) = limit(&[]);
    assert!(left.abs() < 1e-6 && order > 1.8, "{left:.2e} {order}");
    let (traction, _) = limit(&["contact.base.form=paper"]);
    assert!(traction.abs() > 1e-5, "{traction:.2e}");
}

/// What a rate law leaves over of the work is told apart: nothing else is missing then but what the paper's form misses.
#[test]
fn the_residue_of_a_rate_law_stands_apart() {
    let rate = "material.rubber={ elastic = { young = 7.5, poisson = 0.25 } }";
    let (left, order) = limit(&[rate]);
    assert!(left.abs() < 1e-6 && order > 1.8, "{left:.2e} {order}");
    let (traction, _) = limit(&[rate, "contact.base.form=paper"]);
    assert!(traction.abs() > 1e-5, "{traction:.2e}");
    let residue = |sets: &[&str]| {
        let model = model(BLOCK, sets);
        let columns = columns(&model, &run(&model));
        columns["energy.residue"].last().unwrap() / columns["energy.strain"].last().unwrap()
    };
    assert!(residue(&[rate]).abs() > 1e-3, "{}", residue(&[rate]));
    assert_eq!(residue(&[]), 0.0);
}
