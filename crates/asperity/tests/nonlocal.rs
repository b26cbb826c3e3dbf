//! Friction by the mean pressure around a point, on a whole run: the coupling of neighbours is in the matrix, so that
//! Newton's method stays quick, and a restart changes nothing.

mod support;

use asperity::system::State;
use support::{all_bytes, bytes, columns, go_on, model, run};

/// A block is pressed onto a plate and drawn along it.
const BLOCK: &str = r#"
version = 1
space = "plane-strain"
mesh.part.block.rectangle = { from = [0.0, 0.0], to = [4.0, 2.0], cells = [8, 4], cell = "quad8" }
material.rubber.elastic = { young = 10.0, poisson = 0.3 }
body.block.material = "rubber"
tool.plate.profile = [{ line = [[9.0, 0.0], [-9.0, 0.0]] }]
contact.base = { surface = "block.bottom", target = "plate", law.oden_pires = { friction = 0.3, length = 0.01, radius = 1.2 } }
solver = { tolerance = 1e-8 }
[[step]]
increments.count = 2
displacement."block.top" = { x = 0.0, y = -0.2 }
[[step]]
increments.count = 10
displacement."block.top" = { x = 0.3, y = -0.2 }
"#;

#[test]
fn neighbours_are_in_the_matrix() {
    let [mean, local] = ["1.2", "0.0"].map(|radius| {
        let model = model(BLOCK, &[&format!("contact.base.law.oden_pires.radius={radius}")]);
        let keep = run(&model);
        let cut: Vec<_> = keep.attempts.iter().filter_map(|attempt| attempt.failure.as_deref()).collect();
        assert!(cut.is_empty(), "{radius}: {cut:#?}");
        let solutions: usize = keep.attempts.iter().map(|attempt| attempt.solutions()).sum();
        (solutions, columns(&model, &keep))
    });
    assert!(mean.0 <= local.0 + keep_up(local.0), "{} and {} iterations", mean.0, local.0);
    let ratio = |columns: &std::collections::BTreeMap<String, Vec<f64>>| {
        let last = |name: &str| *columns[name].last().unwrap();
        -last("contact.base.force.x") / last("contact.base.thrust")
    };
    // Where all slides the mean redistributes friction and gives little of it away.
    let (mean, local) = (ratio(&mean.1), ratio(&local.1));
    assert!((mean / local - 1.0).abs() < 0.1 && (mean / local - 1.0).abs() > 1e-6, "{mean} {local}");
}

/// Iterations that piecewise steps save a local law.
fn keep_up(iterations: usize) -> usize {
    iterations / 2 + 12
}

#[test]
fn a_restart_changes_nothing() {
    let model = model(BLOCK, &[]);
    let whole = all_bytes(&run(&model));
    let begun = go_on(&model, model.problem.initial_state(), Some(5));
    let state: State = postcard::from_bytes(&bytes(&begun.states[4])).unwrap();
    assert!(whole[5..] == all_bytes(&go_on(&model, state, None))[..]);
}
