//! Soils whose pore water cannot leave.

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
