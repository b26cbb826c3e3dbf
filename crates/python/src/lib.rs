//! Asperity for Python: the module `asperity._native`, which the package `asperity` shows to its users.
//!
//! | file | what |
//! | --- | --- |
//! | `read` | a deck from a file, text, a dict, arrays |
//! | `model` | the model that it makes |
//! | `run` | a run, increment by increment |
//! | `work` | what a run does |
//! | `course` | a run of the library, held with its model |
//! | `state` | an accepted state and its fields |
//! | `arrays` | numbers to NumPy and back |
//! | `point` | one driven point |
//! | `trouble` | exceptions; what stops panics |
//!
//! The classes are documented for their users in `asperity/_native.pyi`. Nothing here computes.
#![warn(missing_docs)]

mod arrays;
mod course;
mod model;
mod point;
mod read;
mod run;
mod state;
mod trouble;
mod work;

use pyo3::prelude::*;

/// The native module.
#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<model::Model>()?;
    module.add_class::<model::Check>()?;
    module.add_class::<run::Run>()?;
    module.add_class::<state::Snapshot>()?;
    module.add_function(wrap_pyfunction!(point::point, module)?)
}
