//! Limit pressures of thick shells, `b/a = 2`: tube `2/sqrt(3) sy ln(b/a)`, sphere `2 sy ln(b/a)`.

use crate::bench::{Bench, Solved};
use crate::{Case, Measured};
use asperity::Error;
use std::f64::consts::TAU;

/// The case.
pub const CASE: Case = Case { name: "thick-shells", measure };

/// The load of the sphere's deck.
const PRESSURE: f64 = 1.6;
/// Height of the layer of the tube.
const HEIGHT: f64 = 0.1;

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let n = bench.pick(1, 4);
    let tube = bench.solve("tube.toml", &[format!("mesh.part.tube.rectangle.cells=[{}, 1]", 8 * n)])?;
    let cells = format!("mesh.part.sphere.annulus.cells=[{}, {}]", 8 * n, 10 * n);
    let sphere = bench.exhaust("sphere.toml", &[cells])?;
    Ok(vec![
        ("tube".into(), bore_pressure(&tube)),
        ("tube_iterations".into(), tube.iterations()),
        ("sphere".into(), PRESSURE * sphere.state.step_time),
    ])
}

/// Force on the bore over its present area.
fn bore_pressure(tube: &Solved) -> f64 {
    let bore = &tube.model.mesh.groups["tube.left"].nodes;
    let radius = 1.0 + tube.state.u[tube.model.problem.dofs.node(bore[0])];
    tube.reaction("tube.left")[0] / (TAU * radius * HEIGHT)
}
