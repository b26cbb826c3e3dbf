//! Contact in space between the faces of bodies, and with rigid tools: the same element as in the plane, with two
//! tangents.

mod averaged;
mod before;
mod border;
mod capture;
mod exit;
mod faces;
mod geometry;
mod guard;
mod kink;
mod nonlocal;
mod open;
mod pair;
mod passage;
mod patch;
mod placed;
mod point;
pub(in crate::contact) mod polygon;
mod rigid;
mod sampled;
mod search;
mod split;
mod surface;
mod target;
mod uzawa;
mod variational;

pub use faces::Faces;
pub use pair::{Contact, Parts};
pub use rigid::Rigid;
pub use surface::{Face, Surface};
pub use target::Target;
