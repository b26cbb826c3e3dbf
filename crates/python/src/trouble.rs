//! Exceptions. Those of the package are classes of Python (`asperity._errors`); here they are made and filled.

use asperity::Error;
use asperity::deck::{Diagnostic, Diagnostics, Severity};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyString};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Does something of the library; a panic becomes an error.
pub fn guarded<T>(work: impl FnOnce() -> T) -> Result<T, Error> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| Error::Internal(message(panic.as_ref())))
}

fn message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "a panic without a message".into())
}

/// An exception of the package by its name, with attributes.
pub fn exception(py: Python<'_>, name: &str, text: &str, attributes: &[(&str, Py<PyAny>)]) -> PyErr {
    let make = || -> PyResult<PyErr> {
        let made = py.import("asperity._errors")?.getattr(name)?.call1((text,))?;
        attributes.iter().try_for_each(|(key, value)| made.setattr(*key, value))?;
        Ok(PyErr::from_value(made))
    };
    make().unwrap_or_else(|error| error)
}

/// The exception of an error.
pub fn raised(py: Python<'_>, error: &Error) -> PyErr {
    raised_with(py, error, &[])
}

/// The exception of an error, with attributes.
pub fn raised_with(py: Python<'_>, error: &Error, attributes: &[(&str, Py<PyAny>)]) -> PyErr {
    let name = match error {
        Error::Input(_) => "DeckError",
        Error::File { .. } | Error::Write { .. } => "ResultError",
        Error::NotConverged(_) => "ConvergenceError",
        Error::Stopped => "Stopped",
        Error::Internal(_) => "InternalError",
    };
    exception(py, name, &error.to_string(), attributes)
}

/// The exception of a deck in error, with its rendered messages and each of them as a dict.
pub fn refused(py: Python<'_>, diagnostics: &Diagnostics) -> PyErr {
    match messages(py, diagnostics) {
        Ok(list) => exception(py, "DeckError", &diagnostics.render(false), &[("messages", list.into_any().unbind())]),
        Err(error) => error,
    }
}

fn messages<'py>(py: Python<'py>, diagnostics: &Diagnostics) -> PyResult<Bound<'py, PyList>> {
    let one = |diagnostic: &Diagnostic| -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        let severity = match diagnostic.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        };
        dict.set_item("severity", severity)?;
        dict.set_item("text", &diagnostic.what)?;
        dict.set_item("label", &diagnostic.label)?;
        dict.set_item("help", diagnostic.help.clone())?;
        let place = diagnostic.place.and_then(|place| Some((place, diagnostics.sources.get(place.source)?)));
        let line = place.map(|(place, source)| {
            let before = source.text.as_bytes().iter().take(place.start).filter(|&&byte| byte == b'\n').count();
            source.first_line + before
        });
        dict.set_item("file", place.map(|(_, source)| source.name.clone()))?;
        dict.set_item("line", line)?;
        Ok(dict)
    };
    PyList::new(py, diagnostics.list.iter().map(one).collect::<PyResult<Vec<_>>>()?)
}

/// Warns, at the line of the caller.
pub fn warn(py: Python<'_>, category: &str, text: &str) -> PyResult<()> {
    let category = py.import("asperity._errors")?.getattr(category)?;
    py.import("warnings")?.call_method1("warn", (PyString::new(py, text), category, 1)).map(drop)
}
