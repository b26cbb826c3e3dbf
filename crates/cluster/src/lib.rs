//! The linear systems of a run, shared out among the ranks of a cluster: `mpirun -n N asperity run DECK`.
//!
//! Every rank reads the deck and holds the whole model, its state and its histories. It evaluates what it owns (`system::Shares` of the
//! core says the rule) and holds its own rows of the matrix, in the bits that one rank alone would find. Those it hands to MUMPS, which
//! factorises with all ranks together, or to PETSc as a deck says; of forces and solutions each gets the whole, in the bits of the rank that
//! found them. So all ranks decide alike, and the first alone writes.
//!
//! Bindings are generated from the headers that are installed (`build.rs`). With `umat` and `frontal`'s METIS this is the
//! only crate of the workspace with `unsafe`; it stands outside the default members, since it needs PETSc and MPI.
#![warn(missing_docs)]
#![deny(unsafe_op_in_unsafe_fn)]

mod engine;
mod memory;
mod mumps;
mod petsc;
mod ranks;
mod rows;

use asperity_core::system::Communicator;

pub use engine::Petsc;
pub use ranks::{Ranks, launched, start};

/// Has runs solve their linear systems by PETSc, and lets decks say how; where there are several ranks, each evaluates its share.
pub fn provide() {
    asperity_core::solve::engine::provide(|problem| Box::new(Petsc::new(problem)), others);
}

/// The ranks that share a run, where there are several.
pub fn others() -> Option<&'static dyn Communicator> {
    start().ok().filter(|ranks| ranks.size() > 1).map(|ranks| ranks as &dyn Communicator)
}
