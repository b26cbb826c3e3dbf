//! Rigid tools in space: facets moved by the six unknowns of a reference node.
//!
//! Facets are triangles, bilinear quadrilaterals, and segments of profiles that are revolved, extruded, or both along a path; they
//! stand in the tool's own frame for ever, and rays are carried into it. The rules of [`select`](super::select) choose among the hits.

mod check;
mod distance;
mod edges;
mod nearest;
mod path;
mod polygons;
pub mod solids;
mod swept;
#[cfg(test)]
mod tests;
mod tool;

pub use super::facet::{Meeting, ToolFacet};
pub use check::{FacetFinding, is_thin};
pub use distance::SmoothPieces;
pub use nearest::{FacetBorder, FacetPoint, RigidFacet};
pub use path::{SweepPath, swept};
pub use polygons::{Quad, Triangle};
pub use swept::ProfileFrame;
pub use tool::{SpaceTool, Tiles};
