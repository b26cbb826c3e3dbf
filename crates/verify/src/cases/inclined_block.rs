//! A block pushed up a slope by a horizontal force: `F / G = (tan alpha + mu) / (1 - mu tan alpha)`.

use crate::bench::Bench;
use crate::{Case, Measured};
use asperity::Error;

/// The case.
pub const CASE: Case = Case { name: "inclined-block", measure };

/// Weight of the block, 8 by 10.
const WEIGHT: f64 = 80.0;
const SLOPE: f64 = 0.1;

fn measure(bench: &Bench) -> Result<Measured, Error> {
    (0..4).map(|tenths| push(bench, tenths)).collect()
}

fn push(bench: &Bench, tenths: usize) -> Result<(String, f64), Error> {
    let run = bench.solve("block.toml", &[format!("contact.sole.law.coulomb.friction=0.{tenths}")])?;
    let [x, y] = run.reaction("block.left");
    Ok((format!("mu_0{tenths}"), (x - SLOPE * y) / SLOPE.hypot(1.0) / WEIGHT))
}
