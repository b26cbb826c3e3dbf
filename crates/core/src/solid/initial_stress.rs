//! Stress fields before the first increment. They are in equilibrium with supports and loads where those are chosen so;
//! nothing then moves.

use crate::tensor::Vec3;

/// A stress field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum InitialStress {
    /// The same everywhere: XX YY ZZ XY YZ XZ.
    Uniform([f64; 6]),
    /// Of ground under its own weight below a level surface, y upwards:
    /// `s_yy = -(surcharge + unit_weight (surface - y))`, `s_xx = s_zz = k0 s_yy`.
    Geostatic {
        /// Height y of the surface.
        surface: f64,
        /// Pressure on the surface.
        surcharge: f64,
        /// Weight of a unit of volume.
        unit_weight: f64,
        /// Horizontal over vertical stress.
        k0: f64,
    },
}

impl InitialStress {
    /// The stress at a place: XX YY ZZ XY YZ XZ.
    pub fn at(&self, x: Vec3) -> [f64; 6] {
        match *self {
            Self::Uniform(stress) => stress,
            Self::Geostatic { surface, surcharge, unit_weight, k0 } => {
                let vertical = -(surcharge + unit_weight * (surface - x[1]));
                [k0 * vertical, vertical, k0 * vertical, 0.0, 0.0, 0.0]
            }
        }
    }
}
