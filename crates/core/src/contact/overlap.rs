//! What is added to the geometric penetration before a law sees it, besides multipliers: overlap that is removed little by
//! little, and wear.
//!
//! A point that penetrates by `g_0` before the first increment, or where its contact is added, may be pressed apart over the time `T`
//! of that step: the law sees `u - (1 - t / T) g_0`; where surfaces fit it never is, as if `T` were infinite. A surface that wears recedes by Archard's depth, the coefficient times the sum of pressure
//! times sliding up to the last accepted state: `u - k sum p ds` (Archard, J. Appl. Phys. 24, 1953). The law itself adds that of the increment.

use super::record::entry;
use crate::system::Instant;

/// What becomes of penetration before the first increment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Overlap {
    /// It presses from the first increment on.
    Keep,
    /// It is removed over the first step, which lasts so long, or over that in which the contact is added.
    Ramp(f64),
    /// The surfaces are meant to fit: what stands between them before the first increment counts as none for good.
    Fit,
}

impl Overlap {
    /// Takes the overlap of a point into its first history, with how much nearer the target lies than in the mean; up to `least` it is none. `added` is the time of the step in which the
    /// contact is there again, if it was not from the start.
    pub fn begin(&self, values: &mut [f64], least: f64, added: Option<[f64; 2]>) {
        let during = match (self, added) {
            // It presses from the next increment on, whose work it then is.
            (Self::Keep, added) => [added.map_or(0.0, |[since, _]| since); 2],
            (Self::Ramp(time), None) => [0.0, *time],
            (Self::Fit, _) => FOR_GOOD,
            (_, added) => added.unwrap_or_default(),
        };
        let overlap = values[entry::PENETRATION] + values[entry::NEARER];
        if overlap > least {
            values[entry::OVERLAP] = overlap;
            values[entry::CLOSURE] = values[entry::NEARER] - overlap;
            [values[entry::SINCE], values[entry::UNTIL]] = during;
        }
    }

    /// Takes the overlap of a point, negative for a gap, with how much nearer the target lies than in the mean, as none for good.
    pub fn fit(values: &mut [f64]) {
        values[entry::OVERLAP] = values[entry::PENETRATION] + values[entry::NEARER];
        values[entry::CLOSURE] = -values[entry::PENETRATION];
        [values[entry::SINCE], values[entry::UNTIL]] = FOR_GOOD;
    }

    /// Takes so deep an overlap as none for good, or forgets it again where it is zero.
    pub fn lay(values: &mut [f64], depth: f64) {
        let during = if depth > 0.0 { FOR_GOOD } else { [0.0; 2] };
        [values[entry::OVERLAP], values[entry::SINCE], values[entry::UNTIL]] = [depth, during[0], during[1]];
    }

    /// Whether what stands between a point and its target counts as none for good.
    pub fn fits(values: &[f64]) -> bool {
        values[entry::UNTIL] == f64::INFINITY
    }

    /// The part of a point's overlap that is removed at the beginning and at the end of an increment.
    pub fn settled(&self, old: &[f64], at: Instant) -> [f64; 2] {
        let [since, until] = [old[entry::SINCE], old[entry::UNTIL]];
        [at.time - at.dt, at.time].map(|t| match until > since {
            true => ((t - since) / (until - since)).clamp(0.0, 1.0),
            false => f64::from(u8::from(t > since + 0.5 * at.dt)),
        })
    }

    /// What overlap, and wear of this depth for a unit of rubbing, add to the penetration of a point at the end of an increment, from its
    /// accepted history.
    pub fn recession(&self, wear: f64, old: &[f64], at: Instant) -> f64 {
        -(1.0 - self.settled(old, at)[1]) * old[entry::OVERLAP] - wear * old[entry::RUBBED]
    }

    /// By how much the overlap of a point is reduced over an increment.
    pub fn removed(&self, old: &[f64], at: Instant) -> f64 {
        let [before, after] = self.settled(old, at);
        (after - before) * old[entry::OVERLAP]
    }
}

/// When an overlap is removed that never is.
const FOR_GOOD: [f64; 2] = [0.0, f64::INFINITY];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_overlap_goes_with_the_time() {
        let (overlap, mut values) = (Overlap::Ramp(4.0), vec![0.0; entry::COUNT]);
        values[entry::PENETRATION] = 0.2;
        overlap.begin(&mut values, 0.1, None);
        assert_eq!((values[entry::OVERLAP], values[entry::CLOSURE]), (0.2, -0.2));
        let at = Instant { time: 1.0, dt: 1.0, ..Instant::default() };
        assert_eq!(overlap.settled(&values, at), [0.0, 0.25]);
        assert!((overlap.recession(0.0, &values, at) + 0.15).abs() < 1e-16);
        assert!((overlap.removed(&values, at) - 0.05).abs() < 1e-16);
        assert_eq!(overlap.settled(&values, Instant { time: 9.0, dt: 1.0, ..at }), [1.0; 2]);
        values[entry::OVERLAP] = 0.0;
        overlap.begin(&mut values, 0.3, None);
        assert_eq!(values[entry::OVERLAP], 0.0);
    }

    /// Of a contact that is added it goes with that step, or at once.
    #[test]
    fn an_overlap_of_a_contact_that_is_added() {
        let at = Instant { time: 6.0, dt: 1.0, ..Instant::default() };
        for (overlap, settled) in [(Overlap::Ramp(4.0), [0.0, 0.25]), (Overlap::Keep, [0.0, 1.0])] {
            let mut values = vec![0.0; entry::COUNT];
            values[entry::PENETRATION] = 0.2;
            overlap.begin(&mut values, 0.1, Some([5.0, 9.0]));
            assert_eq!(values[entry::OVERLAP], 0.2);
            assert_eq!(overlap.settled(&values, at), settled);
        }
        let mut values = vec![0.0; entry::COUNT];
        values[entry::PENETRATION] = 0.2;
        Overlap::Keep.begin(&mut values, 0.1, None);
        assert_eq!(Overlap::Keep.settled(&values, Instant { time: 1.0, dt: 1.0, ..at }), [0.0, 1.0]);
    }

    #[test]
    fn wear_recedes() {
        let (mut values, at) = (vec![0.0; entry::COUNT], Instant::default());
        values[entry::RUBBED] = 50.0;
        assert_eq!([1e-3, 0.0].map(|wear| Overlap::Keep.recession(wear, &values, at)), [-0.05, 0.0]);
    }
}
