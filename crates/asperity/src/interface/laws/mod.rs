//! The laws, one file each, and their registry.

mod cone;
mod coulomb;

pub use cone::ConeScheme;
pub use coulomb::Coulomb;

use super::{Interface, Law};
use crate::declare::Entry;

/// Every law a deck may name.
pub static ALL: &[Entry<Box<dyn Interface>>] = &[coulomb::ENTRY];

/// A law as the object a registry hands out.
fn law<L: super::InterfaceLaw + 'static>(law: L) -> Box<dyn Interface> {
    Box::new(Law(law))
}
