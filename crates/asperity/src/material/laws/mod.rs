//! The laws, one file each, and their registry.

mod elastic;

pub use elastic::Elastic;

use super::{Material, Rate};
use crate::declare::Entry;

/// Every law a deck may name.
pub static ALL: &[Entry<Box<dyn Material>>] = &[elastic::ENTRY];

/// A rate law as the object a registry hands out.
fn rate<L: super::RateLaw + 'static>(law: L) -> Box<dyn Material> {
    Box::new(Rate(law))
}
