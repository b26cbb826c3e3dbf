//! Whether the iterations of an attempt still lead to its end.
//!
//! Newton's method near a solution takes whole steps and makes the unbalanced forces a small part of those in play within a few.
//! Iterations that leave them large, no smaller than they were before, and must shorten their steps, wander: a smaller increment
//! costs less than the rest of them.

use super::constants::progress::{FALL, LARGE, SHORT, WINDOW};

/// The iterations of a sequence: what each left of the unbalanced forces over those in play, and the part of Newton's step that led
/// there.
#[derive(Debug, Default)]
pub(super) struct Progress {
    ratios: Vec<f64>,
    parts: Vec<f64>,
}

impl Progress {
    /// Remembers an iteration; the first of a sequence is that of its first guess.
    pub fn push(&mut self, first: bool, ratio: f64, part: f64) {
        if first {
            *self = Self::default();
        }
        self.ratios.push(ratio);
        self.parts.push(part);
    }

    /// Whether the last iterations wander.
    pub fn wanders(&self) -> bool {
        let Some(start) = self.ratios.len().checked_sub(WINDOW).filter(|start| *start > 1) else { return false };
        let least = |ratios: &[f64]| ratios.iter().copied().fold(f64::INFINITY, f64::min);
        let (before, now) = (least(&self.ratios[1..start]), least(&self.ratios[start..]));
        let shortened = self.parts[start..].iter().filter(|part| **part < SHORT).count();
        now > LARGE && now > FALL * before && 2 * shortened > WINDOW
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wanders(iterations: &[(f64, f64)]) -> Option<usize> {
        let mut progress = Progress::default();
        let mut lost = |(i, &(ratio, part)): (usize, &(f64, f64))| {
            progress.push(i == 0, ratio, part);
            progress.wanders().then_some(i)
        };
        iterations.iter().enumerate().find_map(&mut lost)
    }

    #[test]
    fn forces_that_stay_large_over_shortened_steps_are_given_up() {
        let attempt: Vec<(f64, f64)> = [(1e-2, 0.0), (0.9, 1.0)].into_iter().chain([(0.8, 0.1); 20]).collect();
        assert_eq!(wanders(&attempt), Some(1 + WINDOW));
    }

    #[test]
    fn whole_steps_falling_forces_and_small_ones_are_not() {
        let whole: Vec<(f64, f64)> = [(1.0, 0.0)].into_iter().chain([(0.9, 1.0); 20]).collect();
        let falling: Vec<(f64, f64)> = (0..20).map(|i| (0.8_f64.powi(i), 0.1)).collect();
        let small: Vec<(f64, f64)> = [(1.0, 0.0)].into_iter().chain([(1e-4, 0.1); 20]).collect();
        assert_eq!([wanders(&whole), wanders(&falling), wanders(&small)], [None; 3]);
    }
}
