//! What is added to the geometric penetration before a law sees it, besides multipliers: overlap that is removed little by
//! little, and wear.
//!
//! A point that penetrates by `g_0` before the first increment may be pressed apart over the time `T` of a step: the law
//! sees `u - (1 - t / T) g_0`. A surface that wears recedes by Archard's depth, the coefficient times the sum of pressure
//! times sliding, at the last accepted state: `u - k sum p ds` (Archard, J. Appl. Phys. 24, 1953).

use super::record::entry;
use crate::system::Instant;

/// What becomes of penetration before the first increment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Overlap {
    /// It presses from the first increment on.
    Keep,
    /// It is removed over this time from the start.
    Ramp(f64),
    /// The surfaces are meant to fit: what stands between them before the first increment counts as none for good.
    Fit,
}

/// Archard's wear of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wear {
    /// Depth for a unit of pressure times sliding.
    pub coefficient: f64,
    /// Whether the surface recedes by it.
    pub recedes: bool,
}

impl Overlap {
    /// Takes the overlap of a point into its first history; up to `least` it is none.
    pub fn begin(&self, values: &mut [f64], least: f64) {
        if !matches!(self, Self::Keep) && values[entry::PENETRATION] > least {
            values[entry::OVERLAP] = values[entry::PENETRATION];
            values[entry::CLOSURE] = -values[entry::PENETRATION];
        }
    }

    /// The part that is removed at the beginning and at the end of an increment.
    pub fn settled(&self, at: Instant) -> [f64; 2] {
        match self {
            Self::Keep => [1.0; 2],
            Self::Fit => [0.0; 2],
            Self::Ramp(time) => [at.time - at.dt, at.time].map(|t| (t / time).clamp(0.0, 1.0)),
        }
    }
}

/// What overlap and wear add to the penetration of a point, from its accepted history.
pub fn recession(wear: Option<Wear>, settled: f64, old: &[f64]) -> f64 {
    let worn = wear.filter(|wear| wear.recedes).map_or(0.0, |wear| wear.coefficient * old[entry::RUBBED]);
    -(1.0 - settled) * old[entry::OVERLAP] - worn
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_overlap_goes_with_the_time() {
        let (overlap, mut values) = (Overlap::Ramp(4.0), vec![0.0; entry::COUNT]);
        values[entry::PENETRATION] = 0.2;
        overlap.begin(&mut values, 0.1);
        assert_eq!((values[entry::OVERLAP], values[entry::CLOSURE]), (0.2, -0.2));
        let at = Instant { time: 1.0, dt: 1.0, ..Instant::default() };
        assert_eq!(overlap.settled(at), [0.0, 0.25]);
        assert!((recession(None, 0.25, &values) + 0.15).abs() < 1e-16);
        assert_eq!(overlap.settled(Instant { time: 9.0, dt: 1.0, ..at }), [1.0; 2]);
        values[entry::OVERLAP] = 0.0;
        overlap.begin(&mut values, 0.3);
        assert_eq!(values[entry::OVERLAP], 0.0);
    }

    #[test]
    fn wear_recedes_only_when_it_is_to() {
        let mut values = vec![0.0; entry::COUNT];
        values[entry::RUBBED] = 50.0;
        let wear = |recedes| Some(Wear { coefficient: 1e-3, recedes });
        assert_eq!((recession(wear(true), 1.0, &values), recession(wear(false), 1.0, &values)), (-0.05, 0.0));
    }
}
