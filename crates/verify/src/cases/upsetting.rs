//! A cube upset by half: its force between that without friction and the slab's with it, and what the way costs.

use crate::bench::{Bench, Solved};
use crate::{Case, Measured};
use asperity::Error;

/// The case.
pub const CASE: Case = Case { name: "upsetting", measure };

/// Force on an eighth of the cube at half its height without friction: twice the area at the flow stress of `ln 2`.
fn uniform() -> f64 {
    200.0 * (400.0 + 500.0 * 2.0_f64.ln())
}

/// The run of a cube of cells of a kind, so many along each edge.
fn upset(bench: &Bench, cell: &str, formulation: &str, n: usize) -> Result<Solved, Error> {
    let sets = [
        format!("mesh.part.cube.box.cell={cell:?}"),
        format!("mesh.part.cube.box.cells=[{n}, {n}, {n}]"),
        format!("body.cube.formulation={formulation}"),
    ];
    bench.solve("upsetting.toml", &sets)
}

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let mut measured = Measured::new();
    for (cell, formulation, name) in
        [("hex8", "auto", ""), ("hex8", "standard", "standard_"), ("hex20", "auto", "second_degree_")]
    {
        let n = bench.pick(6, 12) / if cell == "hex20" { 2 } else { 1 };
        let run = upset(bench, cell, formulation, n)?;
        let force: f64 = run.points(0).iter().map(|point| point.force()[2].abs()).sum();
        let found = [("force", force / uniform()), ("iterations", run.solutions() as f64), ("cuts", run.cuts() as f64)];
        measured.extend(found.map(|(key, value)| (format!("{name}{key}"), value)));
    }
    let value = |key: &str| measured.iter().find(|(known, _)| known == key).map_or(f64::NAN, |(_, value)| *value);
    let [force, standard, second] = ["", "standard_", "second_degree_"].map(|name| value(&format!("{name}force")));
    let between = second.min(standard) <= force && force <= second.max(standard);
    measured.extend([
        ("over_standard".into(), value("iterations") / value("standard_iterations")),
        ("over_second_degree".into(), force / second),
        ("between".into(), f64::from(between)),
    ]);
    for (name, n) in [("coarse", bench.pick(3, 8)), ("medium", bench.pick(4, 10)), ("fine", bench.pick(5, 14))] {
        let [own, standard] = ["auto", "standard"].map(|formulation| upset(bench, "hex8", formulation, n));
        let (own, standard) = (own?, standard?);
        measured.extend([
            (format!("{name}_over_standard"), own.solutions() as f64 / standard.solutions() as f64),
            (format!("{name}_cuts"), own.cuts() as f64),
        ]);
    }
    Ok(measured)
}
