//! An O-ring squeezed into its groove: Hertz's force while little is squeezed, and what the way costs.

use crate::bench::{Bench, points, resultant};
use crate::{Case, Measured};
use asperity::Error;
use asperity::model::Model;
use asperity::system::State;
use std::f64::consts::PI;

/// The case.
pub const CASE: Case = Case { name: "o-ring", measure };

/// Contacts of the deck, in its order.
const LID: usize = 1;
/// Travel of the lid, and the part of it up to which forces are compared: a twentieth of the section.
const TRAVEL: f64 = 1.1;
const SQUEEZE: f64 = 0.2;
/// Radius of the section, mean radius of the ring, and plane modulus of the rubber, 4 G.
const SECTION: f64 = 2.0;
const RING: f64 = 20.0;
const MODULUS: f64 = 8.0;

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let mut curve = Vec::new();
    let run = bench.follow("o-ring.toml", &[], |model, state| curve.push((state.time, lid(model, state))))?;
    let (time, force) = curve.iter().copied().rfind(|(time, _)| *time <= SQUEEZE).unwrap_or_default();
    let hertz = 2.0 * PI * RING * hertz(TRAVEL * time);
    Ok(vec![
        ("force".into(), force / hertz - 1.0),
        ("end".into(), curve.last().map_or(f64::NAN, |(_, force)| *force)),
        ("iterations".into(), run.iterations()),
        ("cuts".into(), run.cuts() as f64),
    ])
}

/// Force of the lid on the ring, downwards.
fn lid(model: &Model, state: &State) -> f64 {
    -resultant(&points(model, state, LID))[1]
}

/// Force a length under which a cylinder between two plates is shorter by `approach`, by bisection:
/// `2 P / (pi E') (2 ln(4 R / a) - 1)` with `a^2 = 4 P R / (pi E')`.
fn hertz(approach: f64) -> f64 {
    let shortened = |force: f64| {
        let unit = force / (PI * MODULUS);
        2.0 * unit * (2.0 * (4.0 * SECTION / (4.0 * unit * SECTION).sqrt()).ln() - 1.0)
    };
    let (mut low, mut high) = (1e-9, 0.5 * MODULUS);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if shortened(middle) < approach { low = middle } else { high = middle }
    }
    low
}
