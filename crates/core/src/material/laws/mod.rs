//! The laws, one file each, and their registry.

mod arruda_boyce;
mod axes;
mod cam_clay;
mod drucker_prager;
mod drucker_prager_cap;
mod elastic;
mod gurson;
mod hardening;
mod hill;
mod invariants;
mod isochoric;
mod mohr_coulomb;
mod mooney_rivlin;
mod neo_hookean;
mod neo_hookean_compressible;
mod norton_hoff;
mod ogden;
mod orthotropic;
mod perzyna;
mod saint_venant_kirchhoff;
mod softening;
mod ubiquitous_joint;
mod von_mises;
mod yeoh;

pub use arruda_boyce::ArrudaBoyce;
pub use cam_clay::{CamClay, PressureCourse, Stiffness};
pub use drucker_prager::{Cone, DruckerPrager};
pub use drucker_prager_cap::Capped;
pub use elastic::Elastic;
pub use gurson::{Gurson, Nucleation};
pub use hardening::Hardening;
pub use hill::Hill;
pub use mohr_coulomb::MohrCoulomb;
pub use mooney_rivlin::MooneyRivlin;
pub use neo_hookean::NeoHookean;
pub use neo_hookean_compressible::NeoHookeanCompressible;
pub use norton_hoff::NortonHoff;
pub use ogden::Ogden;
pub use orthotropic::Orthotropic;
pub use perzyna::Perzyna;
pub use saint_venant_kirchhoff::SaintVenantKirchhoff;
pub use von_mises::{BackStress, VonMises};
pub use yeoh::Yeoh;

use super::{Hyper, HyperLaw, Material, Rate, RateLaw};
use crate::declare::Entry;

/// Every law a deck may name.
pub static ALL: &[Entry<Box<dyn Material>>] = &[
    elastic::ENTRY,
    orthotropic::ORTHOTROPIC,
    orthotropic::ANISOTROPIC,
    neo_hookean::ENTRY,
    neo_hookean_compressible::ENTRY,
    saint_venant_kirchhoff::ENTRY,
    ogden::ENTRY,
    mooney_rivlin::ENTRY,
    yeoh::ENTRY,
    arruda_boyce::ENTRY,
    von_mises::COMBINED,
    von_mises::SWIFT,
    von_mises::TABLE,
    von_mises::JOHNSON_COOK,
    von_mises::CHABOCHE,
    hill::COMBINED,
    hill::SWIFT,
    hill::TABLE,
    hill::JOHNSON_COOK,
    hill::GENERAL,
    perzyna::ENTRY,
    norton_hoff::ENTRY,
    drucker_prager::OUTER,
    drucker_prager::INNER,
    drucker_prager::PLANE_STRAIN,
    drucker_prager::HARDENING,
    drucker_prager_cap::ENTRY,
    mohr_coulomb::ENTRY,
    mohr_coulomb::HARDENING,
    cam_clay::ENTRY,
    cam_clay::CONSTANT_SHEAR,
    gurson::COMBINED,
    gurson::SWIFT,
    gurson::TABLE,
    gurson::JOHNSON_COOK,
    ubiquitous_joint::ENTRY,
];

/// A rate law as the object a registry hands out.
fn rate<L: RateLaw>(law: L) -> Box<dyn Material> {
    Box::new(Rate(law))
}

/// A hyperelastic law as the object a registry hands out.
fn hyper<L: HyperLaw>(law: L) -> Box<dyn Material> {
    Box::new(Hyper(law))
}
