//! Friction that steps change: the force of a sliding block follows its coefficient, linearly over the step or at once.

mod support;

use support::{columns, model, run};

/// Coefficients at the end of each increment: tangential over normal force of a block that slides on a plane under a force.
fn coefficients(form: &str, law: &str, steps: &str) -> Vec<f64> {
    let deck = format!(
        r#"
version = 1
space = "plane-strain"
mesh.part.block.rectangle = {{ from = [0.0, 0.0], to = [4.0, 1.0], cells = [4, 1], cell = "quad4" }}
material.stiff.elastic = {{ young = 1e5, poisson = 0.0 }}
body.block = {{ material = "stiff", formulation = "f-bar" }}
tool.plane.profile = [{{ line = [[90.0, 0.0], [-90.0, 0.0]] }}]
contact.sole = {{ surface = "block.bottom", target = "plane", {law}, {form} }}
solver.tolerance = 1e-9
[[step]]
increments = {{ count = 2 }}
displacement."block.top" = {{ x = 0.0 }}
pressure."block.top" = {{ value = 10.0, kind = "dead" }}
[[step]]
increments = {{ count = 2 }}
displacement."block.top" = {{ x = 1.0 }}
{steps}
"#
    );
    let model = model(&deck, &[]);
    let columns = columns(&model, &run(&model));
    let [x, y] = ["contact.sole.force.x", "contact.sole.force.y"].map(|name| &columns[name]);
    x.iter().zip(y).skip(4).map(|(x, y)| (x / y).abs()).collect()
}

const LATER: &str = r#"
[[step]]
increments = { count = 4 }
displacement."block.top" = { x = 3.0 }
friction.sole = { value = 0.1 }
[[step]]
increments = { count = 2 }
displacement."block.top" = { x = 4.0 }
friction.sole = { value = 0.5, amplitude = [[0.0, 1.0], [1.0, 1.0]] }
[[step]]
increments = { count = 1 }
displacement."block.top" = { x = 5.0 }
"#;

/// From 0.3 down to 0.1 over a step, up to 0.5 at once, which stays.
#[test]
fn the_force_follows_the_coefficient() {
    let wanted = [0.25, 0.2, 0.15, 0.1, 0.5, 0.5, 0.5];
    for form in ["form = \"field\"", "form = \"paper\""] {
        let found = coefficients(form, "law.coulomb = { friction = 0.3 }", LATER);
        let near = found.iter().zip(&wanted).all(|(a, b)| (a - b).abs() < 1e-4);
        assert!(found.len() == wanted.len() && near, "{form}: {found:?}");
    }
}

/// A law with a limit of its shear above what is reached here.
#[test]
fn other_laws_have_friction_too() {
    let found = coefficients("form = \"field\"", "law.orowan = { friction = 0.3, shear_strength = 1e3 }", LATER);
    assert!((found[3] - 0.1).abs() < 1e-6 && (found[6] - 0.5).abs() < 1e-6, "{found:?}");
}

/// Without the contact's own friction it begins at zero, and a law that knows none is refused.
#[test]
fn from_nothing_and_of_nothing() {
    let up = "[[step]]\nincrements = { count = 2 }\ndisplacement.\"block.top\" = { x = 3.0 }\nfriction.sole = { value = 0.4 }\n";
    let found = coefficients("form = \"field\"", "law.coulomb = { friction = 0.0 }", up);
    assert!((found[0] - 0.2).abs() < 1e-6 && (found[1] - 0.4).abs() < 1e-6, "{found:?}");
    let refused = std::panic::catch_unwind(|| coefficients("form = \"field\"", "law.frictionless = {}", up));
    let told = refused.unwrap_err().downcast_ref::<String>().cloned().unwrap_or_default();
    assert!(told.contains("has no `friction`") && told.contains("friction.sole"), "{told}");
}
