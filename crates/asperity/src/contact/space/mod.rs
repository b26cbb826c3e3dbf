//! Contact in space between the faces of bodies and a rigid tool: the same element as in the plane, with two tangents.

mod capture;
mod geometry;
mod kink;
mod open;
mod pair;
mod point;
mod surface;

pub use pair::{Contact, Parts};
pub use surface::{Face, Surface};
