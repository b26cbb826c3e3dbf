//! The observer that writes the results of a run, and passes everything on to another that may show it.

use super::log::RunLog;
use super::progress::{Reporter, Request};
use super::quantities::{Parts, Source};
use super::results::Results;
use super::witness::Witness;
use crate::Error;
use crate::solve::{AttemptRecord, IterationRecord, Observer, Problem};
use crate::system::State;

/// Writes tables and frames while a run goes.
pub struct Recorder<'a> {
    /// The parts of the model that are reported.
    pub parts: &'a Parts<'a>,
    /// What is solved.
    pub problem: &'a Problem,
    /// The result directory.
    pub results: Results,
    /// The tables of attempts and iterations.
    pub log: RunLog,
    /// Where the run stands.
    pub reporter: Reporter,
    /// What a diagnosis asks of the run.
    pub witness: Witness,
    /// Who is told too, and may ask to stop.
    pub audience: &'a mut dyn Observer,
    /// A table that could not be written: the run stops at its next accepted increment.
    pub trouble: Option<Error>,
}

impl<'a> Recorder<'a> {
    /// A recorder of a run that begins or goes on.
    pub fn new(
        (parts, problem): (&'a Parts<'a>, &'a Problem),
        results: Results,
        log: RunLog,
        audience: &'a mut dyn Observer,
    ) -> Self {
        let mut reporter = Reporter::new(results.directory(), problem);
        let summary = &results.summary;
        reporter.progress.iterations = summary.iterations;
        reporter.progress.cuts = summary.attempts.saturating_sub(summary.increments);
        (reporter.progress.increment, reporter.progress.time) = (summary.increments, summary.time);
        let trouble = reporter.write().err();
        Self { parts, problem, results, log, reporter, witness: Witness::default(), audience, trouble }
    }
}

impl Observer for Recorder<'_> {
    fn iteration(&mut self, attempt: &AttemptRecord, iteration: &IterationRecord) {
        self.audience.iteration(attempt, iteration);
    }
    fn attempt(&mut self, attempt: &AttemptRecord) {
        self.reporter.attempt(self.problem, attempt);
        self.witness.attempt(self.problem, attempt);
        let told = self.log.attempt(self.problem, attempt);
        // An accepted increment is told when its results are there.
        let told = told.and_then(|()| if attempt.failure.is_some() { self.reporter.write() } else { Ok(()) });
        if let Err(error) = told {
            self.trouble.get_or_insert(error);
        }
        self.audience.attempt(attempt);
    }
    fn accepted(&mut self, state: &State, attempt: &AttemptRecord) -> Result<(), Error> {
        if let Some(error) = self.trouble.take() {
            return Err(error);
        }
        self.witness.accepted(self.problem, state, attempt);
        let last = state.step > attempt.step;
        let source = Source { parts: self.parts, state, step: attempt.step };
        self.results.accepted(&source, last)?;
        if let Some(turn) = &attempt.turn {
            self.results.mode(&source, &turn.mode)?;
        }
        let progress = &mut self.reporter.progress;
        (progress.beyond, progress.worst) = self.results.nearest_to_limits();
        self.reporter.write()?;
        if Request::Checkpoint.take(self.results.directory())? {
            self.results.checkpoint(state)?;
        }
        self.audience.accepted(state, attempt)
    }
    fn wants_stop(&self) -> bool {
        self.audience.wants_stop() || Request::Stop.is_left(self.results.directory())
    }
}
