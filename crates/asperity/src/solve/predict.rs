//! The first guess of an attempt.
//!
//! The predictor carries all unknowns on with the last accepted increment. What prescribed unknowns still miss enters
//! the first solution as known motion (`K_ff dq = -(r + K_fc missing)`), so that a driven row takes the elements
//! behind it along instead of turning them inside out.

use super::constants::predictor::{GOOD_GUESS, ROUNDING};
use super::newton::{Newton, SolveError};
use crate::Failure;
use crate::system::{Evaluation, Tangent};

/// A first guess, and what prescribed unknowns miss there.
type Start = (Vec<f64>, Option<Vec<f64>>);

/// An evaluation that is set aside, and the pattern of its matrix.
struct Aside {
    evaluation: Evaluation,
    residual: Vec<f64>,
    pattern: usize,
}

impl Newton<'_> {
    /// First guess, evaluated, and what the prescribed unknowns still miss there: the motion of the last increment carried
    /// on, node by node or, where that leaves much and this leaves less, with each whole as a rigid body.
    pub(super) fn predict(&mut self) -> Result<Start, SolveError> {
        if self.state.last_dt == 0.0 {
            return Ok(self.begin(self.state.u.clone())?);
        }
        let part = self.at.dt / self.state.last_dt;
        let nodal: Vec<f64> = self.state.u.iter().zip(&self.state.last_change).map(|(u, d)| u + part * d).collect();
        let first = self.guess(nodal.clone(), self.tangent());
        if let Ok((start, unbalanced)) = &first
            && *unbalanced <= GOOD_GUESS
        {
            return Ok(start.clone());
        }
        let aside = self.set_aside();
        let rigid = self.problem.wholes.iter().fold(nodal, |mut u, whole| {
            whole.carry(&self.problem.dofs, self.state, part, &mut u);
            u
        });
        let second = self.guess(rigid, Tangent::None);
        let left =
            |guess: &Result<(Start, f64), Failure>| guess.as_ref().map_or(f64::INFINITY, |(_, unbalanced)| *unbalanced);
        let better = left(&second) < left(&first);
        match if better { second } else { first } {
            Ok(((u, missing), _)) => {
                self.choose(aside, better, &u)?;
                self.complete(&u, missing.as_deref())?;
                Ok((u, missing))
            }
            Err(_) => Ok(self.begin(self.state.u.clone())?),
        }
    }

    /// Keeps the evaluation there is while another guess is tried.
    fn set_aside(&mut self) -> Aside {
        let room = self.memory.other.take();
        let room = room.unwrap_or_else(|| Evaluation::new(&self.problem.terms, self.state));
        Aside {
            evaluation: std::mem::replace(&mut self.evaluation, room),
            residual: self.residual.clone(),
            pattern: self.memory.workspace.analysis(),
        }
    }

    /// Takes the evaluation back that was set aside, at `u`, unless the `other` is the better one.
    fn choose(&mut self, aside: Aside, other: bool, u: &[f64]) -> Result<(), Failure> {
        let Aside { mut evaluation, residual, pattern } = aside;
        if !other {
            std::mem::swap(&mut self.evaluation, &mut evaluation);
            self.residual = residual;
            self.memory.workspace.find_stencils(&self.assembly, u)?;
            self.linearised = pattern == self.memory.workspace.analysis();
        }
        self.memory.other = Some(evaluation);
        Ok(())
    }

    /// A first guess at `u`.
    pub(super) fn begin(&mut self, mut u: Vec<f64>) -> Result<Start, Failure> {
        let missing = self.missing(&mut u);
        self.evaluate(&u, missing.as_deref(), self.tangent())?;
        Ok((u, missing))
    }

    /// Evaluates a first guess and measures the unbalanced forces over those in play at the accepted states, with those of the
    /// motion that prescribed unknowns still miss: for them the matrix is needed. A guess that leads far into a tool has
    /// larger forces in play, which must not count in its favour.
    fn guess(&mut self, mut u: Vec<f64>, tangent: Tangent) -> Result<(Start, f64), Failure> {
        let missing = self.missing(&mut u);
        let tangent = if missing.is_some() { self.tangent() } else { tangent };
        self.evaluate(&u, missing.as_deref(), tangent)?;
        let residual = self.residual.clone();
        if missing.is_some() {
            let mut carried = vec![0.0; residual.len()];
            self.step.constraints.gather(&self.evaluation.carried, &mut carried);
            self.residual.iter_mut().zip(&carried).for_each(|(r, c)| *r += c);
        }
        let unbalanced = self.unbalanced();
        self.residual = residual;
        Ok(((u, missing), unbalanced))
    }

    /// The largest unbalanced force over those in play at the accepted states, moments likewise; over those of the guess where
    /// there were none.
    fn unbalanced(&self) -> f64 {
        let mut largest = [0.0_f64; 2];
        for (&dof, force) in self.step.constraints.free().iter().zip(&self.residual) {
            let kind = usize::from(self.problem.dofs.is_rotation(dof));
            largest[kind] = if force.is_nan() { f64::INFINITY } else { largest[kind].max(force.abs()) };
        }
        let reference = self.measure().reference;
        let over = |kind: usize| {
            let past = self.state.in_play[kind];
            let scale = if past > 0.0 { past } else { reference[kind] };
            largest[kind] / scale.max(f64::MIN_POSITIVE)
        };
        over(0).max(over(1))
    }

    /// What prescribed unknowns miss at `u`; where that is rounding, it is put right in `u` at once.
    pub(super) fn missing(&self, u: &mut [f64]) -> Option<Vec<f64>> {
        let (mut missing, mut largest, mut motion) = (vec![0.0; u.len()], 0.0_f64, 0.0_f64);
        for p in &self.step.prescribed {
            let start = p.value(&self.state.step_start);
            let target = p.course.at(start, self.at.step_time, self.step.duration);
            missing[p.dof] = target - p.value(u);
            largest = largest.max(missing[p.dof].abs());
            motion = motion.max((target - p.value(&self.state.u)).abs()).max(target.abs());
        }
        // A combination also misses what its prescribed partners do; those are simple and already known.
        for p in self.step.prescribed.iter().filter(|p| !p.others.is_empty()) {
            missing[p.dof] += p.others.iter().map(|&(other, c)| c * missing[other]).sum::<f64>();
        }
        if largest > ROUNDING * motion {
            return Some(missing);
        }
        for p in &self.step.prescribed {
            u[p.dof] += missing[p.dof];
        }
        None
    }
}
