//! Laws of solids: from the deformation of an increment to the Cauchy stress, with its exact derivative.
//!
//! A law is written once, generic over the scalar: a [`RateLaw`] works on the rotated stress of an objective frame, a
//! [`HyperLaw`] on the left Cauchy-Green tensor. [`Rate`] and [`Hyper`] turn them into a [`Material`], the object that
//! bodies hold. Laws know no element, no mesh and no contact.
//!
//! To add a law: its file in `laws/`, its `mod` line and its line in [`laws::ALL`].

pub mod external;
mod frame;
mod green_naghdi;
mod hyper;
mod integrated;
mod law;
pub mod laws;
mod logarithmic;
mod memory;
mod rate;
mod small;
mod turned;
mod undrained;
mod vars;

pub use crate::declare::{Variable, VariableKind};
pub use external::{External, Placement};
pub use frame::hughes_winget;
pub use hyper::{Hyper, HyperLaw, Slopes};
pub use law::{Creep, Directions, Flow, Gradient, Lapse, Material};
pub use memory::{Memory, Mullins, TERMS as MOST_TERMS};
pub use rate::{Rate, RateLaw};
pub use small::SmallStrain;
pub use turned::{Spin, Turned};
pub use undrained::Undrained;
pub use vars::{ScalarsAndTensors, ScalarsAndVectors, Vars};
