//! Steps, what is prescribed in them, and the size of increments.

use super::constants::sizes::{AIM, EASY, GROWTH, MOST_PATIENCE, PATIENCE, SHORT, UNEVEN, USUAL};
use crate::amplitude::Amplitude;
use crate::system::{Caution, Constraints};

/// How a prescribed value runs over a step.
#[derive(Debug, Clone, PartialEq)]
pub enum Course {
    /// It stays what it was when the step began.
    Hold,
    /// It goes from what it was to this value along an amplitude.
    To(f64, Amplitude),
}

impl Course {
    /// The value at a time of the step.
    pub fn at(&self, start: f64, step_time: f64, duration: f64) -> f64 {
        let Self::To(end, amplitude) = self else { return start };
        match amplitude.value(step_time / duration) {
            // The end itself, not the end up to rounding.
            1.0 => *end,
            part => start + (end - start) * part,
        }
    }
    /// The course of a multiple of the value.
    pub fn scaled(&self, factor: f64) -> Self {
        match self {
            Self::Hold => Self::Hold,
            Self::To(end, amplitude) => Self::To(end * factor, amplitude.clone()),
        }
    }
}

/// A prescribed unknown, or the prescribed part of a combined one.
#[derive(Debug, Clone, PartialEq)]
pub struct Prescribed {
    /// The unknown: its row of the [`Constraints`] is fixed or combined.
    pub dof: usize,
    /// The combination subtracted from it before comparison: `u_dof - sum c u_other` is what is prescribed. Empty for
    /// a simple one.
    pub others: Vec<(usize, f64)>,
    /// How the value runs.
    pub course: Course,
}

impl Prescribed {
    /// The present value of what is prescribed.
    pub fn value(&self, u: &[f64]) -> f64 {
        u[self.dof] - self.others.iter().map(|&(other, c)| c * u[other]).sum::<f64>()
    }
}

/// Sizes of increments, as parts of the step's duration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Increments {
    /// The first.
    pub first: f64,
    /// The largest.
    pub largest: f64,
    /// The smallest; below it the run gives up.
    pub smallest: f64,
    /// The largest number of increments.
    pub most: usize,
}

/// Part of its step below which an increment is given up whatever the deck says: the load then changes by so little that
/// rounding decides whether it converges, and a run would creep on for ever.
pub const SMALLEST: f64 = 1e-12;

impl Default for Increments {
    fn default() -> Self {
        Self { first: 0.1, largest: 0.1, smallest: 1e-6, most: 10_000 }
    }
}

/// How a step follows a path of equilibria: its load factor is an unknown, increments are lengths of the path.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ArcLength {
    /// Where the step ends; where the load factor is one if nothing is said.
    pub until: Option<Until>,
    /// Whether increments become longer than the largest of the step where they move little.
    pub grows: bool,
}

/// The displacement at which a step ends.
#[derive(Debug, Clone, PartialEq)]
pub struct Until {
    /// Unknowns of whose mean it is.
    pub dofs: Vec<usize>,
    /// That mean.
    pub value: f64,
}

/// One step of a run.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Step {
    /// The user's name for it.
    pub name: String,
    /// Its length in time.
    pub duration: f64,
    /// Sizes of its increments.
    pub increments: Increments,
    /// Amplitudes at whose bends its increments end.
    pub amplitudes: Vec<Amplitude>,
    /// How it follows a path; else loads and prescribed motion go with time.
    pub arc_length: Option<ArcLength>,
    /// Which unknowns are constrained.
    pub constraints: Constraints,
    /// What they are constrained to.
    pub prescribed: Vec<Prescribed>,
    /// Terms that it does without, ascending.
    pub idle: Vec<usize>,
    /// Terms that only the next step does without, ascending.
    pub leaving: Vec<usize>,
}

impl Step {
    /// A step of unit duration and usual increments that keeps all terms.
    pub fn new(name: &str, constraints: Constraints, prescribed: Vec<Prescribed>) -> Self {
        Self {
            name: name.into(),
            duration: 1.0,
            increments: Increments::default(),
            amplitudes: Vec::new(),
            arc_length: None,
            constraints,
            prescribed,
            idle: Vec::new(),
            leaving: Vec::new(),
        }
    }

    /// Whether a time of the step is its end, but for rounding.
    pub fn ends_at(&self, step_time: f64) -> bool {
        step_time >= self.duration * (1.0 - 1e-9)
    }

    /// Whether an increment may be halved.
    pub(super) fn may_halve(&self, dt: f64) -> bool {
        0.5 * dt >= self.increments.smallest.max(SMALLEST) * self.duration
    }

    /// Whether all increments are of one size that was said.
    pub fn is_given(&self) -> bool {
        self.increments.first == self.increments.largest
    }

    /// The size for which creep goes on so evenly as it may where it is `unevenness` for `dt`; none where that says nothing.
    pub(super) fn even(&self, dt: f64, unevenness: f64) -> Option<f64> {
        let free = unevenness > 0.0 && !self.is_given() && self.arc_length.is_none();
        free.then(|| (dt * AIM * UNEVEN / unevenness).max(self.increments.smallest.max(SMALLEST) * self.duration))
    }

    /// Size of the increment to try when the controller wants `wanted` and `done` of the step is behind: the rest of
    /// the step, or to where an amplitude bends, when that is near, and halves of the rest rather than a sliver at the end.
    pub fn next(&self, wanted: f64, done: f64) -> f64 {
        let largest = self.increments.largest * self.duration;
        if let Some(arc) = &self.arc_length {
            // How long the path is does not show before its end.
            return if arc.grows { wanted } else { wanted.min(largest) };
        }
        let wanted = wanted.min(largest);
        let rest = self.bend(wanted, done).map_or(self.duration, |part| part * self.duration) - done;
        if rest <= wanted * (1.0 + 1e-6) {
            rest
        } else if rest < 2.0 * wanted * (1.0 - 1e-6) {
            0.5 * rest
        } else {
            wanted
        }
    }

    /// Where an amplitude bends within two increments of size `wanted`, as a part of the step; where a given number of increments would
    /// have ended they end all the same.
    fn bend(&self, wanted: f64, done: f64) -> Option<f64> {
        let near = [done, done + 2.0 * wanted].map(|time| (time / self.duration).min(1.0));
        let first = self.increments.first;
        let given =
            (self.is_given() && !self.amplitudes.is_empty()).then(|| ((near[0] / first + 1e-6).floor() + 1.0) * first);
        self.amplitudes.iter().filter_map(|amplitude| amplitude.bend(near)).chain(given).reduce(f64::min)
    }

    /// Whether an amplitude bends where an increment of the second length follows one of the first at `done`.
    pub(super) fn turns_between(&self, done: f64, [last, dt]: [f64; 2]) -> bool {
        let near = [done - last, done + dt].map(|time| (time / self.duration).clamp(0.0, 1.0));
        self.amplitudes.iter().any(|amplitude| amplitude.bend(near).is_some())
    }

    /// The size that an increment `dt` from `done` on stands for where the controller wanted `wanted`: that, if an amplitude's bend cut
    /// it short.
    pub(super) fn served(&self, dt: f64, wanted: f64, done: f64) -> f64 {
        if self.bend(wanted, done).is_some() { dt.max(wanted) } else { dt }
    }

    /// What the controller wants after an increment of size `dt` that took `iterations` and moved some node by this part of the model's size.
    pub fn after(&self, dt: f64, wanted: f64, iterations: usize, moved: f64) -> f64 {
        let grows = self.arc_length.as_ref().is_some_and(|arc| arc.grows) && moved > 0.0;
        let largest = (self.increments.largest * self.duration).max(if grows { dt * SHORT / moved } else { 0.0 });
        if iterations > EASY { dt.min(wanted) } else { (GROWTH * dt.max(wanted.min(dt * GROWTH))).min(largest) }
    }
}

impl Caution {
    /// Takes note of a size that failed.
    pub(super) fn fail(&mut self, dt: f64) {
        let again = self.failed > 0.0 && self.rest == 0;
        self.patience = if again { (2 * self.patience).min(MOST_PATIENCE) } else { self.patience.max(PATIENCE) };
        (self.failed, self.rest) = (dt, self.patience);
    }

    /// The size after an increment of size `dt` where the controller wants `wanted`: no larger until enough have succeeded.
    pub(super) fn hold(&mut self, dt: f64, wanted: f64) -> f64 {
        if self.failed == 0.0 {
            return wanted;
        }
        if dt >= self.failed * (1.0 - 1e-9) {
            // That a relaxation of the step was in vain stays known.
            let vain = self.vain;
            self.forget();
            self.vain = vain;
            return wanted;
        }
        self.rest = self.rest.saturating_sub(1);
        if self.rest == 0 { wanted } else { dt.min(wanted) }
    }

    /// The size that serves in a step: the last that did, at most the first of the step and not far below it.
    pub(super) fn usual(&self, step: &Step) -> f64 {
        let first = step.increments.first * step.duration;
        if self.proven > 0.0 { self.proven.clamp(USUAL * first, first) } else { first }
    }

    /// Forgets what failed: it is passed.
    pub(super) fn forget(&mut self) {
        *self = Self { proven: self.proven, ..Self::default() };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn courses() {
        assert_eq!(Course::Hold.at(3.0, 0.5, 1.0), 3.0);
        assert_eq!(Course::To(5.0, Amplitude::ramp()).at(3.0, 0.5, 1.0), 4.0);
        assert_eq!(Course::To(0.3, Amplitude::ramp()).at(0.1, 2.0, 2.0), 0.3);
        assert_eq!(Course::To(5.0, Amplitude::ramp()).scaled(-2.0).at(3.0, 1.0, 1.0), -10.0);
    }

    #[test]
    fn a_size_that_failed_waits_and_waits_longer_when_it_fails_again() {
        let mut caution = Caution::default();
        assert_eq!(caution.hold(1.0, 1.5), 1.5, "nothing failed");
        caution.fail(1.0);
        assert_eq!([(); PATIENCE - 1].map(|()| caution.hold(0.5, 0.75)), [0.5; PATIENCE - 1]);
        assert_eq!(caution.hold(0.5, 0.75), 0.75, "after so many a larger one is tried");
        caution.fail(0.75);
        assert_eq!((caution.failed, caution.rest), (0.75, 2 * PATIENCE));
        assert_eq!(caution.hold(0.75, 1.125), 1.125, "passed");
        assert_eq!(caution, Caution::default());
        (caution.failed, caution.vain) = (1.0, true);
        caution.hold(1.0, 1.5);
        assert_eq!(caution, Caution { vain: true, ..Caution::default() }, "a relaxation in vain is not tried again");
    }

    #[test]
    fn no_sliver_remains_at_the_end_of_a_step() {
        let constraints = Constraints::new(0, &[], &[]);
        let increments = Increments { first: 0.3, largest: 0.3, ..Increments::default() };
        let step = Step {
            name: "s".into(),
            duration: 1.0,
            increments,
            amplitudes: vec![],
            arc_length: None,
            constraints,
            prescribed: Vec::new(),
            idle: vec![],
            leaving: vec![],
        };
        let (mut done, mut sizes) = (0.0, Vec::new());
        while done < 1.0 {
            sizes.push(step.next(0.3, done));
            done += sizes[sizes.len() - 1];
        }
        assert_eq!(sizes.len(), 4);
        assert!(sizes.iter().all(|&s| s > 0.19) && done == 1.0);
    }
}
