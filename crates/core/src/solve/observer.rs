//! What a run tells while it goes: the library prints nothing.

use super::{Turn, Worst};
use crate::FailureKind;
use crate::system::State;

/// One iteration.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct IterationRecord {
    /// Number within the attempt, from zero: the state before the first solution.
    pub iteration: usize,
    /// How often multipliers had been improved before it.
    pub augmentation: usize,
    /// Largest ratio of an unbalanced force to its yardstick.
    pub residual: f64,
    /// Ratio it must not exceed.
    pub tolerance: f64,
    /// Ratio that the rounding of positions may leave.
    pub rounding: f64,
    /// Largest change of a displacement by the last solution over the largest change in the increment.
    pub correction: f64,
    /// Part of the last solution that the line search took.
    pub step: f64,
    /// Unknown with the largest ratio.
    pub worst: Worst,
    /// For each term, how many stencils are on each branch; empty for terms with one branch.
    pub branches: Vec<Vec<usize>>,
    /// Stencils whose branch or discrete choice changed since the iteration before.
    pub changes: usize,
    /// Whether a matrix was factorised for the last solution.
    pub factorised: bool,
    /// The stencil that changed, if few did: (term, stencil).
    pub changed: Option<(usize, usize)>,
}

/// One attempt at an increment, finished.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct AttemptRecord {
    /// Step, from zero.
    pub step: usize,
    /// The increment attempted, from one, over all steps.
    pub increment: usize,
    /// Number of the attempt at it, from one.
    pub attempt: usize,
    /// Time at its end, in the step.
    pub step_time: f64,
    /// Time at its end, since the start.
    pub time: f64,
    /// Its length.
    pub dt: f64,
    /// Whether it is a relaxation to an equilibrium beyond an instability.
    pub relaxed: bool,
    /// Its iterations, beginning with the state before the first solution.
    pub iterations: Vec<IterationRecord>,
    /// Why it was given up, if it was.
    pub failure: Option<String>,
    /// What of.
    pub kind: FailureKind,
    /// Whether it went through a bifurcation or a limit point.
    pub turn: Option<Turn>,
}

impl AttemptRecord {
    /// Number of solutions that were computed.
    pub fn solutions(&self) -> usize {
        self.iterations.len().saturating_sub(1 + self.augmentations())
    }

    /// How often multipliers were improved.
    pub fn augmentations(&self) -> usize {
        self.iterations.last().map_or(0, |last| last.augmentation)
    }

    /// Number of solutions before multipliers were improved: what the increment itself asked for.
    pub fn first_solutions(&self) -> usize {
        self.iterations.iter().filter(|line| line.augmentation == 0).count().saturating_sub(1)
    }

    /// The iterations since multipliers were last improved, the last one first.
    fn since_augmentation(&self) -> impl Iterator<Item = &IterationRecord> {
        let last = self.augmentations();
        self.iterations.iter().rev().take_while(move |line| line.augmentation == last)
    }

    /// Order of convergence at the end: a step of length `c` leaves a residual `r` of the order of `c^p`, hence
    /// `p = ln(r2 / r1) / ln(c2 / c1)`, over the last two whole steps whose residuals are above rounding. `None` where
    /// a branch or discrete choice changed. It needs no common measure of stiff and soft directions,
    /// which residuals alone lack: compare [`residual_order`](Self::residual_order).
    pub fn order(&self) -> Option<f64> {
        let above = self.since_augmentation().skip_while(|i| i.residual <= i.rounding).collect::<Vec<_>>();
        let [second, first, ..] = above.as_slice() else { return None };
        let whole = first.step == 1.0 && second.step == 1.0;
        let falls = second.residual < first.residual && second.correction < first.correction;
        let steady = second.changes == 0 && first.iteration > 0;
        let order = || (second.residual / first.residual).ln() / (second.correction / first.correction).ln();
        (whole && falls && steady).then(order)
    }

    /// Order of convergence, fitted on the last three residuals above `1e-12` over which no branch and no discrete
    /// choice changed: `ln(r3/r2) / ln(r2/r1)`. `None` where there are not three such.
    pub fn residual_order(&self) -> Option<f64> {
        let above = self.since_augmentation().skip_while(|i| i.residual <= 1e-12).collect::<Vec<_>>();
        let [third, second, first, ..] = above.as_slice() else { return None };
        let steady = third.changes == 0 && second.changes == 0 && first.iteration > 0;
        let falls = third.residual < second.residual && second.residual < first.residual;
        let order = || (third.residual / second.residual).ln() / (second.residual / first.residual).ln();
        (steady && falls).then(order)
    }
}

/// Listens to a run, and may ask it to stop.
pub trait Observer {
    /// An iteration was evaluated.
    fn iteration(&mut self, _attempt: &AttemptRecord, _iteration: &IterationRecord) {}
    /// An attempt ended, well or not.
    fn attempt(&mut self, _attempt: &AttemptRecord) {}
    /// An increment was accepted.
    ///
    /// # Errors
    /// An error of writing results stops the run.
    fn accepted(&mut self, _state: &State, _attempt: &AttemptRecord) -> Result<(), crate::Error> {
        Ok(())
    }
    /// Whether the run should stop at the last accepted state; asked before each increment and between iterations.
    fn wants_stop(&self) -> bool {
        false
    }
    /// Whether it stops there, where something else asks for it or does not: every process asks at the same places, so that
    /// several may agree.
    fn stops(&self, asked: bool) -> bool {
        asked || self.wants_stop()
    }
    /// The run has come to its end, whatever that is; what is left is to write its results.
    fn ended(&mut self) {}
}

/// Listens to nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Observer for Silent {}
