//! Models and what is said of them.

use crate::arrays::{plain, table};
use crate::read::{Refusal, Translated, built, given};
use crate::run::Run;
use crate::state::Snapshot;
use crate::trouble::{guarded, raised, warn};
use crate::work::Wanted;
use asperity::deck::{self, Diagnostics, Made, Severity};
use asperity::output::vtk::Cells;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::path::PathBuf;
use std::sync::Arc;

/// A model, built from a deck; nothing changes it.
///
/// `deck` is a path (a deck, or an input deck of Abaqus or CalculiX, `.inp`), the text of a deck (a string with line breaks),
/// or a dict of the same keys. A dict may hold its mesh in arrays: `{"mesh": {"nodes": (n, 2 or 3) array, "cells": {"quad8":
/// (m, 8) array of node indices in VTK's order}, "groups": {"bore": array of nodes, "tube": {"cells": array}}}}`. A group of
/// nodes has the outer edges or faces whose nodes are all in it.
///
/// `set` changes keys, as `--set` of the command does: a dict `{"step.push.increments.count": 20}` or a list of `"key=value"`.
/// `folder` is where the files that a dict or a text names are looked for; the present one if not given.
///
/// Raises DeckError with all that is wrong; warns with DeckWarning.
#[pyclass(frozen, module = "asperity")]
pub struct Model {
    pub made: Arc<Made>,
    /// Whose results they are.
    pub path: PathBuf,
    pub translated: Option<Arc<Translated>>,
}

/// What is said of a model before it is solved.
#[pyclass(frozen, module = "asperity", get_all)]
pub struct Check {
    /// A page for people.
    text: String,
    /// What looks wrong, rendered.
    problems: Vec<String>,
}

#[pymethods]
impl Model {
    #[new]
    #[pyo3(signature = (deck, *, set = None, folder = None))]
    fn new(
        py: Python<'_>,
        deck: &Bound<'_, PyAny>,
        set: Option<&Bound<'_, PyAny>>,
        folder: Option<PathBuf>,
    ) -> PyResult<Self> {
        let none = PyList::empty(py).into_any();
        let mut given = given(py, deck, set.unwrap_or(&none), folder)?;
        let mesh = given.mesh.take().map(|arrays| guarded(|| arrays.mesh()).map_err(|error| raised(py, &error)));
        let mesh = mesh.transpose()?.transpose()?;
        let built = py.detach(|| guarded(|| rayon::scope(|_| built(&given, mesh))));
        let (made, translated) = built.map_err(Refusal::from).flatten().map_err(|refusal| refusal.raised(py))?;
        if made.diagnostics.list.iter().any(|message| message.severity != Severity::Note) {
            warn(py, "DeckWarning", &made.diagnostics.render(false))?;
        }
        Ok(Self { made: Arc::new(made), path: given.path, translated: translated.map(Arc::new) })
    }

    /// The deck's title.
    #[getter]
    fn title(&self) -> &str {
        &self.made.model.title
    }
    /// What the coordinates mean: "axisymmetric", "plane-strain", "plane-stress", "solid".
    #[getter]
    fn space(&self) -> &str {
        self.made.model.space.name()
    }
    /// Number of unknowns, prescribed ones included.
    #[getter]
    fn unknowns(&self) -> usize {
        self.made.model.problem.dofs.count()
    }
    /// Names of the steps.
    #[getter]
    fn steps(&self) -> Vec<&str> {
        self.made.model.problem.steps.iter().map(|step| step.name.as_str()).collect()
    }
    /// Names of the bodies.
    #[getter]
    fn bodies(&self) -> Vec<&str> {
        use asperity::system::Term;
        self.made.model.bodies.iter().map(|(body, _)| Term::name(body.as_ref())).collect()
    }
    /// Names of the contacts.
    #[getter]
    fn contacts(&self) -> Vec<String> {
        asperity::output::Parts::of(&self.made.model).contacts.into_iter().map(|(_, name, _)| name).collect()
    }
    /// Names of the rigid tools.
    #[getter]
    fn tools(&self) -> Vec<String> {
        let parts = asperity::output::Parts::of(&self.made.model);
        parts.tool_names().into_iter().map(str::to_owned).collect()
    }
    /// Keys that the deck does not say, and what holds instead.
    #[getter]
    fn defaults(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let all: std::collections::BTreeMap<_, _> =
            self.made.unsaid.iter().map(|unsaid| (&unsaid.path, &unsaid.instead)).collect();
        plain(py, &all)
    }
    /// Positions of the nodes before any motion, (n, 3).
    #[getter]
    fn nodes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        table(py, self.made.model.mesh.places().flat_map(|place| place.0), 3)
    }
    /// Nodes of the cells in VTK's order, by kind of cell.
    #[getter]
    fn cells<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let mesh = &self.made.model.mesh;
        let all = Cells::of_mesh(mesh).map_err(|error| raised(py, &error))?;
        let mut kinds: Vec<(&str, usize, Vec<i64>)> = Vec::new();
        for (kind, cell) in mesh.kinds.iter().zip(all.iter()) {
            let Some((_, nodes)) = cell else { continue };
            match kinds.iter_mut().find(|(name, ..)| *name == kind.name) {
                Some((_, _, list)) => list.extend_from_slice(nodes),
                None => kinds.push((kind.name, nodes.len(), nodes.to_vec())),
            }
        }
        let dict = PyDict::new(py);
        for (name, width, list) in kinds {
            dict.set_item(name, table(py, list, width)?)?;
        }
        Ok(dict)
    }
    /// Nodes of each group.
    #[getter]
    fn groups<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for (name, group) in &self.made.model.mesh.groups {
            dict.set_item(name, table(py, group.nodes.iter().map(|&node| node as i64), 1)?)?;
        }
        Ok(dict)
    }
    /// The text of the deck, as messages show it.
    #[getter]
    fn deck(&self) -> String {
        self.made.asked().text
    }

    /// Everything that can be said before solving, as `asperity check` does.
    fn check(&self, py: Python<'_>) -> PyResult<Check> {
        let made = &self.made;
        let review = py.detach(|| guarded(|| rayon::scope(|_| deck::review(made))));
        let review = review.and_then(|review| review).map_err(|error| raised(py, &error))?;
        let one = |problem: &deck::Diagnostic| {
            let sources = made.diagnostics.sources.clone();
            Diagnostics { sources, list: vec![problem.clone()] }.render(false)
        };
        Ok(Check { text: review.text, problems: review.problems.iter().map(one).collect() })
    }

    /// The state before the first increment.
    fn initial(&self) -> Snapshot {
        Snapshot::new(self.made.clone(), self.made.model.problem.initial_state())
    }

    /// A run of the model, which solves nothing until its increments are taken: `for state in model.run(): ...`.
    ///
    /// With `out` it leaves the result directory that the command leaves, with `report.html` unless `report` is false; without,
    /// no file. It begins at the first increment, at `start` (a state, of this model or of one with the same mesh, bodies and
    /// contacts), or with `restart` at the checkpoint in `out`. A run that ends with a figure beyond its limit raises
    /// DoubtfulResult, or warns with `doubtful = "warn"`.
    #[pyo3(signature = (out = None, *, start = None, restart = false, report = true, doubtful = "raise"))]
    fn run(
        &self,
        py: Python<'_>,
        out: Option<PathBuf>,
        start: Option<&Snapshot>,
        restart: bool,
        report: bool,
        doubtful: &str,
    ) -> PyResult<Run> {
        let raises = Wanted::raises(doubtful)?;
        if restart && (start.is_some() || out.is_none()) {
            return Err(PyTypeError::new_err(
                "a restart goes on from the checkpoint in `out`: give `out`, and no `start`",
            ));
        }
        let start = start.map(|snapshot| snapshot.state.clone());
        Run::begin(py, self, Wanted { out, start, restart, report, raises })
    }

    /// Runs to the end; the finished run has state, history and summary. Arguments as of `run`.
    #[pyo3(signature = (out = None, *, start = None, restart = false, report = true, doubtful = "raise"))]
    fn solve(
        &self,
        py: Python<'_>,
        out: Option<PathBuf>,
        start: Option<&Snapshot>,
        restart: bool,
        report: bool,
        doubtful: &str,
    ) -> PyResult<Run> {
        let run = self.run(py, out, start, restart, report, doubtful)?;
        run.complete(py)?;
        Ok(run)
    }

    fn __repr__(&self) -> String {
        format!("<asperity.Model '{}', {}, {} unknowns>", self.title(), self.space(), self.unknowns())
    }
}

#[pymethods]
impl Check {
    /// Whether nothing looks wrong.
    #[getter]
    fn ok(&self) -> bool {
        self.problems.is_empty()
    }
    fn __str__(&self) -> String {
        [std::slice::from_ref(&self.text), &self.problems].concat().join("\n")
    }
    fn __repr__(&self) -> String {
        format!("<asperity.Check: {} problems>", self.problems.len())
    }
}
