//! Contact with friction: the element of Charlier & Habraken (1990) between a deformable surface and a target.
//!
//! Every integration point of the surface carries a triad, casts a ray along its inward normal, takes penetration and
//! slip from the place it hits, asks the interface law for pressure and shear, and loads its own nodes and the target.
//! Bodies, laws and tools are known here; other terms of equilibrium are strangers.

mod capture;
mod landmarks;
mod open;
mod pair;
mod penalty;
mod point;
mod record;
mod surface;

pub use pair::{Contact, ContactOptions};
pub use penalty::default_penalty;
pub use record::{PointRecord, PointStatus};
pub use surface::Surface;
