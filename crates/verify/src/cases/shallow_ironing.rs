//! Shallow ironing after Fischer and Wriggers: a slider pressed into a softer slab and dragged over many
//! of its edges, while both deform. Six codes are published; without friction the work of the drag must be
//! stored.

use crate::bench::{Bench, reaction};
use crate::{Case, Measured};
use asperity::Error;

/// The case.
pub const CASE: Case = Case { name: "shallow-ironing", measure };

/// Where the published forces are compared.
const COMPARED: f64 = 5.0;

/// An accepted state.
struct Moment {
    time: f64,
    /// Force on the slider along and across the slab.
    force: [f64; 2],
    stored: f64,
}

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let (press, (drag, steps), cells) = bench.pick((5, (5.0, 50), [40, 6]), (10, (10.0, 500), [60, 10]));
    let sets = |friction: f64| {
        vec![
            format!("mesh.part.slab.rectangle.cells={cells:?}"),
            format!("step.1.increments.count={press}"),
            format!("step.2.increments.count={steps}"),
            format!("step.2.displacement.head.x={drag:?}"),
            format!("contact.sole.law.coulomb.friction={friction:?}"),
        ]
    };
    let mut moments = Vec::new();
    let run = follow(bench, &sets(0.3), &mut moments)?;
    let at = |time: f64| {
        let distance = |moment: &&Moment| (moment.time - time).abs();
        moments.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).map_or([f64::NAN; 2], |moment| moment.force)
    };
    let (pressed, dragged) = (at(1.0), at(1.0 + COMPARED / drag));
    let mut smooth = Vec::new();
    follow(bench, &sets(0.0), &mut smooth)?;
    Ok(vec![
        ("pressed_v".into(), -pressed[1]),
        ("pressed_h".into(), pressed[0]),
        ("dragged_v".into(), -dragged[1]),
        ("dragged_h".into(), dragged[0]),
        ("iterations".into(), run.0),
        ("cuts".into(), run.1),
        ("frictionless".into(), unstored(&smooth, drag) / -dragged[1]),
    ])
}

/// Iterations an increment, and cuts.
fn follow(bench: &Bench, sets: &[String], moments: &mut Vec<Moment>) -> Result<(f64, f64), Error> {
    let run = bench.follow("ironing.toml", sets, |model, state| {
        let stored = state.energies.iter().map(|energies| energies.stored).sum();
        moments.push(Moment { time: state.time, force: reaction(model, state, "head"), stored });
    })?;
    Ok((run.iterations(), run.cuts() as f64))
}

/// Mean force along the slab over the drag, less the growth of the stored energy over its length.
fn unstored(moments: &[Moment], distance: f64) -> f64 {
    let drag: Vec<&Moment> = moments.iter().filter(|moment| moment.time > 1.0 - 1e-9).collect();
    let work: f64 =
        drag.windows(2).map(|w| 0.5 * (w[0].force[0] + w[1].force[0]) * distance * (w[1].time - w[0].time)).sum();
    match drag[..] {
        [first, .., last] => (work - (last.stored - first.stored)) / distance,
        _ => f64::NAN,
    }
}
