//! Corners of bodies whose surfaces go round them: what enters one side of a body near its edge lies behind the other side as deep as it is away from the
//! edge, and was pushed out through that: by a hundred times too small a force, or with none at all.

mod support;

use support::{columns, model, run};

/// Force of the contact at the end of a deck.
fn forces(deck: &str) -> [f64; 3] {
    let model = model(deck, &[]);
    let table = columns(&model, &run(&model));
    ["x", "y", "z"].map(|axis| table.get(&format!("contact.c.force.{axis}")).map_or(0.0, |all| *all.last().unwrap()))
}

fn column(cell: &str, overlap: f64, gap: f64, [surface, target]: [&str; 2]) -> String {
    format!(
        r#"
version = 1
space = "plane-strain"
mesh.part.a.rectangle = {{ from = [0.0, 0.0], to = [10.0, 5.0], cells = [10, 5], cell = "{cell}" }}
mesh.part.b.rectangle = {{ from = [{}, {}], to = [{}, {}], cells = [2, 30], cell = "{cell}" }}
material.m.elastic = {{ young = 2000.0, poisson = 0.3 }}
body.a.material = "m"
body.b.material = "m"
group.ga = {{ of = "a.top", with = ["a.right"] }}
group.gb = {{ of = "b.bottom", with = ["b.left"] }}
contact.c = {{ surface = "{surface}", target = "{target}", law.coulomb.friction = 0.3 }}
[[step]]
displacement."a.bottom" = {{ x = 0.0, y = 0.0 }}
displacement."b.top" = {{ x = 0.0, y = -{} }}
"#,
        10.0 - overlap,
        5.0 + gap,
        11.5 - overlap,
        35.0 + gap,
        gap + 0.1
    )
}

/// A column over the edge of a block: with both sides of either the force is that of the sides which face each other alone.
#[test]
fn a_column_stands_on_the_edge_of_a_block() {
    for cell in ["quad4", "quad8"] {
        for (overlap, gap) in [(0.3, 0.2), (0.75, 0.2), (1.35, 0.2), (0.3, 0.0)] {
            let [_, alone, _] = forces(&column(cell, overlap, gap, ["b.bottom", "a.top"]));
            for [surface, target] in [["gb", "ga"], ["ga", "gb"]] {
                let [_, force, _] = forces(&column(cell, overlap, gap, [surface, target]));
                assert!(
                    alone > 4.5 && (force.abs() / alone - 1.0).abs() < 0.1,
                    "{cell} {overlap} {gap}: {force} {alone}"
                );
            }
        }
    }
}

/// The corner of a post pushes against the end of a beam.
#[test]
fn a_corner_meets_an_end() {
    let deck = |space: &str, meshes: &str, [surface, target]: [&str; 2], steps: &str| {
        format!(
            r#"
version = 1
space = "{space}"
{meshes}
material.m.elastic = {{ young = 2000.0, poisson = 0.35 }}
body.beam.material = "m"
body.post.material = "m"
group.beamtip = {{ of = "beam.bottom", with = ["beam.right"] }}
group.posttip = {{ of = "post.top", with = ["post.left"] }}
contact.c = {{ surface = "{surface}", target = "{target}", law.coulomb.friction = 0.3 }}
[[step]]
{steps}
"#
        )
    };
    let plane = |cell: &str, height: f64, sides: [&str; 2]| {
        let meshes = format!(
            r#"
mesh.part.beam.rectangle = {{ from = [0.0, 0.0], to = [40.0, 2.0], cells = [40, 2], cell = "{cell}" }}
mesh.part.post.rectangle = {{ from = [40.5, -7.0], to = [48.1, {height}], cells = [5, 6], cell = "{cell}" }}
"#
        );
        let steps = r#"
displacement."beam.left" = { x = 0.0, y = 0.0 }
displacement."post.bottom" = { x = -0.6, y = 0.0 }
"#;
        deck("plane-strain", &meshes, sides, steps)
    };
    for cell in ["quad4", "quad8", "tri6"] {
        for height in [0.4, 0.8, 1.543] {
            let [alone, ..] = forces(&plane(cell, height, ["beam.right", "post.left"]));
            let [force, ..] = forces(&plane(cell, height, ["beamtip", "posttip"]));
            assert!(alone < -5.0 && (force / alone - 1.0).abs() < 0.12, "{cell} {height}: {force} {alone}");
        }
    }
    let space = |cell: &str, sides: [&str; 2]| {
        let meshes = format!(
            r#"
mesh.part.beam.box = {{ from = [0.0, 0.0, 0.0], to = [40.0, 2.0, 4.0], cells = [20, 2, 2], cell = "{cell}" }}
mesh.part.post.box = {{ from = [40.5, -6.0, -1.0], to = [44.5, 0.4, 5.0], cells = [3, 5, 4], cell = "{cell}" }}
"#
        );
        let steps = r#"
displacement."beam.left" = { x = 0.0, y = 0.0, z = 0.0 }
displacement."post.right" = { x = -0.6, y = 0.0, z = 0.0 }
"#;
        deck("solid", &meshes, sides, steps)
    };
    for cell in ["hex8", "tet10"] {
        let [alone, ..] = forces(&space(cell, ["beam.right", "post.left"]));
        let [force, ..] = forces(&space(cell, ["beamtip", "posttip"]));
        assert!(alone < -15.0 && (force / alone - 1.0).abs() < 0.12, "{cell}: {force} {alone}");
    }
}

/// A block slides over the end of another, goes down beside it and comes back against its side.
#[test]
fn a_block_slides_off_and_comes_back_against_the_side() {
    let deck = r#"
version = 1
space = "plane-strain"
mesh.part.a.rectangle = { from = [0.0, 0.0], to = [10.0, 5.0], cells = [10, 5], cell = "CELL" }
mesh.part.b.rectangle = { from = [2.2, 5.0], to = [9.2, 9.0], cells = [8, 5], cell = "CELL" }
material.m.elastic = { young = 1000.0, poisson = 0.3 }
body.a.material = "m"
body.b.material = "m"
group.ga = { of = "a.top", with = ["a.right", "a.left"] }
group.gb = { of = "b.bottom", with = ["b.left", "b.right"] }
contact.c = { surface = "gb", target = "ga", law.coulomb.friction = 0.3 }
[[step]]
displacement."a.bottom" = { x = 0.0, y = 0.0 }
displacement."b.top" = { x = 0.0, y = -0.1 }
[[step]]
displacement."b.top" = { x = 8.5, y = -0.1 }
[[step]]
displacement."b.top" = { x = 8.5, y = -2.1 }
[[step]]
displacement."b.top" = { x = 7.7, y = -2.1 }
"#;
    for cell in ["quad4", "quad8"] {
        let [force, ..] = forces(&deck.replace("CELL", cell));
        assert!((force / 24.5 - 1.0).abs() < 0.05, "{cell}: {force}");
    }
}
