//! The laws, one file each, and their registry.

mod cam_clay;
mod cone;
mod coulomb;
mod decay;
mod dilatant;
mod frictionless;
mod implicit;
mod oden_pires;
mod rate_state;
mod shear_limited;
mod sticking;
mod trial;

pub use cam_clay::CamClayInterface;
pub use cone::ConeScheme;
pub use coulomb::Coulomb;
pub use decay::{Decay, SlipDependent, StaticKinetic, VelocityDependent, WorkDependent};
pub use dilatant::Dilatant;
pub use frictionless::Frictionless;
pub use oden_pires::OdenPires;
pub use rate_state::{Evolution, RateState, StateCourse};
pub use shear_limited::{ShearLimited, Transition};
pub use sticking::Sticking;

use super::{Interface, Law};
use crate::declare::Entry;

/// Every law a deck may name.
pub static ALL: &[Entry<Box<dyn Interface>>] = &[
    frictionless::ENTRY,
    sticking::ENTRY,
    coulomb::ENTRY,
    dilatant::COHESIVE,
    dilatant::DILATANT,
    cam_clay::ENTRY,
    cam_clay::PRINTED,
    shear_limited::OROWAN,
    shear_limited::SMOOTH,
    shear_limited::SHAW,
    shear_limited::FACTOR_ONLY,
    decay::STATIC_KINETIC,
    decay::VELOCITY,
    decay::SLIP,
    decay::WORK,
    rate_state::AGEING,
    rate_state::SLIP,
    oden_pires::ENTRY,
];

/// A law as the object a registry hands out.
fn law<L: super::InterfaceLaw + 'static>(law: L) -> Box<dyn Interface> {
    Box::new(Law(law))
}

/// Refuses an update of a law whose increments are exact as they are.
fn nothing_to_integrate(why: &str) -> Result<Box<dyn Interface>, String> {
    Err(format!("{why}: there is nothing to sub-step; remove `update`"))
}
