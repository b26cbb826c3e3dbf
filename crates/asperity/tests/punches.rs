//! Bodies with corners that press into softer ones.

mod support;

use support::{columns, model, run};

/// A stiff block of so many cells on so many coarse soft ones.
fn deck(space: &str, [stiff, soft]: [usize; 2]) -> String {
    format!(
        r#"
version = 1
space = "{space}"
mesh.part.a.rectangle = {{ from = [0.0, 4.0], to = [3.0, 6.0], cells = [{stiff}, {stiff}], cell = "quad4" }}
mesh.part.b.rectangle = {{ from = [0.0, 0.0], to = [9.0, 4.0], cells = [{soft}, 6], cell = "quad4" }}
material.hard.elastic = {{ young = 2e5, poisson = 0.3 }}
material.soft.elastic = {{ young = 50.0, poisson = 0.4 }}
body.a.material = "hard"
body.b.material = "soft"
contact.c = {{ surface = "a.bottom", target = "b.top", law.coulomb.friction = 0.3 }}
[[step]]
symmetry = ["a.left", "b.left"]
displacement."b.bottom" = {{ x = 0.0, y = 0.0 }}
displacement."a.top".y = -0.2
"#
    )
}

fn force(deck: &str) -> f64 {
    let model = model(deck, &[]);
    let run = run(&model);
    columns(&model, &run)["reaction.a.top.y"].last().unwrap().abs()
}

/// The forces of fine meshes are 15.79 and 162.3. Carried by the fine stiff side, whose edge ends within a face of the soft one, they were 24 and
/// 39 % too large.
#[test]
fn the_softer_side_carries_the_field() {
    for (space, fine) in [("plane-strain", 15.79), ("axisymmetric", 162.3)] {
        for (stiff, soft, allowed) in [(10, 7, 0.14), (5, 7, 0.14), (20, 14, 0.1), (20, 12, 0.06)] {
            let error = force(&deck(space, [stiff, soft])) / fine - 1.0;
            assert!(error.abs() < allowed, "{space} {stiff} {soft}: {error}");
        }
    }
}

/// Its corner flipped from side to side, and no increment was small enough at half of the depth.
#[test]
fn a_punch_goes_deep() {
    let deck = r#"
version = 1
space = "plane-strain"
mesh.part.b.rectangle = { from = [0.0, 0.0], to = [8.0, 5.0], cells = [32, 20], cell = "quad4" }
mesh.part.p.rectangle = { from = [0.0, 5.0], to = [2.0, 7.0], cells = [4, 4], cell = "quad4" }
material.soft.von_mises = { young = 70e3, poisson = 0.33, yield_stress = 100.0, hardening = 200.0 }
material.hard.elastic = { young = 200e3, poisson = 0.3 }
body.b.material = "soft"
body.p.material = "hard"
group.sides = { of = "p.bottom", with = ["p.right"] }
contact.c = { surface = "b.top", target = "sides", law.coulomb.friction = 0.1 }
[[step]]
displacement."b.bottom".y = 0.0
symmetry = ["b.left", "p.left"]
displacement."p.top".y = -1.2
"#;
    let model = model(deck, &[]);
    let columns = columns(&model, &run(&model));
    let way = &columns["displacement.p.top.y"];
    assert_eq!(way.last(), Some(&-1.2), "{way:?}");
}
