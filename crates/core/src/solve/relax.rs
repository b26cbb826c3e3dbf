//! Equilibria beyond an instability.
//!
//! Where a contact passes a notch or lets go, no equilibrium lies near the last one, however small the increment: what is
//! held back springs free. At fixed load the unbalanced forces are then followed through a viscous medium,
//! `c dq/ds = -r(q)`, by implicit Euler steps `r(q) + c (q - q_k) = 0` whose viscosity falls as they succeed and grows when
//! one fails, until the forces balance without it (pseudo-transient continuation: Kelley & Keyes, SIAM J. Numer. Anal.
//! 35, 1998). The equilibrium that is found is the one into which a slow motion
//! falls, and not any solution.

use super::constants::relaxation::{AWAY, BACK, ENOUGH, FAST, FEW, ITERATIONS, MOST, SETTLED, SLOW, START};
use super::newton::{Converged, Goal, Iterate, Newton, Sequence, SolveError, largest};
use super::observer::{AttemptRecord, Observer};
use crate::Failure;
use crate::system::apart;

/// One implicit Euler step through a viscous medium.
#[derive(Debug, Clone)]
pub(super) struct PseudoTime {
    /// Its stiffness over one step.
    coefficient: f64,
    /// Free unknowns when the step began.
    anchor: Vec<f64>,
}

impl PseudoTime {
    /// Force over motion of an unknown; a rotation sweeps through the medium at the size of the model.
    fn at(&self, rotation: bool, size: f64) -> f64 {
        self.coefficient * if rotation { size * size } else { 1.0 }
    }
}

impl Newton<'_> {
    /// Adds the resistance of the medium to the residual at `u` and, where the matrix is new, to its diagonal.
    pub(super) fn resist(&mut self, u: &[f64], matrix: bool) {
        let Some(medium) = &self.medium else { return };
        let (pattern, size) = (self.memory.workspace.pattern(), self.problem.size);
        for (row, (&dof, anchor)) in self.step.constraints.free().iter().zip(&medium.anchor).enumerate() {
            let c = medium.at(self.problem.dofs.is_rotation(dof), size);
            self.residual[row] += c * (u[dof] - anchor);
            if let Some(place) = pattern.diagonal(row).filter(|_| matrix) {
                self.evaluation.values[place] += c;
            }
        }
    }

    /// Follows the unbalanced forces from the accepted state to an equilibrium at the end of the increment.
    pub fn relax(mut self, record: &mut AttemptRecord, observer: &mut dyn Observer) -> Result<Converged, SolveError> {
        let mut at = self.begin(self.state.u.clone())?;
        self.begin_sequence();
        self.refresh_stiffness()?;
        let (mut coefficient, mut failed, mut spent) = (START * self.mean_stiffness()?, false, 0);
        while spent < MOST {
            let mut trial = at.clone();
            let taken = match self.implicit_step(coefficient, &mut trial, (&mut *record, &mut *observer), &mut spent) {
                Err(SolveError::Failure(_)) => None,
                taken => taken?,
            };
            match taken {
                Some(iterations) => {
                    at = trial;
                    // After a step that failed the same viscosity is tried once more.
                    coefficient *= if failed {
                        1.0
                    } else if iterations <= FEW {
                        FAST
                    } else {
                        SLOW
                    };
                }
                // A medium that holds more than all that gives way leaves nothing for a still stiffer one to change.
                None if coefficient > self.stiffness => break,
                None => coefficient *= BACK,
            }
            failed = taken.is_none();
            self.evaluate(&at.0, at.1.as_deref(), self.tangent())?;
            self.refresh_stiffness()?;
            let moved = |dof: usize| at.0[dof] - self.state.u[dof];
            let led = largest(self.step.prescribed.iter().map(|prescribed| moved(prescribed.dof)));
            let away = |dof: &usize| moved(*dof).abs() > AWAY * self.problem.size + led;
            self.memory.unborne = self.unborne().into_iter().filter(away).collect();
            let mut bodies = 0..self.problem.dofs.nodes() * self.problem.dofs.per_node();
            if !self.memory.unborne.is_empty() || bodies.any(|dof| away(&dof)) {
                break;
            }
            let balanced = at.1.is_none() && self.measure().converged();
            if balanced && self.settles(&mut at, (&mut *record, &mut *observer), &mut spent)? {
                let norms = self.measure();
                self.is_stable(&at.0, norms.reference[0])?;
                if !self.augment(&at.0)? {
                    return Ok(self.converged(at.0, norms));
                }
            }
        }
        Err(Failure::new("no equilibrium was found in a viscous medium either").into())
    }

    /// One step in the medium: iterations to its end, None if it fails.
    fn implicit_step(
        &mut self,
        coefficient: f64,
        at: &mut Iterate,
        told: (&mut AttemptRecord, &mut dyn Observer),
        spent: &mut usize,
    ) -> Result<Option<usize>, SolveError> {
        let anchor = self.step.constraints.free().iter().map(|&dof| at.0[dof]).collect();
        self.medium = Some(PseudoTime { coefficient, anchor });
        let (mut sequence, goal) =
            (Sequence::default(), Goal::Less { part: ENOUGH, of_tolerance: SETTLED, most: ITERATIONS });
        let evaluated = self.evaluate(&at.0, at.1.as_deref(), self.tangent()).map_err(SolveError::from);
        let taken = evaluated.and_then(|()| self.iterate(at, goal, &mut sequence, told));
        self.medium = None;
        // A step whose forces cannot be found ends before its first solution.
        *spent += sequence.solutions().max(1);
        Ok(taken?.map(|_| sequence.solutions()))
    }

    /// Whether iterations without the medium end close by. What it leaves, small at every node, all points the same way.
    fn settles(
        &mut self,
        at: &mut Iterate,
        told: (&mut AttemptRecord, &mut dyn Observer),
        spent: &mut usize,
    ) -> Result<bool, SolveError> {
        let (rough, mut sequence) = (at.0.clone(), Sequence::default());
        let goal = Goal::Balance { of_tolerance: SETTLED, most: FEW };
        let settled = self.iterate(at, goal, &mut sequence, told);
        *spent += sequence.solutions();
        if matches!(settled, Ok(Some(_))) {
            return Ok(true);
        }
        *at = (rough, None);
        self.evaluate(&at.0, None, self.tangent())?;
        Ok(false)
    }

    /// Mean diagonal entry of a displacement.
    fn mean_stiffness(&self) -> Result<f64, Failure> {
        let pattern = self.memory.workspace.pattern();
        let free = self.step.constraints.free().iter().enumerate();
        let places = free.filter(|(_, dof)| !self.problem.dofs.is_rotation(**dof));
        let rows: Vec<usize> = places.map(|(row, _)| row).collect();
        let mut diagonal: Vec<f64> = (0..pattern.rows())
            .map(|row| pattern.diagonal(row).map_or(0.0, |place| self.evaluation.values[place]))
            .collect();
        self.memory.workspace.shares().complete(&mut diagonal).map_err(apart)?;
        let sum: f64 = rows.iter().map(|&row| diagonal[row].abs()).sum();
        Ok(sum / rows.len().max(1) as f64)
    }
}
