//! Nodes, cells and named groups: what is computed on, and nothing of mechanics.

mod boundary;
pub mod cells;
mod connected;
mod flat;
pub mod formats;
pub mod generate;
mod groups;
pub mod lint;
mod measure;
mod raise;
mod smooth;
mod space;
mod thickness;
mod unstructured;

pub use boundary::{Behind, Faces};
pub use cells::{Cell, Face, Quadrature};
pub use flat::{ROUNDING, flat_normal, is_curved, unit};
pub use groups::{Group, Side};
pub use measure::Adjacency;
pub use smooth::{ALONG, CREASE, arc_height, round_share};
pub use space::Space;
pub use thickness::median;
pub use unstructured::{CellView, Mesh, Numbers};
