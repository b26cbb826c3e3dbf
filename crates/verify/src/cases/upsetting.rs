//! A cube upset by half: its force between that without friction and the slab's with it, and what the way costs.

use crate::bench::Bench;
use crate::{Case, Measured};
use asperity::Error;

/// The case.
pub const CASE: Case = Case { name: "upsetting", measure };

/// Force on an eighth of the cube at half its height without friction: twice the area at the flow stress of `ln 2`.
fn uniform() -> f64 {
    200.0 * (400.0 + 500.0 * 2.0_f64.ln())
}

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let mut measured = Measured::new();
    for (cell, formulation, name) in
        [("hex8", "auto", ""), ("hex8", "standard", "standard_"), ("hex20", "auto", "second_degree_")]
    {
        let n = bench.pick(6, 12) / if cell == "hex20" { 2 } else { 1 };
        let sets = [
            format!("mesh.part.cube.box.cell={cell:?}"),
            format!("mesh.part.cube.box.cells=[{n}, {n}, {n}]"),
            format!("body.cube.formulation={formulation}"),
        ];
        let run = bench.solve("upsetting.toml", &sets)?;
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
    Ok(measured)
}
