//! A ring crushed until its bore touches itself is twice its upper half crushed against a plane.

use crate::bench::{Bench, Solved, both_forms};
use crate::{Case, Measured};
use asperity::Error;

/// The case.
pub const CASE: Case = Case { name: "crushed-ring", measure };

fn measure(bench: &Bench) -> Result<Measured, Error> {
    both_forms(&["contact.bore.form=paper"], |form| crushed(bench, form))
}

fn crushed(bench: &Bench, form: &[String]) -> Result<Measured, Error> {
    let n = bench.pick(1, 2);
    let solve = |deck: &str, cells: usize, more: &[&str]| {
        let cells = [format!("mesh.part.ring.annulus.cells=[{n}, {}]", n * cells)];
        let more: Vec<String> = more.iter().map(|set| (*set).to_owned()).collect();
        bench.solve(deck, &[&cells[..], form, &more].concat())
    };
    let (ring, half) = (solve("ring.toml", 64, &[])?, solve("half.toml", 32, &[])?);
    let free = solve("half.toml", 32, &["tool.plane.profile=[{ line = [[5.0, -90.0], [-5.0, -90.0]] }]"])?;
    let (force, expected) = (ring.reaction("top")[1], half.reaction("top")[1]);
    Ok(vec![
        ("contact".into(), 1.0 - free.reaction("top")[1] / expected),
        ("force".into(), force / expected - 1.0),
        ("pressure".into(), peak(&ring) / peak(&half) - 1.0),
        ("iterations".into(), ring.iterations()),
        ("cuts".into(), ring.cuts() as f64),
    ])
}

fn peak(run: &Solved) -> f64 {
    run.points(0).iter().map(|point| point.pressure).fold(0.0, f64::max)
}
