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

/// What is seen of the strip.
#[derive(Default)]
struct Seen {
    /// Largest contact pressure without fluid.
    peak: f64,
    /// Pressures of the fluid at which the strip is dry, the last, and wet, the first.
    fluid: [f64; 2],
    /// Force that holds the top over those of contact and fluid, when it has passed.
    balance: f64,
    /// The same over that of the fluid alone.
    reaction: f64,
}

/// Looks at an accepted state; the fluid rises to `most`.
fn look((model, state): (&Model, &State), most: f64, seen: &mut Seen) {
    let records = points(model, state, 0);
    if state.time <= 1.0 {
        seen.peak = records.iter().map(|record| record.pressure).fold(0.0, f64::max);
        return;
    }
    let (fluid, pressure) = (&model.fluids[0], most * (state.time - 1.0));
    let [wet, all] = fluid.wetted(state, &state.histories[model.first_fluid()]);
    let borne: f64 = records.iter().map(|record| record.pressure * record.area).sum();
    let held = reaction(model, state, "strip.top")[1].abs();
    (seen.balance, seen.reaction) = (held / (borne + pressure * wet), held / (pressure * wet));
    if wet == 0.0 {
        seen.fluid[0] = pressure;
    } else if seen.fluid[1] == 0.0 && wet > 0.999 * all {
        seen.fluid[1] = pressure;
    }
}

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let closed = STRETCH.powi(-2) - STRETCH.powi(2);
    let (cells, count, most) = bench.pick(([16, 4], 50, 1.1 * closed), ([32, 8], 200, 1.1 * closed));
    let sets = [
        format!("mesh.part.strip.rectangle.cells={cells:?}"),
        format!("step.leak.increments.count={count}"),
        format!("step.leak.pressure.'strip.bottom'.value={most:?}"),
    ];
    let mut seen = Seen::default();
    bench.follow("strip.toml", &sets, |model, state| look((model, state), most, &mut seen))?;
    Ok(vec![
        ("leak".into(), seen.fluid[1] / seen.peak),
        ("dry".into(), seen.fluid[0] / seen.peak),
        ("contact_pressure".into(), seen.peak / closed),
        ("balance".into(), seen.balance),
        ("reaction".into(), seen.reaction),
    ])
}
