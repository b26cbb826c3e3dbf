//! Rigid tools: profiles of smooth segments, moved by the unknowns of a reference node; in space, facets ([`space`]).
//!
//! A profile is drawn with the tool's material on its left. Its segments stand in the tool's own frame for ever; a ray
//! is carried into that frame by the inverse of the tool's [`Pose`], so no motion can accumulate rounding. What a ray
//! meets, [`select`] judges by the paper's two rules against false contacts. This room knows neither meshes nor laws.

mod check;
mod distance;
mod facet;
mod fillet;
mod finding;
mod pose;
mod search;
mod select;
pub mod shapes;
pub mod space;
mod tips;
#[allow(clippy::module_inception)]
mod tool;

#[cfg(test)]
mod conformance;
#[cfg(test)]
mod tests;

pub use distance::{NearestPoint, PieceEnd, SmoothPiece};
pub use fillet::{Draft, rounded};
pub use finding::{FindingSeverity, ProfileFinding};
pub use pose::Pose;
pub use search::BoxTree;
pub use select::{Rejected, Rules, select};
pub use shapes::{ProfileRay, ProfileShape, ShapeKind};
pub use tips::Tip;
pub use tool::{Chain, FacetTool, Hit, ProfileTool};
