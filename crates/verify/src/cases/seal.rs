//! A pressed rubber strip that a fluid passes.

use crate::bench::{Bench, points, reaction};
use crate::{Case, Measured};
use asperity::Error;
use asperity::model::Model;
use asperity::system::State;

/// The case.
pub const CASE: Case = Case { name: "seal", measure };

/// Height of the pressed strip over that of the free one.
const STRETCH: f64 = 0.8;

/// What is seen of one strip.
struct Seen {
    /// Largest contact pressure without fluid.
    peak: f64,
    /// Pressure at which the fluid has passed.
    leak: f64,
    /// Wet part of the surface just before.
    entered: f64,
    /// Force that holds the top over those of contact and fluid: the farthest from one while the fluid enters,
    worst: f64,
    /// and when it has passed.
    last: f64,
}

/// Runs a strip with changes; the fluid rises to `most`.
fn strip(bench: &Bench, sets: &[&str], most: f64) -> Result<Seen, Error> {
    let mut sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    let (cells, count) = bench.pick(([16, 4], 50), ([32, 8], 100));
    sets.push(format!("mesh.part.strip.rectangle.cells={cells:?}"));
    sets.push(format!("step.leak.increments.count={count}"));
    sets.push(format!("step.leak.pressure.'strip.bottom'.value={most:?}"));
    let mut seen = Seen { peak: 0.0, leak: f64::INFINITY, entered: 0.0, worst: 1.0, last: f64::NAN };
    bench.follow("strip.toml", &sets, |model, state| look(model, state, most, &mut seen))?;
    Ok(seen)
}

fn look(model: &Model, state: &State, most: f64, seen: &mut Seen) {
    let records = points(model, state, 0);
    let leaking = state.time > 1.0;
    if !leaking {
        seen.peak = records.iter().map(|record| record.pressure).fold(0.0, f64::max);
        return;
    }
    let (fluid, pressure) = (&model.fluids[0], most * (state.time - 1.0));
    let [wet, all] = fluid.wetted(state, &state.histories[model.first_fluid()]);
    let borne: f64 = records.iter().map(|record| record.pressure * record.area).sum();
    seen.last = reaction(model, state, "strip.top")[1].abs() / (borne + pressure * wet);
    if (seen.last - 1.0).abs() > (seen.worst - 1.0).abs() {
        seen.worst = seen.last;
    }
    match wet > 0.999 * all {
        true => seen.leak = seen.leak.min(pressure),
        false => seen.entered = wet / all,
    }
}

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let closed = STRETCH.powi(-2) - STRETCH.powi(2);
    let free = strip(bench, &[], 1.1 * closed)?;
    let bonded = strip(bench, &["step.press.displacement.'strip.top'.x=0.0"], 3.0 * closed)?;
    Ok(vec![
        ("leak".into(), free.leak / free.peak),
        ("contact_pressure".into(), free.peak / closed),
        ("reaction".into(), free.last),
        ("entered".into(), bonded.entered),
        ("bonded_balance".into(), bonded.worst),
        ("bonded_leak".into(), bonded.leak / bonded.peak),
    ])
}
