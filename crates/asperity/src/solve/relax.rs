//! Equilibria beyond an instability.
//!
//! Where a contact passes a notch or lets go, no equilibrium lies near the last one, however small the increment: what is
//! held back springs free. At fixed load the unbalanced forces are then followed through a viscous medium,
//! `c dq/ds = -r(q)`, by implicit Euler steps `r(q) + c (q - q_k) = 0` whose viscosity falls as they succeed and grows when
//! one fails, until the forces balance without it (pseudo-transient continuation: Kelley & Keyes, SIAM J. Numer. Anal.
//! 35, 1998). The equilibrium that is found is the one into which a slow motion
//! falls, and not any solution.

use super::newton::{Converged, Newton, Trouble};
use super::observer::{AttemptRecord, IterationRecord, Observer};
use super::step::forcing;
use super::trail::Trail;
use crate::Failure;

/// First viscosity over the mean stiffness of an unknown.
const START: f64 = 1e-2;
/// What a step that took few iterations, or many, leaves of the viscosity, and what one that failed makes of it.
const FAST: f64 = 0.25;
const SLOW: f64 = 0.5;
const BACK: f64 = 4.0;
/// Iterations of a step, and up to which they are few.
const ITERATIONS: usize = 10;
const FEW: usize = 3;
/// A step must lower the unbalanced forces to this part of what they are without the medium.
const ENOUGH: f64 = 0.05;
/// Part of the tolerance that iterations without the medium must reach at the end.
const SETTLED: f64 = 1e-2;
/// Most steps of one relaxation.
const STEPS: usize = 150;

/// A viscous medium.
#[derive(Debug, Clone)]
pub(super) struct Drag {
    /// Its stiffness over one step.
    coefficient: f64,
    /// Free unknowns when the step began.
    anchor: Vec<f64>,
}

impl Drag {
    /// Force over motion of an unknown; a rotation sweeps through the medium at the size of the model.
    fn at(&self, rotation: bool, size: f64) -> f64 {
        self.coefficient * if rotation { size * size } else { 1.0 }
    }
}

impl Newton<'_> {
    /// Adds the drag to the residual at `u` and, where the matrix is new, to its diagonal.
    pub(super) fn drag(&mut self, u: &[f64], matrix: bool) {
        let Some(drag) = &self.medium else { return };
        let (pattern, size) = (self.memory.workspace.pattern(), self.problem.size);
        for (row, (&dof, anchor)) in self.step.constraints.free().iter().zip(&drag.anchor).enumerate() {
            let c = drag.at(self.problem.dofs.is_rotation(dof), size);
            self.residual[row] += c * (u[dof] - anchor);
            if matrix {
                self.evaluation.values[pattern.diagonal[row]] += c;
            }
        }
    }

    /// Follows the unbalanced forces from the accepted state to an equilibrium at the end of the increment.
    pub fn relax(mut self, record: &mut AttemptRecord, observer: &mut dyn Observer) -> Result<Converged, Trouble> {
        let mut u = self.state.u.clone();
        let mut missing = self.missing(&mut u);
        self.evaluate(&u, missing.as_deref(), self.tangent())?;
        self.begin_sequence();
        let (mut coefficient, mut failed) = (START * self.mean_stiffness(), false);
        for _ in 0..STEPS {
            let free = self.step.constraints.free();
            self.medium = Some(Drag { coefficient, anchor: free.iter().map(|&dof| u[dof]).collect() });
            let mut trial = (u.clone(), missing.clone());
            let taken = match self.creep(&mut trial, record, observer) {
                Err(Trouble::Failure(_)) => None,
                taken => taken?,
            };
            self.medium = None;
            match taken {
                Some(iterations) => {
                    (u, missing) = trial;
                    // After a step that failed the same viscosity is tried once more.
                    coefficient *= if failed {
                        1.0
                    } else if iterations <= FEW {
                        FAST
                    } else {
                        SLOW
                    };
                }
                None => coefficient *= BACK,
            }
            failed = taken.is_none();
            self.evaluate(&u, missing.as_deref(), self.tangent())?;
            self.refresh_stiffness();
            if missing.is_none() && self.measure().converged() && self.settles(&mut u)? {
                let norms = self.measure();
                self.stands(&u, norms.reference[0])?;
                if !self.augment(&u)? {
                    let Self { evaluation, propped, .. } = self;
                    return Ok(Converged { u, evaluation, in_play: norms.in_play, held: propped, reached: None });
                }
            }
        }
        Err(Failure::new("no equilibrium was found in a viscous medium either").into())
    }

    /// Whether iterations without the medium end close by. What it leaves, small at every node, all points the same way.
    fn settles(&mut self, u: &mut Vec<f64>) -> Result<bool, Trouble> {
        let (rough, mut ratio) = (u.clone(), self.measure().ratio);
        for _ in 0..FEW {
            let iterated = self
                .linearise((0, u), None, forcing(ratio, 1.0, 0.0))
                .and_then(|m| Ok(self.advance(u, (&m, self.tangent()), None)?));
            let norms = self.measure();
            if iterated.is_err() || norms.ratio > ratio.max(norms.allowed) {
                break;
            }
            if norms.ratio <= (SETTLED * norms.allowed).max(norms.rounding) {
                return Ok(true);
            }
            ratio = norms.ratio;
        }
        *u = rough;
        self.evaluate(u, None, self.tangent())?;
        Ok(false)
    }

    /// One step in the medium: iterations to its end, None if it fails.
    fn creep(
        &mut self,
        (u, missing): &mut (Vec<f64>, Option<Vec<f64>>),
        record: &mut AttemptRecord,
        observer: &mut dyn Observer,
    ) -> Result<Option<usize>, Trouble> {
        let (mut goal, mut ratio) = (f64::INFINITY, 0.0);
        self.evaluate(u, missing.as_deref(), self.tangent())?;
        for iteration in 0..=ITERATIONS {
            let norms = self.measure();
            let line = IterationRecord { iteration, ..self.describe(iteration, &norms, &Trail::default()) };
            observer.iteration(record, &line);
            record.iterations.push(line);
            if iteration == 0 {
                goal = (SETTLED * norms.allowed).max(ENOUGH * norms.ratio);
            }
            if iteration > 0 && missing.is_none() && norms.ratio <= goal {
                return Ok(Some(iteration));
            }
            if iteration == ITERATIONS || !norms.ratio.is_finite() {
                break;
            }
            let motion = self.linearise((iteration, u), missing.as_deref(), forcing(norms.ratio, ratio, 0.0))?;
            ratio = norms.ratio;
            let taken = self.advance(u, (&motion, self.tangent()), missing.as_deref())?;
            *missing = missing.take().filter(|_| taken < 1.0).map(|m| m.iter().map(|m| m * (1.0 - taken)).collect());
        }
        Ok(None)
    }

    /// Mean diagonal entry of a displacement.
    fn mean_stiffness(&self) -> f64 {
        let pattern = self.memory.workspace.pattern();
        let free = self.step.constraints.free().iter().enumerate();
        let places = free.filter(|(_, dof)| !self.problem.dofs.is_rotation(**dof));
        let places: Vec<usize> = places.map(|(row, _)| pattern.diagonal[row]).collect();
        let sum: f64 = places.iter().map(|&place| self.evaluation.values[place].abs()).sum();
        sum / places.len().max(1) as f64
    }
}
