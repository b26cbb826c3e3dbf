//! A run whose increments are taken one by one is the run that is made at once, with files or without, and so is a branch of it.

mod support;

use asperity::Error;
use asperity::deck::{self, Made};
use asperity::output::{Begun, CHECKPOINT, Job, RunStatus, SUMMARY, Simulation, Start, Summary, simulate};
use asperity::solve::{AttemptRecord, IterationRecord, Observer, Silent};
use std::path::Path;

fn tube() -> Made {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/decks/tube.toml");
    let sets = [
        "step.push.increments={count=6}",
        "step.push.displacement.\"tube.top\".y=-6.0",
        "mesh.part.tube.rectangle.cells=[1,30]",
    ];
    deck::build(deck::load(&path, &sets.map(String::from)).unwrap()).unwrap()
}

fn job<'a>(made: &'a Made, directory: &'a Path, start: Start<'a>, facts: &'a asperity::diagnosis::Facts) -> Job<'a> {
    Job { start, ..support::job(made, directory, facts) }
}

fn begun<'m>(made: &'m Made, job: &Job) -> Box<Simulation<'m>> {
    match Simulation::begin(&made.model, job).unwrap() {
        Begun::Going(simulation) => simulation,
        Begun::Ended(_) => panic!("there is nothing to run"),
    }
}

/// The end of a run in displacements.
fn complete(mut simulation: Simulation, made: &Made) -> (Vec<f64>, Summary) {
    while simulation.advance(&mut Silent).unwrap().is_some() {}
    let u = simulation.state().u.clone();
    let (summary, ended) = simulation.finish(Ok(()), &deck::facts(made)).unwrap();
    ended.unwrap();
    (u, summary)
}

#[test]
fn one_by_one_is_at_once() {
    let (made, facts) = (tube(), deck::facts(&tube()));
    let (whole, steps, branch) =
        (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let (told, _) = simulate(&made.model, &job(&made, whole.path(), Start::Beginning, &facts), &mut Silent).unwrap();

    let mut simulation = begun(&made, &job(&made, steps.path(), Start::Beginning, &facts));
    for increment in 1..=3 {
        assert_eq!(simulation.advance(&mut Silent).unwrap().unwrap().increment, increment);
        assert_eq!(simulation.state().increment, increment);
    }
    let middle = simulation.state().clone();
    let totals = simulation.totals().len();
    let (u, summary) = complete(*simulation, &made);
    assert_eq!((summary.status, &summary.certificate), (told.status, &told.certificate));
    let read = |directory: &Path, name: &str| std::fs::read_to_string(directory.join(name)).unwrap();
    for name in ["history.csv", "increments.csv", "certificate.csv"] {
        assert_eq!(read(whole.path(), name), read(steps.path(), name), "{name}");
    }
    assert_eq!(read(steps.path(), "history.csv").lines().next().unwrap().split(',').count(), 3 + totals);

    let memory = Simulation::in_memory(&made.model, middle.clone(), &made.deck.limits.limits, &[]).unwrap();
    assert_eq!(complete(memory, &made).0, u);
    let recorded = begun(&made, &job(&made, branch.path(), Start::State(&middle), &facts));
    assert_eq!(complete(*recorded, &made).0, u);
    assert_eq!(read(branch.path(), "history.csv").lines().count(), 1 + 3);
}

#[test]
fn a_run_that_is_stopped_between_increments_leaves_a_checkpoint() {
    let (made, facts) = (tube(), deck::facts(&tube()));
    let directory = tempfile::tempdir().unwrap();
    let mut simulation = begun(&made, &job(&made, directory.path(), Start::Beginning, &facts));
    simulation.advance(&mut Silent).unwrap();
    let (summary, ended) = simulation.finish(Err(Error::Stopped), &facts).unwrap();
    assert_eq!((summary.status, ended), (RunStatus::Stopped, Err(Error::Stopped)));
    assert_eq!(Summary::read(&directory.path().join(SUMMARY)).unwrap().status, RunStatus::Stopped);
    assert!(directory.path().join(CHECKPOINT).exists());
    let mut again = begun(&made, &job(&made, directory.path(), Start::Checkpoint, &facts));
    assert_eq!(again.advance(&mut Silent).unwrap().unwrap().increment, 2);
}

/// Asks for a stop once an iteration of an increment was made.
struct Impatient {
    increment: usize,
    made: bool,
}

impl Observer for Impatient {
    fn iteration(&mut self, attempt: &AttemptRecord, iteration: &IterationRecord) {
        self.made |= attempt.increment == self.increment && iteration.iteration == 1;
    }
    fn wants_stop(&self) -> bool {
        self.made
    }
}

#[test]
fn a_run_that_is_stopped_between_iterations_is_as_if_the_increment_had_not_begun() {
    let (made, facts) = (tube(), deck::facts(&tube()));
    let directory = tempfile::tempdir().unwrap();
    let mut simulation = begun(&made, &job(&made, directory.path(), Start::Beginning, &facts));
    let mut impatient = Impatient { increment: 3, made: false };
    (0..2).for_each(|_| drop(simulation.advance(&mut impatient).unwrap()));
    let before = simulation.state().clone();
    assert_eq!(simulation.advance(&mut impatient), Err(Error::Stopped));
    let state = simulation.state();
    assert_eq!(
        (&state.u, state.increment, state.attempts, state.iterations),
        (&before.u, 2, before.attempts, before.iterations)
    );
    assert_eq!(simulation.finish(Err(Error::Stopped), &facts).unwrap().1, Err(Error::Stopped));

    let u = complete(*begun(&made, &job(&made, directory.path(), Start::Checkpoint, &facts)), &made).0;
    assert_eq!(
        u,
        complete(*begun(&made, &job(&made, tempfile::tempdir().unwrap().path(), Start::Beginning, &facts)), &made).0
    );
}
