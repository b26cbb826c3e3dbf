//! Stresses before the first increment.

use crate::form::{Form, number, one_of, table, table_of};
use crate::source::Spot;
use asperity_core::declare::{Range, unit};
use asperity_core::solid::InitialStress;

one_of! {
    /// A stress field, tension positive.
    pub enum InitialStressKeys {
        /// The same stress everywhere.
        Uniform(UniformStress) = "uniform" => table_of::<UniformStress>(),
        /// That of ground under its own weight below a level surface, y upwards.
        Geostatic(Geostatic) = "geostatic" => table_of::<Geostatic>(),
    }
}

table! {
    /// Components of a stress, tension positive.
    pub struct UniformStress {
        /// Normal stress along x.
        xx: f64 = number(unit::STRESS, Range::ANY).or("0.0"),
        /// Normal stress along y.
        yy: f64 = number(unit::STRESS, Range::ANY).or("0.0"),
        /// Normal stress along z: across the plane, around the axis.
        zz: f64 = number(unit::STRESS, Range::ANY).or("0.0"),
        /// Shear stress.
        xy: f64 = number(unit::STRESS, Range::ANY).or("0.0"),
        /// Shear stress, in space.
        yz: Option<Spot<f64>> = number(unit::STRESS, Range::ANY).spot().unless_given("0"),
        /// Shear stress, in space.
        xz: Option<Spot<f64>> = number(unit::STRESS, Range::ANY).spot().unless_given("0"),
    }
}

table! {
    /// Ground under its own weight: vertical pressure `surcharge + unit_weight (surface - y)`, horizontal `k0` times it.
    pub struct Geostatic {
        /// Height y of the surface.
        surface: f64 = number(unit::LENGTH, Range::ANY).required(),
        /// Pressure on the surface.
        surcharge: f64 = number(unit::STRESS, Range::NOT_NEGATIVE).or("0.0"),
        /// Weight of a unit of volume: `density` times gravity.
        unit_weight: f64 = number(unit::BODY_FORCE, Range::NOT_NEGATIVE).required(),
        /// Horizontal stress over vertical stress (K0).
        k0: f64 = number(unit::NONE, Range::NOT_NEGATIVE).required(),
    }
}

impl InitialStressKeys {
    /// The field, of heights from an origin.
    pub fn field(&self, from: f64) -> InitialStress {
        let or_zero = |shear: Option<Spot<f64>>| shear.map_or(0.0, |shear| shear.value);
        match self {
            Self::Uniform(s) => InitialStress::Uniform([s.xx, s.yy, s.zz, s.xy, or_zero(s.yz), or_zero(s.xz)]),
            Self::Geostatic(Geostatic { surface, surcharge, unit_weight, k0, .. }) => InitialStress::Geostatic {
                surface: surface - from,
                surcharge: *surcharge,
                unit_weight: *unit_weight,
                k0: *k0,
            },
        }
    }

    /// A shear that only a model in space has.
    pub fn across_the_plane(&self) -> Option<Spot<f64>> {
        match self {
            Self::Uniform(stress) => stress.yz.or(stress.xz),
            Self::Geostatic(_) => None,
        }
    }
}
