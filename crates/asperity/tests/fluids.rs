//! Fluids that enter between surfaces: from where they stand, up to where contact bears more.

mod support;

use support::{columns, model, run};

/// A soft block whose top is pressed down more on the left than on the right, and a fluid under it: the wet part of its sole at the
/// ends of increments while the fluid rises to `value`.
fn wet(value: f64, from: &str) -> Vec<f64> {
    let deck = format!(
        r#"
version = 1
space = "plane-strain"
mesh.part.block.rectangle = {{ from = [0.0, 0.0], to = [8.0, 1.0], cells = [16, 2], cell = "quad4" }}
material.foam.elastic = {{ young = 100.0, poisson = 0.0 }}
body.block = {{ material = "foam", formulation = "f-bar" }}
tool.plane.profile = [{{ line = [[90.0, 0.0], [-90.0, 0.0]] }}]
tool.lid.profile = [{{ line = [[-1.0, 1.0], [9.0, 1.0]] }}]
tool.lid.reference = [0.0, 1.0]
contact.sole = {{ surface = "block.bottom", target = "plane", law.frictionless = {{}} }}
contact.lid = {{ surface = "block.top", target = "lid", law.frictionless = {{}} }}
[[step]]
increments = {{ count = 5 }}
symmetry = ["block.left"]
motion.lid = {{ y = -0.1, rotation = 0.5 }}
[[step]]
increments = {{ count = 10 }}
pressure."block.bottom" = {{ value = {value:?}, penetrates = true{from} }}
"#
    );
    let model = model(&deck, &[]);
    columns(&model, &run(&model))["pressure.block.bottom.wetted_part"][5..].to_vec()
}

/// The sole bears about 10 at its left end and 3 at its right one. A fluid of 5 that stands on the right comes to about where the
/// sole bears 5, one on the left nowhere; from its rim it comes as from the right.
#[test]
fn a_fluid_comes_up_to_where_contact_bears_more() {
    let right = wet(5.0, ", from = \"block.bottom_right\"");
    assert!(right.windows(2).all(|pair| pair[1] >= pair[0]), "{right:?}");
    let end = *right.last().unwrap();
    assert!((0.15..0.5).contains(&end), "{right:?}");
    assert!(wet(5.0, ", from = \"block.bottom_left\"").iter().all(|part| *part == 0.0));
    assert_eq!(wet(5.0, ""), right);
    assert_eq!(*wet(15.0, "").last().unwrap(), 1.0);
}

#[test]
fn what_a_fluid_cannot_be_is_told() {
    let told = |from: &str| {
        let refused = std::panic::catch_unwind(|| wet(5.0, from)).unwrap_err();
        refused.downcast_ref::<String>().cloned().unwrap_or_default()
    };
    let nowhere = told(", from = \"block.top\"");
    assert!(nowhere.contains("no node of `from`"), "{nowhere}");
    let dead = told(", kind = \"dead\"");
    assert!(dead.contains("dead, and penetrates"), "{dead}");
    let pulls = std::panic::catch_unwind(|| wet(-5.0, "")).unwrap_err();
    assert!(pulls.downcast_ref::<String>().unwrap().contains("negative, and penetrates"));
}

/// A fluid needs a contact to enter, and presses on both bodies that touch where both are named.
#[test]
fn a_fluid_enters_between_surfaces_that_touch() {
    let deck = |more: &str| {
        format!(
            "version = 1
            space = \"plane-strain\"
            mesh.part.low.rectangle = {{ from = [0.0, 0.0], to = [4.0, 1.0], cells = [4, 1], cell = \"quad4\" }}
            mesh.part.high.rectangle = {{ from = [0.0, 1.0], to = [4.0, 2.0], cells = [4, 1], cell = \"quad4\" }}
            material.m.elastic = {{ young = 100.0, poisson = 0.0 }}
            body.low.material = \"m\"
            body.high.material = \"m\"
            contact.seam = {{ surface = \"high.bottom\", target = \"low.top\", law.frictionless = {{}} }}
            [[step]]
            increments.count = 1
            symmetry = [\"low.left\", \"high.left\", \"low.bottom\"]
            displacement.\"high.top\".y = -0.01
            {more}"
        )
    };
    let read = |more: &str| asperity::deck::read(&deck(more), "test.toml", std::path::Path::new(""), &[]);
    let told = |more: &str| match read(more).and_then(asperity::deck::build) {
        Ok(made) => made.diagnostics.render(false),
        Err(refused) => refused.render(false),
    };
    let dry = told("pressure.\"high.right\" = { value = 1.0, penetrates = true }");
    assert!(dry.contains("penetrates, but none of its sides is in a contact"), "{dry}");
    let one = "pressure.\"high.bottom\" = { value = 1.0, penetrates = true }";
    let half = told(one);
    assert!(half.contains("does not press on `low.top` opposite"), "{half}");
    let both = told(&format!("{one}\npressure.\"low.top\" = {{ value = 1.0, penetrates = true }}"));
    assert!(!both.contains("opposite"), "{both}");
}

/// A slice of one cell between planes of symmetry, where every node lies on the rim of the sole: a fluid of less than the contact
/// pressure, 1, wets none of it, and one of more all.
#[test]
fn a_slice_whose_nodes_all_lie_on_the_rim_is_closed() {
    let wet = |value: f64| {
        let deck = format!(
            r#"
version = 1
space = "solid"
mesh.part.block.box = {{ from = [0.0, 0.0, 0.0], to = [6.0, 2.0, 0.5], cells = [8, 3, 1], cell = "hex8" }}
material.foam.elastic = {{ young = 40.0, poisson = 0.0 }}
body.block = {{ material = "foam" }}
tool.plane.plane = {{ at = [3.0, 0.0, 0.3], normal = [0.0, 1.0, 0.0], side = 30.0 }}
contact.sole = {{ surface = "block.bottom", target = "plane", law.frictionless = {{}} }}
[[step]]
symmetry = ["block.front", "block.back"]
displacement."block.top" = {{ x = 0.0, y = -0.05 }}
[[step]]
increments = {{ count = 10 }}
pressure."block.bottom" = {{ value = {value:?}, penetrates = true }}
"#
        );
        let model = model(&deck, &[]);
        *columns(&model, &run(&model))["pressure.block.bottom.wetted_part"].last().unwrap()
    };
    assert_eq!([wet(0.4), wet(2.0)], [0.0, 1.0]);
}

/// A block on a narrower tool or body: the part of its sole that is wet in the end, in a `space`, with cells, on what is `made`.
fn wet_beyond(space: &str, (cell, cells): (&str, usize), (made, contact): (&str, &str), from: f64, more: &str) -> f64 {
    let deck = format!(
        r#"
version = 1
space = "{space}"
mesh.part.block.rectangle = {{ from = [{from:?}, 0.0], to = [1.0, 0.5], cells = [{cells}, 2], cell = "{cell}" }}
material.foam.elastic = {{ young = 1000.0, poisson = 0.0 }}
body.block.material = "foam"
{made}
contact.sole = {{ {contact}, law.frictionless = {{}} }}
[[step]]
increments.count = 2
displacement."block.top" = {{ x = 0.0, y = -0.02 }}
{more}
[[step]]
increments.count = 2
displacement."block.top" = {{ x = 0.0, y = -0.02 }}
pressure."block.bottom" = {{ value = 1.0, penetrates = true, from = "block.bottom_right" }}
{more}
"#
    );
    let model = model(&deck, &[]);
    *columns(&model, &run(&model))["pressure.block.bottom.wetted_part"].last().unwrap()
}

/// The edge of a tool or a body within a face: the fluid presses on all that lies beyond it, whatever the mesh.
#[test]
fn a_face_is_wet_up_to_the_edge_of_contact() {
    let tool = "tool.flat.profile = [{ line = [[0.55, -1.0], [0.55, 0.0]] }, { line = [[0.55, 0.0], [0.0, 0.0]] }]";
    let body = r#"
mesh.part.low.rectangle = { from = [0.0, -0.5], to = [0.55, 0.0], cells = [4, 2], cell = "quad4" }
body.low.material = "foam""#;
    let on_tool = (tool, r#"surface = "block.bottom", target = "flat""#);
    let [over, under] = [("block.bottom", "low.top"), ("low.top", "block.bottom")]
        .map(|(surface, target)| format!("surface = {surface:?}, target = {target:?}"));
    let held = "displacement.\"low.bottom\" = { x = 0.0, y = 0.0 }";
    for mesh in [("quad4", 5), ("quad4", 7), ("quad4", 13), ("quad8", 5)] {
        let near = |wet: f64, exact: f64| assert!((wet / exact - 1.0).abs() < 0.02, "{mesh:?}: {wet} {exact}");
        near(wet_beyond("plane-strain", mesh, on_tool, 0.0, ""), 0.45);
        near(wet_beyond("axisymmetric", mesh, on_tool, 0.0, ""), 1.0 - 0.55 * 0.55);
        for contact in [&over, &under] {
            near(wet_beyond("plane-strain", mesh, (body, contact), 0.0, held), 0.45);
        }
    }
}

/// The same in space over a square tool, and over a punch of few faces, whose own covered top stays dry.
#[test]
fn what_a_tool_or_a_punch_covers_stays_dry() {
    let square = |cell: &str, cells: usize| {
        format!(
            r#"
version = 1
space = "solid"
mesh.part.block.box = {{ from = [-1.0, 0.0, -1.0], to = [1.0, 0.5, 1.0], cells = [{cells}, 2, {cells}], cell = "{cell}" }}
tool.flat.plane = {{ at = [0.0, 0.0, 0.0], normal = [0.0, 1.0, 0.0], side = 1.1 }}
contact.sole = {{ surface = "block.bottom", target = "flat", law.frictionless = {{}} }}"#
        )
    };
    let punch = r#"
version = 1
space = "plane-strain"
mesh.part.block.rectangle = { from = [-1.0, 0.0], to = [1.0, 0.5], cells = [7, 4], cell = "quad4" }
mesh.part.punch.rectangle = { from = [-0.55, -0.5], to = [0.55, 0.0], cells = [2, 4], cell = "quad4" }
body.punch.material = "foam"
contact.sole = { surface = "block.bottom", target = "punch.top", law.frictionless = {} }"#;
    let wet = |made: &str, more: &str, held: &str| {
        let across = if held.is_empty() { ", z = 0.0" } else { "" };
        let top = format!("displacement.\"block.top\" = {{ x = 0.0, y = -0.02{across} }}\n{held}");
        let deck = format!(
            r#"{made}
material.foam.elastic = {{ young = 1000.0, poisson = 0.0 }}
body.block.material = "foam"
[[step]]
increments.count = 2
{top}
[[step]]
increments.count = 2
{top}
pressure."block.bottom" = {{ value = 1.0, penetrates = true }}
{more}
"#
        );
        let model = model(&deck, &[]);
        let columns = columns(&model, &run(&model));
        move |side: &str| *columns[&format!("pressure.{side}.wetted_part")].last().unwrap()
    };
    let near = |wet: f64, exact: f64, mesh: &str| assert!((wet / exact - 1.0).abs() < 0.02, "{mesh}: {wet} {exact}");
    for (cell, cells) in [("hex8", 4), ("hex8", 5), ("tet4", 4)] {
        near(wet(&square(cell, cells), "", "")("block.bottom"), 1.0 - 0.55 * 0.55, cell);
    }
    let on_top = "pressure.\"punch.top\" = { value = 1.0, penetrates = true }";
    let on_punch = wet(punch, on_top, "displacement.\"punch.bottom\" = { x = 0.0, y = 0.0 }");
    near(on_punch("block.bottom"), 0.45, "punch");
    assert_eq!(on_punch("punch.top"), 0.0);
}

/// A rib narrower than a face keeps the fluid on its side of it.
#[test]
fn a_rib_within_a_face_is_not_passed() {
    let rib = "tool.rib.profile = [
        { line = [[0.05, -1.0], [0.05, 0.0]] },
        { line = [[0.05, 0.0], [-0.05, 0.0]] },
        { line = [[-0.05, 0.0], [-0.05, -1.0]] },
    ]";
    for cells in [10, 15] {
        let on = (rib, r#"surface = "block.bottom", target = "rib""#);
        let wet = wet_beyond("plane-strain", ("quad4", cells), on, -1.0, "");
        assert!((wet / 0.475 - 1.0).abs() < 0.03, "{cells}: {wet}");
    }
}

/// Two blocks with nodes opposite each other, pressed less and less towards the fluid: it comes and goes on both alike.
#[test]
fn a_fluid_presses_on_both_bodies_alike() {
    let fluid = |value: f64| {
        ["high.bottom", "low.top"]
            .map(|side| {
                format!("pressure.\"{side}\" = {{ value = {value:?}, penetrates = true, from = \"{side}_right\" }}\n")
            })
            .concat()
    };
    let deck = format!(
        r#"
version = 1
space = "plane-strain"
mesh.part.low.rectangle = {{ from = [0.0, -1.0], to = [8.0, 0.0], cells = [8, 2], cell = "quad4" }}
mesh.part.high.rectangle = {{ from = [0.0, 0.0], to = [8.0, 1.0], cells = [8, 2], cell = "quad4" }}
material.foam.elastic = {{ young = 100.0, poisson = 0.0 }}
body.low.material = "foam"
body.high.material = "foam"
tool.lid.profile = [{{ line = [[-1.0, 1.0], [9.0, 1.0]] }}]
tool.lid.reference = [0.0, 1.0]
contact.sole = {{ surface = "high.bottom", target = "low.top", law.frictionless = {{}} }}
contact.lid = {{ surface = "high.top", target = "lid", law.frictionless = {{}} }}
[[step]]
increments.count = 5
symmetry = ["high.left", "low.left", "low.bottom"]
motion.lid = {{ y = -0.2, rotation = 1.0 }}
[[step]]
increments.count = 10
{}[[step]]
increments.count = 10
{}"#,
        fluid(5.0),
        fluid(1.0)
    );
    let model = model(&deck, &[]);
    let columns = columns(&model, &run(&model));
    let [high, low] = ["high.bottom", "low.top"].map(|side| columns[&format!("pressure.{side}.wetted_part")].clone());
    for (high, low) in high.iter().zip(&low) {
        assert!((high - low).abs() < 0.5 / 8.0, "{high} {low}");
    }
    assert!(high[14] > 1.0 / 8.0 && high[24] == 0.0, "{high:?}");
}
