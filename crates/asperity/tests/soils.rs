//! Soils whose pore water cannot leave, and soil that does not dilate under a footing.

mod support;

use support::{columns, model, run};

/// An undrained cylinder of Mohr-Coulomb soil that does not dilate bears `6 c cos(phi) / (3 - sin(phi))`, whatever its cells: those that
/// choose incompatible modes keep amplitudes of these behind the pressure of the water.
#[test]
fn an_undrained_cylinder_bears_its_cohesion_in_all_cells() {
    let deck = r#"
version = 1
space = "axisymmetric"
mesh.part.b.rectangle = { from = [0.0, 0.0], to = [1.0, 1.0], cells = [2, 2], cell = "quad4" }
material.m.mohr_coulomb = { young = 1e3, poisson = 0.3, cohesion = 5.0, friction = 20.0 }
body.b = { material = "m", pore_stiffness = 1e6 }
[[step]]
increments.count = 10
symmetry = ["b.left", "b.bottom"]
displacement."b.top".y = -0.05
"#;
    let phi = 20.0_f64.to_radians();
    let strength = 6.0 * 5.0 * phi.cos() / (3.0 - phi.sin());
    // The area grows as the height falls.
    let force = strength * std::f64::consts::PI / 0.95;
    for cell in ["quad4", "quad8", "tri6"] {
        let model = model(deck, &[&format!("mesh.part.b.rectangle.cell=\"{cell}\"")]);
        let found = *columns(&model, &run(&model))["reaction.b.bottom.y"].last().unwrap();
        assert!((found / force - 1.0).abs() < 0.01, "{cell}: {found} in place of {force}");
    }
}

/// Soil of 25 degrees that does not dilate has no equilibrium near many states under a footing: where one was relaxed the next is at once,
/// since shorter ones have none either.
#[test]
fn a_footing_on_soil_without_dilatancy_settles_in_few_increments() {
    let deck = r#"
version = 1
space = "plane-strain"
[mesh.part.s.rectangle]
from = [0.0, -7.8]
along_x = [{ to = 1.3, cells = 5, ratio = 0.25 }, { to = 10.4, cells = 11, ratio = 14.0 }]
along_y = [{ to = 0.0, cells = 10, ratio = 0.1 }]
cell = "quad4"
[material.m]
mohr_coulomb = { young = 2e4, poisson = 0.3, cohesion = 12.0, friction = 25.0 }
[body.s]
material = "m"
strain = "small"
[group.foot]
of = "s.top"
x = [-0.01, 1.31]
[[step]]
displacement = { "s.bottom" = { x = 0.0, y = 0.0 }, "s.left" = { x = 0.0 }, "s.right" = { x = 0.0 }, foot = { x = 0.0, y = -0.18008812705280236 } }
"#;
    let increments = run(&model(deck, &[])).states.len();
    assert!(increments <= 30, "{increments}");
}
