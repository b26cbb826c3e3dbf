//! Arches that snap through: limit points by arc length against prescribed displacement, a tool in place of a force, and a
//! published limit load.

use crate::bench::Bench;
use crate::{Case, Measured};
use asperity::Error;

/// The case.
pub const CASE: Case = Case { name: "arch", measure };

/// Loads at the end of the steps of the shallow and the deep arch; `R^2 / (E I)` of the latter.
const SHALLOW: f64 = 2.0;
const DEEP: f64 = 1000.0;
const SCALE: f64 = 1e4 / 1e6;

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let cells = |times: usize| {
        let n = times * bench.pick(1, 2);
        vec![format!("mesh.part.arch.annulus.cells=[{}, {}]", 2 * n, 32 * n)]
    };
    let fine = |mut sets: Vec<String>| {
        sets.push(format!("step.load.increments.largest={}", bench.pick(0.1, 0.04)));
        sets
    };
    let path = limits(bench, "shallow.toml", &fine(cells(1)))?;
    let led = limits(bench, "led.toml", &cells(2))?;
    let tool = limits(bench, "tool.toml", &fine(cells(1)))?;
    let deep = [
        format!("mesh.part.arch.annulus.cells=[1, {}]", bench.pick(80, 160)),
        format!("step.load.increments.largest={}", bench.pick(0.05, 0.02)),
    ];
    let deep = limits(bench, "deep.toml", &deep)?;
    Ok(vec![
        ("upper".into(), path.upper / led.upper),
        ("lower".into(), path.lower / led.lower),
        ("turns".into(), path.turns as f64),
        ("tool_upper".into(), tool.upper / path.upper),
        ("tool_lower".into(), tool.lower / path.lower),
        ("deep".into(), deep.upper * SCALE),
    ])
}

/// Loads at the limit points of a path, and how many were noted.
struct Limits {
    upper: f64,
    lower: f64,
    turns: usize,
}

fn limits(bench: &Bench, deck: &str, sets: &[String]) -> Result<Limits, Error> {
    let mut loads = Vec::new();
    let load = if deck == "deep.toml" { DEEP } else { SHALLOW };
    let solved = bench.follow(deck, sets, |model, state| {
        let nodes = &model.mesh.groups["crown"].nodes;
        let dofs: Vec<usize> = nodes.iter().map(|&node| model.problem.dofs.node(node) + 1).collect();
        let reaction = dofs.iter().map(|&dof| state.internal[dof] - state.load[dof]).sum::<f64>();
        let follows = model.problem.steps.iter().any(|step| step.arc_length.is_some());
        // Increments of the last step.
        if state.step + usize::from(state.step_increment > 0) >= model.problem.steps.len() {
            loads.push(if follows { load * state.factor } else { -reaction });
        }
    })?;
    let turns = solved.attempts.iter().filter(|attempt| attempt.turn.is_some()).count();
    let upper = extreme(&loads, 0, 1.0);
    let lower = extreme(&loads, upper.0, -1.0);
    Ok(Limits { upper: upper.1, lower: lower.1, turns })
}

/// The first extreme value of a sequence from a place on, of the parabola through the three nearest, and its place.
fn extreme(values: &[f64], from: usize, sign: f64) -> (usize, f64) {
    let peak = |i: &usize| sign * values[*i] >= sign * values[i - 1] && sign * values[*i] > sign * values[i + 1];
    let Some(i) = (from.max(1)..values.len().saturating_sub(1)).find(peak) else { return (from, f64::NAN) };
    let [a, b, c] = [values[i - 1], values[i], values[i + 1]];
    let bend = a - 2.0 * b + c;
    (i, b - (c - a) * (c - a) / (8.0 * bend))
}
