//! Targets that are driven through a body faster than it is thick: the increment is refused, so that it is cut where it may
//! be, and the run stops with the place and the remedy where it may not. What is carried in the end is what small increments
//! carry.

mod support;

use asperity::solve::RunOptions;
use support::{Keep, columns, model};

/// One strip is pressed down on another, 0.1 below it and as thick as it, by more than six thicknesses.
const STRIPS: &str = r#"
version = 1
space = "plane-strain"
mesh.part.lower.rectangle = { from = [0.0, -0.2], to = [3.0, 0.0], cells = [6, 1], cell = "quad4" }
mesh.part.upper.rectangle = { from = [0.6, 0.1], to = [2.4, 0.3], cells = [5, 1], cell = "quad4" }
material.rubber.neo_hookean = { shear = 400.0, bulk = 800.0 }
body.lower.material = "rubber"
body.upper.material = "rubber"
contact.sole = { surface = "upper.bottom", target = "lower.top", form = "paper", law.coulomb = { friction = 0.2 } }
[[step]]
increments.count = 7
displacement."lower.left" = { x = 0.0, y = 0.0 }
displacement."lower.right" = { x = 0.0, y = 0.0 }
displacement."upper.top" = { x = 0.0, y = -1.3 }
"#;

/// The same in space.
const SLABS: &str = r#"
version = 1
space = "solid"
mesh.part.lower.box = { from = [0.0, 0.0, -0.2], to = [3.0, 3.0, 0.0], cells = [4, 2, 1], cell = "hex8" }
mesh.part.upper.box = { from = [0.6, 0.6, 0.1], to = [2.4, 2.4, 0.3], cells = [3, 2, 1], cell = "hex8" }
material.rubber.neo_hookean = { shear = 400.0, bulk = 800.0 }
body.lower.material = "rubber"
body.upper.material = "rubber"
contact.sole = { surface = "upper.back", target = "lower.front", law.coulomb = { friction = 0.2 } }
[[step]]
increments.count = 7
displacement."lower.left" = { x = 0.0, y = 0.0, z = 0.0 }
displacement."lower.right" = { x = 0.0, y = 0.0, z = 0.0 }
displacement."upper.front" = { x = 0.0, y = 0.0, z = -1.3 }
"#;

/// A ball through a held slab, without the steps that look for contact.
const BALL: &str = r#"
version = 1
space = "solid"
mesh.part.slab.box = { from = [0.0, 0.0, -0.5], to = [2.0, 2.0, 0.0], cells = [3, 3, 2], cell = "hex8" }
material.rubber.elastic = { young = 1e3, poisson = 0.3 }
body.slab.material = "rubber"
tool.ball.sphere = { center = [1.0, 1.0, 1.55], radius = 1.5 }
contact.sole = { surface = "slab.front", target = "ball", law.coulomb = { friction = 0.2 } }
solver.piecewise = false
[[step]]
increments.count = 1
displacement."slab.bottom" = { x = 0.0, y = 0.0, z = 0.0 }
displacement."slab.top" = { x = 0.0, y = 0.0, z = 0.0 }
displacement."slab.back" = { x = 0.0, y = 0.0, z = 0.0 }
motion.ball = { z = -8.0 }
"#;

/// The error with which a run stops that must not cut its increments.
fn refusal(deck: &str, sets: &[&str]) -> String {
    let model = model(deck, sets);
    let mut run = model.run(model.problem.initial_state());
    run.run(&RunOptions::default(), &mut Keep::default()).expect_err("the target passes").to_string()
}

/// Whatever a single increment is asked to do: what meets is carried or refused, and never lost.
#[test]
fn strips_that_may_not_be_cut_are_carried_or_refused_with_place_and_remedy() {
    for (deck, count, share) in [(STRIPS, 3, "0.33"), (STRIPS, 1, "1.0"), (SLABS, 1, "1.0")] {
        let (count, smallest) =
            (format!("step.1.increments.count={count}"), format!("step.1.increments.smallest={share}"));
        let model = model(deck, &[&count, &smallest]);
        let (mut run, mut keep) = (model.run(model.problem.initial_state()), Keep::default());
        match run.run(&RunOptions::default(), &mut keep) {
            Ok(_) => {
                let thrust = *columns(&model, &keep)["contact.sole.thrust"].last().unwrap();
                assert!(thrust > 100.0, "{thrust}");
            }
            // The contact or the audit, whichever is asked first: who, where, and what helps.
            Err(error) => {
                let said = error.to_string();
                let words = ["came through", "passes through", "deep in"];
                assert!(words.iter().any(|word| said.contains(word)), "{said}");
            }
        }
    }
}

#[test]
fn a_tool_through_a_slab_in_one_increment_is_refused() {
    let said = refusal(BALL, &["step.1.increments.smallest=1.0"]);
    assert!(said.contains("passes through tool 'ball'"), "{said}");
}

/// However long the increments, strips that meet end to end of their motion carry the same force, or the run is refused; it
/// never ends with another force.
#[test]
fn cut_increments_carry_what_small_ones_do_or_are_refused() {
    let end = |count: &str| {
        let model = model(STRIPS, &[&format!("step.1.increments.count={count}")]);
        let (mut run, mut keep) = (model.run(model.problem.initial_state()), Keep::default());
        let ended = run.run(&RunOptions::default(), &mut keep);
        ended.map(|_| *columns(&model, &keep)["contact.sole.force.y"].last().unwrap())
    };
    let carried: Vec<_> = ["22", "7", "3", "1"].into_iter().map(|count| (count, end(count))).collect();
    let forces: Vec<f64> = carried.iter().filter_map(|(_, force)| force.as_ref().ok().copied()).collect();
    assert!(forces.iter().all(|force| (force / forces[0] - 1.0).abs() < 0.02), "{forces:?}");
    for (count, force) in carried {
        let Err(error) = force else { continue };
        let said = error.to_string();
        let reasons = ["came through", "passes through", "deep in"];
        assert!(reasons.iter().any(|reason| said.contains(reason)), "{count}: {said}");
    }
}
