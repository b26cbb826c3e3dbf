//! The observer that keeps the account of a run, writes its results where they are wanted, and passes everything on to
//! another that may show it.

use super::account::Account;
use super::history::global_columns;
use super::log::RunLog;
use super::progress::{Reporter, Request};
use super::quantities::{Parts, Source};
use super::results::Results;
use super::witness::Witness;
use asperity_core::Error;
use asperity_core::solve::{AttemptRecord, IterationRecord, Observer, Problem};
use asperity_core::system::State;
use std::time::Instant;

/// The files of a run.
pub struct Files {
    /// The result directory, with the account of the run.
    pub results: Results,
    /// The tables of attempts and iterations.
    log: RunLog,
    /// Where the run stands.
    pub reporter: Reporter,
    /// A table that could not be written: the run stops at its next accepted increment.
    trouble: Option<Error>,
}

/// Where the account of a run is kept.
pub enum Keeper {
    /// In a result directory.
    Files(Box<Files>),
    /// In memory only.
    Memory(Box<Account>),
}

/// Keeps a run while it goes.
pub struct Recorder<'r> {
    /// The parts of the model that are reported.
    pub parts: &'r Parts<'r>,
    /// What is solved.
    pub problem: &'r Problem,
    /// The account and the files.
    pub keeper: &'r mut Keeper,
    /// What a diagnosis asks of the run.
    pub witness: &'r mut Witness,
    /// Global quantities of the last accepted increment, by column.
    pub totals: &'r mut Vec<(String, f64)>,
    /// Who is told too, and may ask to stop.
    pub audience: &'r mut dyn Observer,
}

impl Files {
    /// The files of a run that begins or goes on.
    pub fn new(results: Results, log: RunLog, problem: &Problem) -> Self {
        let mut reporter = Reporter::new(results.directory(), problem);
        let summary = &results.account.summary;
        reporter.progress.iterations = summary.iterations;
        reporter.progress.cuts = summary.attempts.saturating_sub(summary.increments);
        (reporter.progress.increment, reporter.progress.time) = (summary.increments, summary.time);
        let trouble = reporter.write().err();
        Self { results, log, reporter, trouble }
    }

    fn attempt(&mut self, problem: &Problem, attempt: &AttemptRecord) {
        self.reporter.attempt(problem, attempt);
        let told = self.log.attempt(problem, attempt);
        // An accepted increment is told when its results are there.
        let told = told.and_then(|()| if attempt.failure.is_some() { self.reporter.write() } else { Ok(()) });
        if let Err(error) = told {
            self.trouble.get_or_insert(error);
        }
    }

    fn accepted(&mut self, source: &Source, frame: super::Frame, last: bool) -> Result<(), Error> {
        self.results.accepted(source, frame, last)?;
        let progress = &mut self.reporter.progress;
        (progress.beyond, progress.worst) = self.results.account.nearest_to_limits();
        self.reporter.write()?;
        if Request::Checkpoint.take(self.results.directory())? {
            self.results.checkpoint(source.state)?;
        }
        Ok(())
    }
}

impl Keeper {
    /// The account of the run.
    pub fn account(&self) -> &Account {
        match self {
            Self::Files(files) => &files.results.account,
            Self::Memory(account) => account,
        }
    }
    /// The account of the run, to write.
    pub fn account_mut(&mut self) -> &mut Account {
        match self {
            Self::Files(files) => &mut files.results.account,
            Self::Memory(account) => account,
        }
    }
    /// Whether another process asks the run to stop.
    pub fn is_asked_to_stop(&self) -> bool {
        matches!(self, Self::Files(files) if Request::Stop.is_left(files.results.directory()))
    }
}

impl Observer for Recorder<'_> {
    fn iteration(&mut self, attempt: &AttemptRecord, iteration: &IterationRecord) {
        if let Keeper::Files(files) = self.keeper {
            let told = files.log.iteration(self.problem, attempt, iteration);
            if let Err(error) = told {
                files.trouble.get_or_insert(error);
            }
        }
        self.audience.iteration(attempt, iteration);
    }
    fn attempt(&mut self, attempt: &AttemptRecord) {
        self.witness.attempt(self.problem, attempt);
        if let Keeper::Files(files) = self.keeper {
            files.attempt(self.problem, attempt);
        }
        self.audience.attempt(attempt);
    }
    fn accepted(&mut self, state: &State, attempt: &AttemptRecord) -> Result<(), Error> {
        if let Keeper::Files(files) = self.keeper
            && let Some(error) = files.trouble.take()
        {
            return Err(error);
        }
        self.witness.accepted(self.problem, state, attempt);
        let begun = Instant::now();
        let source = Source { parts: self.parts, state, step: attempt.step };
        let frame = source.gather()?;
        *self.totals = global_columns(&frame, self.parts.is_plane());
        match self.keeper {
            Keeper::Memory(account) => account.accepted(&source, &frame),
            Keeper::Files(files) => {
                files.results.spent += begun.elapsed();
                files.accepted(&source, frame, state.step > attempt.step)?;
                if let Some(turn) = &attempt.turn {
                    files.results.mode(&source, &turn.mode)?;
                }
            }
        }
        self.audience.accepted(state, attempt)
    }
    fn wants_stop(&self) -> bool {
        self.audience.stops(self.keeper.is_asked_to_stop())
    }
}
