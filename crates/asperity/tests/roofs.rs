//! Obtuse vertices of a tool in the plane, and edges in space: a roof that is pressed into a block and slides over it.

mod support;

use support::{columns, model, run};

/// Forces on a roof with flanks of so many degrees, right and up, over its way: pressed in by a fifth of an edge, then slid by eight edges.
fn forces([left, right]: [f64; 2], friction: f64) -> Vec<[f64; 2]> {
    let [left, right] = [left, right].map(|angle: f64| 8.0 / angle.to_radians().tan());
    let deck = format!(
        r#"
version = 1
space = "plane-strain"
mesh.part.block.rectangle = {{ from = [0.0, 0.0], to = [20.0, 6.0], cells = [40, 12], cell = "quad4" }}
material.elastic.elastic = {{ young = 1e3, poisson = 0.3 }}
body.block.material = "elastic"
tool.roof.profile = [{{ line = [[{}, 14.0], [7.1, 6.0]] }}, {{ line = [[7.1, 6.0], [{}, 14.0]] }}]
contact.top = {{ surface = "block.top", target = "roof", law.coulomb.friction = {friction} }}
[[step]]
displacement."block.bottom" = {{ x = 0.0, y = 0.0 }}
motion.roof.y = -0.1
[[step]]
increments.count = 40
motion.roof = {{ x = 4.0, y = -0.1 }}
"#,
        7.1 - left,
        7.1 + right
    );
    let model = model(&deck, &[]);
    let columns = columns(&model, &run(&model));
    let [x, y] = ["x", "y"].map(|axis| columns[&format!("contact.top.force.{axis}")].clone());
    x.into_iter().zip(y).map(|(x, y)| [x, y]).collect()
}

/// The normals of the flanks had given a force sideways of tan 20 and tan 40 degrees in turn, with friction of 1.25 of that down.
#[test]
fn a_vertex_presses_along_the_normal_of_what_it_slides_over() {
    for friction in [0.0, 0.2] {
        let sharp = forces([45.0; 2], friction);
        for flanks in [[20.0, 40.0], [30.0; 2], [15.0, 60.0]] {
            let blunt = forces(flanks, friction);
            assert_eq!(blunt.len(), sharp.len());
            for ([x, y], [sharp_x, sharp_y]) in blunt.into_iter().zip(&sharp) {
                assert!(
                    (x - sharp_x).abs() + (y - sharp_y).abs() < 1e-4 * sharp_y.abs(),
                    "{flanks:?}: {x} {y}, {sharp_x} {sharp_y}"
                );
                assert!(x.abs() < (friction + 0.15) * y.abs(), "{flanks:?}: {x} {y}");
            }
        }
    }
}

/// Forces on a wedge with flanks of so many degrees, right and up, for a unit of depth, pressed by a part of an edge into a layer of cells.
fn layer(space: &str, flank: f64, [at, down]: [f64; 2]) -> [f64; 2] {
    let wide = 5.0 / flank.to_radians().tan();
    let profile =
        format!("[{{ line = [[{}, 8.0], [{at}, 3.0]] }}, {{ line = [[{at}, 3.0], [{}, 8.0]] }}]", at - wide, at + wide);
    let (mesh, tool, held) = match space {
        "solid" => (
            "box = { from = [0.0, 0.0, 0.0], to = [10.0, 3.0, 0.7], cells = [20, 6, 1], cell = \"hex8\" }",
            format!("{{ profile = {profile}, extrude = {{ origin = [0.0, 0.0, -1.0], along = [0.0, 0.0, 3.0] }} }}"),
            "symmetry = [\"block.front\", \"block.back\"]",
        ),
        _ => (
            "rectangle = { from = [0.0, 0.0], to = [10.0, 3.0], cells = [20, 6], cell = \"quad4\" }",
            format!("{{ profile = {profile} }}"),
            "",
        ),
    };
    let deck = format!(
        r#"
version = 1
space = "{space}"
mesh.part.block.{mesh}
material.elastic.elastic = {{ young = 1e3, poisson = 0.3 }}
body.block.material = "elastic"
tool.wedge = {tool}
contact.top = {{ surface = "block.top", target = "wedge", law.coulomb.friction = 0.1 }}
[[step]]
{held}
displacement."block.bottom" = {{ x = 0.0, y = 0.0 }}
motion.wedge.y = -{down}
"#
    );
    let model = model(&deck, &[]);
    let columns = columns(&model, &run(&model));
    let depth = if space == "solid" { 0.7 } else { 1.0 };
    ["x", "y"].map(|axis| columns[&format!("contact.top.force.{axis}")].last().unwrap() / depth)
}

/// In space nodes alone had felt nothing of a wedge at .3 of a cell, half of its force in the middle of a face at .8, and that along one flank.
#[test]
fn an_edge_in_space_is_a_vertex_in_the_plane() {
    for flank in [30.0, 45.0] {
        for at in [3.0, 3.1, 3.25] {
            for down in [0.15, 0.4] {
                let [plane, solid] = ["plane-strain", "solid"].map(|space| layer(space, flank, [at, down]));
                let apart = (plane[0] - solid[0]).abs() + (plane[1] - solid[1]).abs();
                assert!(apart < 0.02 * plane[1].abs(), "{flank} {at} {down}: {plane:?} {solid:?}");
            }
        }
    }
}
