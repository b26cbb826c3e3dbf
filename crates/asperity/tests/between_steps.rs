//! From one step to the next: what is released or removed is let go little by little, what is held stays.

mod support;

use std::collections::BTreeMap;
use support::{columns, model, run};

/// A block of unit modulus under a plate that moves down by 0.1, and what a second step says.
fn history(second: &str) -> BTreeMap<String, Vec<f64>> {
    let deck = format!(
        r#"
version = 1
space = "plane-strain"
mesh.part.block.rectangle = {{ from = [0.0, 0.0], to = [2.0, 1.0], cells = [4, 2], cell = "quad4" }}
material.soft.elastic = {{ young = 100.0, poisson = 0.0 }}
body.block.material = "soft"
tool.plate.profile = [{{ line = [[-9.0, 1.0], [9.0, 1.0]] }}]
contact.top = {{ surface = "block.top", target = "plate", law.coulomb = {{ friction = 0.0 }} }}
solver.tolerance = 1e-10
[[step]]
increments = {{ count = 2 }}
symmetry = ["block.left", "block.bottom"]
motion.plate = {{ y = -0.1 }}
[[step]]
increments = {{ count = 4 }}
{second}
"#
    );
    let model = model(&deck, &[]);
    let keep = run(&model);
    columns(&model, &keep)
}

/// Vertical force of the contact at the end of each increment of the second step, over that at the end of the first.
fn fading(second: &str) -> Vec<f64> {
    let force = &history(second)["contact.top.force.y"];
    assert!(force[1].abs() > 15.0, "{force:?}");
    force[2..].iter().map(|f| f / force[1]).collect()
}

fn near(found: &[f64], wanted: &[f64], within: f64) {
    let same = |(a, b): (&f64, &f64)| (a - b).abs() < within;
    assert!(found.len() == wanted.len() && found.iter().zip(wanted).all(same), "{found:?} {wanted:?}");
}

#[test]
fn a_tool_that_is_let_go_follows_its_reaction_to_nothing() {
    near(&fading("release = [\"motion.plate\"]"), &[0.75, 0.5, 0.25, 0.0], 1e-6);
}

#[test]
fn a_load_that_takes_over_begins_at_the_reaction() {
    let force = history("load.plate = { y = -5.0 }")["contact.top.force.y"].clone();
    let (first, to) = (force[1].abs(), 5.0);
    let wanted: Vec<f64> = [0.25, 0.5, 0.75, 1.0].map(|t| first + t * (to - first)).into();
    near(&force[2..].iter().map(|f| f.abs()).collect::<Vec<_>>(), &wanted, 1e-5);
}

/// The block goes back to its height while the contact is there no more, though the plate stays where it is.
#[test]
fn what_a_contact_bore_fades_when_it_is_removed() {
    for name in ["top", "plate"] {
        let deck = format!("remove = [\"{name}\"]\ndisplacement.\"block.top_left\" = {{ y = 0.0 }}");
        near(&fading(&deck), &[0.0; 4], 1e-12);
    }
    let history = history("remove = [\"plate\"]");
    let strain = &history["energy.strain"];
    near(&strain[2..].iter().map(|e| e / strain[1]).collect::<Vec<_>>(), &[0.5625, 0.25, 0.0625, 0.0], 0.03);
}

#[test]
fn a_contact_that_is_back_bears_again() {
    let deck = "remove = [\"plate\"]\nmotion.plate = { y = 0.5 }\n[[step]]\nincrements = { count = 4 }\nadd = [\"top\"]\nmotion.plate = { y = -0.1 }";
    let force = &history(deck)["contact.top.force.y"];
    // The law integrates a rate, by increments of another number.
    near(&[force[9] / force[1]], &[1.0], 2e-3);
}

#[test]
fn what_is_held_stays_where_it_is() {
    let deck = "load.plate = { y = -5.0 }\n[[step]]\nincrements = { count = 1 }\nhold = [\"plate\"]";
    let history = history(deck);
    let (place, force) = (&history["tool.plate.translation.y"], &history["contact.top.force.y"]);
    near(&[place[6], force[6]], &[place[5], force[5]], 1e-8);
    let reaction = &history["tool.plate.force.y"];
    near(&[reaction[5].abs(), reaction[6].abs()], &[0.0, 5.0], 1e-6);
}

/// A free side that was led back half of its way, held there.
#[test]
fn a_group_is_held_where_it_is() {
    let deck = "remove = [\"plate\"]\nhold = [\"block.top\"]\n";
    let strain = &history(deck)["energy.strain"];
    near(&strain[2..], &[strain[1]; 4], 1e-8);
}

/// A contact that is added where the block, grown back to its height, lies in the plate presses it down again over the step, in
/// proportion to the time, and no energy is missing; with `overlap = "keep"` at once, and none is missing either.
#[test]
fn a_contact_that_is_added_presses_little_by_little() {
    let steps = "remove = [\"plate\"]\n[[step]]\nincrements = { count = 4 }\nadd = [\"plate\"]";
    let columns = history(steps);
    let force = &columns["contact.top.force.y"];
    let parts: Vec<f64> = force[6..].iter().map(|f| f / force[1]).collect();
    // The block is pressed by logarithmic strain: the force is in proportion within a few per cent on the way.
    near(&parts, &[0.25, 0.5, 0.75, 1.0], 0.02);
    assert!((parts[3] - 1.0).abs() < 1e-4, "{parts:?}");
    let (missing, external) = (columns["energy.missing"].last().unwrap(), columns["energy.external"][1]);
    assert!((missing / external).abs() < 0.02, "{missing} of {external}");
}

/// The same between two bodies, the upper of which a rigid group leads: what leads it is no reason to press at once.
#[test]
fn a_contact_of_a_led_body_is_added_little_by_little() {
    let force = |led: &str, said: [&str; 3]| {
        let [down, held, still] = said;
        let deck = format!(
            r#"
version = 1
space = "plane-strain"
mesh.part.c.rectangle = {{ from = [0.0, 0.0], to = [6.0, 2.0], cells = [6, 2], cell = "quad4" }}
mesh.part.b.rectangle = {{ from = [-1.0, -2.0], to = [7.0, 0.0], cells = [8, 2], cell = "quad4" }}
material.soft.elastic = {{ young = 1000.0, poisson = 0.3 }}
body.c.material = "soft"
body.b.material = "soft"
{led}
contact.k = {{ surface = "c.bottom", target = "b.top", law.coulomb.friction = 0.1 }}
[[step]]
displacement."b.bottom" = {{ x = 0.0, y = 0.0 }}
{down}
[[step]]
{held}
remove = ["k"]
[[step]]
increments.count = 4
{still}
add = ["k"]
"#
        );
        let model = model(&deck, &[]);
        let columns = columns(&model, &run(&model));
        let force = &columns["contact.k.force.y"];
        force[force.len() - 4..].iter().map(|f| f / force[force.len() - 1]).collect::<Vec<f64>>()
    };
    let said = "displacement.\"c.top\" = { x = 0.0, y = -0.1 }";
    let led = "motion.top = { x = 0.0, y = -0.1 }";
    for (body, said) in [("", said), ("rigid.top.group = \"c.top\"", led)] {
        near(&force(body, [said; 3]), &[0.25, 0.5, 0.75, 1.0], 0.02);
    }
}

/// A bar on springs of which one is released, or made stiffer: what they have stored then goes to whoever does so, and no energy is missing.
#[test]
fn springs_that_change_take_their_energy_along() {
    for second in ["release = [\"spring.c.right\"]", "spring.\"c.right\" = { x = 60.0 }"] {
        let deck = format!(
            r#"
version = 1
space = "plane-stress"
mesh.part.c.rectangle = {{ from = [0.0, 0.0], to = [10.0, 2.0], cells = [5, 2], cell = "quad8" }}
material.e.elastic = {{ young = 1e5, poisson = 0.3 }}
body.c.material = "e"
[[step]]
displacement."c.bottom" = {{ y = 0.0 }}
spring."c.left" = {{ x = 10.0 }}
spring."c.right" = {{ x = 20.0 }}
traction."c.right" = {{ x = 5.0 }}
[[step]]
{second}
"#
        );
        let model = model(&deck, &[]);
        let keep = run(&model);
        let columns = columns(&model, &keep);
        let (missing, stored) = (columns["energy.missing"].last().unwrap(), columns["energy.spring"].last().unwrap());
        assert!(missing.abs() < 1e-3 * stored, "{second}: {missing} {stored}");
    }
}

/// A block without weight that was pressed between platens stays on the lower one when the upper is lifted, and an elastic beam on its supports when it is
/// straight again: nothing takes either along.
#[test]
fn what_is_let_go_does_not_follow_the_tool() {
    let block = r#"
mesh.part.b.rectangle = { from = [0.0, 0.0], to = [10.0, 4.0], cells = [10, 4], cell = "quad4" }
material.m.elastic = { young = 1000.0, poisson = 0.3 }
tool.p.profile = [{ line = [[-10.0, 4.0], [20.0, 4.0]] }]
tool.f.profile = [{ line = [[20.0, 0.0], [-10.0, 0.0]] }]
contact.f = { surface = "b.bottom", target = "f", law.coulomb = { friction = 0.1 } }
group.mid = { of = "b.top", x = [4.9, 5.1] }
[[step]]
motion.p = { y = -0.2 }
[[step]]
motion.p = { y = 5.0 }
"#;
    let beam = r#"
mesh.part.b.rectangle = { from = [-40.0, 0.0], to = [40.0, 4.0], cells = [40, 4], cell = "quad8" }
material.m.elastic = { young = 210e3, poisson = 0.3 }
group.mid = { of = "b.top", x = [-0.01, 0.01] }
tool.l.profile = [{ arc = [[-25.0, -5.0], [-30.0, 0.0], [-35.0, -5.0]] }]
tool.r.profile = [{ arc = [[35.0, -5.0], [30.0, 0.0], [25.0, -5.0]] }]
tool.p.profile = [{ arc = [[-5.0, 9.0], [0.0, 4.0], [5.0, 9.0]] }]
contact.l = { surface = "b.bottom", target = "l", law.coulomb = { friction = 0.1 } }
contact.r = { surface = "b.bottom", target = "r", law.coulomb = { friction = 0.1 } }
[[step]]
motion.p = { y = -3.0 }
displacement.mid = { x = 0.0 }
[[step]]
motion.p = { y = 2.0 }
"#;
    for (parts, far) in [(block, 0.02), (beam, 0.05)] {
        let deck = format!(
            "version = 1\nspace = \"plane-strain\"\nbody.b.material = \"m\"\ncontact.p = {{ surface = \"b.top\", target = \"p\", law.coulomb = {{ friction = 0.1 }} }}\n{parts}"
        );
        let model = model(&deck, &[]);
        let state = run(&model).states.pop().unwrap();
        let moved = model.mesh.groups["mid"].nodes.iter().map(|&node| state.u[2 * node + 1].abs()).fold(0.0, f64::max);
        assert!(moved < far, "{moved}");
    }
}
