//! A run, increment by increment.

use crate::arrays::{plain, table};
use crate::course::{Course, Nothing};
use crate::deck::Model;
use crate::state::Snapshot;
use crate::trouble::{exception, guarded, raised, raised_with, warn};
use asperity::Error;
use asperity::deck::{self, Made};
use asperity::diagnosis::Facts;
use asperity::output::{ASKED, Claim, Job, Others, Start, Status, Summary};
use asperity::solve::{AttemptRecord, Silent};
use asperity::system::State;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, TryLockError};

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

/// A run of a model. Iterating takes its increments: each gives the State it led to.
///
/// While an increment is solved other threads of Python go on. Ctrl-C ends the run after the increment, with a checkpoint
/// where results are written. A loop that is left early can be taken up again; `with model.run() as run:` ends the run at
/// the end of the block, whatever happens in it.
#[pyclass(frozen, module = "asperity")]
pub struct Run {
    made: Arc<Made>,
    inner: Mutex<Inner>,
}

/// Takes the increments of a run; when it is left before its end, a checkpoint is written.
#[pyclass(frozen, module = "asperity")]
pub struct Increments {
    run: Py<Run>,
}

struct Inner {
    made: Arc<Made>,
    /// None when the run has ended.
    course: Option<Course>,
    /// The right to write into the directory.
    claim: Option<Claim>,
    out: Option<PathBuf>,
    facts: Facts,
    report: bool,
    raises: bool,
    /// Time, step and increment of each accepted increment,
    leading: [Vec<f64>; 3],
    /// and the columns of `history.csv` behind them.
    columns: Vec<(String, Vec<f64>)>,
    /// The last accepted state,
    state: Arc<State>,
    /// and how it was found.
    record: Option<AttemptRecord>,
    /// Set when the run has ended.
    summary: Option<Summary>,
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
    fn begins(&self) -> Start<'_> {
        match &self.start {
            Some(state) => Start::State(state),
            None if self.restart => Start::Checkpoint,
            None => Start::Beginning,
        }
    }
}

/// Claims the result directory and writes what was asked into it.
fn claimed(model: &Model, wanted: &Wanted, out: &Path) -> Result<Claim, Error> {
    if wanted.restart {
        Job::checkpoint_in(out)?;
    }
    let claim = Claim::take(out, &model.path, Others::Replace)?;
    if let Some(translated) = &model.translated {
        translated.write(out)?;
    }
    if !wanted.restart || !out.join(ASKED).exists() {
        model.made.asked().write(out)?;
    }
    Ok(claim)
}

impl Run {
    /// Begins a run; nothing is solved yet.
    pub fn begin(py: Python<'_>, model: &Model, wanted: Wanted) -> PyResult<Self> {
        let made = model.made.clone();
        let begin = || {
            let facts = deck::facts(&made);
            let notes: Vec<String> = made.diagnostics.list.iter().map(|warning| warning.what.clone()).collect();
            let claim = wanted.out.as_deref().map(|out| claimed(model, &wanted, out)).transpose();
            let claim = claim.map_err(Nothing::Error)?;
            let course = match &wanted.out {
                Some(directory) => {
                    let (options, limits) = (made.deck.output.options(), &made.deck.limits.limits);
                    let (input, start) = (made.input, wanted.begins());
                    let job = Job { directory, options, input, start, limits, notes: &notes, facts: &facts };
                    Course::recorded(made.clone(), &job)
                }
                None => {
                    let initial = || made.model.problem.initial_state();
                    let state = wanted.start.as_deref().cloned().unwrap_or_else(initial);
                    Course::in_memory(made.clone(), state, &notes)
                }
            };
            course.map(|course| (course, claim, facts))
        };
        let begun = py.detach(|| guarded(|| rayon::scope(|_| begin())));
        let mut inner = Inner {
            made: made.clone(),
            course: None,
            claim: None,
            out: wanted.out.clone(),
            facts: Facts::default(),
            report: wanted.report,
            raises: wanted.raises,
            leading: Default::default(),
            columns: Vec::new(),
            state: Arc::default(),
            record: None,
            summary: None,
        };
        match begun.map_err(|error| raised(py, &error))? {
            Ok((course, claim, facts)) => {
                inner.state = Arc::new(course.borrow_dependent().state().clone());
                (inner.course, inner.claim, inner.facts) = (Some(course), claim, facts);
            }
            Err(Nothing::Ended(ended)) => {
                let (summary, ended) = *ended;
                if let Err(error) = ended {
                    return Err(inner.failure(py, &error, &summary));
                }
                inner.state = Arc::new(made.model.problem.initial_state());
                inner.summary = Some(summary);
            }
            Err(Nothing::Error(error)) => return Err(raised(py, &error)),
        }
        Ok(Self { made: model.made.clone(), inner: Mutex::new(inner) })
    }

    /// The inside of the run, unless another thread is at work in it.
    fn inner(&self) -> PyResult<MutexGuard<'_, Inner>> {
        match self.inner.try_lock() {
            Ok(inner) => Ok(inner),
            // What a panic left behind was put in order by who caught it.
            Err(TryLockError::Poisoned(inner)) => Ok(inner.into_inner()),
            Err(TryLockError::WouldBlock) => Err(PyRuntimeError::new_err("this run is at work in another thread")),
        }
    }

    /// The next increment; none when the run has come to its end. Interrupts end the run after the increment.
    fn next(&self, py: Python<'_>) -> PyResult<Option<Snapshot>> {
        let mut inner = self.inner()?;
        if inner.course.is_none() {
            return Ok(None);
        }
        // The guard stays with this thread; what it guards may be at work without the interpreter.
        let working = &mut *inner;
        let advanced = py.detach(|| working.advance());
        if let Err(interrupt) = py.check_signals() {
            if let Err(error) = inner.end(py, Err(Error::Stopped), false) {
                interrupt.set_cause(py, Some(error));
            }
            return Err(interrupt);
        }
        match advanced {
            Ok(true) => Ok(Some(inner.snapshot())),
            Ok(false) => inner.end(py, Ok(()), true).map(|()| None),
            Err(error) => inner.end(py, Err(error), true).map(|()| None),
        }
    }

    /// Solves all increments that are left.
    pub fn complete(&self, py: Python<'_>) -> PyResult<()> {
        while self.next(py)?.is_some() {}
        Ok(())
    }
}

impl Inner {
    fn snapshot(&self) -> Snapshot {
        match &self.record {
            Some(record) => Snapshot::after(self.made.clone(), self.state.clone(), record),
            None => Snapshot::new(self.made.clone(), State::clone(&self.state)),
        }
    }

    /// Solves an increment; false when there is none left.
    fn advance(&mut self) -> Result<bool, Error> {
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
    fn end(&mut self, py: Python<'_>, ended: Result<(), Error>, tells: bool) -> PyResult<()> {
        let Some(mut course) = self.course.take() else { return Ok(()) };
        let (facts, out) = (&self.facts, self.out.as_deref().filter(|_| self.report));
        let finished = py.detach(|| {
            let finish = || course.with_dependent_mut(|_, simulation| simulation.finish(ended, facts));
            let (mut summary, ended) = guarded(|| rayon::scope(|_| finish())).and_then(|finished| finished)?;
            if let Some(out) = out.filter(|_| summary.status != Status::FileError) {
                guarded(|| report::conclude(&mut summary, out))?;
            }
            Ok((summary, ended))
        });
        self.claim = None;
        let (summary, ended) = finished.map_err(|error: Error| raised(py, &error))?;
        let told = match &ended {
            Err(error) if tells => Err(self.failure(py, error, &summary)),
            Ok(()) if tells && summary.status == Status::Doubtful => self.doubt(py, &summary),
            _ => Ok(()),
        };
        self.summary = Some(summary);
        told
    }

    /// What the exception of an error carries.
    fn failure(&self, py: Python<'_>, error: &Error, summary: &Summary) -> PyErr {
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

impl Drop for Increments {
    fn drop(&mut self) {
        let run = self.run.get();
        if let Ok(inner) = run.inner()
            && let Some(course) = &inner.course
        {
            // A loop that was left: the run can go on, here or from the checkpoint.
            let _ = guarded(|| course.borrow_dependent().checkpoint());
        }
    }
}

#[pymethods]
impl Increments {
    fn __iter__(own: PyRef<'_, Self>) -> PyRef<'_, Self> {
        own
    }
    fn __next__(&self, py: Python<'_>) -> PyResult<Option<Snapshot>> {
        self.run.get().next(py)
    }
}

#[pymethods]
impl Run {
    fn __iter__(own: Bound<'_, Self>) -> Increments {
        Increments { run: own.unbind() }
    }
    fn __enter__(own: PyRef<'_, Self>) -> PyRef<'_, Self> {
        own
    }
    fn __exit__(
        &self,
        py: Python<'_>,
        _kind: &Bound<'_, PyAny>,
        _error: &Bound<'_, PyAny>,
        _trace: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        self.close(py)
    }

    /// Solves the next increment and returns the state it led to; None at the end of the run.
    #[pyo3(name = "advance")]
    fn next_state(&self, py: Python<'_>) -> PyResult<Option<Snapshot>> {
        self.next(py)
    }
    /// Solves all increments that are left and returns the run.
    #[pyo3(name = "complete")]
    fn complete_all(own: PyRef<'_, Self>, py: Python<'_>) -> PyResult<Py<Self>> {
        own.complete(py)?;
        Ok(own.into())
    }
    /// Ends the run here, with a checkpoint where results are written.
    fn close(&self, py: Python<'_>) -> PyResult<()> {
        self.inner()?.end(py, Err(Error::Stopped), false)
    }
    /// Writes a checkpoint now, where results are written.
    fn checkpoint(&self, py: Python<'_>) -> PyResult<()> {
        let inner = self.inner()?;
        let Some(course) = &inner.course else { return Ok(()) };
        guarded(|| course.borrow_dependent().checkpoint()).and_then(|done| done).map_err(|error| raised(py, &error))
    }

    /// The last accepted state.
    #[getter]
    fn state(&self) -> PyResult<Snapshot> {
        Ok(self.inner()?.snapshot())
    }
    /// Whether the run has ended.
    #[getter]
    fn done(&self) -> PyResult<bool> {
        Ok(self.inner()?.course.is_none())
    }
    /// The result directory; None where nothing is written.
    #[getter]
    fn directory(&self) -> PyResult<Option<PathBuf>> {
        Ok(self.inner()?.out.clone())
    }
    /// How the run stands or ended, as in `summary.json`: status, certificate, diagnosis, notes, timings.
    #[getter]
    fn summary(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let inner = self.inner()?;
        match (&inner.summary, &inner.course) {
            (Some(summary), _) => plain(py, summary),
            (None, Some(course)) => {
                let mut account = course.borrow_dependent().account().clone();
                account.certify();
                plain(py, &account.summary)
            }
            (None, None) => Ok(py.None()),
        }
    }
    /// How it stands in a word: "running", "converged", "doubtful", "not-converged", "stopped".
    #[getter]
    fn status(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        self.summary(py)?.bind(py).get_item("status").map(Bound::unbind)
    }

    /// A row an accepted increment, a column a global quantity, as in `history.csv`: a DataFrame where pandas is installed, else a
    /// dict of arrays; `frame` insists on the one or the other. Of a restart, the increments since.
    #[pyo3(signature = (*, frame = None))]
    fn history<'py>(&self, py: Python<'py>, frame: Option<bool>) -> PyResult<Bound<'py, PyAny>> {
        let inner = self.inner()?;
        let dict = PyDict::new(py);
        dict.set_item("time", table(py, inner.leading[0].iter().copied(), 1)?)?;
        for (name, column) in ["step", "increment"].iter().zip(&inner.leading[1..]) {
            dict.set_item(name, table(py, column.iter().map(|&x| x as i64), 1)?)?;
        }
        for (name, column) in &inner.columns {
            dict.set_item(name, table(py, column.iter().copied(), 1)?)?;
        }
        py.import("asperity._grid")?.call_method1("frame", (dict, frame))
    }

    /// Another run from the last accepted state, as `State.fork`; this one is not touched.
    #[pyo3(signature = (out = None, *, model = None, report = true, doubtful = "raise"))]
    fn fork(
        &self,
        py: Python<'_>,
        out: Option<PathBuf>,
        model: Option<&Model>,
        report: bool,
        doubtful: &str,
    ) -> PyResult<Run> {
        let (own, start) = (
            Model { made: self.made.clone(), path: "fork".into(), translated: None },
            Some(self.inner()?.state.clone()),
        );
        let raises = Wanted::raises(doubtful)?;
        Run::begin(py, model.unwrap_or(&own), Wanted { out, start, restart: false, report, raises })
    }

    fn __repr__(&self) -> PyResult<String> {
        let inner = self.inner()?;
        let how =
            inner.summary.as_ref().map_or("going".into(), |summary| format!("{:?}", summary.status).to_lowercase());
        Ok(format!("<asperity.Run: {how}, increment {}, time {}>", inner.state.increment, inner.state.time))
    }
}
