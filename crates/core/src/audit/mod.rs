//! An independent check that no part of a body lies inside another body, inside itself or inside a tool, and that nothing
//! came through anything on its way: of the boundaries as they stand, over all surfaces, with and without a contact
//! declared. It shares no code with the search of `contact` and knows of it only how deep its penalties let points in.
//!
//! *Depth.* Every vertex and face centre of a boundary is looked for behind the nearest piece of each other boundary; that it
//! truly lies inside is decided by counting how often a way out leads out of the material and in. Points of tools are
//! looked for in bodies likewise, so that a sharp tool between two nodes is found.
//!
//! *Ways.* Between two accepted states vertices move straight, as do the pieces of bodies; tools move by their unknowns. A
//! point that goes in at one side and out at another that looks the other way came through; so did one that was deep in it
//! between, whatever the sides (*grazing*).
//!
//! Contacts explain depth up to the penetration that they report, facets of curved boundaries up to their sagittas, and what
//! overlapped before any motion up to that.

mod check;
mod grazing;
mod hierarchy;
mod inside;
mod rigid;
mod simplex;
mod surface;

pub use check::{Audit, Claim, Subject};
