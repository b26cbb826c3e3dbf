//! Results: one store of quantities a frame, and the files, tables and pictures made from it. Layer 6; it reads the
//! model and its state and never changes them, so that asking for an output cannot change a solution.

pub mod file;
mod quantity;
pub mod vtk;

pub use quantity::{Frame, Number, Place, Quantity, Unit, Width};
