//! Axes of a body that are those of a cylinder.

mod support;

use support::{columns, model, run};

/// A cube far from the axis of the cylinder, drawn along x, its law with axes of its own or of the cylinder about which it lies at 30 degrees.
fn pulled(law: &str, axes: &str, strain: &str) -> [f64; 3] {
    let deck = format!(
        "version = 1
        space = \"solid\"
        mesh.part.cube.box = {{ from = [0.0, 0.0, 0.0], to = [1.0, 1.0, 1.0], cells = [1, 1, 1], cell = \"hex8\" }}
        material.m.{law}
        body.cube = {{ material = \"m\", formulation = \"f-bar\", strain = \"{strain}\"{axes} }}
        solver.tolerance = 1e-10
        [[step]]
        increments.count = 4
        displacement.\"cube.left\" = {{ x = 0.0, y = 0.0, z = 0.0 }}
        displacement.\"cube.right\" = {{ x = 0.02, y = 0.01, z = 0.0 }}"
    );
    let model = model(&deck, &[]);
    let columns = columns(&model, &run(&model));
    ["x", "y", "z"].map(|axis| *columns[&format!("reaction.cube.right.{axis}")].last().unwrap())
}

/// So far away the axes of the cylinder are the same all over the cube, and those that the law could say itself.
#[test]
fn axes_of_a_cylinder_are_those_at_the_place() {
    let (c, s) = (30f64.to_radians().cos(), 0.5);
    let far = 1e9;
    let cylinder = |turn: &str| {
        format!(", axes = {{ origin = [{:?}, {:?}, 0.0], along = [0.0, 0.0, 1.0]{turn} }}", -far * c, -far * s)
    };
    let wood = |first: &str, third: &str| {
        format!(
            "orthotropic = {{ young_1 = 1000.0, young_2 = 400.0, young_3 = 250.0, poisson_12 = 0.3, poisson_13 = 0.2, poisson_23 = 0.25, \
             shear_12 = 150.0, shear_13 = 120.0, shear_23 = 90.0{first}{third} }}"
        )
    };
    let sheet = |axes: &str| {
        format!(
            "hill_coefficients = {{ young = 1000.0, poisson = 0.3, yield_stress = 5.0, f = 0.3, g = 0.4, h = 0.6, l = 1.4, m = 1.7, n = 1.1{axes} }}"
        )
    };
    let radial = format!(", first_x = {c:?}, first_y = {s:?}");
    let rolled = format!(", rolling_x = {c:?}, rolling_y = {s:?}");
    // Turned by 90 degrees about what goes around, the first axis goes against the third, and the third along the radius.
    let (turned, lying) = (
        ", about = 2, angle = 90.0",
        (", first_x = 0.0, first_z = -1.0", format!(", third_x = {c:?}, third_y = {s:?}, third_z = 0.0")),
    );
    for strain in ["small", "finite"] {
        for (own, plain, turn) in [
            (wood(&radial, ""), wood("", ""), ""),
            (sheet(&rolled), sheet(""), ""),
            (wood(lying.0, &lying.1), wood("", ""), turned),
        ] {
            let (one, other, none) =
                (pulled(&own, "", strain), pulled(&plain, &cylinder(turn), strain), pulled(&plain, "", strain));
            let apart =
                |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max) / one[0].abs();
            assert!(apart(one, other) < 1e-7, "{one:?} {other:?}");
            assert!(apart(one, none) > 1e-2, "the axes make a difference: {one:?} {none:?}");
        }
    }
}

#[test]
fn a_law_without_axes_refuses_them() {
    let deck = "version = 1
        space = \"plane-strain\"
        mesh.part.block.rectangle = { from = [0.0, 0.0], to = [1.0, 1.0], cells = [1, 1], cell = \"quad4\" }
        material.m.elastic = { young = 1e3, poisson = 0.0 }
        body.block = { material = \"m\", axes = AXES }
        [[step]]
        displacement.\"block.bottom\" = { x = 0.0, y = 0.0 }";
    let told = |axes: &str| {
        let read = asperity::deck::read(&deck.replace("AXES", axes), "test.toml", std::path::Path::new(""), &[]);
        read.and_then(asperity::deck::build).err().unwrap().render(false)
    };
    assert!(told("{ along = [0.0, 0.0, 1.0] }").contains("its law has no axes"));
    assert!(told("{ along = [0.0, 0.0, 0.0] }").contains("the axis has no direction"));
    assert!(told("{ along = [0.0, 0.0, 1.0], about = 4 }").contains("about"));
}
