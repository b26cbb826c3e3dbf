//! Edges of a body that press on a tool and on a body: a block that is tipped over one falls at the force of statics.

mod support;

use support::{columns, keep_degree, model, run};

/// Width and height of the block, its weight for a unit of depth, and how far its upper edge is pushed.
const WIDTH: f64 = 4.0;
const HEIGHT: f64 = 10.0;
const WEIGHT: f64 = 4.0;
const PUSHED: f64 = 0.4;

/// Force for a unit of depth on the upper edge of a rigid block that stands on its other lower edge.
fn statics() -> f64 {
    let angle = PUSHED / HEIGHT;
    WEIGHT * (0.5 * WIDTH - 0.5 * HEIGHT * angle) / (HEIGHT + WIDTH * angle)
}

/// A floor: a tool, or a body with so many cells along each axis.
type Floor = Option<[usize; 3]>;

/// Error of the force on the upper edge of a block of so many cells along each axis, over a floor with friction.
fn error(cell: &str, cells: [usize; 3], floor: Floor, friction: f64) -> f64 {
    let (solid, degree) = (cell.starts_with("hex") || cell.starts_with("tet"), keep_degree(cell));
    let (space, part, depth) = if solid { ("solid", "box", 3.0) } else { ("plane-strain", "rectangle", 1.0) };
    let place = |[x, y, z]: [f64; 3]| if solid { format!("[{x:?}, {y:?}, {z:?}]") } else { format!("[{x:?}, {y:?}]") };
    let count = |[x, y, z]: [usize; 3]| if solid { format!("[{x}, {y}, {z}]") } else { format!("[{x}, {y}]") };
    let mesh = |name: &str, from: [f64; 3], to: [f64; 3], cells: [usize; 3]| {
        format!(
            "mesh.part.{name}.{part} = {{ from = {}, to = {}, cells = {}, cell = \"{cell}\" }}",
            place(from),
            place(to),
            count(cells)
        )
    };
    let block = mesh("block", [0.0; 3], [WIDTH, HEIGHT, depth], cells);
    let (table, target, held) = match floor {
        Some(cells) => {
            let low = mesh("low", [-3.0, -2.0, -1.1], [9.0, 0.0, 4.1], cells);
            let held = "displacement.\"low.bottom\" = { x = 0.0, y = 0.0 }";
            (format!("{low}\nbody.low = {{ material = \"steel\"{degree} }}"), "low.top", held)
        }
        None if solid => {
            ("tool.floor.plane = { at = [2.0, 0.0, 1.5], normal = [0.0, 1.0, 0.0], side = 60.0 }".into(), "floor", "")
        }
        None => ("tool.floor.profile = [{ line = [[20.0, 0.0], [-20.0, 0.0]] }]".into(), "floor", ""),
    };
    // One cell thick between planes of symmetry.
    let layer =
        if solid && cells[2] == 1 && floor.is_none() { "symmetry = [\"block.back\", \"block.front\"]" } else { "" };
    let still = if solid { "z = 0.0" } else { "" };
    let [first, then] = [0.0, PUSHED].map(|x| format!("{{ x = {x}{}{still} }}", if solid { ", " } else { "" }));
    let deck = format!(
        r#"
version = 1
space = "{space}"
{block}
{table}
material.steel.elastic = {{ young = 1e3, poisson = 0.3 }}
body.block = {{ material = "steel", density = 1e-2{degree} }}
group.edge = {{ of = "block.left", y = [9.9, 10.1] }}
contact.sole = {{ surface = "block.bottom", target = "{target}", law.coulomb.friction = {friction} }}
[[step]]
increments.count = 1
displacement.edge = {first}
gravity.y = -10.0
{held}
{layer}
[[step]]
displacement.edge = {then}
"#
    );
    let model = model(&deck, &[]);
    let force = *columns(&model, &run(&model))["reaction.edge.x"].last().unwrap();
    force.abs() / (statics() * depth) - 1.0
}

/// Means of gaps over faces had it fall 17 to 42 % too early.
#[test]
fn a_block_tips_over_its_edge_on_a_tool() {
    for (cell, cells, allowed) in [
        ("quad4", [4, 5, 0], 0.01),
        ("tri3", [4, 5, 0], 0.06),
        ("quad8", [2, 3, 0], 0.01),
        ("quad9", [2, 3, 0], 0.01),
        ("tri6", [2, 3, 0], 0.01),
        ("hex8", [4, 5, 3], 0.01),
        ("hex8", [4, 5, 1], 0.01),
        ("hex20", [2, 3, 2], 0.01),
        ("hex20", [2, 3, 1], 0.01),
        ("hex27", [2, 3, 1], 0.01),
        ("tet10", [2, 3, 2], 0.01),
    ] {
        for friction in [0.6, 1.2] {
            let error = error(cell, cells, None, friction);
            assert!(error.abs() < allowed, "{cell} {friction}: {error}");
        }
    }
}

/// The floor has smaller faces here and there, which do not match.
#[test]
fn a_block_tips_over_its_edge_on_a_body() {
    for (cell, cells, floor, allowed) in [
        ("quad4", [4, 5, 0], [9, 2, 0], 0.015),
        ("quad4", [3, 5, 0], [23, 2, 0], 0.015),
        ("quad8", [2, 3, 0], [8, 1, 0], 0.015),
        ("tri6", [2, 3, 0], [7, 1, 0], 0.015),
        ("hex8", [3, 4, 2], [7, 1, 4], 0.015),
        ("hex20", [2, 3, 1], [5, 1, 3], 0.015),
        ("tet10", [2, 3, 2], [5, 1, 3], 0.015),
    ] {
        let error = error(cell, cells, Some(floor), 0.6);
        assert!(error.abs() < allowed, "{cell}: {error}");
    }
}

/// A strip that is held at one end lifts off the table at once, though the gap at the end of its first face opens with the square of the
/// distance: a mean by dual functions alone is less than zero there.
#[test]
fn a_held_strip_lifts_off_freely() {
    for (cell, floor) in [("quad8", false), ("quad4", false), ("quad8", true), ("tri6", false)] {
        let (table, target) = if floor {
            (
                "mesh.part.low.rectangle = { from = [-1.0, -1.0], to = [9.0, 0.0], cells = [9, 1], cell = \"quad8\" }\nbody.low.material = \"steel\"",
                "low.top",
            )
        } else {
            ("tool.floor.profile = [{ line = [[20.0, 0.0], [-20.0, 0.0]] }]", "floor")
        };
        let deck = format!(
            r#"
version = 1
space = "plane-strain"
mesh.part.strip.rectangle = {{ from = [0.0, 0.0], to = [8.0, 0.4], cells = [7, 1], cell = "{cell}" }}
{table}
material.steel.elastic = {{ young = 1e3, poisson = 0.3 }}
body.strip = {{ material = "steel"{} }}
contact.sole = {{ surface = "strip.bottom", target = "{target}", law.coulomb.friction = 0.2 }}
[[step]]
increments.count = 4
displacement."strip.left" = {{ x = 0.0, y = 0.0 }}
displacement."strip.bottom_right" = {{ y = 0.3 }}
{}
"#,
            keep_degree(cell),
            if floor { "displacement.\"low.bottom\" = { x = 0.0, y = 0.0 }" } else { "" }
        );
        let model = model(&deck, &[]);
        let columns = columns(&model, &run(&model));
        let [lift, pressed] =
            ["reaction.strip.bottom_right.y", "contact.sole.force.y"].map(|name| columns[name].last().unwrap().abs());
        assert!(pressed < 0.01 * lift, "{cell} {floor}: {pressed} of {lift}");
    }
}
