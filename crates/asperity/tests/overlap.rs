//! Overlap before the first increment, and wear: what is added to the penetration that a law sees.

mod support;

use asperity::output::{Parts, QuantityPlace, Source};
use std::collections::BTreeMap;
use support::{Keep, columns, model, run};

/// A block that reaches into a plate by 0.05, its top held.
const BLOCK: &str = r#"
version = 1
space = "plane-strain"
mesh.part.block.rectangle = { from = [0.0, 0.0], to = [2.0, 2.0], cells = [2, 2], cell = "quad8" }
material.rubber.elastic = { young = 10.0, poisson = 0.0 }
body.block.material = "rubber"
tool.plate.profile = [{ line = [[9.0, 0.05], [-9.0, 0.05]] }]
contact.base = { surface = "block.bottom", target = "plate", law.frictionless = {}, overlap = "ramp" }
[[step]]
duration = 2.0
increments.count = 4
displacement."block.top" = { x = 0.0, y = 0.0 }
"#;

fn ran(sets: &[&str]) -> (asperity::model::Model, Keep, BTreeMap<String, Vec<f64>>) {
    let model = model(BLOCK, sets);
    let keep = run(&model);
    let columns = columns(&model, &keep);
    (model, keep, columns)
}

/// The force of a column that is shortened by what the overlap leaves; the penalty is in series with it.
fn column_force(overlap: f64) -> f64 {
    let penalty = 50.0 * 10.0 / 1.0;
    2.0 * overlap / (2.0 / 10.0 + 1.0 / penalty)
}

#[test]
fn an_overlap_is_removed_over_the_first_step() {
    let (_, _, ramped) = ran(&[]);
    for (i, force) in ramped["contact.base.force.y"].iter().enumerate() {
        let expected = column_force(0.05 * (i + 1) as f64 / 4.0);
        assert!((force / expected - 1.0).abs() < 0.03, "{force} {expected}");
    }
    let (_, _, kept) = ran(&["contact.base.overlap=keep"]);
    assert!((kept["contact.base.force.y"][0] / column_force(0.05) - 1.0).abs() < 0.03);
    let last = |columns: &BTreeMap<String, Vec<f64>>| *columns["contact.base.force.y"].last().unwrap();
    // Up to what a rate law makes of another path.
    assert!((last(&ramped) / last(&kept) - 1.0).abs() < 1e-3);
    // What the overlap gives is in the balance.
    for columns in [&ramped, &kept] {
        let of = |name: &str| *columns[name].last().unwrap();
        assert!(of("energy.strain") > 0.0 && of("energy.missing").abs() < 0.02 * of("energy.strain"));
    }
}

/// A block that reaches in by a third of its height is squeezed as one that the plate is pressed into.
#[test]
fn a_deep_overlap_is_removed() {
    let force = |deck: String| {
        let model = model(&deck, &[]);
        *columns(&model, &run(&model))["contact.base.force.y"].last().unwrap()
    };
    let pressed = format!("{}motion.plate = {{ y = 0.6 }}", BLOCK.replace("0.05", "0.0"));
    let [ramped, pressed] = [BLOCK.replace("0.05", "0.6"), pressed].map(force);
    assert!((ramped / pressed - 1.0).abs() < 0.01, "{ramped} {pressed}");
}

#[test]
fn nodes_are_moved_without_strain() {
    let (model, _, columns) = ran(&["contact.base.overlap=adjust"]);
    assert!(columns["contact.base.force.y"].iter().all(|force| force.abs() < 1e-9));
    let bottom = &model.mesh.groups["block.bottom"].nodes;
    assert!(bottom.iter().all(|&node| (model.mesh.points[node][1] - 0.05).abs() < 1e-12));
    let others = model.mesh.points.iter().filter(|x| x[1] > 0.06).count();
    assert_eq!(others + bottom.len(), model.mesh.points.len());
    assert!(columns["energy.strain"].iter().all(|energy| energy.abs() < 1e-12));
}

/// A ring on a plane that cuts it: its nodes come to lie on the plane, and the edges between them too.
#[test]
fn a_curved_surface_is_moved_onto_its_target() {
    const RING: &str = r#"
version = 1
space = "plane-strain"
mesh.part.ring.annulus = { from = [2.0, -120.0], to = [3.0, -60.0], cells = [2, 12], cell = "quad8" }
material.rubber.elastic = { young = 10.0, poisson = 0.0 }
body.ring.material = "rubber"
tool.plate.profile = [{ line = [[9.0, -2.95], [-9.0, -2.95]] }]
contact.base = { surface = "ring.outer", target = "plate", law.frictionless = {}, overlap = "adjust" }
[[step]]
increments.count = 1
displacement."ring.inner" = { x = 0.0, y = 0.0 }
"#;
    let model = model(RING, &[]);
    let outer = &model.mesh.groups["ring.outer"].nodes;
    assert!(outer.iter().all(|&node| model.mesh.points[node][1] > -2.95 - 1e-9));
    assert!(outer.iter().filter(|&&node| (model.mesh.points[node][1] + 2.95).abs() < 1e-9).count() > 5);
    let columns = columns(&model, &run(&model));
    // What the edges between a moved node and one that was not leave inside.
    assert!(columns["contact.base.max_penetration"][0] < 1e-3);
}

/// A column whose foot wears as it is drawn along: the pressure falls as `exp(-k c s)` with the stiffness `c` per area.
#[test]
fn wear_relieves_the_pressure() {
    let worn = |recedes: &str| {
        let sets = [
            "tool.plate.profile=[{ line = [[9.0, 0.0], [-9.0, 0.0]] }]",
            "step.1.displacement={ block = { x = 0.0 }, 'block.top' = { x = 0.0, y = -0.05 } }",
            &format!("contact.base.wear={{ coefficient = 0.1, recedes = {recedes} }}"),
        ];
        let deck = BLOCK.to_owned()
            + "[[step]]\nincrements.count = 100\ndisplacement = { block = { x = 1.0 }, 'block.top' = { x = 1.0, y = -0.05 } }";
        let model = model(&deck, &sets);
        let keep = run(&model);
        let pressure = columns(&model, &keep)["contact.base.max_pressure"].clone();
        let state = keep.states.last().unwrap();
        let frame = Source { parts: &Parts::of(&model), state, step: 1 }.gather().unwrap();
        let depth = frame.at(QuantityPlace::Contact).find(|q| q.name == "contact_wear").unwrap().values[0];
        (pressure[3], *pressure.last().unwrap(), depth)
    };
    let stiffness = 1.0 / (2.0 / 10.0 + 1.0 / 500.0);
    let (before, after, depth) = worn("true");
    let left = (-0.1 * stiffness * 1.0_f64).exp();
    assert!((after / before / left - 1.0).abs() < 0.02, "{before} {after} {left}");
    // The column is longer by the depth: `p = 10 ln(2 / h)`.
    let longer = [before, after].map(|pressure| 2.0 * (-pressure / 10.0).exp());
    assert!((depth / (longer[1] - longer[0]) - 1.0).abs() < 0.005, "{depth} {longer:?}");
    let (before, after, depth) = worn("false");
    assert!((after / before - 1.0).abs() < 1e-6 && (depth - 0.1 * before).abs() < 1e-3 * depth, "{depth} {before}");
}

/// A block under 20 N is drawn by 3 and back by 2, and wears in an increment by a hundred times what it penetrates: the mean depth is
/// `k p s` all the same, all of the slip rubs, and the work of the load on the receding surface is not missing.
#[test]
fn wear_beyond_the_penetration_keeps_its_slip() {
    const WORN: &str = r#"
version = 1
space = "plane-strain"
mesh.part.a.rectangle = { from = [0.0, 0.0], to = [2.0, 1.0], cells = [4, 2], cell = "quad4" }
material.m.elastic = { young = 1e6, poisson = 0.0 }
body.a.material = "m"
tool.t.profile = [{ line = [[50.0, 0.0], [-50.0, 0.0]] }]
contact.c = { surface = "a.bottom", target = "t", law.coulomb.friction = 0.3, wear = { coefficient = 1e-4, recedes = true } }
[[step]]
displacement."a.top".x = 0.0
pressure."a.top".value = 10.0
[[step]]
increments.count = 10
displacement."a.top".x = 3.0
[[step]]
increments.count = 10
displacement."a.top".x = 1.0
"#;
    for sets in [&[][..], &["contact.c.form=paper"]] {
        let model = model(WORN, sets);
        let keep = run(&model);
        let columns = columns(&model, &keep);
        let frame = Source { parts: &Parts::of(&model), state: keep.states.last().unwrap(), step: 2 }.gather().unwrap();
        let field = |name: &str| frame.at(QuantityPlace::Contact).find(|q| q.name == name).unwrap().values.clone();
        let (wear, area) = (field("contact_wear"), field("contact_area"));
        let volume: f64 = wear.iter().zip(&area).map(|(wear, area)| wear * area).sum();
        assert!((volume / (1e-4 * 20.0 * 5.0) - 1.0).abs() < 0.005, "{sets:?}: {volume}");
        // At nodes, which probes read.
        let nodal = &frame.at(QuantityPlace::Node).find(|q| q.name == "contact_wear_averaged").unwrap().values;
        let (least, most) = wear.iter().fold((f64::MAX, 0.0_f64), |(least, most), x| (least.min(*x), most.max(*x)));
        let within = least * (1.0 - 1e-9)..=most * (1.0 + 1e-9);
        let bottom = &model.mesh.groups["a.bottom"].nodes;
        assert!(least > 0.0 && bottom.iter().all(|&node| within.contains(&nodal[node])), "{sets:?}: {nodal:?}");
        let last = |name: &str| *columns[name].last().unwrap();
        let (slid, worn) = (0.3 * 20.0 * 5.0, 20.0 * 1e-4 * 10.0 * 5.0);
        assert!(
            (last("contact.c.dissipation") / slid - 1.0).abs() < 0.005,
            "{sets:?}: {}",
            last("contact.c.dissipation")
        );
        assert!((last("energy.friction") / (slid + worn) - 1.0).abs() < 0.005, "{sets:?}: {}", last("energy.friction"));
        assert!(last("energy.missing").abs() < 0.005 * slid, "{sets:?}: {}", last("energy.missing"));
    }
}

/// Variables of laws are fields of the contact points; a law that does not have one has no number there.
#[test]
fn variables_of_laws_are_fields() {
    let model = model(include_str!("decks/every_interface.toml"), &[]);
    let state = model.problem.initial_state();
    let frame = Source { parts: &Parts::of(&model), state: &state, step: 0 }.gather().unwrap();
    for name in ["contact_dilation", "contact_log_state", "contact_slip_velocity", "contact_closure"] {
        let field = frame.at(QuantityPlace::Contact).find(|q| q.name == name).unwrap_or_else(|| panic!("{name}"));
        let numbers = field.values.iter().filter(|value| value.is_finite()).count();
        assert!(numbers > 0 && numbers < field.values.len(), "{name}");
    }
}
