//! What is free: motions that meet no stiffness, in an iterate and in a solution.

use super::linear::LinearError;
use super::newton::{Newton, Trouble};
use crate::system::Tangent;
use crate::{Error, Failure};

/// Stiffness that props an iterate in which something is free, over the largest in the matrix.
const PROP: f64 = 1e-4;
/// Force over the reference force that holds what meets no stiffness.
const RESISTANCE: f64 = 1e-3;

impl Newton<'_> {
    /// Whether there are terms that may yet hold what is free: contacts.
    pub(super) fn may_hold(&self) -> bool {
        self.problem.terms.iter().any(|term| term.bends())
    }

    /// Factorises with a small stiffness on every unknown, since an iterate may lose a contact that the solution has.
    /// The solution itself must stand without it.
    pub(super) fn prop(&mut self, motions: &[Vec<f64>], iteration: usize) -> Result<(), Trouble> {
        self.propped = self.name_motions(motions);
        for &place in &self.memory.workspace.pattern().diagonal {
            self.evaluation.values[place] += PROP * self.stiffness;
        }
        self.factorise_matrix().map_err(|e| self.explain(e, iteration))
    }

    /// A solution that was reached with a propped matrix must stand without the prop: what still meets no stiffness must
    /// meet a force when it moves by more than it did in the increment, as when everything slips and would slip back.
    pub(super) fn stands(&mut self, u: &[f64], reference: f64) -> Result<(), Trouble> {
        if self.propped.is_empty() {
            return Ok(());
        }
        let motions = match self.factorise_matrix() {
            Err(LinearError::Singular(motions)) => motions,
            factorised => {
                // Nothing is known of the inverse of this one.
                self.solver.refuse();
                return factorised.map_err(|e| self.explain(e, 1));
            }
        };
        for motion in motions {
            if !self.is_held(u, &motion, reference)? {
                return Err(Failure::new(self.name_motions(&[motion]).join("; ")).into());
            }
        }
        Ok(self.evaluate(u, None, self.tangent())?)
    }

    /// Whether finite motion to either side meets a force.
    pub(super) fn is_held(&mut self, u: &[f64], motion: &[f64], reference: f64) -> Result<bool, Failure> {
        let mut full = vec![0.0; u.len()];
        self.step.constraints.expand(motion, &mut full);
        let largest = |v: &mut dyn Iterator<Item = f64>| v.fold(0.0_f64, |m, x| m.max(x.abs()));
        let change = largest(&mut u.iter().zip(&self.state.u).map(|(a, b)| a - b));
        let unit = largest(&mut full.iter().copied());
        for side in [1.0, -1.0] {
            let moved: Vec<f64> = u.iter().zip(&full).map(|(u, d)| u + side * 2.0 * change / unit * d).collect();
            self.evaluate(&moved, None, Tangent::None)?;
            if self.slope(&full).abs() <= RESISTANCE * unit * reference {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// What a linear system that cannot be solved means in the user's words.
    pub(super) fn explain(&self, error: LinearError, iteration: usize) -> Trouble {
        let motions = match &error {
            LinearError::Singular(motions) => motions,
            LinearError::Inaccurate(_) | LinearError::NotFinite(_) => {
                return Trouble::Failure(Failure::new(error.to_string()));
            }
            LinearError::Other(_) => return Trouble::Error(Error::Internal(error.to_string())),
        };
        let text = self.name_motions(motions).join("; ");
        if iteration == 0 {
            Trouble::Error(Error::NotConverged(format!(
                "{text}: nothing holds it; support it, or bring it into contact"
            )))
        } else {
            Trouble::Failure(Failure::new(format!("{text} in iteration {iteration}")))
        }
    }

    pub(super) fn name_motions(&self, motions: &[Vec<f64>]) -> Vec<String> {
        let expanded = |motion: &Vec<f64>| {
            let mut full = vec![0.0; self.state.u.len()];
            self.step.constraints.expand(motion, &mut full);
            full
        };
        self.problem.name_motions(&motions.iter().map(expanded).collect::<Vec<_>>())
    }
}
