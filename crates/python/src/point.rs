//! One point of a law, driven along a path.

use crate::arrays::table;
use crate::read::given;
use crate::trouble::{guarded, raised, raised_with, refused};
use asperity::deck;
use asperity::point::Record;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::path::PathBuf;

/// Drives every law of a point's deck along its path, as `asperity point` does: of each law its columns as arrays.
///
/// `deck`, `set` and `folder` as of `Model`. Raises ConvergenceError where a path cannot be followed; its `records` hold what was
/// reached.
#[pyfunction]
#[pyo3(signature = (deck, *, set = None, folder = None))]
pub fn point<'py>(
    py: Python<'py>,
    deck: &Bound<'py, PyAny>,
    set: Option<&Bound<'py, PyAny>>,
    folder: Option<PathBuf>,
) -> PyResult<Bound<'py, PyDict>> {
    let none = PyList::empty(py).into_any();
    let given = given(py, deck, set.unwrap_or(&none), folder)?;
    let read = || match &given.text {
        Some(text) => deck::read_driven(text, &given.path.display().to_string(), &given.folder, &given.sets),
        None => deck::load_driven(&given.path, &given.sets),
    };
    let driven = guarded(read).map_err(|error| raised(py, &error))?.map_err(|found| refused(py, &found))?;
    let followed = py.detach(|| guarded(|| driven.follow()));
    let (records, stopped) = followed.map_err(|error| raised(py, &error))?;
    let all = PyDict::new(py);
    for record in &records {
        all.set_item(&record.name, columns(py, record)?)?;
    }
    match stopped {
        None => Ok(all),
        Some(error) => Err(raised_with(py, &error, &[("records", all.into_any().unbind())])),
    }
}

fn columns<'py>(py: Python<'py>, record: &Record) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (place, name) in record.columns.iter().enumerate() {
        dict.set_item(name, table(py, record.rows.iter().map(|row| row[place]), 1)?)?;
    }
    Ok(dict)
}
