//! What the field has in space alone: the parts of two faces that see each other with their quadrature.

mod cut;
mod overlap;
mod polygon;

pub use cut::{CutFace, SeenNodes, nearby};
pub use overlap::{DIRECTIONS, PolygonPart, Spread, foot, spread, whole};
pub use polygon::{INTEGRALS, PartMap};
