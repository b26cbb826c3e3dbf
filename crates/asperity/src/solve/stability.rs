//! Loss of stability, from the signs of the pivots: those of L D L^T have as many negative ones as the matrix has negative
//! eigenvalues (Sylvester's law of inertia), those of L U the sign of the determinant. Where these change from one accepted
//! increment to the next the path went through a bifurcation or a limit point. The eigenvalue nearest to zero is followed by one inverse iteration an increment, so
//! that where it changes its sign the time between can be told.

use super::linear::LinearSolver;
use super::observer::AttemptRecord;
use super::problem::Problem;
use super::step::norm;
use crate::system::{Signs, State};
use std::time::{Duration, Instant};

/// Inverse iterations on a mode that is followed, on one that is begun, and at most where the number of negative eigenvalues has
/// changed, where they end at this change of the eigenvalue.
const FOLLOWED: usize = 1;
const BEGUN: usize = 3;
const CHANGED: usize = 12;
const SETTLED: f64 = 1e-3;
/// Cosine of the angle between two vectors of the same mode, at least.
const SAME: f64 = 0.9;

/// A change of the number of negative eigenvalues of the tangent between two accepted states.
#[derive(Debug, Clone, PartialEq)]
pub struct Turn {
    /// Times of the states.
    pub times: [f64; 2],
    /// Negative eigenvalues at them,
    pub negative: [usize; 2],
    /// if they were counted; else one for a negative determinant, as that of an unsymmetric tangent.
    pub counted: bool,
    /// When the eigenvalue nearest to zero passes it, linear between the two, if it was followed.
    pub critical: Option<f64>,
    /// Its mode on all unknowns, the largest entry one.
    pub mode: Vec<f64>,
    /// The unknown that moves most, in words.
    pub largest: String,
}

impl std::fmt::Display for Turn {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let ([from, to], [before, after]) = (self.times, self.negative);
        let what =
            if after > before { "bifurcation or limit point" } else { "return from a bifurcation or limit point" };
        write!(f, "{what} between time {from:.5} and {to:.5}")?;
        if let Some(critical) = self.critical {
            write!(f, ", at about {critical:.5}")?;
        }
        match self.counted {
            true => write!(f, ": {before} negative eigenvalues of the stiffness before and {after} after")?,
            false => write!(f, ": the determinant of the stiffness changes its sign")?,
        }
        write!(f, "; the mode is largest at {}", self.largest)
    }
}

/// What is followed from one increment to the next.
#[derive(Debug, Default)]
pub struct Stability {
    /// Eigenvector nearest to the null space, of length one, over the free unknowns; empty at first.
    mode: Vec<f64>,
    eigenvalue: f64,
    /// Time of the state to which both belong.
    time: f64,
    /// Changes so far, without their modes.
    pub turns: Vec<Turn>,
    /// Time that it took.
    pub spent: Duration,
}

impl Stability {
    /// Looks at the factor of an attempt that is about to be accepted, where it has one of its own, and says whether the
    /// number of negative eigenvalues has changed since the last such.
    pub(super) fn look(
        &mut self,
        (problem, state): (&Problem, &mut State),
        record: &AttemptRecord,
        solver: &dyn LinearSolver,
    ) -> Option<Turn> {
        let fresh = !record.relaxed && record.iterations.iter().any(|line| line.factorised);
        let frontal::Signs { symmetric, negative } = solver.signs().filter(|_| fresh)?;
        let begun = Instant::now();
        let constraints = &problem.steps[record.step].constraints;
        let now = Signs { time: record.time, step: record.step, symmetric, negative };
        let last = state.signs.replace(now);
        let same = last.filter(|last| problem.steps[last.step].constraints.free() == constraints.free());
        let known = same.is_some_and(|last| last.time == self.time) && self.mode.len() == constraints.free_count();
        // Of what is not symmetric at both no more is known than whether the number is odd.
        let counted = same.is_some_and(|last| last.symmetric && symmetric);
        let changed =
            same.filter(|last| if counted { last.negative != negative } else { last.negative % 2 != negative % 2 });
        let before = (self.eigenvalue, self.mode.clone());
        if !known {
            // Something of every mode.
            self.mode =
                (0..constraints.free_count()).map(|k| ((k + 1) as f64 * 1.618_033_988_749_895).fract() - 0.5).collect();
        }
        let turned = self.iterate(
            solver,
            if changed.is_some() {
                CHANGED
            } else if known {
                FOLLOWED
            } else {
                BEGUN
            },
        );
        self.time = record.time;
        let turn = changed.filter(|_| turned).map(|last| {
            let cosine: f64 = before.1.iter().zip(&self.mode).map(|(a, b)| a * b).sum();
            let passes = known && cosine.abs() >= SAME && before.0 * self.eigenvalue < 0.0;
            let part = before.0 / (before.0 - self.eigenvalue);
            let mut mode = vec![0.0; state.u.len()];
            constraints.expand(&self.mode, &mut mode);
            let most = (0..mode.len()).max_by(|&a, &b| mode[a].abs().total_cmp(&mode[b].abs())).unwrap_or(0);
            let scale = mode[most];
            mode.iter_mut().for_each(|x| *x /= scale);
            Turn {
                times: [last.time, record.time],
                negative: [last.negative, negative],
                counted,
                critical: passes.then_some(last.time + part * (record.time - last.time)),
                largest: problem.name_of(most),
                mode,
            }
        });
        self.turns.extend(turn.clone().map(|turn| Turn { mode: Vec::new(), ..turn }));
        self.spent += begun.elapsed();
        turn
    }

    /// Inverse iterations; false where they lead nowhere.
    fn iterate(&mut self, solver: &dyn LinearSolver, most: usize) -> bool {
        for _ in 0..most {
            let length = norm(&self.mode);
            self.mode.iter_mut().for_each(|x| *x /= length);
            let mut image = self.mode.clone();
            if !solver.substitute(&mut image) {
                return false;
            }
            let inverse: f64 = self.mode.iter().zip(&image).map(|(x, y)| x * y).sum();
            let (before, length) = (std::mem::replace(&mut self.eigenvalue, 1.0 / inverse), norm(&image));
            if !(length > 0.0 && length.is_finite() && inverse != 0.0) {
                self.mode.clear();
                return false;
            }
            self.mode = image;
            self.mode.iter_mut().for_each(|x| *x /= length);
            if (before - self.eigenvalue).abs() <= SETTLED * self.eigenvalue.abs() {
                break;
            }
        }
        true
    }
}
