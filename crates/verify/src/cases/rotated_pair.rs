//! A pressed and sheared pair turned by 63 degrees in one increment: nothing slips, no pressure changes, and the
//! reaction turns. Newton's method is begun at the turned place: a straight guess from the prescribed nodes would turn
//! the cells inside out. Whether that place is in equilibrium, and what slips on the way, is for the terms to say.

use crate::bench::{Bench, points, reaction};
use crate::{Case, Measured};
use asperity::Error;
use asperity::contact::{ContactRecord, PointStatus};
use asperity::model::Model;
use asperity::solve::{RunOptions, Silent};
use asperity::system::State;
use asperity::tensor::Vec3;

/// The case.
pub const CASE: Case = Case { name: "rotated-pair", measure };

const ANGLE: f64 = 63.0;

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let mut measured = turned(bench, "pair.toml")?;
    let bodies = turned(bench, "bodies.toml")?;
    measured.extend(bodies.into_iter().map(|(what, value)| (format!("bodies_{what}"), value)));
    Ok(measured)
}

fn turned(bench: &Bench, deck: &str) -> Result<Measured, Error> {
    let model = bench.model(deck, &[])?;
    let mut run = model.run(model.problem.initial_state());
    run.run(&RunOptions { increments: Some(2) }, &mut Silent)?;
    let (loaded, force) = (points(&model, &run.state, 0), reaction(&model, &run.state, "block.top"));
    carry_on_turning(&model, &mut run.state);
    run.run(&RunOptions::default(), &mut Silent)?;
    let (turned, now) = (points(&model, &run.state, 0), reaction(&model, &run.state, "block.top"));
    let stick = |points: &[ContactRecord]| points.iter().filter(|point| point.status == PointStatus::Stick).count();
    Ok(vec![
        ("sticking".into(), (stick(&loaded).min(stick(&turned)) as f64) / loaded.len() as f64),
        ("sheared".into(), largest(&loaded, |point| point.shear.abs()) / largest(&loaded, |point| point.pressure)),
        ("slip".into(), change(&loaded, &turned, |point| point.slip)),
        ("pressure".into(), change(&loaded, &turned, |point| point.pressure) / largest(&loaded, |p| p.pressure)),
        ("shear".into(), change(&loaded, &turned, |point| point.shear) / largest(&loaded, |p| p.shear.abs())),
        ("reaction".into(), turning_error(force, now)),
        ("increments".into(), run.state.increment as f64 - 2.0),
    ])
}

fn largest(points: &[ContactRecord], value: impl Fn(&ContactRecord) -> f64) -> f64 {
    points.iter().map(value).fold(0.0, f64::max)
}

fn change(before: &[ContactRecord], after: &[ContactRecord], value: impl Fn(&ContactRecord) -> f64) -> f64 {
    before.iter().zip(after).map(|(before, after)| (value(after) - value(before)).abs()).fold(0.0, f64::max)
}

/// Difference of the reaction on the turned block and the turned reaction, over its size.
fn turning_error([x, y]: [f64; 2], now: [f64; 2]) -> f64 {
    let (s, c) = ANGLE.to_radians().sin_cos();
    (now[0] - (c * x - s * y)).hypot(now[1] - (s * x + c * y)) / x.hypot(y)
}

/// The predictor carries on with the last change, which is made the turn.
fn carry_on_turning(model: &Model, state: &mut State) {
    let ((s, c), dofs) = (ANGLE.to_radians().sin_cos(), &model.problem.dofs);
    for (node, &Vec3([x, y, _])) in model.mesh.points.iter().enumerate() {
        let at = dofs.node(node);
        let (x, y) = (x + state.u[at], y + state.u[at + 1]);
        state.last_change[at] = c * x - s * y - x;
        state.last_change[at + 1] = s * x + c * y - y;
    }
    if dofs.tools() > 0 {
        state.last_change[dofs.tool(0)..].copy_from_slice(&[0.0, 0.0, ANGLE.to_radians()]);
    }
    state.last_dt = model.problem.steps[state.step].duration;
}
