//! Steps that follow a path of equilibria by its length, past limit points and snap-back.
//!
//! The load factor, the part of what the step changes of loads and prescribed motion, is an unknown besides the displacements. The
//! equation that goes with it says how far an increment leads, `|du| = s` over all nodes (cylindrical arc length: Riks, Int. J.
//! Solids Struct. 15, 1979; Crisfield, Comput. Struct. 13, 1981), linearised with everything else (Ramm 1981; Schweizerhof and
//! Wriggers, Comput. Methods Appl. Mech. Engrg. 59, 1986), so that there are no roots to choose from. Both are solved for with
//! the factor of the stiffness alone, once for the unbalanced forces and once for the load; a spring that is in the matrix, and not in the
//! equations, keeps it regular at limit points. The last increment carried on is
//! the first guess: it goes the same way along the path. The first increment of a step is one of the load factor and is the
//! measure of those that follow; the one that would pass the end of the step ends there. Where contact closes or opens the path has a corner,
//! beyond which a motion carried on leads nowhere: there it begins anew with an increment of the load factor.

use super::constants::path::{AHEAD, LENGTH, LOAD, REACHED, SHORTEST};
use super::newton::{Newton, SolveError};
use super::schedule::{ArcLength, Until};
use super::step::NewtonStep;
use crate::system::{Evaluation, Role, Tangent, apart};
use crate::{Failure, FailureKind};

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

/// A spring that makes the stiffness regular at a limit point. Its force is taken out again: to hold an unknown of a motion `du` by
/// a stiffness `k` and to push it by `k du` is to do nothing.
#[derive(Debug, Clone, Copy)]
struct Spring {
    dof: usize,
    /// Its number among the free unknowns, and its place on the diagonal, if this rank has that.
    row: usize,
    place: Option<usize>,
    stiffness: f64,
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
    sprung: Option<Sprung>,
}

/// Where a converged attempt came to on its path.
#[derive(Debug, Clone, PartialEq)]
pub struct Reached {
    /// The load factor.
    pub factor: f64,
    /// Length of the increment.
    pub length: f64,
    /// Whether the step ends there.
    pub ends: bool,
    /// What the matrix that was factorised last has besides the stiffness.
    pub(super) sprung: Option<Sprung>,
}

/// A spring in a matrix that was factorised.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sprung {
    /// The free unknown that it holds.
    pub row: usize,
    /// What the matrix answers to the force of the spring over the motion of that unknown.
    pub answer: Vec<f64>,
}

impl Sprung {
    /// Whether the stiffness without the spring has a negative eigenvalue more, by the inertia of
    /// `[[K + k e e^T, e], [e^T, 1 / k]]`, and its determinant another sign.
    pub fn more(&self) -> usize {
        usize::from(self.answer[self.row] > 1.0)
    }
    /// Makes a solution with the matrix one without the spring (Sherman and Morrison).
    pub fn without(&self, x: &mut [f64]) {
        let pulled = x[self.row] / (1.0 - self.answer[self.row]);
        x.iter_mut().zip(&self.answer).for_each(|(x, answer)| *x += pulled * answer);
    }
}

impl Until {
    /// Where it stands, and that it is there already where it is.
    pub(super) fn stands(&self, u: &[f64]) -> (f64, bool) {
        let mean = self.mean(u);
        (mean, (mean - self.value).abs() <= REACHED * self.value.abs())
    }
    /// The mean of its unknowns.
    fn mean(&self, u: &[f64]) -> f64 {
        self.dofs.iter().map(|&dof| u[dof]).sum::<f64>() / self.dofs.len().max(1) as f64
    }
}

/// Whether a matrix was factorised, and what the force of the spring does.
type Solved = (bool, Option<Vec<f64>>);

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
        let load = dt / self.step.duration;
        let load = if state.last_factor < 0.0 { -load } else { load };
        let bound = if carried { Bound::Length(state.arc * dt) } else { Bound::Factor(factor + load) };
        let room = self.memory.other.take().unwrap_or_else(|| Evaluation::new(&self.problem.terms, state));
        self.path = Some(Path { arc, bound, factor, led: self.led(), room, sprung: None });
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
    pub(super) fn linearise_on_path(
        &mut self,
        (iteration, u): (usize, &[f64]),
        forcing: f64,
    ) -> Result<NewtonStep, SolveError> {
        if !self.linearised {
            self.evaluate_on_path(u, self.tangent())?;
        }
        let mut push = self.push(u)?;
        let led = self.path.as_ref().is_some_and(|path| path.led.is_some());
        if !led && push.iter().all(|force| *force == 0.0) {
            return Err(SolveError::End(Failure::new(format!(
                "step '{}' follows a path, and no load on what is free changes in it: say the load whose factor is followed, or leave \
                 `control` out",
                self.step.name
            ))));
        }
        let mut rhs: Vec<f64> = self.residual.iter().map(|r| -r).collect();
        self.memory.workspace.kinks(&self.assembly, u, &mut self.memory.kinks)?;
        let spring = self.spring()?;
        let place = spring.and_then(|spring| spring.place).map(|place| (place, self.evaluation.values[place]));
        if let (Some(spring), Some((place, value))) = (&spring, place) {
            self.evaluation.values[place] = value + spring.stiffness;
        }
        let solved = self.solve_all(iteration, [&mut rhs, &mut push], (spring.as_ref(), forcing));
        if let Some((place, value)) = place {
            self.evaluation.values[place] = value;
        }
        let Some((factorised, by_spring)) = solved? else {
            self.system.invalidate_factor();
            return self.linearise_on_path((iteration, u), forcing);
        };
        let (mut du, mut with_load, mut with_spring) = (vec![0.0; u.len()], vec![0.0; u.len()], vec![0.0; u.len()]);
        if let Some(led) = self.path.as_ref().and_then(|path| path.led.as_ref()) {
            with_load.copy_from_slice(led);
        }
        self.step.constraints.expand(&rhs, &mut du);
        self.step.constraints.expand(&push, &mut with_load);
        if let (Some(spring), Some(answer)) = (&spring, by_spring) {
            self.step.constraints.expand(&answer, &mut with_spring);
            if factorised {
                let sprung = Some(Sprung { row: spring.row, answer });
                self.path.iter_mut().for_each(|path| path.sprung.clone_from(&sprung));
            }
        }
        let [load, pulled] = self.changes(u, [&du, &with_load, &with_spring], spring.map(|spring| spring.dof))?;
        for (du, (load_moves, spring_moves)) in du.iter_mut().zip(with_load.iter().zip(&with_spring)) {
            *du += load * load_moves + pulled * spring_moves;
        }
        let mut motion = NewtonStep { du, part: 1.0, factorised, load, lost: false };
        self.limit(u, None, &mut motion);
        motion.load *= motion.part;
        self.memory.mip.aim(&self.assembly, &self.memory.kinks, (u, &motion.du))?;
        Ok(motion)
    }

    /// The spring that holds what moved most in the last increment.
    fn spring(&self) -> Result<Option<Spring>, Failure> {
        let (free, last) = (self.step.constraints.free(), &self.state.last_change);
        let nodes = self.problem.dofs.node(self.problem.dofs.nodes());
        let among = free.iter().enumerate().filter(|(_, dof)| **dof < nodes && self.state.last_dt > 0.0);
        let most = among.max_by(|a, b| last[*a.1].abs().total_cmp(&last[*b.1].abs()));
        let Some((row, &dof)) = most else { return Ok(None) };
        let place = self.memory.workspace.pattern().diagonal(row);
        let mut stiffness = [place.map_or(0.0, |place| self.evaluation.values[place].abs())];
        self.memory.workspace.shares().largest(&mut stiffness).map_err(apart)?;
        Ok(Some(Spring { dof, row, place, stiffness: stiffness[0] }))
    }

    /// Solves for unbalanced forces, load, and the force of the spring over the motion of its unknown; whether a matrix was
    /// factorised. None where an old factor does not serve.
    fn solve_all(
        &mut self,
        iteration: usize,
        [rhs, push]: [&mut Vec<f64>; 2],
        (spring, forcing): (Option<&Spring>, f64),
    ) -> Result<Option<Solved>, SolveError> {
        let factorised = self.solve_linear(iteration, rhs, forcing)?;
        let mut pulled = spring.map(|spring| {
            let mut forces = vec![0.0; push.len()];
            forces[spring.row] = spring.stiffness;
            forces
        });
        for more in std::iter::once(push).chain(&mut pulled) {
            let solved = self.system.solve_again(&self.evaluation.values, more, LOAD);
            if !solved.map_err(|error| self.explain(error, 1))? {
                return Ok(None);
            }
        }
        Ok(Some((factorised, pulled)))
    }

    /// Changes of the load factor and of the unknown that the spring holds, from the equation of the increment and from what
    /// the spring is to be without force: the step is `du[0] + load du[1] + pulled du[2]`.
    fn changes(&self, u: &[f64], du: [&[f64]; 3], sprung: Option<usize>) -> Result<[f64; 2], Failure> {
        let Some(path) = &self.path else { return Ok([0.0; 2]) };
        let moved = self.moved(u);
        // The equation of the increment: a row over (load, pulled) and what it is to be.
        let (first, wanted) = match (path.bound, &path.arc.until) {
            (Bound::Factor(factor), _) => ([1.0, 0.0], factor - path.factor),
            (Bound::End, None) => ([1.0, 0.0], 1.0 - path.factor),
            (Bound::Length(length), _) => {
                let [rest, load, pulled] = du.map(|du| 2.0 * self.along(&moved, du));
                ([load, pulled], length * length - self.along(&moved, &moved) - rest)
            }
            (Bound::End, Some(until)) => {
                let [rest, load, pulled] = du.map(|du| until.mean(du));
                ([load, pulled], until.value - until.mean(u) - rest)
            }
        };
        let (second, held) = match sprung {
            Some(dof) => ([du[1][dof], du[2][dof] - 1.0], -du[0][dof]),
            None => ([0.0, 1.0], 0.0),
        };
        let determinant = first[0] * second[1] - first[1] * second[0];
        let load = (wanted * second[1] - first[1] * held) / determinant;
        let pulled = (first[0] * held - wanted * second[0]) / determinant;
        match load.is_finite() && pulled.is_finite() {
            true => Ok([load, pulled]),
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
    pub(super) fn advance_on_path(
        &mut self,
        u: &mut [f64],
        (motion, tangent): (&NewtonStep, Tangent),
    ) -> Result<f64, Failure> {
        let (begin, factor) = (u.to_vec(), self.path.as_ref().map_or(0.0, |path| path.factor));
        let mut part = 1.0;
        loop {
            self.memory.mip.follow(part);
            u.iter_mut().zip(begin.iter().zip(&motion.du)).for_each(|(u, (begin, du))| *u = begin + part * du);
            let evaluated = self.load_to(factor + part * motion.load).and_then(|()| self.evaluate_on_path(u, tangent));
            match evaluated {
                Ok(()) => return Ok(part * motion.part),
                Err(failure) if part <= SHORTEST || failure.kind == FailureKind::Apart => return Err(failure),
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
        Some(Reached { factor: path.factor, length, ends: path.bound == Bound::End, sprung: path.sprung })
    }
}
