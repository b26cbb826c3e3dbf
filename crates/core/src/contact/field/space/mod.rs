//! What the field has in space alone: the parts of two faces that see each other with their quadrature.

mod overlap;
mod polygon;

pub use overlap::{DIRECTIONS, PolygonPart, Spread, spread, whole};
