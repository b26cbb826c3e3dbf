//! A run that goes on from the end of a step with what lies ahead changed.

use crate::bench::Bench;
use crate::{Case, Measured};
use asperity::Error;
use asperity::output::checkpoint::{self, Head, InputHash, Stamp};
use asperity::solve::{RunOptions, Silent};
use asperity::system::State;

/// The case.
pub const CASE: Case = Case { name: "branch", measure };

/// Increments of the first two steps.
const BEFORE: usize = 12;

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let (back, on) = (bench.solve("back.toml", &[])?.state, bench.solve("on.toml", &[])?.state);
    let first = bench.model("back.toml", &[])?;
    let mut run = first.run(first.problem.initial_state());
    run.run(&RunOptions { increments: Some(BEFORE) }, &mut Silent)?;
    let second = bench.model("on.toml", &[])?;
    let mut branch = second.run(through_a_file(&run.state)?);
    branch.run(&RunOptions::default(), &mut Silent)?;
    let differ = |a: &State, b: &State| a.u.iter().zip(&b.u).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    Ok(vec![("branch".into(), differ(&branch.state, &on)), ("changed".into(), differ(&back, &on))])
}

/// A state as the file of a checkpoint keeps it.
fn through_a_file(state: &State) -> Result<State, Error> {
    let folder = tempfile::tempdir().map_err(|error| Error::file("a folder for the checkpoint", error))?;
    let path = folder.path().join("run.checkpoint");
    let stamp = Stamp { step: state.step as u64, increment: state.increment as u64, time: state.time };
    checkpoint::save(&path, &Head { input: InputHash::of(&[]), stamp }, state)?;
    Ok(checkpoint::read(&path)?.1)
}
