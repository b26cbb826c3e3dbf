//! Nodes, cells and named groups: what is computed on, and nothing of mechanics.

pub mod cells;
pub mod generate;
mod groups;
mod measure;
mod unstructured;

pub use cells::{Cell, Face, Rule};
pub use groups::{Group, Side};
pub use measure::Adjacency;
pub use unstructured::{CellView, Mesh};
