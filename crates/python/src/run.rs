//! A run, increment by increment.

use crate::arrays::{plain, table};
use crate::course::{Course, Nothing};
use crate::model::Model;
use crate::state::Snapshot;
use crate::trouble::{guarded, raised};
use crate::work::{Inner, Wanted, claimed, kept};
use asperity::Error;
use asperity::deck::{self, Made};
use asperity::diagnosis::Facts;
use asperity::output::Job;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, TryLockError};

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
                    let (options, limits) = (made.results.clone(), &made.deck.limits.limits);
                    let (input, parts, start) = (made.input, &made.parts[..], wanted.begins());
                    let (asked, notes, facts) = (made.asked(), &notes, &facts);
                    let asked = Some(&asked);
                    let job = Job { directory, options, input, parts, asked, start, limits, notes, facts };
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
                inner.state = Arc::new(made.model.problem.initial_state());
                if let Err(error) = ended {
                    return Err(inner.failure(py, &error, &summary));
                }
                // Only the checkpoint of a finished run ends a run before it begins.
                if let Some(out) = &wanted.out {
                    inner.state = Arc::new(kept(&made, out).map_err(|error| raised(py, &error))?);
                }
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
        let state = self.inner()?.state.clone();
        Snapshot::new(self.made.clone(), state).fork(py, out, model, report, doubtful)
    }

    fn __repr__(&self) -> PyResult<String> {
        let inner = self.inner()?;
        let how =
            inner.summary.as_ref().map_or("going".into(), |summary| format!("{:?}", summary.status).to_lowercase());
        Ok(format!("<asperity.Run: {how}, increment {}, time {}>", inner.state.increment, inner.state.time))
    }
}
