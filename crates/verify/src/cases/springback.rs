//! Springback of a bent strip: tools removed in one line, against tools lifted off.

use crate::bench::Bench;
use crate::{Case, Measured};
use asperity::Error;

/// The case.
pub const CASE: Case = Case { name: "springback", measure };

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let mut drawn = Vec::new();
    let removed = bench.follow("strip.toml", &[], |_, state| {
        if state.step == 0 || drawn.is_empty() || state.step_increment == 0 && state.step == 1 {
            drawn.clone_from(&state.u);
        }
    })?;
    let lifted = bench.solve("lifted.toml", &[])?;
    let (mesh, dofs) = (&removed.model.mesh, &removed.model.problem.dofs);
    let distance = |one: &[f64], other: &[f64], node: usize| {
        let first = dofs.node(node);
        (one[first] - other[first]).hypot(one[first + 1] - other[first + 1])
    };
    let all =
        |one: &[f64], other: &[f64]| (0..mesh.points.len()).map(|node| distance(one, other, node)).fold(0.0, f64::max);
    let still = vec![0.0; removed.state.u.len()];
    let apart = all(&removed.state.u, &lifted.state.u);
    let end = mesh.groups["strip.bottom_right"].nodes[0];
    let springback = distance(&removed.state.u, &drawn, end);
    Ok(vec![
        ("apart".into(), apart / all(&removed.state.u, &still)),
        ("of_springback".into(), apart / springback),
        ("springback".into(), springback),
    ])
}
