//! The linear systems of a run, shared out among the ranks of a cluster: `mpirun -n N asperity run DECK`.
//!
//! Every rank reads the deck, holds the whole model and evaluates it, and so comes to the same matrix, to the bit. Of that
//! matrix it hands its own rows to PETSc, which factorises or preconditions it with all ranks together; of the solution each
//! gets the whole, in the bits of the rank that found it. So all ranks decide alike, and the first alone writes.
//!
//! Bindings are generated from the headers that are installed (`build.rs`). With `umat` and `frontal`'s METIS this is the
//! only crate of the workspace with `unsafe`; it stands outside the default members, since it needs PETSc and MPI.
#![warn(missing_docs)]
#![deny(unsafe_op_in_unsafe_fn)]

mod engine;
mod petsc;
mod ranks;
mod rows;

pub use engine::{DIRECT, Petsc};
pub use ranks::{Ranks, launched, start};

/// Has runs solve their linear systems by PETSc, and lets decks say how.
pub fn provide() {
    asperity_core::solve::engine::provide(|problem| Box::new(Petsc::new(problem)));
}
