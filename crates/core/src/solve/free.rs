//! What is free: motions that meet no stiffness, in an iterate and in a solution.

use super::constants::regularisation::{CLOSE, EASED, MOST_EASED, MOVED, RESISTANCE, SMALL};
use super::linear::LinearError;
use super::newton::{IfFree, Newton, SolveError, largest};
use super::observer::AttemptRecord;
use crate::system::{Tangent, Whole};
use crate::{Error, Failure, FailureKind};

/// The failure that motions without stiffness are, in words.
fn unheld(text: String) -> Failure {
    let kind = if text.contains("deforms without resistance") { FailureKind::Hourglass } else { FailureKind::Free };
    Failure::new(text).of(kind)
}

impl Newton<'_> {
    /// Whether there are terms that may yet hold what is free: contacts.
    pub(super) fn may_hold(&self) -> bool {
        self.problem.terms.iter().any(|term| term.bends())
    }

    /// Puts a small stiffness on every unknown, since an iterate may lose a contact that the solution has.
    /// The solution itself must be stable without it.
    pub(super) fn regularise(&mut self, motions: &[Vec<f64>]) {
        self.regularised = self.name_motions(motions);
        self.was_singular = true;
        let small = SMALL * EASED.powi(self.steady.min(MOST_EASED)) * self.stiffness;
        let pattern = self.memory.workspace.pattern();
        for place in (0..pattern.rows()).filter_map(|row| pattern.diagonal(row)) {
            self.evaluation.values[place] += small;
        }
    }

    /// Whether what nothing holds stays where it is: before it has moved, what lies close to something that it may touch.
    fn holds_still(&self) -> bool {
        match self.problem.newton.if_free {
            IfFree::Auto => self.state.increment > 0 || self.free_is_close,
            IfFree::Stop => false,
            IfFree::Hold => true,
        }
    }

    /// The failure that forces are which move what the last matrix was regularised against.
    pub(super) fn pushed(&self) -> Failure {
        let motions = self.regularised.join("; ");
        let failure = unheld(format!("{motions}: it is pushed that way, and nothing that it touches resists"));
        let kind = if failure.kind == FailureKind::Free { FailureKind::Pushed } else { failure.kind };
        failure.of(kind)
    }

    /// A solution that was reached with a regularised matrix must be stable without that, unless what is free is to be held.
    pub(super) fn is_stable(&mut self, u: &[f64], reference: f64) -> Result<(), SolveError> {
        if self.regularised.is_empty() {
            return Ok(());
        }
        let loose = self.rigid_modes(u, reference)?;
        self.regularised = self.name_motions(&loose);
        if self.regularised.is_empty() || self.holds_still() {
            return Ok(());
        }
        Err(unheld(self.regularised.join("; ")).into())
    }

    /// The iterate to begin from anew where the first guess carries something on that nothing holds any more, a body that has lost its contact and
    /// would drift on as it last moved; none where it does not. What is free is where it was, all else where it came to, so that nothing that
    /// goes away takes it along.
    ///
    /// It does so where the guess left no force unbalanced, so that no matrix was solved, or where one that was solved from it was singular. A
    /// contact that lets go in the iterations is judged likewise, since the matrix that was solved last may still have held it.
    ///
    /// # Errors
    /// What is free in words, unless it is to be held.
    pub(super) fn at_rest(
        &mut self,
        u: &[f64],
        record: &AttemptRecord,
        reference: f64,
    ) -> Result<Option<Vec<f64>>, SolveError> {
        let guessed = record.iterations.len() == 1;
        if !guessed && !self.was_singular && !self.lets_go(record) || !self.opened().any(|opened| opened) {
            return Ok(None);
        }
        self.complete(u, None)?;
        let loose = self.rigid_modes(u, reference)?;
        let motions = self.name_motions(&loose);
        if motions.is_empty() || self.holds_still() {
            self.regularised = motions;
            // What was factorised last may be singular.
            self.system.invalidate_factor();
            return Ok((!loose.is_empty()).then(|| self.without(&loose, u)));
        }
        let text = format!("{}: nothing holds it any more at time {:.4}", motions.join("; "), self.at.time);
        if !guessed {
            return Err(unheld(text).into());
        }
        Err(SolveError::End(unheld(format!(
            "{text}; support it, keep it in contact, or leave it where it is by `solver.if_free = \"hold\"`"
        ))))
    }

    /// `u` with the parts and tools that motions move where they were when the increment began.
    fn without(&self, motions: &[Vec<f64>], u: &[f64]) -> Vec<f64> {
        let (mut u, dofs) = (u.to_vec(), &self.problem.dofs);
        let mut back = |dof: usize| u[dof] = self.state.u[dof];
        for motion in motions.iter().map(|motion| self.expanded(motion)) {
            let least = MOVED * largest(motion.iter().copied());
            let moves = |dof: &usize| motion[*dof].abs() > least;
            let of_whole = |whole: &Whole| whole.nodes().flat_map(|node| dofs.displacements(node)).collect::<Vec<_>>();
            self.problem.wholes.iter().map(of_whole).filter(|all| all.iter().any(moves)).flatten().for_each(&mut back);
            (dofs.node(dofs.nodes())..dofs.count()).filter(moves).for_each(&mut back);
        }
        u
    }

    /// For each term with contact, whether all of it is open.
    fn opened(&self) -> impl Iterator<Item = bool> {
        let terms = self.problem.terms.iter().zip(&self.evaluation.branches).filter(|(term, _)| term.bends());
        terms.map(|(_, branches)| branches.iter().all(|(branch, _)| *branch == 0))
    }

    /// Whether a contact that touched in the first iterations is open all over now.
    fn lets_go(&self, record: &AttemptRecord) -> bool {
        let Some(first) = record.iterations.first() else { return false };
        let touched = self.problem.terms.iter().zip(&first.branches).filter(|(term, _)| term.bends());
        touched.zip(self.opened()).any(|((_, counts), opened)| opened && counts.iter().skip(1).any(|count| *count > 0))
    }

    /// Motions that meet no stiffness at `u`, nor a force when they go on further than the increment did, as where everything
    /// slips and would slip back. The evaluation is then that of `u`.
    fn rigid_modes(&mut self, u: &[f64], reference: f64) -> Result<Vec<Vec<f64>>, SolveError> {
        let motions = match self.factorise_matrix() {
            Err(LinearError::Singular(motions)) => motions,
            factorised => {
                // Nothing is known of the inverse of this one.
                self.system.invalidate_factor();
                return factorised.map(|()| Vec::new()).map_err(|e| self.explain(e, 1));
            }
        };
        // Where nothing touches, what a body would run into does not hold it.
        let touches = self.opened().any(|opened| !opened);
        let mut loose = Vec::new();
        for motion in motions {
            if !touches || !self.is_held(u, &motion, reference)? {
                loose.push(motion);
            }
        }
        self.evaluate(u, None, self.tangent())?;
        self.free_is_close = self.are_close(u, &loose)?;
        Ok(loose)
    }

    /// Whether each of these motions at `u` moves a place of a body that lies as close to what it may touch as one may whose faces touch
    /// it.
    fn are_close(&mut self, u: &[f64], motions: &[Vec<f64>]) -> Result<bool, Failure> {
        self.memory.workspace.kinks(&self.assembly, u, &mut self.memory.kinks)?;
        let (kinks, far) = (&self.memory.kinks, CLOSE * self.problem.cell_size);
        let close = |motion: &Vec<f64>| {
            let motion = self.expanded(motion);
            kinks.list().iter().any(|kink| -kink.y[0] <= far && kinks.along(kink, &motion).iter().any(|y| *y != 0.0))
        };
        Ok(motions.iter().all(close))
    }

    /// A motion of the free unknowns as one of all.
    fn expanded(&self, motion: &[f64]) -> Vec<f64> {
        let mut full = vec![0.0; self.state.u.len()];
        self.step.constraints.expand(motion, &mut full);
        full
    }

    /// Whether finite motion to either side meets a force.
    pub(super) fn is_held(&mut self, u: &[f64], motion: &[f64], reference: f64) -> Result<bool, Failure> {
        let full = self.expanded(motion);
        let change = largest(u.iter().zip(&self.state.u).map(|(a, b)| a - b));
        let unit = largest(full.iter().copied());
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
    pub(super) fn explain(&self, error: LinearError, iteration: usize) -> SolveError {
        let motions = match &error {
            LinearError::Singular(motions) => motions,
            LinearError::Inaccurate(_) | LinearError::NotFinite(_) => {
                return SolveError::Failure(Failure::from(&error));
            }
            LinearError::Memory(text) | LinearError::Input(text) => return SolveError::Error(Error::input(text)),
            LinearError::Other(_) => return SolveError::Error(Error::Internal(error.to_string())),
        };
        let text = self.name_motions(motions).join("; ");
        if iteration == 0 {
            SolveError::End(unheld(format!("{text}: nothing holds it; support it, or bring it into contact")))
        } else {
            SolveError::Failure(unheld(format!("{text} in iteration {iteration}")))
        }
    }

    pub(super) fn name_motions(&self, motions: &[Vec<f64>]) -> Vec<String> {
        self.problem.name_motions(&motions.iter().map(|motion| self.expanded(motion)).collect::<Vec<_>>())
    }
}
