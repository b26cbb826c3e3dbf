//! What is free: motions that meet no stiffness, in an iterate, in a solution, and before the first increment.

use super::linear::LinearError;
use super::newton::{IfFree, Newton, Trouble};
use crate::system::{Tangent, Term};
use crate::{Error, Failure};
use std::sync::Arc;

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

    /// A solution that was reached with a propped matrix must stand without the prop, unless what is free is to be held.
    pub(super) fn stands(&mut self, u: &[f64], reference: f64) -> Result<(), Trouble> {
        if self.propped.is_empty() {
            return Ok(());
        }
        self.propped = self.loose(u, reference)?;
        if self.propped.is_empty() || self.problem.newton.if_free == IfFree::Hold {
            return Ok(());
        }
        Err(Failure::new(self.propped.join("; ")).into())
    }

    /// Whether the first guess, which left no force unbalanced, carries something on that nothing holds any more: no matrix
    /// was ever solved, and a body that has lost its contact would drift on as it last moved.
    ///
    /// # Errors
    /// An error that names it, unless what is free is to be held.
    pub(super) fn drifts(&mut self, u: &[f64], reference: f64) -> Result<bool, Trouble> {
        let opened = |(term, branches): (&Arc<dyn Term>, &Vec<(u8, u32)>)| {
            term.bends() && branches.iter().all(|(branch, _)| *branch == 0)
        };
        if !self.problem.terms.iter().zip(&self.evaluation.branches).any(opened) {
            return Ok(false);
        }
        self.complete(u, None)?;
        let motions = self.loose(u, reference)?;
        match self.problem.newton.if_free {
            _ if motions.is_empty() => Ok(false),
            IfFree::Hold => Ok(true),
            IfFree::Stop => Err(Trouble::Error(Error::NotConverged(format!(
                "{}: nothing holds it any more at time {:.4}; support it, keep it in contact, or leave it where it is by \
                 `solver.if_free = \"hold\"`",
                motions.join("; "),
                self.at.time
            )))),
        }
    }

    /// Motions that meet no stiffness at `u`, nor a force when they go on further than the increment did, as where everything
    /// slips and would slip back; in words. The evaluation is then that of `u`.
    fn loose(&mut self, u: &[f64], reference: f64) -> Result<Vec<String>, Trouble> {
        let motions = match self.factorise_matrix() {
            Err(LinearError::Singular(motions)) => motions,
            factorised => {
                // Nothing is known of the inverse of this one.
                self.solver.refuse();
                return factorised.map(|()| Vec::new()).map_err(|e| self.explain(e, 1));
            }
        };
        let mut loose = Vec::new();
        for motion in motions {
            if !self.is_held(u, &motion, reference)? {
                loose.push(motion);
            }
        }
        self.evaluate(u, None, self.tangent())?;
        Ok(self.name_motions(&loose))
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
        let mut named: Vec<String> = Vec::new();
        for motion in motions {
            let mut full = vec![0.0; self.state.u.len()];
            self.step.constraints.expand(motion, &mut full);
            let names = self.problem.terms.iter().filter_map(|term| term.describe_motion(&full)).collect::<Vec<_>>();
            named.extend(if names.is_empty() { vec![self.problem.name_of_largest(&full)] } else { names });
        }
        named.sort();
        named.dedup();
        named
    }

    /// Motions that meet no stiffness at the accepted state, in words: what would stop the first iteration.
    pub fn free_motions(mut self) -> Result<Vec<String>, Trouble> {
        let u = self.state.u.clone();
        self.evaluate(&u, None, Tangent::Exact)?;
        match self.factorise_matrix() {
            Ok(()) => Ok(Vec::new()),
            Err(LinearError::Singular(motions)) => Ok(self.name_motions(&motions)),
            Err(other) => Err(Trouble::Error(Error::Internal(other.to_string()))),
        }
    }
}
