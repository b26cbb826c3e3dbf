//! An accepted state and what is reported of it, as arrays.

use crate::arrays::{grid, table, values};
use crate::model::Model;
use crate::run::Run;
use crate::trouble::{guarded, raised};
use crate::work::Wanted;
use asperity::Error;
use asperity::contact::ContactRecord;
use asperity::deck::Made;
use asperity::declare::nearest;
use asperity::output::{BodyGrid, Frame, Parts, Quantity, QuantityPlace, Source, cloud, global_columns, tool_outlines};
use asperity::solve::AttemptRecord;
use asperity::system::State;
use pyo3::exceptions::{PyLookupError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

/// Where fields live, by the names that users give.
const PLACES: [(&str, QuantityPlace); 5] = [
    ("node", QuantityPlace::Node),
    ("cell", QuantityPlace::Cell),
    ("gauss", QuantityPlace::Gauss),
    ("contact", QuantityPlace::Contact),
    ("face", QuantityPlace::Face),
];

/// What is read of a contact point.
type Of<T> = fn(&ContactRecord) -> T;

/// An accepted state of a model, with all that is reported of it; nothing changes it.
#[pyclass(frozen, name = "State", module = "asperity")]
pub struct Snapshot {
    made: Arc<Made>,
    /// The state.
    pub state: Arc<State>,
    /// The step that led to it, from zero.
    step: usize,
    /// How it was found.
    found: Found,
    frame: OnceLock<Frame>,
}

/// How an increment was found.
#[derive(Debug, Clone, Copy, Default)]
pub struct Found {
    dt: f64,
    iterations: usize,
    attempts: usize,
    relaxed: bool,
}

impl From<&AttemptRecord> for Found {
    fn from(record: &AttemptRecord) -> Self {
        let iterations = record.solutions();
        Self { dt: record.dt, iterations, attempts: record.attempt, relaxed: record.relaxed }
    }
}

impl Snapshot {
    /// A state of which no increment is known.
    pub fn new(made: Arc<Made>, state: impl Into<Arc<State>>) -> Self {
        let state = state.into();
        let step = state.step.min(made.model.problem.steps.len().saturating_sub(1));
        Self { made, state, step, found: Found::default(), frame: OnceLock::new() }
    }
    /// The state that an increment led to.
    pub fn after(made: Arc<Made>, state: Arc<State>, record: &AttemptRecord) -> Self {
        Self { made, state, step: record.step, found: record.into(), frame: OnceLock::new() }
    }

    fn source<'a>(&'a self, parts: &'a Parts<'a>) -> Source<'a> {
        Source { parts, state: &self.state, step: self.step }
    }

    fn gathered(&self) -> Result<Frame, Error> {
        let gather = || self.source(&Parts::of(&self.made.model)).gather();
        guarded(|| rayon::scope(|_| gather())).and_then(|frame| frame)
    }

    fn frame(&self, py: Python<'_>) -> PyResult<&Frame> {
        if let Some(frame) = self.frame.get() {
            return Ok(frame);
        }
        let frame = py.detach(|| self.gathered()).map_err(|error| raised(py, &error))?;
        Ok(self.frame.get_or_init(|| frame))
    }

    fn totals_named<'f>(frame: &'f Frame, prefix: &str) -> impl Iterator<Item = (&'f str, &'f Quantity)> {
        frame
            .at(QuantityPlace::Global)
            .filter_map(move |quantity| Some((quantity.name.strip_prefix(prefix)?, quantity)))
    }
}

fn place(name: &str) -> PyResult<QuantityPlace> {
    let found = PLACES.iter().find(|(known, _)| *known == name);
    found.map(|(_, place)| *place).ok_or_else(|| {
        let all = PLACES.map(|(known, _)| format!("\"{known}\"")).join(", ");
        PyValueError::new_err(format!("there is no place \"{name}\"; there are {all}"))
    })
}

fn missing(what: &str, name: &str, all: &[&str]) -> PyErr {
    let near = match nearest(name, all.iter().copied()) {
        Some(near) => format!("did you mean '{near}'?"),
        None if all.is_empty() => "there are none at all".to_owned(),
        None => format!("there are {}", all.join(", ")),
    };
    PyLookupError::new_err(format!("there is no {what} '{name}'; {near}"))
}

#[pymethods]
impl Snapshot {
    /// Accepted increments so far, over all steps.
    #[getter]
    fn increment(&self) -> usize {
        self.state.increment
    }
    /// Time since the start.
    #[getter]
    fn time(&self) -> f64 {
        self.state.time
    }
    /// Name of the step that led to it.
    #[getter]
    fn step(&self) -> &str {
        self.made.model.problem.steps.get(self.step).map_or("", |step| step.name.as_str())
    }
    /// Length of the increment that led to it; zero where none is known.
    #[getter]
    fn dt(&self) -> f64 {
        self.found.dt
    }
    /// Newton iterations of that increment.
    #[getter]
    fn iterations(&self) -> usize {
        self.found.iterations
    }
    /// Attempts at it that were cut.
    #[getter]
    fn cuts(&self) -> usize {
        self.found.attempts.saturating_sub(1)
    }
    /// Whether it was found by relaxation, beyond an instability.
    #[getter]
    fn relaxed(&self) -> bool {
        self.found.relaxed
    }

    /// Names of the fields, by place: "node", "cell", "gauss" (integration points of bodies), "contact" (points), "face" (faces
    /// of contact surfaces).
    #[getter]
    fn fields<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let frame = self.frame(py)?;
        let dict = PyDict::new(py);
        for (name, place) in PLACES {
            dict.set_item(name, frame.at(place).map(|quantity| quantity.name.as_str()).collect::<Vec<_>>())?;
        }
        Ok(dict)
    }

    /// A field by its name in the result files, one row a place: three columns of a vector, six of a stress (XX YY ZZ XY YZ XZ).
    ///
    /// `at` is its place; if not given, the first of node, cell, gauss, contact, face that has the name.
    #[pyo3(signature = (name, at = None))]
    fn field<'py>(&self, py: Python<'py>, name: &str, at: Option<&str>) -> PyResult<Bound<'py, PyAny>> {
        let frame = self.frame(py)?;
        let places = match at {
            Some(at) => vec![place(at)?],
            None => PLACES.iter().map(|(_, place)| *place).collect(),
        };
        let quantity = places.iter().find_map(|place| frame.get(*place, name)).ok_or_else(|| {
            let all: Vec<&str> = places.iter().flat_map(|place| frame.at(*place)).map(|q| q.name.as_str()).collect();
            missing("field", name, &all)
        })?;
        values(py, quantity)
    }
    /// Displacements of the nodes, (n, 3).
    #[getter]
    fn displacement<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.field(py, "displacement", Some("node"))
    }
    /// Cauchy stress at the integration points, (m, 6): XX YY ZZ XY YZ XZ.
    #[getter]
    fn stress<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.field(py, "cauchy_stress", Some("gauss"))
    }

    /// Global quantities by the columns of `history.csv`.
    #[getter]
    fn totals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let plane = Parts::of(&self.made.model).is_plane();
        let dict = PyDict::new(py);
        for (name, value) in global_columns(self.frame(py)?, plane) {
            dict.set_item(name, value)?;
        }
        Ok(dict)
    }
    /// The force that holds each group that is held or moved, (3,) each; in axial symmetry of the full circumference.
    #[getter]
    fn reactions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for (name, quantity) in Self::totals_named(self.frame(py)?, "reaction.") {
            dict.set_item(name, table(py, quantity.values.iter().copied(), 1)?)?;
        }
        Ok(dict)
    }
    /// Of each rigid tool its translation, rotation in degrees, and the force and moment that hold it.
    #[getter]
    fn tools<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (frame, dict) = (self.frame(py)?, PyDict::new(py));
        for tool in Parts::of(&self.made.model).tool_names() {
            let own = PyDict::new(py);
            for (what, quantity) in Self::totals_named(frame, &format!("tool.{tool}.")) {
                own.set_item(what, table(py, quantity.values.iter().copied(), 1)?)?;
            }
            dict.set_item(tool, own)?;
        }
        Ok(dict)
    }

    /// What a contact carries at its points, or at the nodes of its surface where its stress is a field of nodal values:
    /// position, normal, traction, force (n, 3); pressure, shear, gap, slip, slip_path, area, status (n,).
    ///
    /// Gaps are negative where it penetrates, and not a number where nothing is near; status is 0 open, 1 stick, 2 slip.
    #[pyo3(signature = (name))]
    fn contact<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyDict>> {
        let parts = Parts::of(&self.made.model);
        let found = parts.contacts.iter().find(|(_, own, _)| own == name);
        let (term, _, contact) = found.ok_or_else(|| {
            missing("contact", name, &parts.contacts.iter().map(|(_, own, _)| own.as_str()).collect::<Vec<_>>())
        })?;
        let read = || self.state.histories.get(*term).map(|history| contact.records(&self.state.u, history));
        let records = guarded(read).map_err(|error| raised(py, &error))?.unwrap_or_default();
        let dict = PyDict::new(py);
        let vectors: [(&str, Of<[f64; 3]>); 4] = [
            ("position", |r| r.position.0),
            ("normal", |r| r.inward.0),
            ("traction", |r| r.traction().0),
            ("force", |r| r.force().0),
        ];
        for (name, of) in vectors {
            dict.set_item(name, table(py, records.iter().flat_map(of), 3)?)?;
        }
        let scalars: [(&str, Of<f64>); 6] = [
            ("pressure", |r| r.pressure),
            ("shear", |r| r.shear),
            ("gap", |r| -r.penetration),
            ("slip", |r| r.slip),
            ("slip_path", |r| r.slipped),
            ("area", |r| r.area),
        ];
        for (name, of) in scalars {
            dict.set_item(name, table(py, records.iter().map(of), 1)?)?;
        }
        dict.set_item("status", table(py, records.iter().map(|r| r.status as u8), 1)?)?;
        Ok(dict)
    }

    /// A grid of PyVista with all fields: "bodies", "points", "contacts" or "tools", undeformed; `warp_by_vector("displacement")`
    /// moves it.
    #[pyo3(signature = (kind = "bodies"))]
    fn grid<'py>(&self, py: Python<'py>, kind: &str) -> PyResult<Bound<'py, PyAny>> {
        let mut frame = self.frame(py)?.clone();
        let parts = Parts::of(&self.made.model);
        let read = || match kind {
            "bodies" => BodyGrid::new(parts.mesh).map(|grid| Some(grid.at(&mut frame))),
            "points" => Ok(Some(cloud(&mut frame, QuantityPlace::Gauss))),
            "contacts" => Ok(Some(cloud(&mut frame, QuantityPlace::Contact))),
            "tools" => Ok(Some(tool_outlines(&self.source(&parts), &frame))),
            _ => Ok(None),
        };
        let made = guarded(read).and_then(|made| made).map_err(|error| raised(py, &error))?;
        let made = made.ok_or_else(|| {
            let all = "\"bodies\", \"points\", \"contacts\", \"tools\"";
            PyValueError::new_err(format!("there is no grid \"{kind}\"; there are {all}"))
        })?;
        py.import("asperity._grid")?.call_method1("unstructured", (grid(py, made)?,))
    }

    /// A run from this state on, of its own model or of another with the same mesh, bodies and contacts.
    #[pyo3(signature = (out = None, *, model = None, report = true, doubtful = "raise"))]
    pub fn fork(
        &self,
        py: Python<'_>,
        out: Option<PathBuf>,
        model: Option<&Model>,
        report: bool,
        doubtful: &str,
    ) -> PyResult<Run> {
        let own = Model { made: self.made.clone(), path: "fork".into(), translated: None };
        let raises = Wanted::raises(doubtful)?;
        let wanted = Wanted { out, start: Some(self.state.clone()), restart: false, report, raises };
        Run::begin(py, model.unwrap_or(&own), wanted)
    }
    /// A copy that shares nothing.
    fn copy(&self) -> Self {
        let (made, state) = (self.made.clone(), Arc::new(State::clone(&self.state)));
        Self { made, state, step: self.step, found: self.found, frame: OnceLock::new() }
    }
    fn __copy__(&self) -> Self {
        self.copy()
    }
    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Self {
        self.copy()
    }
    fn __repr__(&self) -> String {
        format!("<asperity.State: increment {} of step '{}', time {}>", self.increment(), self.step(), self.time())
    }
}
