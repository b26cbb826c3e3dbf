//! What is predicted of a run before it begins is what the run then has.

use asperity::deck::{Made, build, read};
use asperity::solve::{RunOptions, Silent};
use std::num::NonZeroUsize;
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

fn made(text: &str) -> Made {
    let made = read(text, "deck.toml", Path::new("."), &[]).and_then(build);
    made.unwrap_or_else(|found| panic!("{}", found.render(false)))
}

#[test]
fn unknowns_and_entries_are_those_of_the_matrix() {
    for (text, slack) in [(BOX, 1.0), (PLATE, 1.1)] {
        let made = made(text);
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

const CUBE: &str = r#"
version = 1
space = "solid"
mesh.part.cube.box = { from = [0.0, 0.0, 0.0], to = [1.0, 1.0, 1.0], cells = [CELLS], cell = "CELL" }
material.rubber.neo_hookean = { shear = 0.385, bulk = 0.833 }
body.cube.material = "rubber"
MORE
[[step]]
increments.count = 1
displacement."cube.bottom" = { x = 0.0, y = 0.0, z = 0.0 }
"#;
const PUNCH: &str = r#"
tool.punch.sphere = { center = [0.5, 2.0, 0.5], radius = 1.0 }
contact.top = { surface = "cube.top", target = "punch", law.coulomb = { friction = 0.3 } }
"#;
const PRESS: &str = "displacement.\"cube.top\" = { x = 0.1, y = -0.1, z = 0.0 }";

/// What each rank held at most, in GiB, where MUMPS factorised (Debian's PETSc 3.18 and OpenBLAS): cells, contact, ranks.
type Held = (&'static str, &'static str, &'static str, &'static [(usize, &'static [f64])]);
#[rustfmt::skip]
const HELD: &[Held] = &[
    ("12, 12, 12", "hex8", "", &[(1, &[0.163]), (2, &[0.145, 0.099])]),
    ("16, 16, 16", "hex8", "", &[(1, &[0.268]), (2, &[0.215, 0.173])]),
    ("20, 20, 20", "hex8", "", &[(1, &[0.485]), (2, &[0.343, 0.309])]),
    ("24, 24, 24", "hex8", "", &[(1, &[0.867]), (2, &[0.572, 0.546])]),
    ("10, 10, 10", "hex20", "", &[(1, &[0.342]), (2, &[0.263, 0.210])]),
    ("20, 20, 20", "hex8", PUNCH, &[(1, &[0.570]), (2, &[0.422, 0.377])]),
    ("36, 36, 36", "hex8", "", &[(1, &[3.676]), (2, &[2.347, 2.211])]),
];

#[test]
fn what_ranks_hold_is_predicted() {
    let mut worst = 0.0_f64;
    for &(cells, cell, more, held) in HELD {
        let pressed = if more.is_empty() { PRESS } else { "motion.punch = { x = 0.01, y = -0.02 }" };
        let text = CUBE.replace("[CELLS]", &format!("[{cells}]")).replace("CELL", cell).replace("MORE", more) + pressed;
        let problem = &made(&text).model.problem;
        let demand = problem.demand(&problem.initial_state()).unwrap();
        for &(ranks, held) in held {
            let [first, other] = demand.of_ranks(NonZeroUsize::new(ranks).unwrap()).direct;
            for (rank, held) in held.iter().enumerate() {
                let part = if rank == 0 { first } else { other } as f64 / (held * f64::from(1 << 30));
                assert!((part - 1.0).abs() < 0.15, "{cells} {cell} {more} rank {rank} of {ranks}: {part:.2}");
                worst = worst.max((part - 1.0).abs());
            }
        }
    }
    eprintln!("at most {worst:.3} off");
}
