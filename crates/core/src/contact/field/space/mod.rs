//! What the field has in space alone: the parts of two faces that see each other with their quadrature, and the search.

mod overlap;
mod polygon;
mod search;

pub use overlap::{DIRECTIONS, FacePart, Spread, spread, whole};
