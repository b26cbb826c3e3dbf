//! Prandtl's limit load of a strip punch on perfectly plastic ground, `(2 + pi)/sqrt(3) sy`.

use crate::bench::{Bench, Solved};
use crate::{Case, Measured, fit};
use asperity::Error;

/// The case.
pub const CASE: Case = Case { name: "strip-punch", measure };

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let finest = bench.pick(8, 32);
    let runs = [4, 2, 1].map(|part| run(bench, finest / part, &[]));
    let [coarse, middle, fine] = runs;
    let loads = [load(&coarse?), load(&middle?), load(&fine?)];
    let settled = |formulation| {
        let formulation = format!("body.ground.formulation={formulation}");
        run(bench, 8, &[&formulation, "step.press.displacement.face={ y = -0.02 }"])
    };
    let [locked, free] = [settled("standard")?, settled("f-bar")?];
    let tight = run(bench, bench.pick(8, 16), &["solver.tolerance=1e-11"])?;
    Ok(vec![
        ("finest".into(), loads[2]),
        ("extrapolated".into(), fit::extrapolate(loads)),
        ("locked".into(), load(&locked) / load(&free)),
        ("order".into(), tight.order()),
        ("iterations".into(), tight.iterations()),
    ])
}

/// The deck with `n` cells under the half of the punch.
fn run(bench: &Bench, n: usize, more: &[&str]) -> Result<Solved, Error> {
    let (part, rest) = ("mesh.part.ground.rectangle", 5 * n / 2);
    let mut sets = vec![
        format!("{part}.along_x=[{{ to = 1.0, cells = {n} }}, {{ to = 6.0, cells = {rest}, smooth = true }}]"),
        format!("{part}.along_y=[{{ to = 0.0, cells = {rest}, ratio = 0.25 }}]"),
    ];
    sets.extend(more.iter().map(|set| (*set).to_string()));
    bench.solve("punch.toml", &sets)
}

/// Mean pressure under the half of the punch, of width 1.
fn load(run: &Solved) -> f64 {
    -run.reaction("face")[1]
}
