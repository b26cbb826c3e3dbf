//! A round tool pushed into a block and drawn along it without friction: what the work of the supports misses of the
//! stored energy over the drawing, in which no point opens or closes, by the form of the contact and by the law of the solid.

use crate::bench::Bench;
use crate::{Case, Measured};
use asperity::Error;
use asperity::system::State;

/// The case.
pub const CASE: Case = Case { name: "energy-balance", measure };

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let (variational, order) = limit(bench, &[])?;
    let (traction, _) = limit(bench, &["contact.base.form=traction"])?;
    let (rate, _) = limit(bench, &["material.rubber={ elastic = { young = 7.5, poisson = 0.25 } }"])?;
    Ok(vec![
        ("variational".into(), variational.abs()),
        ("order".into(), order),
        ("traction".into(), traction),
        ("hypoelastic".into(), rate),
    ])
}

/// Missing over strain energy for infinitely many increments, and the order at which it is approached.
fn limit(bench: &Bench, sets: &[&str]) -> Result<(f64, f64), Error> {
    let coarse = bench.pick(1, 4);
    let missing = [1, 2, 4].map(|times| missing(bench, sets, coarse * times));
    let [a, b, c] = missing.into_iter().collect::<Result<Vec<_>, _>>()?[..] else { return Ok((f64::NAN, f64::NAN)) };
    Ok((c + (c - b) / 3.0, ((b - a) / (c - b)).log2()))
}

/// What drawing the tool misses, over the strain energy.
fn missing(bench: &Bench, sets: &[&str], times: usize) -> Result<f64, Error> {
    let count = format!("step.draw.increments.count={}", 10 * times);
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).chain([count]).collect();
    let mut pushed = 0.0;
    let run = bench.follow("block.toml", &sets, |_, state| {
        if state.time <= 1.0 + 1e-9 {
            pushed = balance(state);
        }
    })?;
    Ok((balance(&run.state) - pushed) / run.state.energies[0].stored)
}

/// Work from outside less what is stored and dissipated.
fn balance(state: &State) -> f64 {
    state.external_work - state.energies.iter().map(|energy| energy.stored + energy.dissipated).sum::<f64>()
}
