//! A rigid ball pressed into an elastic slab and dragged along it with friction: `H = mu V` but for the bow wave.

use crate::bench::{Bench, points, resultant};
use crate::{Case, Measured};
use asperity::Error;
use asperity::contact::ContactRecord;

/// The case.
pub const CASE: Case = Case { name: "dragged-ball", measure };

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let cells = bench.pick("[16, 6, 4]", "[32, 12, 8]");
    let (mut ratios, mut violation) = (Vec::new(), 0.0_f64);
    let run = bench.follow("slab.toml", &[format!("mesh.part.slab.box.cells={cells}")], |model, state| {
        let points = points(model, state, 0);
        violation = points.iter().map(|point| point.violation).fold(violation, f64::max);
        if state.time > 1.5 {
            let force = resultant(&points);
            ratios.push(-force[0] / force[2]);
        }
    })?;
    let (least, most) = ratios.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), &r| (a.min(r), b.max(r)));
    Ok(vec![
        ("ratio".into(), ratios.iter().sum::<f64>() / ratios.len() as f64),
        ("ripple".into(), most - least),
        ("cone".into(), violation),
        ("along".into(), along(&run.points(0))),
        ("iterations".into(), run.iterations()),
        ("cuts".into(), run.cuts() as f64),
    ])
}

/// Friction along the motion over all friction.
fn along(points: &[ContactRecord]) -> f64 {
    let forward: f64 = points.iter().map(|point| point.area * point.shear * point.along[0]).sum();
    forward / points.iter().map(|point| point.area * point.shear).sum::<f64>()
}
