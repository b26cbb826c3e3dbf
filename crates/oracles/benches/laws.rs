//! What laws and bodies cost on one thread: one stress update with its tangent for every law that a deck of `cases/point`
//! sets, elastic and flowing; and the evaluation of a body of 100k unknowns (hex8, von Mises, all of it flowing), beside
//! which the time of one whole Newton iteration with a fresh factorisation is printed: `cargo bench -p oracles --bench laws`.

use asperity::deck::{self, load_point};
use asperity::material::{Directions, Material};
use asperity::solve::{AttemptRecord, IterationRecord, Observer, RunOptions};
use asperity::system::{Assembly, Evaluation, Instant, State, Tangent, Trial, Workspace};
use asperity::tensor::Tensor2;
use criterion::{Criterion, criterion_group, criterion_main};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant as Clock};

/// The laws of all decks with the decks' names.
fn laws() -> Vec<(String, Arc<dyn Material>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/point");
    let mut decks: Vec<_> = std::fs::read_dir(folder).expect("the cases").map(|e| e.expect("a file").path()).collect();
    decks.sort();
    let mut laws: Vec<(String, Arc<dyn Material>)> = Vec::new();
    for deck in decks {
        let Ok(loaded) = load_point(&deck, &[]) else { panic!("{}", deck.display()) };
        for (name, law) in &loaded.deck.material {
            if laws.iter().all(|(known, _)| known != law.name()) {
                laws.push((law.name().into(), law.build(&name.text, Path::new(""), false).expect("a law").0));
            }
        }
    }
    laws
}

/// A stretch and a shear of the size given, all of it within the plane.
fn deformation(size: f64) -> Tensor2 {
    Tensor2([[1.0 + size, 0.7 * size, 0.0], [-0.2 * size, 1.0 - size, 0.0], [0.0, 0.0, 1.0]])
}

/// A state reached by a few increments.
fn reached(law: &dyn Material, size: f64) -> Vec<f64> {
    let mut state = vec![0.0; law.state_len()];
    law.initialise(&mut state);
    for _ in 0..5 {
        let mut new = state.clone();
        if law.update(&deformation(size), 0.1.into(), &state, &mut new).is_ok() {
            state = new;
        }
    }
    state
}

fn updates(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("update with tangent");
    group.sample_size(20).measurement_time(Duration::from_millis(600)).warm_up_time(Duration::from_millis(200));
    for (name, law) in laws() {
        for (what, size) in [("elastic", 1e-6), ("flowing", 4e-3)] {
            let old = reached(law.as_ref(), size);
            let (f, mut new) = (deformation(size), old.clone());
            for (directions, space) in [(Directions::Plane, "plane"), (Directions::Space, "space")] {
                group.bench_function(format!("{name}, {what}, {space}"), |bencher| {
                    bencher.iter(|| law.update_with_gradient(&f, 0.1.into(), &old, &mut new, directions).is_ok());
                });
            }
        }
    }
    group.finish();
}

const CELLS: usize = 32;

fn block() -> deck::Loaded {
    let text = format!(
        "version = 1\nspace = \"solid\"\n\
         mesh.part.block.box = {{ from = [0.0, 0.0, 0.0], to = [1.0, 1.0, 1.0], cells = [{CELLS}, {CELLS}, {CELLS}], cell = \"hex8\" }}\n\
         material.steel.von_mises = {{ young = 1e3, poisson = 0.3, yield_stress = 1.0, hardening = 10.0 }}\n\
         body.block.material = \"steel\"\n\
         solver.factors = \"fresh\"\n\
         [[step]]\nsymmetry = [\"block.left\", \"block.front\"]\nincrements.count = 10\n\
         displacement.\"block.bottom\" = {{ x = 0.0, y = 0.0, z = 0.0 }}\n\
         displacement.\"block.top\" = {{ x = 0.0, y = -0.02, z = 0.0 }}\n"
    );
    deck::read(&text, "block.toml", Path::new("."), &[]).unwrap_or_else(|found| panic!("{}", found.render(false)))
}

/// When each iteration was evaluated.
#[derive(Default)]
struct Times(Vec<Clock>);

impl Observer for Times {
    fn iteration(&mut self, _: &AttemptRecord, _: &IterationRecord) {
        self.0.push(Clock::now());
    }
}

fn body(criterion: &mut Criterion) {
    let Ok(made) = deck::build(block()) else { panic!("the block") };
    let problem = &made.model.problem;
    let mut times = Times::default();
    let mut run = made.model.run(problem.initial_state());
    // The first increment is elastic at first; the second flows.
    run.run(&RunOptions { increments: Some(2) }, &mut times).expect("two increments");
    let last = times.0.windows(2).last().map_or(0.0, |two| (two[1] - two[0]).as_secs_f64());
    let state = run.state;
    let evaluation = evaluate(&made, &state, criterion);
    println!(
        "{} unknowns: one evaluation {evaluation:.3} s, one Newton iteration {last:.3} s, ratio {:.3} (at most 0.25)",
        problem.dofs.count(),
        evaluation / last
    );
}

/// Benches the evaluation of the body one increment on from a state, and returns the mean time of a few.
fn evaluate(made: &deck::Made, state: &State, criterion: &mut Criterion) -> f64 {
    let problem = &made.model.problem;
    let step = &problem.steps[0];
    let at = Instant { step: 0, step_time: state.step_time + 0.1, time: state.time + 0.1, dt: 0.1, factor: None };
    let terms = problem.terms.iter().zip(&state.histories);
    let attempts = terms.map(|(term, history)| term.attempt(state, history, at)).collect::<Result<Vec<_>, _>>();
    let attempts = attempts.expect("an attempt");
    let assembly =
        Assembly { terms: &problem.terms, attempts, dofs: &problem.dofs, constraints: &step.constraints, apart: 0..0 };
    let (mut workspace, mut evaluation) = (Workspace::default(), Evaluation::new(&problem.terms, state));
    workspace.prepare(&assembly, state).expect("a pattern");
    let u: Vec<f64> = state.u.iter().zip(&state.last_change).map(|(u, change)| u + change).collect();
    let trial = Trial::at(&u, Tangent::Exact);
    let mut once = || workspace.evaluate(&assembly, &trial, &mut evaluation).expect("an evaluation");
    let begun = Clock::now();
    (0..3).for_each(|_| once());
    let mean = begun.elapsed().as_secs_f64() / 3.0;
    let mut group = criterion.benchmark_group("body");
    group.sample_size(10).measurement_time(Duration::from_secs(5));
    group.bench_function(format!("hex8, von Mises, {} unknowns", u.len()), |bencher| bencher.iter(&mut once));
    group.finish();
    mean
}

fn one_thread(criterion: &mut Criterion) {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("the first pool");
    updates(criterion);
    body(criterion);
}

criterion_group!(benches, one_thread);
criterion_main!(benches);
