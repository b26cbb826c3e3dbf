//! A periodic cell of a laminate: its moduli are those of the layers in series and side by side, exactly.

mod support;

use support::{columns, model, run};

/// Layers of modulus 10 and 1000 across x, 0.3 and 0.7 wide, without lateral strain; what is led and how.
fn modulus(led: &str, column: &str) -> f64 {
    let deck = format!(
        r#"
version = 1
space = "plane-strain"
mesh.part.cell.rectangle = {{ from = [0.0, 0.0], to = [1.0, 1.0], cells = [10, 4], cell = "quad4" }}
group.soft = {{ of = "cell", x = [0.0, 0.3] }}
group.stiff = {{ of = "cell", x = [0.3, 1.0] }}
material.soft.elastic = {{ young = 10.0, poisson = 0.0 }}
material.stiff.elastic = {{ young = 1000.0, poisson = 0.0 }}
body.soft = {{ material = "soft", strain = "small" }}
body.stiff = {{ material = "stiff", strain = "small" }}
solver.tolerance = 1e-12
[[periodic]]
surface = "cell.right"
target = "cell.left"
lead = "cell.bottom_right"
[[periodic]]
surface = "cell.top"
target = "cell.bottom"
lead = "cell.top_left"
[[step]]
increments = {{ count = 1 }}
displacement."cell.bottom_left" = {{ x = 0.0, y = 0.0 }}
{led}
"#
    );
    let model = model(&deck, &[]);
    let history = columns(&model, &run(&model));
    history[column].last().unwrap() / 1e-3
}

#[test]
fn a_laminate_has_its_exact_moduli() {
    let across = "displacement.\"cell.bottom_right\" = { x = 1e-3, y = 0.0 }\ndisplacement.\"cell.top_left\" = { x = 0.0, y = 0.0 }";
    let series = 1.0 / (0.3 / 10.0 + 0.7 / 1000.0);
    let found = modulus(across, "reaction.cell.bottom_right.x");
    assert!((found / series - 1.0).abs() < 1e-10, "{found} {series}");
    let along = "displacement.\"cell.bottom_right\" = { x = 0.0, y = 0.0 }\ndisplacement.\"cell.top_left\" = { x = 0.0, y = 1e-3 }";
    let parallel = 0.3 * 10.0 + 0.7 * 1000.0;
    let found = modulus(along, "reaction.cell.top_left.y");
    assert!((found / parallel - 1.0).abs() < 1e-10, "{found} {parallel}");
    // Shear: the layers are in series, with half of their moduli.
    let sheared = "displacement.\"cell.bottom_right\" = { x = 0.0, y = 1e-3 }\ndisplacement.\"cell.top_left\" = { x = 0.0, y = 0.0 }";
    let found = modulus(sheared, "reaction.cell.bottom_right.y");
    assert!((found / (0.5 * series) - 1.0).abs() < 1e-10, "{found} {series}");
}
