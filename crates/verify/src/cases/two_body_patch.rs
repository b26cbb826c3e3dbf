//! Two blocks of different meshes under uniform pressure: the stress is uniform to rounding.

use crate::bench::{Bench, Solved};
use crate::{Case, Measured};
use asperity::Error;

/// The case.
pub const CASE: Case = Case { name: "two-body-patch", measure };

const PRESSURE: f64 = 10.0;

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let n = bench.pick(1, 3);
    let meshed = |foundation: &str, punch: &str| {
        vec![
            format!("mesh.part.foundation.rectangle.cells=[{}, {}]", 7 * n, 3 * n),
            format!("mesh.part.punch.rectangle.cells=[{}, {}]", 5 * n, 2 * n),
            format!("mesh.part.foundation.rectangle.cell={foundation}"),
            format!("mesh.part.punch.rectangle.cell={punch}"),
        ]
    };
    let with = |mut sets: Vec<String>, more: &[&str]| {
        sets.extend(more.iter().map(|set| (*set).to_owned()));
        bench.solve("flush.toml", &sets)
    };
    let one = with(meshed("quad4", "quad4"), &["contact.joint.passes=one", "contact.joint.gauss=2"])?;
    Ok(vec![
        ("flush_quad4".into(), error(&with(meshed("quad4", "quad4"), &[])?)),
        ("flush_quad8".into(), error(&with(meshed("quad8", "quad8"), &[])?)),
        ("flush_mixed".into(), error(&with(meshed("quad4", "quad8"), &[])?)),
        ("punch_quad4".into(), error(&bench.solve("punch4.toml", &[])?)),
        ("punch_quad8".into(), error(&bench.solve("punch8.toml", &[])?)),
        ("one_pass".into(), error(&one)),
        ("two_passes".into(), error(&with(meshed("quad8", "quad8"), &["contact.joint.passes=two"])?)),
        ("one_pass_quad8".into(), error(&with(meshed("quad8", "quad8"), &["contact.joint.passes=one"])?)),
        ("flush_hex8".into(), error(&bench.solve("flush_box.toml", &boxes(bench, "hex8", "hex8"))?)),
        ("flush_hex20".into(), error(&bench.solve("flush_box.toml", &boxes(bench, "hex20", "hex20"))?)),
        ("flush_tet10".into(), error(&bench.solve("flush_box.toml", &boxes(bench, "tet10", "hex8"))?)),
        ("punch_hex8".into(), error(&bench.solve("punch_box.toml", &[])?)),
    ])
}

/// The meshes of two blocks in space.
fn boxes(bench: &Bench, foundation: &str, punch: &str) -> Vec<String> {
    let (low, high) = bench.pick(([3, 2, 2], [2, 1, 3]), ([7, 3, 5], [5, 2, 4]));
    vec![
        format!("mesh.part.foundation.box.cells={low:?}"),
        format!("mesh.part.punch.box.cells={high:?}"),
        format!("mesh.part.foundation.box.cell={foundation}"),
        format!("mesh.part.punch.box.cell={punch}"),
    ]
}

/// Largest deviation of the vertical stress from the pressure, over the pressure.
fn error(run: &Solved) -> f64 {
    let bodies = run.model.bodies.iter().zip(&run.state.histories);
    let stresses = bodies.flat_map(|((body, _), history)| body.records(&run.state.u, history));
    stresses.map(|record| (record.state[1] + PRESSURE).abs() / PRESSURE).fold(0.0, f64::max)
}
