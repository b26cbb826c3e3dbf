//! A block under uniform pressure on a plane: the contact pressure is constant, on edges of both degrees, with every
//! number of contact points that integrates the edge exactly.

use crate::bench::{Bench, Solved, resultant};
use crate::{Case, Measured};
use asperity::Error;

/// The case.
pub const CASE: Case = Case { name: "contact-patch", measure };

/// Pressure times undeformed width.
const FORCE: f64 = 30.0;
const CELLS: [(&str, &str); 5] =
    [("quad4", "full"), ("tri3", "full"), ("quad8", "reduced"), ("quad9", "full"), ("tri6", "full")];

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let (mut spread, mut balance) = (0.0_f64, 0.0_f64);
    let mut measured = Vec::new();
    for (cell, integration) in CELLS {
        let sets = |gauss: Option<usize>| {
            let kind =
                [format!("mesh.part.block.rectangle.cell={cell}"), format!("body.block.integration={integration}")];
            let kept = (cell == "tri3").then(|| "body.block.degree=1".to_string());
            kind.into_iter()
                .chain(kept)
                .chain(gauss.map(|points| format!("contact.sole.gauss={points}")))
                .collect::<Vec<_>>()
        };
        let default = bench.solve("patch.toml", &sets(None))?;
        measured.push((cell.into(), self::spread(&default)));
        balance = balance.max((force(&default) / FORCE - 1.0).abs());
        for points in 2..=3 {
            spread = spread.max(self::spread(&bench.solve("patch.toml", &sets(Some(points)))?));
        }
    }
    measured.push(("more_points".into(), spread));
    measured.push(("force".into(), balance));
    Ok(measured)
}

fn force(run: &Solved) -> f64 {
    resultant(&run.points(0))[1]
}

/// Difference of the largest and the smallest pressure over the mean.
fn spread(run: &Solved) -> f64 {
    let pressures: Vec<f64> = run.points(0).iter().map(|point| point.pressure).collect();
    let (low, high) = pressures.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), &p| (low.min(p), high.max(p)));
    (high - low) * pressures.len() as f64 / pressures.iter().sum::<f64>()
}
