//! What a run does: its increments, its files, its end.

use crate::arrays::plain;
use crate::course::Course;
use crate::model::Model;
use crate::state::Snapshot;
use crate::trouble::{exception, guarded, raised, raised_with, warn};
use asperity::Error;
use asperity::deck::Made;
use asperity::diagnosis::Facts;
use asperity::output::{Job, Others, ResultsClaim, RunStatus, Start, Summary, resumed};
use asperity::solve::{AttemptRecord, Silent};
use asperity::system::State;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What is wanted of a run.
pub struct Wanted {
    /// The result directory, if results are to be written.
    pub out: Option<PathBuf>,
    /// The state at which it begins, if not at the first increment.
    pub start: Option<Arc<State>>,
    /// Whether it goes on from the checkpoint in the result directory.
    pub restart: bool,
    /// Whether `report.html` is written.
    pub report: bool,
    /// Whether a doubtful result is an exception, or a mere warning.
    pub raises: bool,
}

/// A run at work, or at its end.
pub struct Inner {
    pub made: Arc<Made>,
    /// None when the run has ended.
    pub course: Option<Course>,
    /// The right to write into the directory.
    pub claim: Option<ResultsClaim>,
    pub out: Option<PathBuf>,
    pub facts: Facts,
    pub report: bool,
    pub raises: bool,
    /// Time, step and increment of each accepted increment,
    pub leading: [Vec<f64>; 3],
    /// and the columns of `history.csv` behind them.
    pub columns: Vec<(String, Vec<f64>)>,
    /// The last accepted state,
    pub state: Arc<State>,
    /// and how it was found.
    pub record: Option<AttemptRecord>,
    /// Set when the run has ended.
    pub summary: Option<Summary>,
}

impl Wanted {
    /// Whether a doubtful result is an exception.
    pub fn raises(doubtful: &str) -> PyResult<bool> {
        match doubtful {
            "raise" => Ok(true),
            "warn" => Ok(false),
            other => Err(PyValueError::new_err(format!("doubtful is \"raise\" or \"warn\", not \"{other}\""))),
        }
    }
    /// Where it begins.
    pub fn begins(&self) -> Start<'_> {
        match &self.start {
            Some(state) => Start::State(state),
            None if self.restart => Start::Checkpoint,
            None => Start::Beginning,
        }
    }
}

/// Claims the result directory and writes what was asked into it.
pub fn claimed(model: &Model, wanted: &Wanted, out: &Path) -> Result<ResultsClaim, Error> {
    if wanted.restart {
        Job::checkpoint_in(out)?;
    }
    let claim = ResultsClaim::take(out, &model.path, Others::Replace)?;
    if let Some(translated) = &model.translated {
        translated.write(out)?;
    }
    Ok(claim)
}

/// The state in the checkpoint of a result directory.
pub fn kept(made: &Made, out: &Path) -> Result<State, Error> {
    resumed(&Job::checkpoint_in(out)?, &made.model.problem, &made.parts).map(|(state, _)| state)
}

impl Inner {
    /// The last accepted state.
    pub fn snapshot(&self) -> Snapshot {
        match &self.record {
            Some(record) => Snapshot::after(self.made.clone(), self.state.clone(), record),
            None => Snapshot::new(self.made.clone(), State::clone(&self.state)),
        }
    }

    /// Solves an increment; false when there is none left.
    pub fn advance(&mut self) -> Result<bool, Error> {
        let Some(course) = &mut self.course else { return Ok(false) };
        let advance = |simulation: &mut asperity::output::Simulation| simulation.advance(&mut Silent);
        // In a thread of the pool: from outside, every parallel loop would hand over to it and wait.
        let advanced = guarded(|| rayon::scope(|_| course.with_dependent_mut(|_, simulation| advance(simulation))))
            .and_then(|a| a);
        let simulation = course.borrow_dependent();
        if simulation.state().increment != self.state.increment {
            self.state = Arc::new(simulation.state().clone());
        }
        let Some(record) = advanced? else { return Ok(false) };
        let leading = [self.state.time, (record.step + 1) as f64, self.state.increment as f64];
        self.leading.iter_mut().zip(leading).for_each(|(column, value)| column.push(value));
        if self.columns.is_empty() {
            self.columns = simulation.totals().iter().map(|(name, _)| (name.clone(), Vec::new())).collect();
        }
        self.columns.iter_mut().zip(simulation.totals()).for_each(|((_, column), (_, value))| column.push(*value));
        self.record = Some(record);
        Ok(true)
    }

    /// Ends the run with what it ended with: results and summary say so, and where it `tells`, an exception.
    pub fn end(&mut self, py: Python<'_>, ended: Result<(), Error>, tells: bool) -> PyResult<()> {
        let Some(mut course) = self.course.take() else { return Ok(()) };
        let (facts, out) = (&self.facts, self.out.as_deref().filter(|_| self.report));
        let finished = py.detach(|| {
            let finish = || course.with_dependent_mut(|_, simulation| simulation.finish(ended, facts));
            let (mut summary, ended) = guarded(|| rayon::scope(|_| finish())).and_then(|finished| finished)?;
            if let Some(out) = out.filter(|_| summary.status != RunStatus::FileError) {
                guarded(|| report::conclude(&mut summary, out))?;
            }
            Ok((summary, ended))
        });
        self.claim = None;
        let (summary, ended) = finished.map_err(|error: Error| raised(py, &error))?;
        let told = match &ended {
            Err(error) if tells => Err(self.failure(py, error, &summary)),
            Ok(()) if tells && summary.status == RunStatus::Doubtful => self.doubt(py, &summary),
            _ => Ok(()),
        };
        self.summary = Some(summary);
        told
    }

    /// What the exception of an error carries.
    pub fn failure(&self, py: Python<'_>, error: &Error, summary: &Summary) -> PyErr {
        match self.attributes(py, summary) {
            Ok(attributes) => raised_with(py, error, &attributes),
            Err(other) => other,
        }
    }
    fn attributes(&self, py: Python<'_>, summary: &Summary) -> PyResult<[(&'static str, Py<PyAny>); 3]> {
        let directory = self.out.clone().into_pyobject(py)?.unbind();
        let state = Py::new(py, self.snapshot())?.into_any();
        Ok([("summary", plain(py, summary)?), ("directory", directory), ("state", state)])
    }

    fn doubt(&self, py: Python<'_>, summary: &Summary) -> PyResult<()> {
        let mut lines: Vec<&str> =
            summary.notes.iter().filter(|note| note.starts_with("doubtful")).map(String::as_str).collect();
        if lines.is_empty() {
            lines = summary.diagnosis.iter().map(|finding| finding.what.as_str()).collect();
        }
        let text = lines.join("\n");
        if self.raises {
            return Err(exception(py, "DoubtfulResult", &text, &self.attributes(py, summary)?));
        }
        warn(py, "DoubtfulWarning", &text)
    }
}

impl Drop for Inner {
    /// A run that nobody holds any more ends as one that was stopped: its checkpoint is there.
    fn drop(&mut self) {
        if self.course.is_some() && self.out.is_some() {
            // Nobody is there to be told.
            let _ = Python::attach(|py| self.end(py, Err(Error::Stopped), false));
        }
    }
}
