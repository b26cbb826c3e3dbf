//! Asperity for Python: the module `asperity._native`, which the package `asperity` shows to its users.
//!
//! | file | what |
//! | --- | --- |
//! | `deck` | a deck from a file, a dict, arrays; the model that it makes |
//! | `run` | a run, increment by increment |
//! | `state` | an accepted state and its fields |
//! | `arrays` | numbers to NumPy and back |
//! | `point` | one driven point |
//! | `trouble` | exceptions; what stops panics |
//!
//! The classes are documented for their users in `asperity/_native.pyi`. Nothing here computes.
#![warn(missing_docs)]

mod arrays;
mod course;
mod deck;
mod point;
mod run;
mod state;
mod trouble;

use pyo3::prelude::*;

/// The native module.
#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<deck::Model>()?;
    module.add_class::<deck::Check>()?;
    module.add_class::<run::Run>()?;
    module.add_class::<state::Snapshot>()?;
    module.add_function(wrap_pyfunction!(point::point, module)?)
}
