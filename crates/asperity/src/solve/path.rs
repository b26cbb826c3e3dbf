//! Steps that follow a path of equilibria by its length, past limit points and snap-back.
//!
//! The load factor, the part of what the step changes of loads and prescribed motion, is an unknown besides the displacements. The
//! equation that goes with it says how far an increment leads, `|du| = s` over all nodes (cylindrical arc length: Riks, Int. J.
//! Solids Struct. 15, 1979; Crisfield, Comput. Struct. 13, 1981), linearised with everything else (Ramm 1981; Schweizerhof and
//! Wriggers, Comput. Methods Appl. Mech. Engrg. 59, 1986), so that there are no roots to choose from. Both are solved for with
//! the factor of the stiffness alone, once for the unbalanced forces and once for the load. The last increment carried on is
//! the first guess: it goes the same way along the path. The first increment of a step is one of the load factor and is the
//! measure of those that follow; the one that would pass the end of the step ends there.

use super::linear::LinearError;
use super::newton::{Newton, Trouble, Variant};
use super::schedule::{ArcLength, Until};
use super::step::Motion;
use crate::Failure;
use crate::system::{Evaluation, Role, Tangent};

/// What the solution for the load may leave of it where it is an iterative one.
const LOAD: f64 = 1e-7;
/// By what part of itself the square of the length of an increment may differ from what it should be.
const LENGTH: f64 = 0.05;
/// Difference of an end that is reached, over what leads to it.
const REACHED: f64 = 1e-9;
/// Cosine of the angle between two increments, at least: else the path turns back.
const AHEAD: f64 = -0.5;
/// Shortest part of a step that is taken where the whole cannot be evaluated.
const SHORTEST: f64 = 0.01;

/// The equation of the load factor.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Bound {
    /// The length of the increment.
    Length(f64),
    /// The load factor.
    Factor(f64),
    /// The end of the step by a displacement.
    End,
}

/// An attempt on its path.
#[derive(Debug)]
pub(super) struct Path<'a> {
    arc: &'a ArcLength,
    bound: Bound,
    /// Load factor of the trial state.
    factor: f64,
    /// Motion of the prescribed unknowns with the load factor; none where there is none.
    led: Option<Vec<f64>>,
    /// Room for the forces of loads.
    room: Evaluation,
}

/// Where a converged attempt came to on its path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reached {
    /// The load factor.
    pub factor: f64,
    /// Length of the increment.
    pub length: f64,
    /// Whether the step ends there.
    pub ends: bool,
}

impl Until {
    /// The mean of its unknowns.
    fn mean(&self, u: &[f64]) -> f64 {
        self.dofs.iter().map(|&dof| u[dof]).sum::<f64>() / self.dofs.len().max(1) as f64
    }
}

impl<'a> Newton<'a> {
    /// The first guess, evaluated.
    pub(super) fn begin_path(&mut self, arc: &'a ArcLength) -> Result<Vec<f64>, Failure> {
        let (state, dt) = (self.state, self.at.dt);
        let (mut u, mut factor) = (state.u.clone(), state.factor);
        let carried = state.last_dt > 0.0 && state.arc > 0.0;
        if carried {
            let part = dt / state.last_dt;
            u.iter_mut().zip(&state.last_change).for_each(|(u, change)| *u += part * change);
            factor += part * state.last_factor;
        }
        let bound = if carried { Bound::Length(state.arc * dt) } else { Bound::Factor(factor + dt / self.step.duration) };
        let room = self.memory.other.take().unwrap_or_else(|| Evaluation::new(&self.problem.terms, state));
        self.path = Some(Path { arc, bound, factor, led: self.led(), room });
        let aim = if let Bound::Factor(aim) = bound { aim } else { factor };
        if let Some(end) = self.end(&u, aim) {
            self.bind(end);
        }
        self.load_to(factor)?;
        self.evaluate_on_path(&u, self.tangent())?;
        Ok(u)
    }

    /// The motion of all prescribed unknowns over the step.
    fn led(&self) -> Option<Vec<f64>> {
        let mut led = vec![0.0; self.state.u.len()];
        for p in &self.step.prescribed {
            let start = p.value(&self.state.step_start);
            led[p.dof] = p.course.at(start, self.step.duration, self.step.duration) - start;
        }
        for p in self.step.prescribed.iter().filter(|p| !p.others.is_empty()) {
            led[p.dof] += p.others.iter().map(|&(other, c)| c * led[other]).sum::<f64>();
        }
        led.iter().any(|led| *led != 0.0).then_some(led)
    }

    fn bind(&mut self, bound: Bound) {
        self.path.iter_mut().for_each(|path| path.bound = bound);
    }

    /// Takes the trial state to a load factor.
    fn load_to(&mut self, factor: f64) -> Result<(), Failure> {
        self.path.iter_mut().for_each(|path| path.factor = factor);
        self.open_loads(factor)
    }

    /// Opens the loads at a load factor.
    fn open_loads(&mut self, factor: f64) -> Result<(), Failure> {
        self.at.factor = Some(factor);
        let terms = self.problem.terms.iter().zip(&self.state.histories);
        for ((term, history), attempt) in terms.zip(&mut self.assembly.attempts) {
            if term.role() == Role::Load {
                *attempt = term.attempt(self.state, history, self.at)?;
            }
        }
        Ok(())
    }

    /// Evaluates at `u`, and what the prescribed motion adds with the load factor where a matrix is found.
    pub(super) fn evaluate_on_path(&mut self, u: &[f64], tangent: Tangent) -> Result<(), Failure> {
        let led = self.path.as_mut().and_then(|path| path.led.take());
        let evaluated = self.evaluate(u, led.as_deref().filter(|_| tangent != Tangent::None), tangent);
        self.path.iter_mut().for_each(|path| path.led = led.clone());
        evaluated
    }

    /// Forces on the free unknowns by which the unbalanced ones fall with the load factor: those of loads, which go in
    /// proportion, and of prescribed motion.
    fn push(&mut self, u: &[f64]) -> Result<Vec<f64>, Failure> {
        let factor = self.path.as_ref().map_or(0.0, |path| path.factor);
        let (mut forces, before) = (self.loads_at(factor + 1.0, u)?, self.loads_at(factor, u)?);
        let led = self.path.as_ref().is_some_and(|path| path.led.is_some());
        for ((force, before), carried) in forces.iter_mut().zip(before).zip(&self.evaluation.carried) {
            *force -= before + if led { *carried } else { 0.0 };
        }
        let mut free = vec![0.0; self.residual.len()];
        self.step.constraints.gather(&forces, &mut free);
        Ok(free)
    }

    /// Forces of the loads at `u` and a load factor, at which they stay open.
    fn loads_at(&mut self, factor: f64, u: &[f64]) -> Result<Vec<f64>, Failure> {
        self.open_loads(factor)?;
        let Some(path) = &mut self.path else { return Ok(Vec::new()) };
        self.memory.workspace.evaluate_loads(&self.assembly, u, &mut path.room)?;
        Ok(path.room.load.clone())
    }

    /// Newton's step of displacements and load factor from `u`.
    pub(super) fn linearise_on_path(&mut self, (iteration, u): (usize, &[f64]), forcing: f64) -> Result<Motion, Trouble> {
        if !self.linearised {
            self.evaluate_on_path(u, self.tangent())?;
        }
        let mut push = self.push(u)?;
        let mut rhs: Vec<f64> = self.residual.iter().map(|r| -r).collect();
        self.memory.workspace.kinks(&self.assembly, u, &mut self.memory.kinks)?;
        let factorised = self.solve_linear(iteration, &mut rhs, forcing)?;
        let solved = if factorised || self.problem.newton.variant != Variant::Full {
            self.solver.solve(&mut push).map(|()| true)
        } else {
            self.solver.iterate_again(&self.evaluation.values, &mut push, LOAD)
        };
        if !solved.map_err(|error: LinearError| self.explain(error, 1))? {
            self.solver.refuse();
            return self.linearise_on_path((iteration, u), forcing);
        }
        let (mut du, mut with_load) = (vec![0.0; u.len()], vec![0.0; u.len()]);
        if let Some(led) = self.path.as_ref().and_then(|path| path.led.as_ref()) {
            with_load.copy_from_slice(led);
        }
        self.step.constraints.expand(&rhs, &mut du);
        self.step.constraints.expand(&push, &mut with_load);
        let load = self.load_change(u, &du, &with_load)?;
        du.iter_mut().zip(&with_load).for_each(|(du, with)| *du += load * with);
        let mut motion = Motion { du, part: 1.0, factorised, load };
        self.limit(u, None, &mut motion);
        motion.load *= motion.part;
        self.memory.mixed.aim(&self.assembly, &self.memory.kinks, &motion.du)?;
        Ok(motion)
    }

    /// Change of the load factor that goes with displacements `du` and `with_load` times itself.
    fn load_change(&self, u: &[f64], du: &[f64], with_load: &[f64]) -> Result<f64, Failure> {
        let Some(path) = &self.path else { return Ok(0.0) };
        let change = match (path.bound, &path.arc.until) {
            (Bound::Factor(factor), _) => factor - path.factor,
            (Bound::Length(length), _) => {
                let moved = self.moved(u);
                let missing = length * length - self.along(&moved, &moved) - 2.0 * self.along(&moved, du);
                missing / (2.0 * self.along(&moved, with_load))
            }
            (Bound::End, Some(until)) => (until.value - until.mean(u) - until.mean(du)) / until.mean(with_load),
            (Bound::End, None) => 1.0 - path.factor,
        };
        match change.is_finite() {
            true => Ok(change),
            false => Err(Failure::new("the load moves nothing along the path")),
        }
    }

    fn moved(&self, u: &[f64]) -> Vec<f64> {
        u.iter().zip(&self.state.u).map(|(u, before)| u - before).collect()
    }

    /// The product of two motions over the nodes.
    fn along(&self, a: &[f64], b: &[f64]) -> f64 {
        let nodes = self.problem.dofs.node(self.problem.dofs.nodes());
        a[..nodes].iter().zip(&b[..nodes]).map(|(a, b)| a * b).sum()
    }

    /// Goes along a step; the part of the whole that was taken.
    pub(super) fn advance_on_path(&mut self, u: &mut Vec<f64>, (motion, tangent): (&Motion, Tangent)) -> Result<f64, Failure> {
        let (begin, factor) = (u.clone(), self.path.as_ref().map_or(0.0, |path| path.factor));
        let mut part = 1.0;
        loop {
            self.memory.mixed.follow(part);
            u.iter_mut().zip(begin.iter().zip(&motion.du)).for_each(|(u, (begin, du))| *u = begin + part * du);
            let evaluated =
                self.load_to(factor + part * motion.load).and_then(|()| self.evaluate_on_path(u, tangent));
            match evaluated {
                Ok(()) => return Ok(part * motion.part),
                Err(failure) if part <= SHORTEST => return Err(failure),
                Err(_) => part *= 0.5,
            }
        }
    }

    /// The end of the step, where a state lies at it or beyond it.
    fn end(&self, u: &[f64], factor: f64) -> Option<Bound> {
        let path = self.path.as_ref()?;
        let passed = match &path.arc.until {
            None => factor >= 1.0 - REACHED,
            Some(until) => {
                let [before, now] = [&self.state.u[..], u].map(|u| until.mean(u) - until.value);
                before * now <= REACHED * before.abs() * until.value.abs()
            }
        };
        passed.then_some(Bound::End)
    }

    /// Whether forces that balance at `u` do so where the increment should end. One that has passed the end of the step is to
    /// end there.
    ///
    /// # Errors
    /// A [`Failure`] where the path turned back.
    pub(super) fn arrives(&mut self, u: &[f64]) -> Result<bool, Failure> {
        let Some(path) = &self.path else { return Ok(true) };
        let (moved, last) = (self.moved(u), &self.state.last_change);
        let there = match (path.bound, &path.arc.until) {
            (Bound::Factor(factor), _) => (factor - path.factor).abs() <= REACHED * factor.abs(),
            (Bound::Length(length), _) => (self.along(&moved, &moved) / (length * length) - 1.0).abs() <= LENGTH,
            (Bound::End, None) => (path.factor - 1.0).abs() <= REACHED,
            (Bound::End, Some(until)) => (until.mean(u) - until.value).abs() <= REACHED * until.value.abs(),
        };
        if !there {
            return Ok(false);
        }
        let sizes = self.along(&moved, &moved) * self.along(last, last);
        if self.state.last_dt > 0.0 && self.along(&moved, last) < AHEAD * sizes.sqrt() {
            return Err(Failure::new("the path turns back on itself"));
        }
        if path.bound != Bound::End
            && let Some(end) = self.end(u, path.factor)
        {
            self.bind(end);
            return self.arrives(u);
        }
        Ok(true)
    }

    /// Where the attempt came to.
    pub(super) fn reached(&mut self, u: &[f64]) -> Option<Reached> {
        let moved = self.moved(u);
        let length = self.along(&moved, &moved).sqrt();
        let path = self.path.take()?;
        self.memory.other = Some(path.room);
        Some(Reached { factor: path.factor, length, ends: path.bound == Bound::End })
    }
}
