//! A factor that serves increment after increment, as a part of the accepted state: every attempt begins with the matrix
//! that the state holds, its factor and what it has served for, whatever was solved since the state was accepted. So an
//! attempt that is made again, and a run that goes on from a checkpoint, arrive at the same bits.

use super::linear::{LinearError, LinearSolver, Unknowns};
use super::newton::{Memory, Newton, Variant};
use super::problem::Problem;
use crate::system::{Constraints, Csr, Factorised, Preconditioner};
use std::sync::Arc;
use std::time::Instant;

impl Memory {
    /// What the next increment begins with: the factor there is, if it is to serve on.
    pub(super) fn preconditioner(&self, solver: &dyn LinearSolver) -> Option<Preconditioner> {
        let (service, matrix) = (solver.service()?, self.factorised.clone()?);
        Some(Preconditioner { matrix, service, near: self.influences.near() })
    }

    /// Factorises a matrix of the pattern at hand, and analyses that before if it is new.
    pub(super) fn factorise(
        &mut self,
        (problem, constraints): (&Problem, &Constraints),
        values: &[f64],
        solver: &mut dyn LinearSolver,
    ) -> Result<(), LinearError> {
        let analysis = self.workspace.analysis();
        if self.analysed != analysis {
            let unknowns = Unknowns { dofs: &problem.dofs, free: constraints.free() };
            solver.analyse(self.workspace.pattern(), unknowns)?;
            self.analysed = analysis;
            self.analyses += 1;
        }
        self.factorised = None;
        self.factorisations += 1;
        let begun = Instant::now();
        let factorised = solver.factorise(values);
        self.factorising += begun.elapsed();
        factorised?;
        self.symmetric += usize::from(solver.signs().is_some_and(|signs| signs.symmetric));
        if problem.newton.variant == Variant::Full && solver.service().is_some() {
            // Its factor may serve on.
            let Csr { starts, columns, .. } = self.workspace.pattern();
            self.factorised = Some(Arc::new(Factorised {
                free: constraints.free().to_vec(),
                starts: starts.clone(),
                columns: columns.clone(),
                values: values.to_vec(),
            }));
        }
        Ok(())
    }

    fn holds(&self, matrix: &Arc<Factorised>) -> bool {
        self.factorised.as_ref().is_some_and(|held| Arc::ptr_eq(held, matrix))
    }
}

impl Newton<'_> {
    /// Begins a sequence of matrices with the preconditioner of the accepted state.
    pub(super) fn begin_sequence(&mut self) {
        let held = self.state.preconditioner.as_ref();
        let held = held.filter(|held| held.matrix.free == self.step.constraints.free());
        if !held.is_some_and(|held| self.take_up(held)) {
            self.solver.refuse();
        }
        self.solver.begin();
    }

    /// Sees to it that the solver is where it was when the state was accepted; false where the matrix has no factor, which
    /// is that of a damaged checkpoint then.
    fn take_up(&mut self, held: &Preconditioner) -> bool {
        let memory = &mut *self.memory;
        let (same, service) = (memory.holds(&held.matrix), self.solver.service());
        if same && service == Some(held.service) && memory.influences.near() == held.near {
            return true;
        }
        if !same && self.factorise_again(&held.matrix).is_err() {
            return false;
        }
        self.solver.resume(held.service);
        self.memory.influences.resume(&held.near, &self.step.constraints, self.solver).is_ok()
    }

    fn factorise_again(&mut self, matrix: &Arc<Factorised>) -> Result<(), LinearError> {
        let memory = &mut *self.memory;
        // Neither is that of the matrices to come, as far as is known.
        (memory.analysed, memory.followed, memory.factorised) = (0, 0, None);
        memory.free.clone_from(&matrix.free);
        let unknowns = Unknowns { dofs: &self.problem.dofs, free: &matrix.free };
        self.solver.analyse(&matrix.pattern(), unknowns)?;
        self.solver.factorise(&matrix.values)?;
        (memory.analyses, memory.factorisations) = (memory.analyses + 1, memory.factorisations + 1);
        memory.symmetric += usize::from(self.solver.signs().is_some_and(|signs| signs.symmetric));
        memory.factorised = Some(matrix.clone());
        Ok(())
    }
}
