//! A rigid hub turned by 200 degrees under torque: closed form, and work in against energy stored.

use crate::bench::{Bench, Solved};
use crate::{Case, Measured};
use asperity::Error;

/// The case.
pub const CASE: Case = Case { name: "rigid-hub", measure };

/// Torque over rotation, and the rotation: `4 pi G / (1/a^2 - 1/b^2)` with `G = 4`, `a = 1`, `b = 2`.
const STIFFNESS: f64 = 16.0 * std::f64::consts::PI / 0.75;
const TURN: f64 = 200.0;

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let finer = bench.pick(vec![], vec!["mesh.part.ring.annulus.cells=[16, 96]".to_owned()]);
    let hub = bench.solve("hub.toml", &finer)?;
    let turn = hub.state.u[hub.model.problem.dofs.tool(0) + 2].to_degrees();
    let exact = 0.5 * STIFFNESS * TURN.to_radians().powi(2);
    let twist = bench.solve("twist.toml", &[])?;
    Ok(vec![
        ("turn".into(), turn),
        ("stored".into(), stored(&hub) / exact),
        ("work".into(), hub.state.external_work / stored(&hub) - 1.0),
        ("twist".into(), twist.state.external_work / stored(&twist) - 1.0),
    ])
}

fn stored(run: &Solved) -> f64 {
    run.state.energies.iter().map(|energies| energies.stored).sum()
}
