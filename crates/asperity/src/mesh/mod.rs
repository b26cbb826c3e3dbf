//! Nodes, cells and named groups: what is computed on, and nothing of mechanics.

pub mod cells;
mod mesh;

pub use cells::{Cell, Face, Rule};
pub use mesh::{CellView, Group, Mesh, Side};
