//! A run with everything that is kept of it, from its start, from the checkpoint in its result directory or from any accepted
//! state: at once ([`simulate`]), or increment by increment ([`Simulation`]).

use super::account::Account;
use super::asked::Asked;
use super::certificate::Limits;
use super::checkpoint::InputHash;
use super::closing;
use super::input::{Origin, Part, resumed, terms_of};
use super::log::RunLog;
use super::options::ResultOptions;
use super::progress::Request;
use super::quantities::{Parts, Source};
use super::recorder::{Files, Keeper, Recorder};
use super::results::{CHECKPOINT, Results, SUMMARY};
use super::summary::{RunStatus, Summary};
use super::witness::Witness;
use crate::diagnosis::{Facts, RunCourse};
use asperity_core::Error;
use asperity_core::model::Model;
use asperity_core::solve::{AttemptRecord, Observer, Run};
use asperity_core::system::State;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Where and how the results of a run are written.
#[derive(Debug, Clone)]
pub struct Job<'a> {
    /// The result directory.
    pub directory: &'a Path,
    /// What is written, and how often.
    pub options: ResultOptions,
    /// Fingerprint of deck and mesh,
    pub input: InputHash,
    /// and of their parts.
    pub parts: &'a [Part],
    /// The deck, which is written beside the results.
    pub asked: Option<&'a Asked>,
    /// Where the run begins.
    pub start: Start<'a>,
    /// What the figures of the certificate may be.
    pub limits: &'a Limits,
    /// What was said of the model beforehand, for the notes of the summary.
    pub notes: &'a [String],
    /// What a diagnosis asks of the model.
    pub facts: &'a Facts,
}

/// Where a run begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Start<'a> {
    /// At the first increment.
    Beginning,
    /// At the checkpoint in the result directory.
    Checkpoint,
    /// At a checkpoint that is kept in the result directory; what came after it is dropped.
    Kept(&'a Path),
    /// At an accepted state of another run; its results begin there.
    State(&'a State),
}

/// How a run ended: its summary, and what it ended with; [`Error::Stopped`] when it was asked to stop.
pub type Ended = (Summary, Result<(), Error>);

/// A run whose increments are taken one by one.
///
/// [`begin`](Self::begin) it, [`advance`](Self::advance) until there is no more increment or an error, then
/// [`finish`](Self::finish): whatever it ended with, the results say so. [`simulate`] does just this.
pub struct Simulation<'m> {
    model: &'m Model,
    parts: Parts<'m>,
    run: Run<'m>,
    keeper: Keeper,
    witness: Witness,
    totals: Vec<(String, f64)>,
    spent: Duration,
}

/// A run that was asked for.
pub enum Begun<'m> {
    /// It goes.
    Going(Box<Simulation<'m>>),
    /// There is nothing to run: it had come to its end before, or it does not fit into the memory there is.
    Ended(Box<Ended>),
}

/// Runs a model and writes its results; `summary.json` says how it ended, however it ended.
///
/// # Errors
/// An error when the results cannot be written or the checkpoint not be read; nothing was run then. What the run itself
/// ends with is the second part of the result: [`Error::Stopped`] when the audience asked for it.
pub fn simulate(model: &Model, job: &Job, audience: &mut dyn Observer) -> Result<Ended, Error> {
    match Simulation::begin(model, job)? {
        Begun::Ended(ended) => Ok(*ended),
        Begun::Going(mut simulation) => {
            let ended = loop {
                match simulation.advance(audience) {
                    Ok(Some(_)) => {}
                    Ok(None) => break Ok(()),
                    Err(error) => break Err(error),
                }
            };
            audience.ended();
            simulation.finish(ended, job.facts)
        }
    }
}

impl<'m> Simulation<'m> {
    /// Begins a run whose results are written.
    ///
    /// # Errors
    /// An error when the results cannot be written, the checkpoint not be read, or the state is not of the model.
    pub fn begin(model: &'m Model, job: &Job) -> Result<Begun<'m>, Error> {
        let (state, changed) = job.state(model)?;
        let ended = |ended: Ended| Ok(Begun::Ended(Box::new(ended)));
        if let Some(finished) = job.finished(model, &state) {
            return ended((finished, Ok(())));
        }
        if let Err(error) = model.problem.check_memory(&state) {
            return ended((job.refuse(model, &error)?, Err(error)));
        }
        let parts = Parts::of(model);
        let (results, log) = job.open(model, &Source { parts: &parts, state: &state, step: state.step }, &changed)?;
        let files = Files::new(results, log, &model.problem);
        Ok(Begun::Going(Box::new(Self::new(model, parts, state, Keeper::Files(Box::new(files))))))
    }

    /// Begins a run at an accepted state, of which nothing is written.
    ///
    /// # Errors
    /// [`Error::Input`] when the state is not of the model, or the run does not fit into the memory there is.
    pub fn in_memory(model: &'m Model, state: State, limits: &Limits, notes: &[String]) -> Result<Self, Error> {
        model.problem.fits(&state).map_err(Error::Input)?;
        model.problem.check_memory(&state)?;
        let parts = Parts::of(model);
        let mut account = Account::new(&parts);
        account.limits.clone_from(limits);
        account.summary.title.clone_from(&model.title);
        account.summary.notes.extend_from_slice(notes);
        Ok(Self::new(model, parts, state, Keeper::Memory(Box::new(account))))
    }

    fn new(model: &'m Model, parts: Parts<'m>, state: State, keeper: Keeper) -> Self {
        let (witness, totals, spent) = (Witness::default(), Vec::new(), Duration::ZERO);
        Self { model, parts, run: model.run(state), keeper, witness, totals, spent }
    }

    /// Solves the next increment and accepts it; none when all steps are done.
    ///
    /// # Errors
    /// [`Error::Stopped`] when the audience or another process asks for it; what else ends a run. The accepted state then is
    /// the last one that was reached.
    pub fn advance(&mut self, audience: &mut dyn Observer) -> Result<Option<AttemptRecord>, Error> {
        let mut recorder = Recorder {
            parts: &self.parts,
            problem: &self.model.problem,
            keeper: &mut self.keeper,
            witness: &mut self.witness,
            totals: &mut self.totals,
            audience,
        };
        if self.run.state.step < self.model.problem.steps.len() && recorder.wants_stop() {
            return Err(Error::Stopped);
        }
        let begun = Instant::now();
        let record = self.run.advance(&mut recorder);
        self.spent += begun.elapsed();
        record
    }

    /// Ends the run with what it ended with, and says so in its results; those of a run that did not come to its end hold a
    /// checkpoint. Nothing may follow.
    ///
    /// # Errors
    /// An error when the results cannot be written.
    pub fn finish(&mut self, mut ended: Result<(), Error>, facts: &Facts) -> Result<Ended, Error> {
        if let (Keeper::Files(files), true) = (&mut self.keeper, ended.is_ok()) {
            ended = files.results.settle();
        }
        let state = &self.run.state;
        // Before the first increment of a step the checkpoint of the one before stands, from which the step may yet be changed.
        let stands = state.step_increment == 0 && state.increment > 0;
        if let (Keeper::Files(files), Err(why)) = (&mut self.keeper, &ended)
            && !(stands && files.results.directory().join(CHECKPOINT).exists())
            && let Err(error) = files.results.checkpoint(state)
        {
            let lost = format!("the last accepted increment is not kept: {error}");
            files.results.account.summary.notes.push(lost);
            if *why == Error::Stopped {
                ended = Err(error);
            }
        }
        let account = self.keeper.account_mut();
        closing::close(account, self.model, &self.run, self.spent.as_secs_f64());
        if matches!(ended, Ok(()) | Err(Error::NotConverged(_))) {
            let failed = ended.as_ref().err().map(|reason| (self.run.ended, reason.to_string()));
            let course = self.witness.course((&self.model.problem, state), failed);
            account.diagnose(facts, RunCourse { adrift: self.run.first_held.clone(), ..course });
        }
        match &mut self.keeper {
            Keeper::Memory(account) => account.end(&ended),
            Keeper::Files(files) => {
                files.results.finish(&ended)?;
                Request::clear(files.results.directory())?;
                let status = files.results.account.summary.status;
                (files.reporter.progress.status, files.reporter.progress.remaining) = (status, None);
                files.reporter.write()?;
            }
        }
        Ok((self.keeper.account().summary.clone(), ended))
    }

    /// Writes a checkpoint of the last accepted state, where results are written at all.
    ///
    /// # Errors
    /// An error when it cannot be written.
    pub fn checkpoint(&self) -> Result<(), Error> {
        match &self.keeper {
            Keeper::Files(files) => files.results.checkpoint(self.state()),
            Keeper::Memory(_) => Ok(()),
        }
    }
    /// The last accepted state.
    pub fn state(&self) -> &State {
        &self.run.state
    }
    /// Global quantities of the last increment that was accepted here, by column; none before the first.
    pub fn totals(&self) -> &[(String, f64)] {
        &self.totals
    }
    /// Certificate and summary so far.
    pub fn account(&self) -> &Account {
        self.keeper.account()
    }
}

impl Job<'_> {
    /// The checkpoint in a result directory.
    ///
    /// # Errors
    /// [`Error::File`] when there is none.
    pub fn checkpoint_in(directory: &Path) -> Result<PathBuf, Error> {
        let path = directory.join(CHECKPOINT);
        let reason = "there is no checkpoint to go on from; `asperity run` begins at the first increment";
        if path.exists() { Ok(path) } else { Err(Error::file(&path, reason)) }
    }

    /// The state at which the run begins, and the parts of the deck that have changed since it was reached.
    fn state(&self, model: &Model) -> Result<(State, Vec<String>), Error> {
        match self.start {
            Start::Beginning => Ok((model.problem.initial_state(), Vec::new())),
            Start::State(state) => {
                model.problem.fits(state).map_err(Error::Input)?;
                Ok((state.clone(), Vec::new()))
            }
            Start::Checkpoint => resumed(&Self::checkpoint_in(self.directory)?, &model.problem, self.parts),
            Start::Kept(path) => resumed(path, &model.problem, self.parts),
        }
    }

    /// Whether the results of an earlier run are gone on with.
    fn goes_on(&self) -> bool {
        matches!(self.start, Start::Checkpoint | Start::Kept(_))
    }

    /// The summary of the run, where it goes on from its own end: that tells more than a run of no increments could.
    fn finished(&self, model: &Model, state: &State) -> Option<Summary> {
        if !self.goes_on() || state.step < model.problem.steps.len() {
            return None;
        }
        let mut summary = Summary::read(&self.directory.join(SUMMARY)).ok()?;
        let ended = matches!(summary.status, RunStatus::Converged | RunStatus::Doubtful)
            && summary.increments == state.increment;
        summary.notes.push("this run had come to its end before; nothing was computed or written".into());
        ended.then_some(summary)
    }

    /// The summary of a run that does not begin; where it was to go on, that of the run so far stands.
    fn refuse(&self, model: &Model, error: &Error) -> Result<Summary, Error> {
        let mut summary = Summary::begin(&model.title, model.space.name());
        (summary.input_hash, summary.unknowns) = (Some(self.input.to_string()), model.problem.dofs.count());
        summary.notes.extend_from_slice(self.notes);
        summary.end(&Err(error.clone()), false);
        if !self.goes_on() {
            Results::clear(self.directory)?;
            summary.write(&self.directory.join(SUMMARY))?;
        }
        Ok(summary)
    }

    fn open(&self, model: &Model, start: &Source, changed: &[String]) -> Result<(Results, RunLog), Error> {
        let origin = Origin { input: self.input, parts: self.parts.to_vec(), terms: terms_of(&model.problem) };
        let mut results = if self.goes_on() {
            Results::resume(self.directory, start, self.options.clone(), origin)?
        } else {
            Results::create(self.directory, start, self.options.clone(), origin)?
        };
        if let Some(asked) = self.asked {
            asked.write(self.directory)?;
        }
        if !changed.is_empty() {
            let time = start.state.time;
            let note = format!(
                "gone on from time {time} with a deck of which these parts have changed: {}",
                changed.join(", ")
            );
            results.account.summary.notes.push(note);
        }
        results.account.limits.clone_from(self.limits);
        results.account.summary.title.clone_from(&model.title);
        results.account.summary.notes.extend_from_slice(self.notes);
        results.write_summary()?;
        let log = if self.goes_on() {
            RunLog::resume(self.directory, start.state.increment)?
        } else {
            RunLog::create(self.directory)?
        };
        Ok((results, log))
    }
}
