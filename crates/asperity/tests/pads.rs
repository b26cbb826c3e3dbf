//! Rubber of second degree under rigid tools in space.

mod support;

use support::{columns, model, run};

/// A thin pad whose foot is held, squeezed by 15 % between rough plates. With its top glued the force is 2 050 (`hex20`), with `hex8` 2 043.
#[test]
fn a_thin_pad_is_squeezed() {
    for cell in ["hex20", "hex27", "tet10"] {
        let deck = format!(
            r#"
version = 1
space = "solid"
mesh.part.pad.box = {{ from = [0.0, 0.0, 0.0], to = [14.0, 2.0, 14.0], cells = [2, 1, 2], cell = "{cell}" }}
material.rubber.neo_hookean = {{ shear = 1.5, bulk = 100.0 }}
body.pad.material = "rubber"
tool.plate.plane = {{ at = [7.0, 2.0, 7.0], normal = [0.0, -1.0, 0.0], side = 60.0 }}
contact.top = {{ surface = "pad.top", target = "plate", law.coulomb.friction = 0.4 }}
[[step]]
symmetry = ["pad.left", "pad.back"]
displacement."pad.bottom" = {{ x = 0.0, y = 0.0, z = 0.0 }}
motion.plate.y = -0.3
"#
        );
        let model = model(&deck, &[]);
        let columns = columns(&model, &run(&model));
        let (way, force) = (columns["tool.plate.translation.y"].last(), columns["contact.top.force.y"].last());
        assert_eq!(way, Some(&-0.3), "{cell}");
        assert!((1650.0..2100.0).contains(&force.unwrap().abs()), "{cell}: {force:?}");
    }
}

/// Sideways over downward force of a cylinder that slides over cells of half its radius, with a coefficient of 0.25.
#[test]
fn a_cylinder_slides_smoothly() {
    let deck = r#"
version = 1
space = "solid"
mesh.part.b.box = { from = [0.0, 0.0, 0.0], to = [24.0, 10.0, 4.0], cells = [10, 4, 2], cell = "hex20" }
material.m.neo_hookean = { shear = 2.0, bulk = 20.0 }
body.b.material = "m"
tool.t.cylinder = { from = [10.0, 15.0, -5.0], to = [10.0, 15.0, 9.0], radius = 5.0 }
contact.c = { surface = "b.top", target = "t", law.coulomb.friction = 0.25 }
[[step]]
increments = { first = 0.2, largest = 0.25 }
symmetry = ["b.back", "b.front"]
displacement."b.bottom" = { x = 0.0, y = 0.0 }
motion.t.y = -1.0
[[step]]
increments = { first = 0.1, largest = 0.1 }
motion.t = { y = -1.0, x = 4.0 }
"#;
    let model = model(deck, &[]);
    let columns = columns(&model, &run(&model));
    let [x, y] = ["x", "y"].map(|axis| &columns[&format!("contact.c.force.{axis}")]);
    let ratios: Vec<f64> = x.iter().zip(y).map(|(x, y)| x / y).collect();
    for ratio in &ratios[ratios.len() - 7..] {
        assert!((ratio.abs() - 0.25).abs() < 0.025, "{ratios:?}");
    }
}
