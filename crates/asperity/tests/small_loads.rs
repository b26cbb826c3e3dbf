//! Small loads beside large ones move what is soft or slender as much as alone.

mod support;

use support::{model, run};

/// Mean displacement of a group along y at the end.
fn sunk(deck: &str, sets: &[&str], group: &str) -> f64 {
    let model = model(deck, sets);
    let keep = run(&model);
    let (u, nodes) = (&keep.states.last().unwrap().u, &model.mesh.groups[group].nodes);
    nodes.iter().map(|&node| u[model.problem.dofs.node(node) + 1]).sum::<f64>() / nodes.len() as f64
}

/// A clip bears a hundredth of a newton beside a block that bears ten kilonewtons or ten meganewtons.
#[test]
fn a_clip_beside_a_pressed_block() {
    let deck = r#"
version = 1
space = "plane-strain"
thickness = 10.0
mesh.part.block.rectangle = { from = [0.0, 0.0], to = [100.0, 100.0], cells = [6, 6], cell = "quad8" }
mesh.part.clip.rectangle = { from = [200.0, 0.0], to = [250.0, 1.0], cells = [25, 1], cell = "quad8" }
material.m.elastic = { young = 210e3, poisson = 0.3 }
body.block.material = "m"
body.clip.material = "m"
[[step]]
displacement = { "block.bottom" = { x = 0.0, y = 0.0 }, "clip.left" = { x = 0.0, y = 0.0 } }
traction."block.top".y = -10.0
[[step]]
traction."clip.right".y = -0.001
"#;
    // P L^3 / 3 E I.
    let bent = -0.01 * 50.0_f64.powi(3) / (3.0 * 210e3 / 0.91 * 10.0 / 12.0);
    for traction in ["-10.0", "-1e4"] {
        let large = format!("step.1.traction.'block.top'.y={traction}");
        let found = sunk(deck, &[&large], "clip.right");
        assert!((found / bent - 1.0).abs() < 0.01, "{traction}: {found} in place of {bent}");
    }
}

/// A steel arm and a rubber lip that hang from a pressed block sink under their weight by `q L^4 / 8 E I`.
#[test]
fn an_arm_and_a_lip_of_a_pressed_block() {
    let deck = r#"
version = 1
space = "plane-strain"
mesh.part.arm.rectangle = { from = [0.0, 0.0], to = [300.0, 1.0], cells = [60, 1], cell = "quad8" }
mesh.part.block.rectangle = { from = [-100.0, 0.0], to = [0.0, 100.0], cells = [4, 100], cell = "quad8" }
material = { steel.elastic = { young = 210e3, poisson = 0.3 }, soft.elastic = { young = 2.0, poisson = 0.3 } }
body = { arm.material = "steel", block.material = "steel" }
tie = [{ surface = "arm.left", target = "block.right" }]
[[step]]
increments.count = 1
displacement."block.bottom" = { x = 0.0, y = 0.0 }
traction."block.top".y = -200.0
[[step]]
increments.count = 1
body_force.arm.y = -7.7e-5
"#;
    let lip =
        ["mesh.part.arm.rectangle.to=[20.0, 1.0]", "mesh.part.arm.rectangle.cells=[20, 1]", "body.arm.material=soft"];
    for (sets, young, length, force) in [(&[][..], 210e3, 300.0_f64, 7.7e-5), (&lip[..], 2.0, 20.0, 1.18e-5)] {
        let weight = |force: f64| format!("step.2.body_force.arm.y={}", -force);
        let found = |force: f64| sunk(deck, &[sets, &[&weight(force)]].concat(), "arm.right");
        let moved = found(force) - found(0.0);
        let right = -force * length.powi(4) / (8.0 * young / 0.91 / 12.0);
        assert!((moved / right - 1.0).abs() < 0.02, "{young}: {moved} in place of {right}");
    }
}

/// A strip a thousand times as long as thick is bent at its end by `P L^3 / 3 E I`, in cells of both degrees.
#[test]
fn a_strip_a_thousand_times_as_long_as_thick() {
    for (kind, along) in [("quad4", 100), ("quad4", 400), ("quad8", 100), ("quad8", 1000)] {
        let deck = format!(
            r#"
version = 1
space = "plane-strain"
mesh.part.strip.rectangle = {{ from = [0.0, 0.0], to = [1e3, 1.0], cells = [{along}, 1], cell = "{kind}" }}
material.m.elastic = {{ young = 210e3, poisson = 0.3 }}
body.strip.material = "m"
[[step]]
displacement."strip.left" = {{ x = 0.0, y = 0.0 }}
traction."strip.right".y = {}
"#,
            -3.0 * 210e3 / 0.91 / 12.0 / 1e9
        );
        let found = sunk(&deck, &[], "strip.right");
        assert!((found + 1.0).abs() < 0.005, "{kind}, {along}: {found}");
    }
}
