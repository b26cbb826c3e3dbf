//! Two glued blocks of different meshes under uniform pressure: the stress is uniform to rounding.

use crate::bench::{Bench, Solved};
use crate::{Case, Measured};
use asperity::Error;

/// The case.
pub const CASE: Case = Case { name: "tie-patch", measure };

const PRESSURE: f64 = 3.0;

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let plane = [
        ("plane_strain_quad4", "plane-strain", ["quad4", "quad4"]),
        ("plane_strain_quad8", "plane-strain", ["quad8", "quad8"]),
        ("plane_strain_mixed", "plane-strain", ["quad4", "tri6"]),
        ("axisymmetric_quad4", "axisymmetric", ["quad4", "quad4"]),
        ("axisymmetric_quad8", "axisymmetric", ["quad8", "quad8"]),
    ];
    let space = [
        ("hex8", ["hex8", "hex8"]),
        ("hex20", ["hex20", "hex20"]),
        ("tet10", ["hex8", "tet10"]),
        ("wedge15", ["tet4", "wedge15"]),
    ];
    let mut measured = Measured::new();
    for (key, space, [low, up]) in plane {
        let cells = ["low", "up"].into_iter().zip([low, up]);
        let mut sets: Vec<String> =
            cells.map(|(part, cell)| format!("mesh.part.{part}.rectangle.cell={cell}")).collect();
        sets.push(format!("space={space}"));
        measured.push((key.into(), error(&bench.solve("blocks.toml", &sets)?)));
    }
    for (key, [low, up]) in space {
        let cells = ["low", "up"].into_iter().zip([low, up]);
        let mut sets: Vec<String> = cells.map(|(part, cell)| format!("mesh.part.{part}.box.cell={cell}")).collect();
        sets.extend((low == "tet4").then(|| "body.low.degree=1".to_string()));
        measured.push((key.into(), error(&bench.solve("boxes.toml", &sets)?)));
    }
    Ok(measured)
}

/// Largest deviation of the vertical stress from the pressure, over the pressure.
fn error(run: &Solved) -> f64 {
    let bodies = run.model.bodies.iter().zip(&run.state.histories);
    let stresses = bodies.flat_map(|((body, _), history)| body.records(&run.state.u, history));
    stresses.map(|record| (record.state[1] + PRESSURE).abs() / PRESSURE).fold(0.0, f64::max)
}
