//! What is predicted of a run before it begins is what the run then has.

use asperity::deck::{build, read};
use asperity::solve::{RunOptions, Silent};
use std::path::Path;

const BOX: &str = r#"
version = 1
space = "solid"
mesh.part.cube.box = { from = [0.0, 0.0, 0.0], to = [1.0, 1.0, 1.0], cells = [5, 4, 3], cell = "hex20" }
material.steel.elastic = { young = 1e3, poisson = 0.3 }
body.cube = { material = "steel" }
[[step]]
increments = { count = 1 }
displacement."cube.bottom" = { x = 0.0, y = 0.0, z = 0.0 }
displacement."cube.top" = { y = -0.01 }
"#;

/// In the plane, where supports are inclined and a tool is free to follow its load.
const PLATE: &str = r#"
version = 1
space = "plane-strain"
mesh.part.block.rectangle = { from = [0.0, 0.0], to = [4.0, 2.0], cells = [16, 8], cell = "quad8" }
material.steel.elastic = { young = 1e3, poisson = 0.3 }
body.block = { material = "steel" }
tool.punch.profile = [{ line = [[-20.0, 2.0], [20.0, 2.0]] }]
contact.cap = { surface = "block.top", target = "punch", law.coulomb = { friction = 0.2 } }
[[step]]
increments = { count = 1 }
displacement."block.bottom" = { along = [1.0, 2.0], value = 0.0 }
displacement."block.top_left" = { x = 0.0 }
load.punch = { y = -1.0 }
"#;

#[test]
fn unknowns_and_entries_are_those_of_the_matrix() {
    for (text, slack) in [(BOX, 1.0), (PLATE, 1.1)] {
        let made = read(text, "deck.toml", Path::new("."), &[]).and_then(build);
        let made = made.unwrap_or_else(|found| panic!("{}", found.render(false)));
        let problem = &made.model.problem;
        let demand = problem.demand(&problem.initial_state()).unwrap();
        let mut run = made.model.run(problem.initial_state());
        run.run(&RunOptions::default(), &mut Silent).unwrap();
        let pattern = run.memory.workspace.pattern();
        assert_eq!(demand.unknowns, pattern.rows());
        let (predicted, found) = (demand.entries as f64, pattern.columns.len() as f64);
        assert!(predicted >= found / slack && predicted <= found * slack, "{predicted} {found}");
        assert!(demand.bytes > demand.factorisation.bytes as u64 && demand.factorisation.flops > 0.0);
    }
}
