//! What tests of whole runs share: a model from a deck, and an observer that keeps what a run tells.
#![allow(dead_code)] // each test binary uses a part of it

use asperity::deck::{Made, build, read};
use asperity::diagnosis::Facts;
use asperity::model::Model;
use asperity::output::{Certificate, Frame, Job, Parts, Source, Start, global_columns, simulate};
use asperity::solve::{AttemptRecord, Observer, RunOptions, Silent};
use asperity::system::State;
use std::collections::BTreeMap;
use std::path::Path;

/// The model of a deck.
pub fn model(deck: &str, sets: &[&str]) -> Model {
    made(deck, sets).model
}

/// A deck and its model.
pub fn made(deck: &str, sets: &[&str]) -> Made {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_string()).collect();
    let made = read(deck, "test.toml", Path::new(""), &sets).and_then(build);
    made.unwrap_or_else(|found| panic!("{}", found.render(false)))
}

/// The results of a deck from its beginning, in a directory.
pub fn job<'a>(made: &'a Made, directory: &'a Path, facts: &'a Facts) -> Job<'a> {
    let (options, limits) = (made.results.clone(), &made.deck.limits.limits);
    let (input, parts, start) = (made.input, &made.parts[..], Start::Beginning);
    Job { directory, options, input, parts, asked: None, start, limits, notes: &[], facts }
}

/// Runs a model to its end with all its files.
pub fn write_results(made: &Made, directory: &Path) {
    simulate(&made.model, &job(made, directory, &Facts::default()), &mut Silent).unwrap().1.unwrap();
}

/// Keeps every attempt and every accepted state.
#[derive(Default)]
pub struct Keep {
    pub attempts: Vec<AttemptRecord>,
    pub states: Vec<State>,
}

impl Observer for Keep {
    fn attempt(&mut self, attempt: &AttemptRecord) {
        self.attempts.push(attempt.clone());
    }
    fn accepted(&mut self, state: &State, _: &AttemptRecord) -> Result<(), asperity::Error> {
        self.states.push(state.clone());
        Ok(())
    }
}

/// A state as it is written to a checkpoint.
pub fn bytes(state: &State) -> Vec<u8> {
    postcard::to_stdvec(state).unwrap()
}

/// All accepted states, likewise.
pub fn all_bytes(keep: &Keep) -> Vec<Vec<u8>> {
    keep.states.iter().map(bytes).collect()
}

/// Runs from the start to the end.
pub fn run(model: &Model) -> Keep {
    go_on(model, model.problem.initial_state(), None)
}

/// Runs from a state to the end, or over some increments.
pub fn go_on(model: &Model, from: State, increments: Option<usize>) -> Keep {
    let mut keep = Keep::default();
    let mut run = model.run(from);
    run.run(&RunOptions { increments }, &mut keep).unwrap_or_else(|error| panic!("{error}"));
    keep
}

/// What some work gives on so many threads.
pub fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

/// The columns of the history of a run, by name, each with a value an increment.
pub fn columns(model: &Model, keep: &Keep) -> BTreeMap<String, Vec<f64>> {
    let mut columns = BTreeMap::<String, Vec<f64>>::new();
    for frame in frames(model, keep) {
        for (name, value) in global_columns(&frame, Parts::of(model).is_plane()) {
            columns.entry(name).or_default().push(value);
        }
    }
    columns
}

/// What is reported of each accepted increment of a run.
fn frames(model: &Model, keep: &Keep) -> Vec<Frame> {
    let accepted = keep.attempts.iter().filter(|attempt| attempt.failure.is_none());
    let parts = Parts::of(model);
    let gather =
        |(state, attempt): (&State, &AttemptRecord)| Source { parts: &parts, state, step: attempt.step }.gather();
    keep.states.iter().zip(accepted).map(|pair| gather(pair).unwrap()).collect()
}

/// The certificate of a run.
pub fn certificate(model: &Model, keep: &Keep) -> Certificate {
    let mut certificate = Certificate::default();
    frames(model, keep).iter().for_each(|frame| certificate.observe(frame));
    certificate
}

/// What a body says so that its cells are not raised to second degree.
pub fn keep_degree(cell: &str) -> &'static str {
    if ["tri3", "tet4", "wedge6"].contains(&cell) { ", degree = 1" } else { "" }
}
