//! Whole runs of two bodies: turned as a whole they answer alike, and a block that slides over the edges of another drags
//! alike whichever of them it covers.

mod support;

use support::{Keep, columns, model, run};

/// A sector of a ring is pressed upon another and drawn along it.
const RINGS: &str = r#"
version = 1
space = "plane-strain"
material.rubber.neo_hookean = { shear = 4.0, bulk = 10.0 }
body.bed.material = "rubber"
body.shoe.material = "rubber"
contact.sole = { surface = "shoe.inner", target = "bed.outer", law.coulomb = { friction = 0.3 } }
solver.tolerance = 1e-12
"#;

/// The deck with everything turned by some degrees.
fn rings(cell: &str, passes: &str, turn: f64) -> String {
    let part = |name: &str, radii: [f64; 2], angles: [f64; 2], cells: [usize; 2]| {
        let [from, to] = [0, 1].map(|k| format!("[{:?}, {:?}]", radii[k], angles[k] + turn));
        format!("[mesh.part.{name}.annulus]\nfrom = {from}\nto = {to}\ncells = {cells:?}\ncell = \"{cell}\"\n")
    };
    let moved = |[across, along]: [f64; 2]| {
        let (sin, cos) = (turn + 45.0).to_radians().sin_cos();
        format!("{{ x = {:?}, y = {:?} }}", across * cos - along * sin, across * sin + along * cos)
    };
    let step = |motion: [f64; 2], increments: usize| {
        format!("[[step]]\nincrements.count = {increments}\ndisplacement.\"shoe.outer\" = {}\n", moved(motion))
    };
    let held = "displacement.\"bed.inner\" = { x = 0.0, y = 0.0 }\n";
    [
        RINGS.replace("law.coulomb", &format!("passes = \"{passes}\", law.coulomb")),
        part("bed", [20.0, 24.0], [0.0, 90.0], [2, 15]),
        part("shoe", [24.05, 27.0], [35.0, 55.0], [2, 4]),
        step([-0.4, 0.0], 3),
        held.into(),
        step([-0.45, 1.5], 5),
    ]
    .concat()
}

#[test]
fn two_bodies_turned_as_a_whole_answer_alike() {
    for (cell, passes) in [("quad4", "one"), ("quad8", "two"), ("quad8", "one")] {
        let turn = 37.0_f64;
        let ends = [0.0, turn].map(|turn| {
            let model = model(&rings(cell, passes, turn), &[]);
            let keep = run(&model);
            (keep.states.last().unwrap().u.clone(), columns(&model, &keep))
        });
        let (sin, cos) = turn.to_radians().sin_cos();
        let largest = ends[0].0.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
        for (a, b) in ends[0].0.chunks_exact(2).zip(ends[1].0.chunks_exact(2)) {
            let turned = [cos * a[0] - sin * a[1], sin * a[0] + cos * a[1]];
            assert!((0..2).all(|k| (turned[k] - b[k]).abs() < 1e-8 * largest), "{cell}, {passes}: {turned:?} {b:?}");
        }
        let last = |end: usize, name: &str| *ends[end].1[name].last().unwrap();
        let force = |end: usize| ["contact.sole.force.x", "contact.sole.force.y"].map(|name| last(end, name));
        let (a, b) = (force(0), force(1));
        let size = a[0].hypot(a[1]);
        assert!(size > 0.1, "{cell}, {passes}: nothing is carried");
        let off = (cos * a[0] - sin * a[1] - b[0]).hypot(sin * a[0] + cos * a[1] - b[1]);
        assert!(off < 1e-8 * size, "{cell}, {passes}: {off:e} of {size}");
        assert!((last(0, "contact.sole.max_pressure") / last(1, "contact.sole.max_pressure") - 1.0).abs() < 1e-8);
    }
}

/// A block under a dead pressure slides along a slab over several of its edges.
const BLOCK: &str = r#"
version = 1
space = "plane-strain"
mesh.part.slab.rectangle = { from = [0.0, -1.0], to = [3.0, 0.0], cells = [10, 3], cell = "quad8" }
mesh.part.block.rectangle = { from = [0.4, 0.0], to = [1.1, 0.4], cells = [3, 2], cell = "quad8" }
material.rubber.elastic = { young = 1e3, poisson = 0.3 }
body.slab.material = "rubber"
body.block.material = "rubber"
contact.sole = { surface = "block.bottom", target = "slab.top", law.coulomb = { friction = 0.2 } }
[[step]]
increments.count = 2
displacement."slab.bottom" = { x = 0.0, y = 0.0 }
displacement."block.top" = { x = 0.0 }
pressure."block.top" = { value = 5.0, kind = "dead" }
[[step]]
increments.count = 60
displacement."block.top" = { x = 1.4 }
"#;

/// The drag on the block: in no increment does it change by a hundredth, whichever edges its corners cross.
#[test]
fn sliding_over_edges_drags_evenly() {
    let model = model(BLOCK, &[]);
    let keep: Keep = run(&model);
    let (columns, limit) = (columns(&model, &keep), 0.2 * 5.0 * 0.7);
    let drag = &columns["contact.sole.force.x"][6..];
    for two in drag.windows(2) {
        // The block leans a little, so that its pressure has a part along the slab.
        assert!((two[0].abs() / limit - 1.0).abs() < 0.03, "{} of {limit}", two[0]);
        assert!((two[1] - two[0]).abs() < 0.01 * limit, "{two:?} of {limit}");
    }
}

/// Nodes of a soft base, which carry, come under a stiff block that slides over it and leave its sight within increments of most of a face:
/// what they slipped until then is friction's work as well.
#[test]
fn what_leaves_sight_keeps_its_friction_work() {
    let deck = r#"
version = 1
space = "plane-strain"
mesh.part.base.rectangle = { from = [0.0, -4.0], to = [23.0, 0.0], cells = [22, 2], cell = "quad4" }
mesh.part.block.rectangle = { from = [1.0, 0.0], to = [5.0, 2.0], cells = [5, 2], cell = "quad4" }
material.soft.elastic = { young = 2e3, poisson = 0.3 }
material.stiff.elastic = { young = 200e3, poisson = 0.3 }
body.base.material = "soft"
body.block.material = "stiff"
rigid.head.group = "block.top"
contact.foot = { surface = "block.bottom", target = "base.top", law.coulomb = { friction = 0.3 } }
[[step]]
name = "press"
displacement."base.bottom" = { x = 0.0, y = 0.0 }
load.head.y = -4.0
[[step]]
name = "slide"
increments = { largest = 0.05, first = 0.05 }
motion.head.x = 16.0
"#;
    let model = model(deck, &[]);
    let keep = run(&model);
    assert!(keep.states.iter().all(|state| state.jumps == 0));
    let columns = columns(&model, &keep);
    let last = |name: &str| *columns[name].last().unwrap();
    let (friction, external) = (last("energy.friction"), last("energy.external"));
    assert!((external - 0.3 * 4.0 * 16.0).abs() < 0.02 * external, "{external}");
    assert!((friction - external).abs() < 0.01 * external, "{friction} of {external}");
}
