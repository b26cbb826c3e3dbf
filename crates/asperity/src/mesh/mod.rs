//! Nodes, cells and named groups: what is computed on, and nothing of mechanics.

pub mod cells;
pub mod generate;
mod groups;
mod measure;
mod space;
mod unstructured;

pub use cells::{Cell, Face, Rule};
pub use groups::{Group, Side};
pub use measure::Adjacency;
pub use space::Space;
pub use unstructured::{CellView, Mesh};
