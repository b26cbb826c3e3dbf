//! A round tool pushed into a block and drawn along it without friction: what the work of the supports misses of the
//! stored energy over the drawing, in which no point opens or closes, by the form of the contact and by the law of the solid.

use crate::bench::Bench;
use crate::{Case, Measured};
use asperity::Error;
use asperity::system::{Energies, State};

/// The case.
pub const CASE: Case = Case { name: "energy-balance", measure };

/// The linear law between Cauchy's stress and Jaumann's rate in place of rubber.
const RATE: &str = "material.rubber={ elastic = { young = 7.5, poisson = 0.25 } }";
/// Stress at Gauss points.
const PAPER: &str = "contact.base.form=paper";

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let ideal = limit(bench, &[])?;
    let paper = limit(bench, &[PAPER])?;
    let rate = limit(bench, &[RATE])?;
    let both = limit(bench, &[PAPER, RATE])?;
    Ok(vec![
        ("field".into(), ideal.missing.abs()),
        ("order".into(), ideal.order),
        ("paper".into(), paper.missing),
        ("hypoelastic".into(), rate.missing.abs()),
        ("hypoelastic_order".into(), rate.order),
        ("residue".into(), rate.residue),
        ("paper_rate".into(), both.missing),
        ("paper_residue".into(), both.residue),
    ])
}

/// What drawing the tool misses and what the rate law leaves over, both over the strain energy and for infinitely many
/// increments, and the order at which the first is approached.
struct Limit {
    missing: f64,
    residue: f64,
    order: f64,
}

fn limit(bench: &Bench, sets: &[&str]) -> Result<Limit, Error> {
    let coarse = bench.pick(1, 4);
    let [a, b, c] = [drawn(bench, sets, coarse)?, drawn(bench, sets, 2 * coarse)?, drawn(bench, sets, 4 * coarse)?];
    let [missing, residue] = [0, 1].map(|i| c[i] + (c[i] - b[i]) / 3.0);
    Ok(Limit { missing, residue, order: ((b[0] - a[0]) / (c[0] - b[0])).log2() })
}

/// What drawing the tool misses and what the rate law leaves over meanwhile, over the strain energy.
fn drawn(bench: &Bench, sets: &[&str], times: usize) -> Result<[f64; 2], Error> {
    let count = format!("step.draw.increments.count={}", 10 * times);
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).chain([count]).collect();
    let mut pushed = [0.0; 2];
    let run = bench.follow("block.toml", &sets, |_, state| {
        if state.time <= 1.0 + 1e-9 {
            pushed = ledger(state);
        }
    })?;
    let end = ledger(&run.state);
    Ok([0, 1].map(|i| (end[i] - pushed[i]) / run.state.energies[0].stored))
}

/// Work from outside that nothing has taken up, and the residue of the rate law.
fn ledger(state: &State) -> [f64; 2] {
    let taken: f64 = state.energies.iter().map(Energies::taken).sum();
    [state.external_work - taken, state.energies.iter().map(|energy| energy.residue).sum()]
}
