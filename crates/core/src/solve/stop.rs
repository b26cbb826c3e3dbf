//! Tools that a load drives and that nothing bears any more: they stop where they are, as against a spacer, and the stop bears
//! what their contacts do not.
//!
//! A blank holder that the rim of the blank has left is the common case. Without a stop no state is in equilibrium. One whose rounded edge
//! the rim still props up comes down by itself, with a relaxation: it is stopped before that, and rim and stop share its load.

use super::constants::stops::{LOST, YIELD};
use super::newton::{Converged, IfFree, Newton, SolveError};
use super::run::Run;
use crate::Failure;
use crate::system::{Evaluation, Row, State};

/// Force of a stop under a load after some motion, and its stiffness.
fn stop(load: f64, motion: f64, cell: f64) -> [f64; 2] {
    let stiffness = load.abs() / (YIELD * cell);
    [load + stiffness * motion, stiffness]
}

impl Newton<'_> {
    /// Adds the forces of the stops at `u` and, where the matrix is new, their stiffness.
    pub(super) fn stop(&mut self, u: &[f64], matrix: bool) {
        for &dof in &self.state.stopped {
            let (load, Row::Free(row)) = (self.evaluation.load[dof], self.step.constraints.row(dof)) else { continue };
            let [force, stiffness] = stop(load, u[dof] - self.state.u[dof], self.problem.cell_size);
            self.evaluation.internal[dof] += force;
            if let Some(place) = self.memory.workspace.pattern().diagonal(*row).filter(|_| matrix) {
                self.evaluation.values[place] += stiffness;
            }
        }
    }

    /// The unknowns of tools that a load drives, and that no contact bears in the present evaluation though one did before.
    pub(super) fn unborne(&self) -> Vec<usize> {
        let (dofs, state) = (&self.problem.dofs, self.state);
        let (load, internal) = (&self.evaluation.load, &self.evaluation.internal);
        let lost = |dof: &usize| {
            load[*dof] != 0.0
                && matches!(self.step.constraints.row(*dof), Row::Free(_))
                && internal[*dof].abs() <= LOST * load[*dof].abs()
                && state.internal[*dof].abs() > LOST * load[*dof].abs()
        };
        let tools = dofs.node(dofs.nodes())..state.u.len();
        tools.filter(|dof| !dofs.is_rotation(*dof)).filter(lost).collect()
    }
}

impl Run<'_> {
    /// Stops what nothing bears any more after an attempt that failed; whether there was anything.
    pub(super) fn stops(&mut self) -> bool {
        let unborne = std::mem::take(&mut self.memory.unborne);
        let may = self.problem.newton.if_free != IfFree::Stop && self.state.increment > 0;
        let new = unborne.into_iter().filter(|dof| may && !self.state.stopped.contains(dof)).collect::<Vec<_>>();
        self.state.stopped.extend(&new);
        !new.is_empty()
    }

    /// Whether contacts bear no more than the load of any tool that stands on a stop in a converged attempt, and nothing of one that grows: a
    /// stop presses, and one that would have to pull is let go of.
    ///
    /// # Errors
    /// The failure of an attempt with a stop in the place of what bears.
    pub(super) fn nothing_bears_stopped(&mut self, converged: &Converged) -> Result<(), SolveError> {
        let State { stopped, u: before, load: past, .. } = &mut self.state;
        let Evaluation { internal, load, .. } = &converged.evaluation;
        let is_borne = |dof: usize| {
            let [force, _] = stop(load[dof], converged.u[dof] - before[dof], self.problem.cell_size);
            // What a load grows by goes to what bears it, and not to the stop.
            let grows = (load[dof] - past[dof]) * load[dof] > 0.0;
            force * load[dof] < 0.0 || grows && (internal[dof] - force).abs() > LOST * load[dof].abs()
        };
        stopped.retain(|&dof| load[dof] != 0.0);
        let borne = stopped.iter().copied().find(|&dof| is_borne(dof));
        stopped.retain(|&dof| !is_borne(dof));
        match borne {
            Some(dof) => Err(Failure::new(format!("{} is borne again", self.problem.name_of(dof))).into()),
            None => Ok(()),
        }
    }

    /// Takes the forces of the stops out of those of the terms: they are reactions.
    pub(super) fn take_stops(&self, converged: &mut Converged) {
        let Evaluation { internal, load, .. } = &mut converged.evaluation;
        for &dof in &self.state.stopped {
            internal[dof] -= stop(load[dof], converged.u[dof] - self.state.u[dof], self.problem.cell_size)[0];
        }
    }

    /// The tools that stand on a stop, in words.
    pub(super) fn stopped(&self) -> Vec<String> {
        let name = |&dof: &usize| format!("{} under its load", self.problem.name_of(dof));
        self.state.stopped.iter().map(name).collect()
    }
}
