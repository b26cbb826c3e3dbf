//! The first guess of an attempt.
//!
//! The predictor carries all unknowns on with the last accepted increment, or along the parabola through the last three states
//! where that would have foretold the last of them much better, as it does where a motion is smooth: a body that is upset
//! spreads the faster the flatter it is, and a straight line misses its volume by the square of the increment's strain. What
//! prescribed unknowns still miss enters the first solution as known motion (`K_ff dq = -(r + K_fc missing)`), so that a driven
//! row takes the elements behind it along instead of turning them inside out.
//!
//! Contact stresses are carried on too. The straight motion leads off a round tool by the sagitta of its way, far more than a stiff
//! penalty lets a point penetrate; the first step is therefore made with the points closed whose pressure, carried on, still presses.
//! As in the primal-dual active set strategy (Hueber & Wohlmuth, Comput. Methods Appl. Mech. Eng. 194, 2005) the stress
//! decides and not the gap alone.

use super::constants::predictor::{ROUNDING, SMOOTH};
use super::newton::{Iterate, Newton, SolveError};
use crate::system::{State, apart};
use crate::{Failure, FailureKind};

impl Newton<'_> {
    /// First guess, evaluated, and what the prescribed unknowns still miss there: the motion of the last increment carried on; the
    /// accepted state where there is none, or where what that leads to cannot be evaluated.
    pub(super) fn predict(&mut self) -> Result<Iterate, SolveError> {
        let state = self.state;
        if state.last_dt > 0.0 {
            self.hold(true);
            let (mut ahead, ratio) = (state.ahead(self.at.dt), self.at.dt / state.last_dt);
            for whole in self.problem.wholes.iter().filter(|_| !state.bends) {
                whole.turn_on(&self.problem.dofs, [&state.u, &state.last_change], ratio, &mut ahead);
            }
            match self.begin(ahead) {
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
        self.memory.mip.guess();
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

/// Takes note that the unknowns have come to `u` over `dt`, the first of them displacements of nodes.
pub(super) fn learn(state: &mut State, u: &[f64], dt: f64, displacements: usize) {
    let (before, last) = (state.last_dt, &state.last_change);
    let change: Vec<f64> = u.iter().zip(&state.u).map(|(now, before)| now - before).collect();
    let missed = |parabola: bool| {
        let told = state.carried(dt, parabola);
        u.iter().zip(told).take(displacements).map(|(now, told)| (now - told).abs()).fold(0.0, f64::max)
    };
    state.bends = before > 0.0 && !state.bend.is_empty() && missed(true) < SMOOTH * missed(false);
    let faster = |(now, last): (&f64, &f64)| (now / dt - last / before) / (dt + before);
    state.bend = if before > 0.0 { change.iter().zip(last).map(faster).collect() } else { Vec::new() };
    (state.last_change, state.last_dt) = (change, dt);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A state that went along a curve, at times that are not even.
    fn gone(curve: impl Fn(f64) -> f64, times: &[f64]) -> State {
        let mut state = State { u: vec![curve(times[0])], last_change: vec![0.0], ..State::default() };
        for two in times.windows(2) {
            let u = vec![curve(two[1])];
            learn(&mut state, &u, two[1] - two[0], 1);
            state.u = u;
        }
        state
    }

    #[test]
    fn a_smooth_motion_goes_on_along_its_parabola_and_a_kink_straight_on() {
        let parabola = |t: f64| 1.0 + 2.0 * t - 3.0 * t * t;
        let state = gone(parabola, &[0.0, 0.1, 0.3, 0.35]);
        assert!(state.bends && (state.ahead(0.2)[0] - parabola(0.55)).abs() < 1e-14);
        // Two increments make a parabola, and the third tells whether it holds.
        assert!(!gone(parabola, &[0.0, 0.1, 0.3]).bends);
        let kinked = gone(|t| parabola(t) + 5.0 * (t - 0.3).max(0.0), &[0.0, 0.1, 0.3, 0.35]);
        let straight = kinked.u[0] + kinked.last_change[0] * (0.2 / 0.05);
        assert!(!kinked.bends && (kinked.ahead(0.2)[0] - straight).abs() < 1e-14);
    }
}
