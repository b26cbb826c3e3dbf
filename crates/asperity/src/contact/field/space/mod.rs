//! What the field has in space alone: the tangents of a point, the parts of two faces that see each other with their
//! quadrature, and the search.

mod overlap;
mod polygon;
mod search;
mod spot;
mod triad;

pub use overlap::{FacePart, Spread, spread};
pub use spot::FaceSpot;
pub use triad::MaterialLine;
