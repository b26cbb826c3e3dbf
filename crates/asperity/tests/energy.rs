//! The balance of energy of contact: what the work of the supports misses of the energy that is stored,
//! by the form of the contact and by the law of the solid.

mod support;

use support::{columns, model, run};

const BLOCK: &str = include_str!("../../../cases/energy-balance/block.toml");

/// What drawing the tool misses, over the strain energy, with so many times more increments.
fn missing(sets: &[&str], times: usize) -> f64 {
    let count = format!("step.draw.increments.count={}", 10 * times);
    let model = model(BLOCK, &[sets, &[&count]].concat());
    let columns = columns(&model, &run(&model));
    let (missing, stored) = (&columns["energy.missing"], &columns["energy.strain"]);
    let pushed = missing.len() - 10 * times - 1;
    (missing.last().unwrap() - missing[pushed]) / stored.last().unwrap()
}

/// Value for infinitely many increments, and the order at which it is approached.
fn limit(sets: &[&str]) -> (f64, f64) {
    let [a, b, c] = [1, 2, 4].map(|times| missing(sets, times));
    (c + (c - b) / 3.0, ((b - a) / (c - b)).log2())
}

#[test]
fn a_field_keeps_the_energy() {
    let (left, order) = limit(&[]);
    assert!(left.abs() < 1e-6 && order > 1.8, "{left:.2e} {order}");
    let (traction, _) = limit(&["contact.base.form=paper"]);
    assert!(traction.abs() > 1e-5, "{traction:.2e}");
}

/// What a rate law leaves over of the work is told apart: nothing else is missing then but what the paper's form misses.
#[test]
fn the_residue_of_a_rate_law_stands_apart() {
    let rate = "material.rubber={ elastic = { young = 7.5, poisson = 0.25 } }";
    let (left, order) = limit(&[rate]);
    assert!(left.abs() < 1e-6 && order > 1.8, "{left:.2e} {order}");
    let (traction, _) = limit(&[rate, "contact.base.form=paper"]);
    assert!(traction.abs() > 1e-5, "{traction:.2e}");
    let residue = |sets: &[&str]| {
        let model = model(BLOCK, sets);
        let columns = columns(&model, &run(&model));
        columns["energy.residue"].last().unwrap() / columns["energy.strain"].last().unwrap()
    };
    assert!(residue(&[rate]).abs() > 1e-3, "{}", residue(&[rate]));
    assert_eq!(residue(&[]), 0.0);
}

/// A block rubs to and fro on another under a constant force, two increments a stroke.
const RUBBING: &str = r#"
version = 1
space = "plane-strain"
mesh.part.a.rectangle = { from = [0.0, 0.0], to = [4.0, 1.0], cells = [8, 2], cell = "quad4" }
mesh.part.g.rectangle = { from = [-3.0, -2.0], to = [7.0, 0.0], cells = [17, 4], cell = "quad4" }
material.m.elastic = { young = 1e4, poisson = 0.3 }
body.a.material = "m"
body.g.material = "m"
contact.c = { surface = "a.bottom", target = "g.top", law.coulomb = { friction = 0.25 } }
[[step]]
increments = { count = 2 }
displacement = { "g.bottom" = { x = 0.0, y = 0.0 }, "a.top" = { x = 0.0 } }
traction."a.top".y = -5.0
[[step]]
increments = { count = 2 }
displacement."a.top".x = 0.5
[[step]]
increments = { count = 2 }
displacement."a.top".x = -0.5
[[step]]
increments = { count = 2 }
displacement."a.top".x = 0.5
"#;

/// Friction that turns within an increment dissipates all the way: 0.25 of 20 N over 2.5 mm, and less than a per cent is elastic. What
/// drives the block does as much, and nothing is missing.
#[test]
fn friction_that_turns_within_an_increment_keeps_its_work() {
    for sets in [&[][..], &["contact.c.form=paper"], &["contact.c.augmentation={}"]] {
        let model = model(RUBBING, sets);
        let columns = columns(&model, &run(&model));
        let last = |name: &str| *columns[name].last().unwrap();
        let (friction, external) = (last("energy.friction"), last("energy.external"));
        assert!((friction / 12.5 - 1.0).abs() < 0.01, "{sets:?}: {friction}");
        assert!((external - friction - last("energy.strain")).abs() < 0.01 * friction, "{sets:?}: {external}");
        assert!(last("energy.missing").abs() < 0.005 * friction, "{sets:?}: {}", last("energy.missing"));
        // With multipliers the law's own figure counts what they have still to take.
        let (told, most) =
            (last("contact.c.dissipation"), if sets == ["contact.c.augmentation={}"] { 0.05 } else { 0.01 });
        assert!((told / friction - 1.0).abs() < most, "{sets:?}: {told} {friction}");
    }
}

/// A block is rubbed over 5 mm under 50 N, ten times to and fro in one step: `10 mu N 20 mm`, less the elastic recoil.
#[test]
fn friction_over_the_cycles_of_an_amplitude() {
    let turns = (0..20).map(|k| format!("[{}, {}]", 0.025 + 0.05 * f64::from(k), 1 - 2 * (k % 2)));
    let amplitude = turns.collect::<Vec<_>>().join(", ");
    let deck = format!(
        r#"
version = 1
space = "plane-strain"
mesh.part.block.rectangle = {{ from = [0.0, 0.0], to = [10.0, 4.0], cells = [10, 4], cell = "quad4" }}
material.steel.elastic = {{ young = 1e3, poisson = 0.3 }}
body.block.material = "steel"
tool.floor.profile = [{{ line = [[60.0, 0.0], [-40.0, 0.0]] }}]
contact.sole = {{ surface = "block.bottom", target = "floor", law.coulomb = {{ friction = 0.2 }} }}
rigid.top = {{ group = "block.top", reference = [5.0, 0.0] }}
[[step]]
load.top.y = -50.0
motion.top = {{ x = 0.0, rotation = 0.0 }}
[[step]]
motion.top = {{ x = 5.0, rotation = 0.0, amplitude = [[0.0, 0.0], {amplitude}, [1.0, 0.0]] }}
"#
    );
    for sets in [&[][..], &["step.2.increments.count=7"]] {
        let model = model(&deck, sets);
        let work = *columns(&model, &run(&model))["energy.friction"].last().unwrap();
        assert!((work / 1995.0 - 1.0).abs() < 0.005, "{work}");
    }
}

/// A block pressed onto another, lifted by many times what it had been pressed by, and put back, each in one increment: the trapezoid of the work
/// has half of the force all the way.
#[test]
fn what_lifts_off_in_one_increment_has_no_work_in_the_air() {
    const LIFTED: &str = r#"
version = 1
space = "plane-strain"
mesh.part.a.rectangle = { from = [0.0, 0.0], to = [4.0, 1.0], cells = [9, 3], cell = "quad8" }
mesh.part.b.rectangle = { from = [1.0, 1.0], to = [3.0, 2.0], cells = [5, 3], cell = "quad4" }
material.m.elastic = { young = 1e3, poisson = 0.3 }
body.a.material = "m"
body.b.material = "m"
contact.c = { surface = "b.bottom", target = "a.top", law.coulomb.friction = 0.3 }
[[step]]
displacement."a.bottom" = { x = 0.0, y = 0.0 }
displacement."b.top" = { x = 0.0, y = -0.02 }
[[step]]
increments.count = 1
displacement."b.top" = { x = 0.0, y = 3.0 }
[[step]]
increments.count = 1
displacement."b.top" = { x = 0.0, y = -0.02 }
"#;
    let model = model(LIFTED, &[]);
    let columns = columns(&model, &run(&model));
    let stored = columns["energy.strain"].last().unwrap();
    let missing = columns["energy.missing"].iter().fold(0.0_f64, |most, missing| most.max(missing.abs()));
    assert!(missing < 0.1 * stored, "{missing} of {stored}");
}
