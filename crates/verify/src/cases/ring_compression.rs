//! The ring test: how a bore widens or closes under friction `m k`, beside Avitzur's upper bound.

use crate::bench::Bench;
use crate::{Case, Measured, fit};
use asperity::Error;
use asperity::model::Model;
use asperity::output::figure::Chart;
use asperity::system::State;

/// The case.
pub const CASE: Case = Case { name: "ring-compression", measure };

/// Shear factors, as their keys say them, and the decrease of the bore in per cent by Avitzur.
const TABLE: [(&str, f64, [f64; 6]); 5] = [
    ("0", 0.0, [-5.41, -11.80, -19.52, -29.10, -41.42, -58.11]),
    ("005", 0.05, [-4.37, -9.26, -14.72, -20.75, -27.13, -32.96]),
    ("01", 0.1, [-3.32, -6.72, -10.00, -12.67, -13.64, -11.77]),
    ("02", 0.2, [-1.15, -1.51, -0.97, 0.80, 4.81, 13.23]),
    ("04", 0.4, [1.38, 3.60, 7.10, 12.68, 21.91, 38.50]),
];
const BORE: f64 = 1.5;

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let mut measured = Measured::new();
    let mut chart = Chart::new("Ring 6:3:2", "reduction of height in per cent", "decrease of bore in per cent");
    for (key, factor, table) in TABLE {
        let curve = press(bench, factor)?;
        for at in [10.0, 20.0, 30.0, 40.0, 50.0, 60.0] {
            measured.push((format!("m_{key}_{at}"), fit::at(&curve, at)));
        }
        chart.line(format!("m = {factor}"), curve.iter().map(|&(x, y)| [x, y]).collect());
        let row = table.iter().enumerate().map(|(i, &y)| [10.0 * (i + 1) as f64, y]).collect();
        let style = chart.series.len() - 1;
        let line = chart.line(if factor == 0.4 { "Avitzur" } else { "" }, row);
        (line.marks, line.width, line.style) = (true, 0.0, style);
    }
    bench.draw("ring-compression", &chart)?;
    Ok(measured)
}

/// Decrease of the bore over the reduction, both in per cent.
fn press(bench: &Bench, factor: f64) -> Result<Vec<(f64, f64)>, Error> {
    let (n, increments) = bench.pick((1, 60), (2, 300));
    let law = if factor == 0.0 { "={ frictionless = {} }".into() } else { format!(".shear_factor.factor={factor:?}") };
    let mut sets: Vec<String> = ["end", "bore", "rim"].map(|name| format!("contact.{name}.law{law}")).into();
    sets.push(format!("mesh.part.ring.rectangle.cells=[{}, {}]", 6 * n, 4 * n));
    sets.push(format!("step.press.increments.count={increments}"));
    let mut curve = vec![(0.0, 0.0)];
    bench.follow("ring.toml", &sets, |model, state| curve.push((60.0 * state.time, closed(model, state))))?;
    Ok(curve)
}

/// Mean decrease of the bore over its nodes.
fn closed(model: &Model, state: &State) -> f64 {
    let bore = &model.mesh.groups["ring.left"].nodes;
    let moved: f64 = bore.iter().map(|&node| state.u[model.problem.dofs.node(node)]).sum();
    -100.0 * moved / (BORE * bore.len() as f64)
}
