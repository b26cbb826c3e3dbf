//! Straight columns past Euler's load: where the run notes a bifurcation, and its mode.

use crate::bench::Bench;
use crate::{Case, Measured};
use asperity::Error;
use asperity::solve::AttemptRecord;
use std::f64::consts::PI;

/// The case.
pub const CASE: Case = Case { name: "euler-columns", measure };

/// Young's modulus, width and length.
const YOUNG: f64 = 2600.0;
const WIDTH: f64 = 1.0;
const LENGTH: f64 = 20.0;

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let mut measured = Measured::new();
    let elastic = ["material.rubber={ elastic = { young = 2600.0, poisson = 0.3 } }".to_owned()];
    // Half a wave between pins, a quarter over a clamp.
    let columns = [("pinned", 1.0, 6.4), ("cantilever", 2.0, 1.6)];
    for (name, part, load) in columns {
        let euler = (PI / (part * LENGTH)).powi(2) * YOUNG * WIDTH.powi(3) / 12.0;
        for (law, sets) in [("", &[][..]), ("_rate", &elastic)] {
            let found = find(bench, &format!("{name}.toml"), sets)?;
            measured.push((format!("{name}{law}"), load * found.critical / euler));
            measured.push((format!("{name}{law}_turns"), found.turns as f64));
        }
    }
    // Clamped and guided it is half a wave, and the motion is that of the straight column.
    let strain = |wave: f64| (PI / (wave * LENGTH)).powi(2) * WIDTH * WIDTH / 12.0;
    let led = find(bench, "led.toml", &[])?;
    measured.push(("led".into(), 0.08 * led.critical / (strain(1.0) * LENGTH)));
    for (name, top, part) in [("space", 2.0 / YOUNG, 2.0), ("space-led", 0.08 / LENGTH, 1.0)] {
        let n = bench.pick(2, 3);
        let cells = format!("mesh.part.column.box.cells=[{n}, {}, {n}]", 10 * n);
        let run = bench.solve(&format!("{name}.toml"), &[cells])?;
        let turn = run.attempts.iter().find_map(|attempt| attempt.turn.as_ref());
        let critical = turn.and_then(|turn| turn.critical).unwrap_or(f64::NAN);
        let name = name.replace('-', "_");
        measured.push((name.clone(), top * critical / strain(part)));
        // Increments that had a factor of their own.
        let fresh = |attempt: &&AttemptRecord| attempt.iterations.iter().any(|line| line.factorised);
        measured.push((format!("{name}_fresh"), run.attempts.iter().filter(fresh).count() as f64));
    }
    Ok(measured)
}

struct Found {
    /// Time of the first critical state.
    critical: f64,
    turns: usize,
}

fn find(bench: &Bench, deck: &str, sets: &[String]) -> Result<Found, Error> {
    let n = bench.pick(20, 60);
    let mut sets = sets.to_vec();
    sets.push(format!("mesh.part.column.rectangle.cells=[{}, {n}]", n / 10));
    let run = bench.solve(deck, &sets)?;
    let turns: Vec<_> = run.attempts.iter().filter_map(|attempt| attempt.turn.as_ref()).collect();
    let critical = turns.first().and_then(|turn| turn.critical).unwrap_or(f64::NAN);
    Ok(Found { critical, turns: turns.len() })
}
