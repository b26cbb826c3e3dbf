//! Laws of solids: from the deformation of an increment to the Cauchy stress, with its exact derivative.
//!
//! A law is written once, generic over the scalar: a [`RateLaw`] works on the rotated stress of an objective frame.
//! [`Rate`] turns it into a [`Material`], the object that bodies hold. Laws know no element, no mesh and no contact.
//!
//! To add a law: its file in `laws/`, its `mod` line and its line in [`laws::ALL`].

mod law;
pub mod laws;
mod rate;

pub use crate::declare::{Variable, VariableKind};
pub use law::{Directions, Gradient, Material};
pub use rate::{Rate, RateLaw, Vars, hughes_winget};
