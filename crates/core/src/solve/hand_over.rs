//! From one step to the next: what held and no longer does is let go little by little.
//!
//! The forces of supports that are released and of terms that the step does without act on as loads when it begins, so that nothing
//! moves, and fall to zero over it. So does what keeps loads from acting that are there again.

use super::run::Run;
use crate::Failure;
use crate::system::{History, Instant, Role, Row, State, Term};

impl Run<'_> {
    /// Before the first increment of a step: notes the forces that it lets go, and forgets what its idle terms remember.
    pub(super) fn enter(&mut self) {
        let (steps, state) = (&self.problem.steps, &mut self.state);
        if std::mem::replace(&mut state.entered, true) {
            return;
        }
        (state.factor, state.last_factor, state.arc) = (0.0, 0.0, 0.0);
        let leaving = std::mem::take(&mut state.leaving);
        state.handed.clear();
        let before = state.step.checked_sub(1).and_then(|before| steps.get(before));
        let (Some(before), Some(now)) = (before, steps.get(state.step)) else { return };
        let (rows, after) = (&before.constraints, &now.constraints);
        state.stopped.retain(|&dof| matches!(after.row(dof), Row::Free(_)));
        let mut handed = vec![0.0; state.u.len()];
        for dof in 0..handed.len() {
            let held = state.internal[dof] - state.load[dof];
            match (rows.row(dof), after.row(dof)) {
                (Row::Fixed, Row::Free(_) | Row::Combined(_)) => handed[dof] += held,
                // Of what followed others and stays behind, what it bore was theirs.
                (Row::Combined(others), Row::Fixed) => {
                    let free = others.iter().map(|&(free, c)| (rows.free()[free], c));
                    free.filter(|(dof, _)| matches!(after.row(*dof), Row::Free(_)))
                        .for_each(|(dof, c)| handed[dof] -= c * held);
                }
                (Row::Combined(others), Row::Free(_)) => {
                    handed[dof] += held;
                    others.iter().for_each(|&(free, c)| handed[rows.free()[free]] -= c * held);
                }
                _ => {}
            }
        }
        let gone = leaving.iter().filter(|(term, _)| before.leaving.contains(term));
        for (term, forces) in gone {
            let is_load = self.problem.terms[*term].role() == Role::Load;
            for &(dof, force) in forces {
                if is_load {
                    handed[dof] += force;
                    state.load[dof] -= force;
                } else {
                    handed[dof] -= force;
                    state.internal[dof] -= force;
                }
            }
        }
        for (dof, handed) in handed.iter_mut().enumerate() {
            if *after.row(dof) == Row::Fixed {
                *handed = 0.0;
            }
            state.load[dof] += *handed;
        }
        let is_back = |term: &&usize| !now.idle.contains(term) && self.problem.terms[**term].role() == Role::Load;
        for &term in before.idle.iter().filter(is_back) {
            // One that cannot be evaluated yet is there at once.
            let forces =
                beginning(self.problem.terms[term].as_ref(), &state.histories[term], state).unwrap_or_default();
            forces
                .iter()
                .filter(|(dof, _)| *after.row(*dof) != Row::Fixed)
                .for_each(|(dof, force)| handed[*dof] -= force);
        }
        if handed.iter().any(|&force| force != 0.0) {
            state.handed = handed;
        }
        for &term in before.idle.iter().filter(|term| !now.idle.contains(term)) {
            let at = Instant { step: state.step, time: state.time, ..Instant::default() };
            // One that cannot begin says why in the first increment.
            if let Ok(history) = self.problem.terms[term].returned(state, at, state.time + now.duration) {
                state.histories[term] = history;
            }
        }
        for &term in &before.leaving {
            state.histories[term] = self.problem.terms[term].initial();
            // What it had stored is not given back.
            let energies = &mut state.energies[term];
            energies.dissipated += std::mem::take(&mut energies.stored);
        }
    }
}

/// Forces of a load when a step begins, by unknown.
fn beginning(load: &dyn Term, history: &History, state: &State) -> Result<Vec<(usize, f64)>, Failure> {
    let at = Instant { step: state.step, time: state.time, ..Instant::default() };
    let attempt = load.attempt(state, history, at)?;
    let mut forces = Vec::new();
    attempt.each(&state.u, &mut |dofs, local| forces.extend(dofs.iter().copied().zip(local.force.iter().copied())))?;
    Ok(forces)
}
