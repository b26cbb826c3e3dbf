//! An O-ring squeezed into its groove: Lindley's force until it touches the walls, and what the way costs.

use crate::bench::{Bench, points};
use crate::{Case, Measured};
use asperity::Error;
use asperity::model::Model;
use asperity::system::State;

/// The case.
pub const CASE: Case = Case { name: "o-ring", measure };

/// Contacts of the deck, in its order.
const LID: usize = 1;
/// Travel of the lid, and the part of it at which forces are compared: the ring does not touch the walls yet.
const TRAVEL: f64 = 1.1;
const SQUEEZE: f64 = 0.6;
/// Diameter of the section, mean diameter of the ring, and Young's modulus of the rubber, 3 G.
const SECTION: f64 = 4.0;
const RING: f64 = 40.0;
const YOUNG: f64 = 6.0;

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let mut curve = Vec::new();
    let run = bench.follow("o-ring.toml", &[], |model, state| curve.push((state.time, lid(model, state))))?;
    let (time, force) = curve.iter().copied().filter(|(time, _)| *time <= SQUEEZE).next_back().unwrap_or_default();
    let squeeze = TRAVEL * time / SECTION;
    let lindley = std::f64::consts::PI * RING * SECTION * YOUNG * (1.25 * squeeze.powf(1.5) + 50.0 * squeeze.powi(6));
    Ok(vec![
        ("force".into(), force / lindley - 1.0),
        ("end".into(), curve.last().map_or(f64::NAN, |(_, force)| *force)),
        ("iterations".into(), run.iterations()),
        ("cuts".into(), run.cuts() as f64),
    ])
}

/// Force of the lid on the ring, downwards.
fn lid(model: &Model, state: &State) -> f64 {
    -points(model, state, LID).iter().map(|point| point.force()[1]).sum::<f64>()
}
