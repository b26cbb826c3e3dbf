//! The first guess of an attempt.
//!
//! The predictor carries all unknowns on with the last accepted increment. What prescribed unknowns still miss enters
//! the first solution as known motion (`K_ff dq = -(r + K_fc missing)`), so that a driven row takes the elements
//! behind it along instead of turning them inside out.
//!
//! Contact stresses are carried on too. The straight motion leads off a round tool by the sagitta of its way, far more than a stiff
//! penalty lets a point penetrate; the first step is therefore made with the points closed whose pressure, carried on, still presses.
//! As in the primal-dual active set strategy (Hueber & Wohlmuth, Comput. Methods Appl. Mech. Eng. 194, 2005) the stress
//! decides and not the gap alone.

use super::constants::predictor::ROUNDING;
use super::newton::{Iterate, Newton, SolveError};
use crate::system::apart;
use crate::{Failure, FailureKind};

impl Newton<'_> {
    /// First guess, evaluated, and what the prescribed unknowns still miss there: the motion of the last increment carried on; the
    /// accepted state where there is none, or where what that leads to cannot be evaluated.
    pub(super) fn predict(&mut self) -> Result<Iterate, SolveError> {
        let state = self.state;
        if state.last_dt > 0.0 {
            let part = self.at.dt / state.last_dt;
            let carried = state.u.iter().zip(&state.last_change).map(|(u, d)| u + part * d).collect();
            self.hold(true);
            match self.begin(carried) {
                Err(failure) if failure.kind != FailureKind::Apart => self.hold(false),
                begun => return Ok(begun?),
            }
        }
        Ok(self.begin(state.u.clone())?)
    }

    /// Whether from now on contact points that were closed are held so.
    pub(super) fn hold(&mut self, hold: bool) {
        self.holding = hold;
        self.assembly.attempts.iter().for_each(|attempt| attempt.hold(hold));
    }

    /// Whether that holds any which is open, on any rank: there is no equilibrium then yet.
    pub(super) fn holds(&self) -> Result<bool, Failure> {
        let mut held = [f64::from(self.assembly.attempts.iter().any(|attempt| attempt.holds()))];
        if self.holding {
            self.memory.workspace.shares().largest(&mut held).map_err(apart)?;
        }
        Ok(held[0] > 0.0)
    }

    /// A first guess at `u`.
    pub(super) fn begin(&mut self, mut u: Vec<f64>) -> Result<Iterate, Failure> {
        let missing = self.missing(&mut u);
        self.evaluate(&u, missing.as_deref(), self.tangent())?;
        Ok((u, missing))
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
