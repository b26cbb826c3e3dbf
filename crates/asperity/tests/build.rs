//! What the conditions of a deck become: constraints and courses of each step.

use asperity::amplitude::Amplitude;
use asperity::deck::{build, read, review};
use asperity::model::Model;
use asperity::solve::{Course, Prescribed};
use asperity::system::Row;
use std::path::Path;

const HEAD: &str = r#"
version = 1
space = "plane-strain"
mesh.part.block.rectangle = { from = [0.0, 0.0], to = [2.0, 1.0], cells = [2, 1], cell = "quad4" }
material.steel.elastic = { young = 210e3, poisson = 0.3 }
body.block.material = "steel"
"#;

const TOOL: &str = "tool.plate.profile = [{ line = [[5.0, -1.0], [-5.0, -1.0]] }]\n";

fn made(deck: &str) -> Model {
    let loaded = read(deck, "test.toml", Path::new(""), &[]);
    loaded.and_then(build).map(|made| made.model).unwrap_or_else(|d| panic!("{}", d.render(false)))
}

fn refused(deck: &str) -> String {
    let loaded = read(deck, "test.toml", Path::new(""), &[]);
    loaded.and_then(build).err().expect("the deck is wrong").render(false)
}

/// What a step prescribes for an unknown.
fn prescribed(built: &Model, step: usize, dof: usize) -> Option<&Prescribed> {
    let mut found = built.problem.steps[step].prescribed.iter().filter(|p| p.dof == dof);
    let first = found.next();
    assert!(found.next().is_none(), "unknown {dof} is prescribed twice");
    assert_eq!(first.is_some(), !matches!(built.problem.steps[step].constraints.row(dof), Row::Free(_)));
    first
}

fn course(built: &Model, step: usize, dof: usize) -> Option<&Course> {
    prescribed(built, step, dof).map(|p| &p.course)
}

fn node(built: &Model, group: &str) -> usize {
    let nodes = &built.mesh.groups[group].nodes;
    assert_eq!(nodes.len(), 1);
    nodes[0]
}

fn to(value: f64) -> Course {
    Course::To(value, Amplitude::ramp())
}

#[test]
fn a_displacement_stands_until_it_is_said_anew_or_released() {
    let built = made(&format!(
        "{HEAD}
        [[step]]
        displacement.'block.bottom' = {{ x = 0.0, y = 0.0 }}
        displacement.'block.top' = {{ y = -1.0 }}
        [[step]]
        displacement.'block.top' = {{ y = -3.0, amplitude = [[0.0, 0.0], [0.5, 1.0], [1.0, 0.0]] }}
        [[step]]
        [[step]]
        release = ['displacement.block.top']"
    ));
    let (top, bottom) = (2 * node(&built, "block.top_left"), 2 * node(&built, "block.bottom_left"));
    let there_and_back = Amplitude::new(vec![[0.0, 0.0], [0.5, 1.0], [1.0, 0.0]]).unwrap();
    let wanted = [Some(to(-1.0)), Some(Course::To(-3.0, there_and_back)), Some(Course::Hold), None];
    for (step, wanted) in wanted.iter().enumerate() {
        assert_eq!(course(&built, step, top + 1), wanted.as_ref(), "step {step}");
        assert_eq!(course(&built, step, top), None);
        assert_eq!(course(&built, step, bottom), Some(&Course::Hold));
    }
}

#[test]
fn groups_that_share_a_node_must_agree_on_it() {
    let agree = format!(
        "{HEAD}
        [[step]]
        symmetry = ['block.left', 'block.bottom']
        displacement.'block.bottom' = {{ x = 0.0 }}
        [[step]]
        displacement.'block.left' = {{ x = 0.0 }}"
    );
    let built = made(&agree);
    let corner = 2 * node(&built, "block.bottom_left");
    assert_eq!(course(&built, 1, corner), Some(&Course::Hold));
    let text =
        refused(&agree.replace("displacement.'block.left' = { x = 0.0 }", "displacement.'block.left' = { x = 0.1 }"));
    assert!(text.contains("cannot follow both") && text.contains("`displacement.block.left`"), "{text}");
    // A claim that comes to rest where another holds agrees with it from then on.
    let later = "{HEAD}
        [[step]]
        displacement.'block.left' = { x = 0.1 }
        [[step]]
        displacement.'block.bottom_left' = { x = 0.1 }";
    made(&later.replace("{HEAD}", HEAD));
}

#[test]
fn an_inclined_support_couples_the_components() {
    let built = made(&format!(
        "{HEAD}
        [[step]]
        displacement.'block.left' = {{ x = 0.0, y = 0.0 }}
        displacement.'block.bottom_right' = {{ along = [3.0, -4.0], value = 0.5 }}"
    ));
    let corner = 2 * node(&built, "block.bottom_right");
    assert!(matches!(built.problem.steps[0].constraints.row(corner), Row::Free(_)));
    let along = prescribed(&built, 0, corner + 1).unwrap();
    // u . (3, -4) / 5 = 0.5, so u_y = -0.625 + 0.75 u_x.
    let [(other, factor)] = along.others[..] else { panic!("{along:?}") };
    assert!(other == corner && (factor - 0.75).abs() < 1e-15, "{along:?}");
    let Course::To(value, _) = along.course else { panic!("{along:?}") };
    assert!((value + 0.625).abs() < 1e-15);
}

#[test]
fn an_inclined_support_gives_way_to_a_held_component() {
    let built = made(&format!(
        "{HEAD}
        [[step]]
        displacement.'block.left' = {{ x = 0.0 }}
        displacement.'block.bottom_left' = {{ along = [2.0, 1.0], value = 0.0 }}"
    ));
    let corner = 2 * node(&built, "block.bottom_left");
    assert_eq!(course(&built, 0, corner), Some(&Course::Hold));
    let along = prescribed(&built, 0, corner + 1).unwrap();
    assert!(along.others[0].0 == corner && (along.others[0].1 + 2.0).abs() < 1e-14);
}

#[test]
fn a_plane_of_symmetry_may_be_inclined_but_not_bent() {
    let ring = HEAD.replace(
        "block.rectangle = { from = [0.0, 0.0], to = [2.0, 1.0], cells = [2, 1], cell = \"quad4\" }",
        "block.annulus = { from = [1.0, 0.0], to = [2.0, 30.0], cells = [1, 3], cell = \"quad8\" }",
    );
    let built = made(&format!("{ring}\n[[step]]\nsymmetry = ['block.start', 'block.end']"));
    let (start, end) = (2 * node(&built, "block.start_inner"), 2 * node(&built, "block.end_inner"));
    assert_eq!((course(&built, 0, start), course(&built, 0, start + 1)), (None, Some(&Course::Hold)));
    // The normal (-sin 30, cos 30): u_y = tan 30 u_x.
    let along = prescribed(&built, 0, end + 1).unwrap();
    assert!((along.others[0].1 - 30f64.to_radians().tan()).abs() < 1e-12);
    assert_eq!(along.course, Course::Hold);
    let text = refused(&format!("{ring}\n[[step]]\nsymmetry = ['block.outer']"));
    assert!(text.contains("not flat"), "{text}");
}

#[test]
fn a_tool_is_held_moved_or_loaded() {
    let built = made(&format!(
        "{HEAD}{TOOL}
        [contact.base]
        surface = 'block.bottom'
        target = 'plate'
        law.coulomb = {{ friction = 0.0 }}
        [[step]]
        symmetry = ['block.left']
        motion.plate = {{ y = 1.0, rotation = 90.0 }}
        [[step]]
        load.plate = {{ y = 5.0 }}
        [[step]]
        [[step]]
        release = ['load.plate']"
    ));
    let tool = built.problem.dofs.tool(0);
    let y = [Some(to(1.0)), None, None, Some(Course::Hold)];
    for (step, wanted) in y.iter().enumerate() {
        assert_eq!(course(&built, step, tool), Some(&Course::Hold), "x in step {step}");
        assert_eq!(course(&built, step, tool + 1), wanted.as_ref(), "y in step {step}");
    }
    assert_eq!(course(&built, 0, tool + 2), Some(&to(std::f64::consts::FRAC_PI_2)));
    assert_eq!(course(&built, 1, tool + 2), Some(&Course::Hold));
    let names: Vec<&str> = built.problem.terms.iter().map(|term| term.name()).collect();
    assert_eq!(names, ["block", "base", "load.plate"]);
}

#[test]
fn a_force_on_nodes_that_are_led_is_reported() {
    let deck = format!(
        "{HEAD}
        [[step]]
        symmetry = ['block.left']
        displacement.'block.bottom' = {{ y = 0.0 }}
        force.'block.bottom' = {{ x = 1.0, y = 2.0 }}
        force.'block.top' = {{ x = 1.0 }}"
    );
    let found = read(&deck, "test.toml", Path::new(""), &[]).and_then(build).err().unwrap();
    let told: Vec<&str> = found.list.iter().map(|d| d.what.as_str()).collect();
    assert_eq!(told, ["`force.block.bottom` moves nothing along y"]);
    assert_eq!(found.list[0].label, "all its nodes are held there");
}

#[test]
fn a_back_stress_in_the_frame_of_jaumann_is_noted_at_its_body() {
    let law = "von_mises = { young = 210e3, poisson = 0.3, yield_stress = 200.0, kinematic = 1e3 }";
    let head = HEAD.replace("elastic = { young = 210e3, poisson = 0.3 }", law);
    for (rate, noted) in [("body.block.rate = 'jaumann'", true), ("", false), ("body.block.strain = 'small'", false)] {
        let deck = format!("{head}{rate}\n[[step]]\ndisplacement.'block.bottom' = {{ x = 0.0, y = 0.0 }}");
        let made = read(&deck, "test.toml", Path::new(""), &[]).and_then(build).unwrap_or_else(|d| panic!("{d:?}"));
        assert_eq!(review(&made).unwrap().text.contains("a back stress turns"), noted, "{rate}");
    }
}

#[test]
fn nodes_on_the_axis_of_revolution_stay_on_it() {
    let deck = format!("{HEAD}\n[[step]]\nsymmetry = ['block.bottom']").replace("plane-strain", "axisymmetric");
    let built = made(&deck);
    assert_eq!(course(&built, 0, 2 * node(&built, "block.top_left")), Some(&Course::Hold));
    assert_eq!(course(&built, 0, 2 * node(&built, "block.top_left") + 1), None);
}

/// A block on a plate, with more said of their contact.
fn resting(more: &str) -> String {
    format!(
        "{HEAD}{TOOL}
        [contact.base]
        surface = 'block.bottom'
        target = 'plate'
        law.coulomb = {{ friction = 0.3 }}
        {more}
        [[step]]
        symmetry = ['block.left']"
    )
}

#[test]
fn penalties_and_thickness_have_their_printed_defaults() {
    let deck = resting("");
    let built = made(&deck);
    let modulus = 210e3 * 0.7 / (1.3 * 0.4);
    let options = built.field_contacts[0].options();
    // One cell deep: h = 1.
    assert!((options.penalty / (50.0 * modulus) - 1.0).abs() < 1e-12);
    assert_eq!((options.tangential_penalty, options.thickness), (options.penalty, 1.0));
    let given = deck
        .replace("law.coulomb", "penalty = 7.0\nlaw.coulomb")
        .replace("version = 1", "version = 1\nthickness = 3.0");
    let options = *made(&given).field_contacts[0].options();
    assert_eq!((options.penalty, options.tangential_penalty, options.thickness), (7.0, 7.0, 3.0));
}

#[test]
fn the_elastic_slip_is_said_or_a_default_and_refused_where_nothing_follows_it() {
    let part = |more: &str| made(&resting(more)).field_contacts[0].options().elastic_slip;
    assert_eq!([part(""), part("elastic_slip = 0.02")], [Some(0.005), Some(0.02)]);
    assert_eq!([part("tangential_penalty = 3.0"), part("augmentation = {}")], [None, None]);
    let sticking = resting("").replace("coulomb = { friction = 0.3 }", "sticking = {}");
    assert_eq!(made(&sticking).field_contacts[0].options().elastic_slip, None);
    for more in ["tangential_penalty = 3.0", "augmentation = {}"] {
        let told = refused(&resting(&format!("{more}\nelastic_slip = 0.01")));
        assert!(told.contains("`elastic_slip` is for friction by the pressure"), "{told}");
    }
}

/// A strip of 60 by 1 follows pressure by bending, a block of 2 by 1 by squeezing its cells.
#[test]
fn a_thin_body_has_the_penalty_of_its_bending() {
    let deck = resting("");
    let deck = deck.replace("to = [2.0, 1.0], cells = [2, 1]", "to = [60.0, 1.0], cells = [60, 2]");
    let modulus = 210e3 * 0.7 / (1.3 * 0.4);
    let thickness: f64 = 60.0 / 61.0;
    let bending = modulus * thickness.powi(3) / 12.0 * (std::f64::consts::PI / (3.5 * thickness)).powi(4);
    let penalty = made(&deck).field_contacts[0].options().penalty;
    assert!((penalty / (50.0 * bending) - 1.0).abs() < 1e-12, "{penalty} {bending}");
}

/// The same strip does not bend where its other face is held, and follows by squeezing its cells; held along itself it bends.
#[test]
fn a_thin_body_that_is_held_over_a_face_does_not_bend() {
    let penalty = |held: &str| {
        let deck = resting("").replace("to = [2.0, 1.0], cells = [2, 1]", "to = [60.0, 1.0], cells = [60, 2]");
        made(&format!("{deck}\ndisplacement.'block.top' = {{ {held} }}")).field_contacts[0].options().penalty
    };
    let (modulus, height) = (210e3 * 0.7 / (1.3 * 0.4), 0.5);
    for held in ["y = 0.0", "x = 0.0, y = -0.1"] {
        assert!((penalty(held) / (50.0 * modulus / height) - 1.0).abs() < 1e-12, "{held}");
    }
    assert!(penalty("x = 0.0") < 0.2 * penalty("y = 0.0"));
}

/// A half ring of radius 50 and thickness 1 also stretches: `200 M t / R^2` more, but for the chords of its edges.
#[test]
fn a_curved_thin_body_also_follows_by_stretching() {
    let deck = format!(
        "{HEAD}{TOOL}
        [contact.base]
        surface = 'block.inner'
        target = 'plate'
        law.coulomb = {{ friction = 0.3 }}
        [[step]]
        symmetry = ['block.start']"
    );
    let part =
        "mesh.part.block.annulus = { from = [50.0, 0.0], to = [51.0, 180.0], cells = [2, 90], cell = \"quad8\" }";
    let line = HEAD.lines().find(|line| line.starts_with("mesh")).unwrap();
    let deck = deck.replace(line, part);
    let (modulus, thickness) =
        (210e3 * 0.7 / (1.3 * 0.4), 50.5 * std::f64::consts::PI / (50.5 * std::f64::consts::PI + 1.0));
    let bending = std::f64::consts::PI.powi(4) / (12.0 * 3.5_f64.powi(4) * thickness);
    let expected = 50.0 * modulus * (bending + 200.0 * thickness / 2500.0);
    let penalty = made(&deck).field_contacts[0].options().penalty;
    assert!((penalty / expected - 1.0).abs() < 1e-3, "{penalty} {expected}");
}

#[test]
fn increments_are_fractions_of_their_step() {
    let deck = format!("{HEAD}\n[[step]]\nsymmetry = ['block.left']\nduration = 4.0\nincrements = {{ count = 8 }}");
    let step = &made(&deck).problem.steps[0];
    assert_eq!((step.duration, step.increments.first, step.increments.largest), (4.0, 0.125, 0.125));
    let step = &made(&deck.replace("count = 8", "first = 0.2")).problem.steps[0];
    assert_eq!((step.increments.first, step.increments.largest, step.increments.smallest), (0.2, 0.2, 1e-6));
}

/// A program that does not provide a loader says so, as the package for Python does.
#[test]
fn a_law_of_a_library_needs_a_program_that_loads_it() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml").display().to_string();
    let deck =
        HEAD.replace("steel.elastic = { young = 210e3, poisson = 0.3 }", &format!("steel.umat.library = {file:?}"));
    let told = refused(&format!("{deck}[[step]]\ndisplacement.\"block.left\" = {{ x = 0.0, y = 0.0 }}\n"));
    assert!(told.contains("this program loads no laws of shared libraries; the command `asperity` does"), "{told}");
}

/// A sheet that bears a load across its face is not called overloaded by it, in the coordinates of a survey neither.
#[test]
fn numbers_that_hardly_belong_together_are_told() {
    let deck = |[x, y]: [f64; 2], load: f64| {
        format!(
            r#"
version = 1
space = "plane-strain"
mesh.part.sheet.rectangle = {{ from = [{x:.1}, {y:.1}], to = [{:.1}, {:.1}], cells = [50, 2], cell = "quad4" }}
material.m.von_mises = {{ young = 200e3, poisson = 0.3, yield_stress = 200.0 }}
body.sheet.material = "m"
tool.plate.profile = [{{ line = [[{:.1}, {:.1}], [{:.1}, {:.1}]] }}]
contact.face = {{ surface = "sheet.top", target = "plate", law.coulomb = {{ friction = 0.1 }} }}
[[step]]
displacement."sheet.bottom" = {{ y = 0.0 }}
displacement."sheet.left" = {{ x = 0.0 }}
load.plate = {{ y = {load:.1} }}
"#,
            x + 100.0,
            y + 1.0,
            x - 10.0,
            y + 1.0,
            x + 110.0,
            y + 1.0
        )
    };
    let told = |at, load| {
        let made = build(read(&deck(at, load), "test.toml", Path::new(""), &[]).unwrap()).unwrap();
        format!("{:?}", review(&made).unwrap().problems)
    };
    for at in [[0.0, 0.0], [4.5e5, 5.4e6]] {
        let told = told(at, -10e3);
        assert!(!told.contains("amounts to"), "{told}");
    }
    assert!(told([0.0, 0.0], -1e6).contains("`load.plate` amounts to a stress of 1.0e4"));
}
