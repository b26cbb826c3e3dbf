//! Whether the iterations of an attempt still lead to its end.
//!
//! Newton's method near a solution takes whole steps and makes the unbalanced forces a small part of those in play within a few.
//! Iterations that leave them large, no smaller than they were before, and must shorten their steps, wander: a smaller increment
//! costs less than the rest of them. So do those over which contact finds no states that would balance the linear step: what they
//! change then is no more than a guess. Where bodies flow a few iterations tell: those that do not bring the unbalanced forces down soon
//! lead into deformations that no increment has, and from there to no end.

use super::constants::progress::{FALL, LARGE, LOST, SHORT, SOON, STILL, WINDOW};

/// The iterations of a sequence: what each left of the unbalanced forces over those in play, the part of Newton's step that led
/// there, and over how many steps contact found no states.
#[derive(Debug, Default)]
pub(super) struct Progress {
    ratios: Vec<f64>,
    parts: Vec<f64>,
    lost: usize,
}

impl Progress {
    /// Remembers an iteration; the first of a sequence is that of its first guess.
    pub fn push(&mut self, first: bool, ratio: f64, (part, lost): (f64, bool)) {
        if first {
            *self = Self::default();
        } else {
            self.lost += usize::from(lost);
        }
        self.ratios.push(ratio);
        self.parts.push(part);
    }

    /// Whether the last iterations wander, where bodies flow or not.
    pub fn wanders(&self, flows: bool) -> bool {
        let astray = self.ratios.len() > SOON && self.ratios.last().is_some_and(|ratio| *ratio > STILL);
        if self.lost >= LOST || flows && astray {
            return true;
        }
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
            progress.push(i == 0, ratio, (part, false));
            progress.wanders(false).then_some(i)
        };
        iterations.iter().enumerate().find_map(&mut lost)
    }

    #[test]
    fn forces_that_stay_large_over_shortened_steps_are_given_up() {
        let attempt: Vec<(f64, f64)> = [(1e-2, 0.0), (0.9, 1.0)].into_iter().chain([(0.8, 0.1); 20]).collect();
        assert_eq!(wanders(&attempt), Some(1 + WINDOW));
    }

    #[test]
    fn a_second_step_without_states_of_contact_is_the_last() {
        let mut progress = Progress::default();
        let mut wanders = |first, lost| {
            progress.push(first, 0.1, (1.0, lost));
            progress.wanders(false)
        };
        // What led to the first iterate belongs to no step of the sequence.
        assert_eq!(
            [(true, true), (false, true), (false, false), (false, true)].map(|(f, l)| wanders(f, l)),
            [false, false, false, true]
        );
    }

    #[test]
    fn forces_that_stay_large_are_given_up_soon_where_bodies_flow() {
        let given_up = |flows, ratios: &[f64]| {
            let mut progress = Progress::default();
            let mut push = |(i, &ratio): (usize, &f64)| {
                progress.push(i == 0, ratio, (1.0, false));
                progress.wanders(flows).then_some(i)
            };
            ratios.iter().enumerate().find_map(&mut push)
        };
        assert_eq!(given_up(true, &[0.9; 20]), Some(SOON));
        assert_eq!(given_up(true, &[0.9, 0.9, 0.9, 0.9, 0.05, 0.2]), Some(5));
        assert_eq!([given_up(false, &[0.9; 20]), given_up(true, &[0.9, 0.9, 0.9, 0.9, 0.05, 1e-3])], [None; 2]);
    }

    #[test]
    fn whole_steps_falling_forces_and_small_ones_are_not() {
        let whole: Vec<(f64, f64)> = [(1.0, 0.0)].into_iter().chain([(0.9, 1.0); 20]).collect();
        let falling: Vec<(f64, f64)> = (0..20).map(|i| (0.8_f64.powi(i), 0.1)).collect();
        let small: Vec<(f64, f64)> = [(1.0, 0.0)].into_iter().chain([(1e-4, 0.1); 20]).collect();
        assert_eq!([wanders(&whole), wanders(&falling), wanders(&small)], [None; 3]);
    }
}
