//! Augmentation on whole runs: what it leaves of penetration and of elastic slip, that the penalty then no longer matters,
//! and that its multipliers are part of the state.

mod support;

use asperity::system::State;
use support::{all_bytes, bytes, columns, go_on, model, run};

const ROLLER: &str = include_str!("../../../cases/hertz-cylinder/roller.toml");
const RING: &str = include_str!("../../../cases/crushed-ring/ring.toml");
const HALF: &str = include_str!("../../../cases/crushed-ring/half.toml");
const COARSE: [&str; 4] = [
    "mesh.part.roller.annulus.along_radius=[{ to = 49.0, cells = 6, ratio = 0.01 }, { to = 50.0, cells = 5 }]",
    "mesh.part.roller.annulus.along_angle=[{ to = -89.0, cells = 5 }, { to = 0.0, cells = 8, smooth = true }]",
    "step.load.increments.count=5",
    "contact.foot.augmentation={}",
];

/// A block is pressed onto a plate, then drawn along it by less than it takes to slide, and by more.
const BLOCK: &str = r#"
version = 1
space = "plane-strain"
mesh.part.block.rectangle = { from = [0.0, 0.0], to = [4.0, 2.0], cells = [4, 2], cell = "quad8" }
material.rubber.elastic = { young = 10.0, poisson = 0.3 }
body.block.material = "rubber"
tool.plate.profile = [{ line = [[9.0, 0.0], [-9.0, 0.0]] }]
contact.base = { surface = "block.bottom", target = "plate", law.coulomb = { friction = 0.5 }, augmentation = { loops = 40 } }
[[step]]
increments.count = 2
displacement."block.top" = { x = 0.0, y = -0.1 }
[[step]]
increments.count = 4
displacement."block.top" = { x = 0.02, y = -0.1 }
[[step]]
increments.count = 3
displacement."block.top" = { x = 1.0, y = -0.1 }
"#;

/// A cube is pressed onto a plate, and drawn askew until it slides.
const CUBE: &str = r#"
version = 1
space = "solid"
mesh.part.block.box = { from = [0.0, 0.0, 0.0], to = [1.0, 1.0, 1.0], cells = [2, 2, 2], cell = "hex8" }
material.rubber.elastic = { young = 10.0, poisson = 0.0 }
body.block.material = "rubber"
tool.plate.plane = { at = [0.5, 0.5, 0.0], normal = [0.0, 0.0, 1.0], side = 9.0 }
contact.base = { surface = "block.back", target = "plate", law.coulomb = { friction = 0.3 }, augmentation = {} }
[[step]]
increments.count = 2
displacement."block.front" = { x = 0.0, y = 0.0, z = -0.05 }
[[step]]
increments.count = 4
displacement."block.front" = { x = 0.3, y = 0.2, z = -0.05 }
"#;

fn coarse<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&COARSE, more].concat()
}

fn last(columns: &std::collections::BTreeMap<String, Vec<f64>>, name: &str) -> f64 {
    *columns[name].last().unwrap_or_else(|| panic!("{name}"))
}

/// Hertz: weighted penetrations at the nodes below 1e-6 of the edges after at most six augmentations, in every increment.
#[test]
fn penetration_is_taken_out() {
    let model = model(ROLLER, &coarse(&[]));
    let keep = run(&model);
    let columns = columns(&model, &keep);
    assert!(keep.attempts.iter().all(|attempt| attempt.failure.is_none() && attempt.augmentations() <= 6));
    assert!(keep.attempts.iter().any(|attempt| attempt.augmentations() > 0));
    assert!(columns["contact.foot.nodal_penetration"].iter().all(|left| *left <= 1e-6));
    assert!((last(&columns, "contact.foot.force.y") - 500.0).abs() < 1e-4);
}

/// A penalty ten times softer gives the same answer, where without multipliers it gives another.
#[test]
fn the_penalty_no_longer_matters() {
    let pushed = |sets: &[&str]| {
        let model = model(ROLLER, &coarse(sets));
        let keep = run(&model);
        keep.states.last().unwrap().u[model.problem.dofs.tool(0) + 1]
    };
    let soft = "contact.foot.penalty=2e6";
    let (fine, coarse) = (pushed(&[]), pushed(&[soft, "contact.foot.augmentation.loops=60"]));
    let bare = |sets: &[&str]| {
        let model = model(ROLLER, &[&COARSE[..3], sets].concat());
        run(&model).states.last().unwrap().u[model.problem.dofs.tool(0) + 1]
    };
    // What is left is where along the last edge the contact ends.
    let (with, without) = (coarse / fine - 1.0, bare(&[soft]) / fine - 1.0);
    assert!(with.abs() < 2e-3 && without.abs() > 0.02, "{with} {without}");
}

/// What sticks does not creep.
#[test]
fn creep_is_taken_out() {
    let creep = |sets: &[&str]| {
        let model = model(
            BLOCK,
            &[&["contact.base.law.coulomb.friction=9.0", "mesh.part.block.rectangle.cell=quad4"], sets].concat(),
        );
        let keep = go_on(&model, model.problem.initial_state(), Some(6));
        assert!(keep.attempts.iter().all(|attempt| attempt.failure.is_none()));
        let slip = |state: &State| {
            let history = &state.histories[model.first_contact()];
            model.field_contacts[0].records(&state.u, history).iter().map(|record| record.slip).collect::<Vec<_>>()
        };
        let (pressed, drawn) = (slip(&keep.states[1]), slip(&keep.states[5]));
        pressed.iter().zip(drawn).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    let held = creep(&[]);
    let crept = creep(&["contact.base.augmentation.slip=1.0", "contact.base.augmentation.penetration=1.0"]);
    assert!(held < 1e-5 && crept > 5.0 * held, "{held} {crept}");
}

/// What slides follows Coulomb's law and loses the work of its friction.
#[test]
fn sliding_is_as_without_multipliers() {
    let [with, without] = ["1e-6", "1.0"].map(|left| {
        let sets = ["penetration", "slip"].map(|key| format!("contact.base.augmentation.{key}={left}"));
        let model = model(BLOCK, &sets.each_ref().map(String::as_str));
        let keep = run(&model);
        assert!(keep.attempts.iter().all(|attempt| attempt.failure.is_none()));
        columns(&model, &keep)
    });
    let friction = |columns| last(columns, "contact.base.force.x") / last(columns, "contact.base.force.y");
    assert!((friction(&with) / friction(&without) - 1.0).abs() < 1e-3);
    assert!(with["contact.base.coulomb_violation"].iter().all(|&excess| excess < 1e-12));
    assert!(with["contact.base.least_dissipation"].iter().all(|&least| least >= 0.0));
    let missing = last(&with, "energy.missing").abs() / last(&with, "energy.external");
    assert!(missing < 0.04, "{missing}");
}

#[test]
fn multipliers_are_part_of_the_state() {
    let model = model(BLOCK, &[]);
    let whole = all_bytes(&run(&model));
    for k in [1, 3, 6] {
        let begun = go_on(&model, model.problem.initial_state(), Some(k));
        let state: State = postcard::from_bytes(&bytes(&begun.states[k - 1])).unwrap();
        assert!(whole[k..] == all_bytes(&go_on(&model, state, None))[..], "{k}");
    }
    let mut twice = model;
    twice.problem.newton.rehearse = true;
    assert!(whole == all_bytes(&run(&twice)));
}

/// Largest penetration at the nodes in any increment.
fn nodal(columns: &std::collections::BTreeMap<String, Vec<f64>>, name: &str) -> f64 {
    columns[&format!("contact.{name}.nodal_penetration")].iter().copied().fold(0.0, f64::max)
}

/// A ring that touches itself is twice its half on a plane, with multipliers as without, and whatever the penalty.
#[test]
fn a_surface_that_touches_itself_is_augmented() {
    let crushed = |deck: &str, sets: [&str; 2]| {
        let model = model(deck, &["contact.bore.augmentation={ loops = 60 }", sets[0], sets[1]]);
        let keep = run(&model);
        assert!(keep.attempts.iter().any(|attempt| attempt.augmentations() > 0));
        columns(&model, &keep)
    };
    let ring = |penalty: &str| crushed(RING, ["mesh.part.ring.annulus.cells=[1, 192]", penalty]);
    let (stiff, soft) = (ring("contact.bore.penalty=1e4"), ring("contact.bore.penalty=3e3"));
    assert!([&stiff, &soft].into_iter().all(|columns| nodal(columns, "bore") <= 1e-6));
    let half = crushed(HALF, ["mesh.part.ring.annulus.cells=[1, 96]", "contact.bore.penalty=2e4"]);
    let bare = model(RING, &["mesh.part.ring.annulus.cells=[1, 192]", "contact.bore.penalty=3e3"]);
    let bare = columns(&bare, &run(&bare));
    let [force, soft, half, bare] = [&stiff, &soft, &half, &bare].map(|columns| last(columns, "reaction.top.y"));
    assert!((force / half - 1.0).abs() < 2e-5, "{force} {half}");
    // What is left is where along the last edge the contact ends.
    assert!((soft / force - 1.0).abs() < 0.015 && (bare / force - 1.0).abs() > 0.02, "{force} {soft} {bare}");
}

/// In space.
#[test]
fn faces_in_space_are_augmented() {
    let model = model(CUBE, &[]);
    let keep = run(&model);
    let columns = columns(&model, &keep);
    assert!(columns["contact.base.nodal_penetration"].iter().all(|left| *left <= 1e-6));
    assert!(keep.attempts.iter().any(|attempt| attempt.augmentations() > 0));
    let penetration = columns["contact.base.max_penetration"].iter().copied().fold(0.0, f64::max);
    assert!(penetration < 1e-5, "{penetration}");
    let [along, across] = ["x", "y"].map(|axis| last(&columns, &format!("contact.base.force.{axis}")));
    let friction = along.hypot(across) / last(&columns, "contact.base.thrust");
    assert!((friction / 0.3 - 1.0).abs() < 0.02, "{friction}");
}

/// Rubber that cannot give way aside is far stiffer than what the default penalty goes by; the penalty is raised until few augmentations
/// suffice, and the force is that of the bulk.
#[test]
fn few_augmentations_suffice_for_rubber_that_is_confined() {
    let deck = r#"
version = 1
space = "plane-strain"
mesh.part.block.rectangle = { from = [0.0, 0.0], to = [2.0, 1.0], cells = [8, 4], cell = "quad4" }
material.rubber.neo_hookean = { shear = 1.0, bulk = 5e3 }
body.block.material = "rubber"
tool.punch.profile = [{ line = [[-1.0, 1.0], [3.0, 1.0]] }]
contact.top = { surface = "block.top", target = "punch", law.frictionless = {}, augmentation = {} }
[[step]]
symmetry = ["block.left", "block.right", "block.bottom"]
motion.punch = { y = -0.1 }
increments.count = 4
"#;
    let model = model(deck, &[]);
    let keep = run(&model);
    assert!(keep.attempts.len() == 4 && keep.attempts.iter().all(|attempt| attempt.failure.is_none()));
    let columns = columns(&model, &keep);
    assert!(columns["contact.top.nodal_penetration"].iter().all(|left| *left <= 1e-6));
    // Pressure holds the energy of the bulk alone: nothing is stored by multipliers or lost by a penalty that rose.
    let [missing, external] = ["energy.missing", "energy.external"].map(|name| last(&columns, name));
    assert!((missing / external).abs() < 0.02, "{missing} of {external}");
}
