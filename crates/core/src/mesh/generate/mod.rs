//! Structured generators: a rectangle, a sector of an annulus, a box, each graded as wanted, so that a first run needs
//! no mesher.
//!
//! A part is a lattice of bricks; every brick is tiled by one cell or, for triangles, tetrahedra and wedges, by
//! several. The nodes of second degree cells lie on half steps of the lattice, and each lattice point is mapped on its
//! own, so that mid-side nodes of an arc lie on the arc. A part named `NAME` brings the group `NAME` of its cells, one
//! group `NAME.SIDE` for each of its sides and one group of a single node for each of its corners. Nothing here knows
//! what the mesh is for.

mod annulus;
mod block;
mod lattice;
mod rectangle;
mod spacing;
mod tiling;

pub use annulus::Annulus;
pub use block::Block;
pub use rectangle::Rectangle;
pub use spacing::{Grade, Spacing, SpacingRun};

#[cfg(test)]
mod tests;
