//! Steps and increments: the loop around the attempts.

use super::constants::increments::{ATTEMPTS, BACK, CUBIC, DRIVEN, FAR, JUMPED, LEAP, NEAR, NOISE, RELAX, RETURNS};
use super::constants::path::{ASTRAY, CORNER};
use super::constants::regularisation::CLOSE;
use super::constants::sizes::{AIM, EASY, PAST, UNEVEN};
use super::linear::{LinearSolver, LinearSystem, SolverCounts, engine};
use super::newton::{self, Converged, Memory, Newton, SolveError};
use super::observer::{AttemptRecord, Observer};
use super::path::Reached;
use super::predict::learn;
use super::problem::{Problem, largest};
use super::rigid::free_motions;
use super::schedule::Step;
use super::snap::{Snap, set_free};
use super::stability::{Look, Stability, Turn, softens};
use crate::system::{Caution, Energies, Evaluation, Interpenetration, Signs, Softest, State, Unevenness, Workspace};
use crate::{Error, Failure, FailureKind};
use std::time::{Duration, Instant};

/// Options of a run.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RunOptions {
    /// Stop after this many accepted increments, if given.
    pub increments: Option<usize>,
}

/// Why a run ended well.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stop {
    /// All steps are done.
    Done,
    /// The observer asked for it, or the given number of increments is reached.
    Asked,
}

/// A run: the accepted state and the memory around it.
pub struct Run<'a> {
    /// The problem.
    pub problem: &'a Problem,
    /// The accepted state.
    pub state: State,
    /// Memory of the iterations.
    pub memory: Memory,
    /// Time that the audit took.
    pub audited: Duration,
    /// Signs of the tangents so far.
    pub stability: Stability,
    /// What was held still first that nothing held, in words, and when.
    pub first_held: Option<(String, f64)>,
    /// The most unevenly that a body crept over an increment, beyond what is allowed, which body, and when.
    pub uneven: Option<(f64, String, f64)>,
    /// What the run failed of, if it did.
    pub ended: FailureKind,
    system: LinearSystem,
    /// Whether the first state is known to be one of the problem.
    fits: bool,
}

/// How far an increment leapt, over the size of the model: what it moved where that is far more than at the speed of the
/// increment before and than what it was driven.
fn leap([before, driven, moved]: [f64; 3], size: f64) -> f64 {
    let leaps = before > 0.0 && moved > LEAP * before && moved > DRIVEN * driven && moved > FAR * size;
    if leaps { moved / size } else { 0.0 }
}

impl<'a> Run<'a> {
    /// A run from a given state: the initial one or that of a checkpoint.
    pub fn new(problem: &'a Problem, state: State, solver: Box<dyn LinearSolver>) -> Self {
        Self {
            problem,
            state,
            memory: Memory { workspace: Workspace::of(engine::others()), ..Memory::default() },
            audited: Duration::ZERO,
            stability: Stability::default(),
            first_held: None,
            uneven: None,
            ended: FailureKind::Other,
            system: LinearSystem::new(solver, problem.newton.policy(), problem.dofs.clone()),
            fits: false,
        }
    }

    /// What the linear systems took so far.
    pub fn solver_counts(&self) -> SolverCounts {
        self.system.counts()
    }

    /// Runs to the end of the last step.
    ///
    /// # Errors
    /// [`Error::NotConverged`] when the increments shrink to nothing or a motion is held by nothing; [`Error::Input`] when
    /// it does not fit into memory or began with a state of another model; an error of the observer. An observer that asks
    /// for a stop is no error.
    pub fn run(&mut self, options: &RunOptions, observer: &mut dyn Observer) -> Result<Stop, Error> {
        self.check_state()?;
        self.problem.check_memory(&self.state)?;
        let mut accepted = 0;
        while self.state.step < self.problem.steps.len() {
            if observer.wants_stop() || options.increments.is_some_and(|most| accepted >= most) {
                return Ok(Stop::Asked);
            }
            match self.advance(observer) {
                Err(Error::Stopped) => return Ok(Stop::Asked),
                advanced => advanced?,
            };
            accepted += 1;
        }
        Ok(Stop::Done)
    }

    /// The state that a run begins with is one of its problem.
    fn check_state(&mut self) -> Result<(), Error> {
        if !self.fits {
            self.problem.fits(&self.state).map_err(Error::Input)?;
            self.fits = true;
        }
        Ok(())
    }

    /// Solves the next increment and accepts it; none when all steps are done.
    ///
    /// # Errors
    /// As [`run`](Self::run), and [`Error::Stopped`] when the observer asks for it between two iterations. The accepted state
    /// then is the last one that was reached.
    pub fn advance(&mut self, observer: &mut dyn Observer) -> Result<Option<AttemptRecord>, Error> {
        self.check_state()?;
        let Some(step) = self.problem.steps.get(self.state.step) else { return Ok(None) };
        if self.state.step_increment >= step.increments.most {
            self.ended = FailureKind::TooMany;
            return Err(self.too_many(step));
        }
        if let Some(until) = step.arc_length.as_ref().and_then(|arc| arc.until.as_ref())
            && self.state.step_increment == 0
            && let (mean, true) = until.stands(&self.state.u)
        {
            return Err(Error::Input(format!(
                "step '{}' is over before it begins: the mean displacement of its `until` is {mean} already; give another one",
                step.name
            )));
        }
        self.enter();
        let record = self.increment(step, observer)?;
        observer.accepted(&self.state, &record)?;
        Ok(Some(record))
    }

    /// Rigid motions that meet no stiffness at the accepted state, in words: "body 'billet' is free along y". Contact that
    /// has not closed yet holds nothing. Nothing is factorised.
    ///
    /// # Errors
    /// An error when the state cannot be evaluated, or there is no step left.
    pub fn free_motions(&self) -> Result<Vec<String>, Error> {
        let Some(step) = self.problem.steps.get(self.state.step) else { return Ok(Vec::new()) };
        let dt = step.next(self.state.next_dt, self.state.step_time);
        let motions = free_motions(self.problem, &self.state, dt).map_err(|f| Error::NotConverged(f.reason))?;
        Ok(if motions.is_empty() { Vec::new() } else { self.problem.name_motions(&motions) })
    }

    /// Solves one increment, cutting it as often as needed, and accepts it.
    fn increment(&mut self, step: &Step, observer: &mut dyn Observer) -> Result<AttemptRecord, Error> {
        // What a path does past its limit points is no jump.
        let still = step.arc_length.is_some() || !self.problem.relaxes();
        let (mut wanted, mut relaxing, mut relaxed) = (self.state.next_dt, false, still);
        let mut caution = self.state.caution;
        // In a step that has just begun no size has served.
        let begun = self.state.step_time > 0.0;
        let (arc, stopped, spent) =
            (self.state.arc, self.state.stopped.clone(), [self.state.attempts, self.state.iterations]);
        let served = if begun { caution.usual(step) } else { RELAX * caution.usual(step) };
        let again = self.problem.contacts.is_empty() && self.state.jumps > 0;
        let longest = if again { served } else { RELAX * served };
        let (mut cause, mut returns) = (String::new(), 0);
        for attempt in 1..=ATTEMPTS {
            let dt = step.next(wanted, self.state.step_time);
            let mut record = self.begin(attempt, dt, relaxing);
            self.memory.unborne.clear();
            let result = self.attempt(dt, &mut record, observer);
            self.state.attempts += 1;
            self.state.iterations += record.solutions();
            let result = result.and_then(|mut converged| {
                self.nothing_bears_stopped(&converged)?;
                converged.held.extend(self.stopped());
                self.take_stops(&mut converged);
                Ok((self.audit(&converged, !relaxing)?, converged))
            });
            match result {
                Ok((found, mut converged)) => {
                    if self.leaves_path(step, &converged, record.solutions()) && step.may_halve(dt) && !relaxing {
                        record.failure = Some("the first increment of a path leads far from where it began".into());
                        observer.attempt(&record);
                        wanted = 0.5 * dt;
                        continue;
                    }
                    let may_return = returns < RETURNS && !relaxing && step.arc_length.is_none() && step.may_halve(dt);
                    let bears = self.problem.contact_bears(&self.state.energies);
                    if may_return && !bears && self.goes_back(step, &converged, dt) {
                        record.failure =
                            Some("it goes back on the way that the increments before it went, as no path does".into());
                        observer.attempt(&record);
                        caution.fail(dt);
                        (wanted, returns) = (0.5 * dt, returns + 1);
                        continue;
                    }
                    let (unevenness, body) = self.unevenness(step, &converged, dt);
                    let even = step.even(dt, unevenness);
                    if let Some(size) = even.filter(|size| unevenness > UNEVEN && *size < AIM * dt && !relaxing) {
                        record.failure = Some(format!("body '{body}' creeps unevenly over it"));
                        observer.attempt(&record);
                        wanted = size;
                        continue;
                    }
                    if converged.held.is_empty() {
                        let before = (self.state.signs, self.state.softest.clone());
                        let look = Look {
                            problem: self.problem,
                            record: &record,
                            values: &converged.evaluation.values,
                            memory: &self.memory,
                            system: &mut self.system,
                            sprung: converged.reached.as_mut().and_then(|reached| reached.sprung.take()),
                        };
                        record.turn = self.stability.look(&mut self.state, look);
                        if let Some(turn) = record.turn.take_if(|_| step.arc_length.is_none()) {
                            record.turn = self.look_again(turn, (&record, &converged.u), before.clone());
                        }
                        // A contact that closes in this increment bears at its end.
                        let closes = !bears && self.problem.contact_bears(&converged.evaluation.energies);
                        let goes_on = closes || self.state.last_dt > 0.0 && keeps_contact(&record);
                        let crosses = |turn: &Turn| {
                            let path = !(bears || closes) || goes_on && turn.deforms(self.problem);
                            path && turn.crosses(&self.state, (&converged.u, dt), self.problem.size)
                        };
                        if may_return && record.turn.as_ref().is_some_and(crosses) {
                            (self.state.signs, self.state.softest) = before;
                            self.stability.forget_last();
                            (record.turn, record.failure) =
                                (None, Some("it goes past a bifurcation, back on the way to its mode".into()));
                            observer.attempt(&record);
                            caution.fail(dt);
                            (wanted, returns) = (0.5 * dt, returns + 1);
                            continue;
                        }
                    }
                    observer.attempt(&record);
                    self.state.caution = caution;
                    self.accept(step, (&record, wanted), converged)?;
                    self.note(found);
                    // The step that follows keeps increments that were given.
                    let given = self.problem.steps.get(self.state.step).is_some_and(Step::is_given);
                    if let Some(size) = even.filter(|_| !given) {
                        self.state.next_dt = self.state.next_dt.min(size);
                    }
                    if unevenness > self.uneven.as_ref().map_or(UNEVEN, |(most, ..)| *most) {
                        self.uneven = Some((unevenness, body, self.state.time));
                    }
                    return Ok(record);
                }
                Err(SolveError::End(failure)) => {
                    (record.failure, record.kind) = (Some(failure.reason.clone()), failure.kind);
                    observer.attempt(&record);
                    self.ended = failure.kind;
                    return Err(Error::NotConverged(failure.reason));
                }
                Err(SolveError::Error(error)) => {
                    record.failure = Some(error.to_string());
                    observer.attempt(&record);
                    // What goes on from here does so as if the increment had not begun.
                    (self.state.arc, self.state.stopped) = (arc, stopped);
                    [self.state.attempts, self.state.iterations] = spent;
                    return Err(error);
                }
                Err(SolveError::Failure(failure)) => {
                    if let Some(with) = self.memory.workspace.shares().with() {
                        with.failed(&failure.reason);
                    }
                    (record.failure, record.kind) = (Some(failure.reason.clone()), failure.kind);
                    observer.attempt(&record);
                    // Relaxation is the last resort: what made it one is why the increment failed.
                    if !relaxing || cause.is_empty() {
                        (cause, self.ended) = (failure.reason, failure.kind);
                    } else {
                        cause = format!("{cause}; {}", failure.reason);
                    }
                    caution.fail(dt);
                    relaxed |= relaxing;
                    let small = relaxing || dt <= longest && !caution.vain;
                    if small && self.stops() {
                        relaxing = false;
                        continue;
                    }
                    if self.begins_anew(dt / served) {
                        wanted = served;
                        continue;
                    }
                    caution.vain |= relaxing;
                    relaxing = !relaxed && (small || !step.may_halve(dt));
                    if !relaxing && !step.may_halve(dt) {
                        return Err(self.give_up(step, dt, &cause));
                    }
                    wanted = if relaxing { dt } else { 0.5 * dt };
                }
            }
        }
        Err(self.give_up(step, wanted, "too many attempts at one increment"))
    }

    /// Whether the first increment of a path, which is one of the load, may have gone past a limit point: it took many iterations and
    /// moved a node far.
    fn leaves_path(&self, step: &Step, converged: &Converged, iterations: usize) -> bool {
        if step.arc_length.is_none() || self.state.arc > 0.0 || iterations <= EASY {
            return false;
        }
        let nodes = self.problem.dofs.nodes() * self.problem.dofs.per_node();
        let moved = converged.u[..nodes].iter().zip(&self.state.u).map(|(now, before)| now - before);
        newton::largest(moved) > ASTRAY * self.problem.size
    }

    /// Looks again for a turn from the signs and the softest mode that were known `before`, with the derivative of the forces at the converged
    /// unknowns: the matrix of a first iteration turns with stresses of the accepted state, which do not balance the loads that act now.
    fn look_again(
        &mut self,
        turn: Turn,
        (record, u): (&AttemptRecord, &[f64]),
        before: (Option<Signs>, Option<Softest>),
    ) -> Option<Turn> {
        let newton = Newton::open(self.problem, &self.state, record.dt, &mut self.memory, &mut self.system);
        let Ok(evaluation) = newton.and_then(|newton| newton.derivative_at(u)) else {
            return Some(turn);
        };
        self.stability.forget_last();
        (self.state.signs, self.state.softest) = before;
        let look = Look {
            problem: self.problem,
            record,
            values: &evaluation.values,
            memory: &self.memory,
            system: &mut self.system,
            sprung: None,
        };
        let turn = self.stability.look_at(&mut self.state, look);
        self.memory.spare = Some(evaluation);
        turn
    }

    /// Begins a path anew, where increments fail down to such a part of what had served and contact may have made a corner of it; whether it did.
    fn begins_anew(&mut self, part: f64) -> bool {
        let anew = self.state.arc > 0.0 && part < CORNER && !self.problem.contacts.is_empty();
        if anew {
            self.state.arc = 0.0;
        }
        anew
    }

    /// Whether an increment goes back on the way that those before it went, farther than it would have gone on and than it is driven, while
    /// what drives it goes on and the stiffness falls: Newton's method has then come to another branch than the one that a path near it leads to, the other side of a
    /// column that buckles, or its straight shape beyond the Euler load.
    fn goes_back(&self, step: &Step, converged: &Converged, dt: f64) -> bool {
        let state = &self.state;
        if state.last_dt == 0.0 || !softens(state, dt) || step.turns_between(state.step_time, [state.last_dt, dt]) {
            return false;
        }
        let (mut along, mut squares, mut most) = (0.0, [0.0; 2], 0.0_f64);
        let nodes = self.problem.dofs.nodes() * self.problem.dofs.per_node();
        let changes = converged.u[..nodes].iter().zip(&state.u).map(|(now, before)| now - before);
        for (change, last) in changes.zip(&state.last_change) {
            let carried = last * (dt / state.last_dt);
            along += change * carried;
            (squares[0], squares[1]) = (squares[0] + change * change, squares[1] + carried * carried);
            most = most.max(change.abs());
        }
        let driven = step.prescribed.iter().map(|p| (converged.u[p.dof] - state.u[p.dof]).abs()).fold(0.0, f64::max);
        along < 0.0
            && squares[0] > BACK * BACK * squares[1]
            && most > DRIVEN * driven
            && most > NEAR * self.problem.size
    }

    /// How wrong the stress of a body may be at most, as a part of it, or the strain that loads make, because it crept unevenly over an
    /// increment, and its name.
    ///
    /// The strain is wrong so far as loads, and not prescribed motions, do the work that creep dissipates. It may be wrong by a part of
    /// what the increment adds, or by a small part of all that the terms have taken up.
    fn unevenness(&self, step: &Step, converged: &Converged, dt: f64) -> (f64, String) {
        let Converged { evaluation, u, .. } = converged;
        let lanes = self.state.histories.iter().zip(&evaluation.histories).zip(&evaluation.energies);
        let terms = self.problem.terms.iter().zip(lanes).enumerate().filter(|(number, _)| !step.idle.contains(number));
        let moved = u.iter().zip(&self.state.u).zip(self.state.load.iter().zip(&evaluation.load));
        let past = PAST * exchanged(&self.state)[0].abs();
        let work: f64 = moved.map(|((now, before), (f0, f1))| 0.5 * (f0 + f1) * (now - before)).sum();
        let all = terms.map(|(_, (term, ((old, new), energies)))| {
            let Unevenness { stress, power } = term.unevenness(old, new, dt);
            let crept = energies.dissipated.min(work).max(0.0);
            let strain = if crept > 0.0 { power * crept / (work + past) } else { 0.0 };
            (stress.max(strain), term.name())
        });
        let (most, name) = all.fold((0.0, ""), |most, one| if one.0 > most.0 { one } else { most });
        (most, name.to_owned())
    }

    /// Looks whether anything lies in anything in a converged state, or came through something on the way to it.
    /// What sprang free did not go `straight`.
    fn audit(&mut self, converged: &Converged, straight: bool) -> Result<[Interpenetration; 2], Failure> {
        let Some(audit) = &self.problem.audit else { return Ok(Default::default()) };
        let begun = Instant::now();
        let idle = self.problem.steps.get(self.state.step).map_or(&[][..], |step| &step.idle);
        let found = audit.check([&self.state.u, &converged.u], (&converged.evaluation.histories, idle), straight);
        self.audited += begun.elapsed();
        found
    }

    /// Keeps what the audit found in the accepted increment.
    fn note(&mut self, found: [Interpenetration; 2]) {
        let increment = self.state.increment;
        let [found, deepest] = found.map(|found| Interpenetration { increment, ..found });
        self.state.deepest_node = deepest;
        if found.relative > self.state.worst_interpenetration.relative {
            self.state.worst_interpenetration = found.clone();
        }
        self.state.interpenetration = found;
    }

    fn begin(&self, attempt: usize, dt: f64, relaxed: bool) -> AttemptRecord {
        AttemptRecord {
            step: self.state.step,
            increment: self.state.increment + 1,
            attempt,
            step_time: self.state.step_time + dt,
            time: self.state.time + dt,
            dt,
            relaxed,
            ..AttemptRecord::default()
        }
    }

    /// How far the step has come, in words.
    fn came_to(&self, step: &Step) -> String {
        match step.arc_length {
            Some(_) => format!("load factor {:.4}", self.state.factor),
            None => format!("{:.4} of its duration", self.state.step_time / step.duration),
        }
    }

    fn too_many(&self, step: &Step) -> Error {
        let until = step.arc_length.as_ref().and_then(|arc| arc.until.as_ref());
        let far = until.map_or(String::new(), |until| {
            let (mean, _) = until.stands(&self.state.u);
            format!("; the mean displacement of its `until` is {mean:.6e} and is to be {:.6e}", until.value)
        });
        Error::NotConverged(format!(
            "step '{}' stops at {}: it has used the most increments allowed, {}{far}",
            step.name,
            self.came_to(step),
            step.increments.most
        ))
    }

    fn give_up(&self, step: &Step, dt: f64, reason: &str) -> Error {
        Error::NotConverged(format!(
            "step '{}' stops at {}: an increment of {:.1e} of it still fails: {reason}",
            step.name,
            self.came_to(step),
            dt / step.duration
        ))
    }

    fn attempt(
        &mut self,
        dt: f64,
        record: &mut AttemptRecord,
        observer: &mut dyn Observer,
    ) -> Result<Converged, SolveError> {
        let mut solve = |record: &mut AttemptRecord, observer: &mut dyn Observer| {
            let newton = Newton::open(self.problem, &self.state, dt, &mut self.memory, &mut self.system)?;
            if record.relaxed { newton.relax(record, observer) } else { newton.solve(record, observer) }
        };
        if self.problem.newton.rehearse {
            let _ = solve(&mut record.clone(), &mut super::Silent);
        }
        let mut converged = solve(record, observer)?;
        self.problem.following.place(&mut converged.u);
        Ok(converged)
    }

    fn accept(
        &mut self,
        step: &Step,
        (record, wanted): (&AttemptRecord, f64),
        mut converged: Converged,
    ) -> Result<(), Error> {
        let (before, taken, forces) = (balance(&self.state), exchanged(&self.state), self.state.internal.clone());
        let broke = converged.evaluation.energies.iter().any(|energies| energies.bonds > 0.0);
        let moved_before = self.moved();
        let (last_dt, reached) = (self.state.last_dt, converged.reached.take());
        let converged_freely = converged.held.is_empty();
        self.commit(converged, record.dt)?;
        let moved = self.moved();
        if reached.is_none() && !record.relaxed && converged_freely && !broke {
            self.look_for_snap(record, &forces, taken);
        }
        let (state, dt) = (&mut self.state, record.dt);
        let expected = if last_dt > 0.0 { moved_before * dt / last_dt } else { 0.0 };
        let driven = step.prescribed.iter().map(|p| state.last_change[p.dof].abs()).fold(0.0, f64::max);
        state.leap = leap([expected, driven, moved], self.problem.size);
        if !record.relaxed {
            let served = step.served(dt, wanted, state.step_time - dt);
            let after = step.after(served, wanted, record.first_solutions(), moved / self.problem.size);
            state.next_dt = state.caution.hold(served, after);
            state.caution.proven = served;
        } else {
            // What the jump did must not be carried on, nor its increment be the measure of the next.
            state.last_dt = 0.0;
            state.next_dt = dt.max(JUMPED * state.caution.usual(step));
            state.caution.forget();
            state.jumps += 1;
        }
        if record.relaxed || broke {
            // What ends higher than it began has set nothing free: that energy is missing.
            state.released += (balance(state) - before).max(0.0);
        }
        state.increment += 1;
        state.step_increment += 1;
        state.time += dt;
        state.step_time += dt;
        let ends = match reached {
            None => {
                state.factor = (state.step_time / step.duration).min(1.0);
                step.ends_at(state.step_time)
            }
            Some(Reached { factor, length, ends, .. }) => {
                (state.last_factor, state.factor) = (factor - state.factor, factor);
                if state.arc == 0.0 {
                    state.arc = length / dt;
                }
                ends
            }
        };
        if ends {
            self.begin_next_step();
        }
        Ok(())
    }

    /// Notes an accepted increment that set energy free, more than rounding, which is all there is where no force is in play.
    fn look_for_snap(&mut self, record: &AttemptRecord, forces: &[f64], before: [f64; 2]) {
        if self.state.in_play[0] == 0.0 {
            return;
        }
        let now = exchanged(&self.state);
        let energy = set_free(&self.state, forces, [0, 1].map(|i| now[i] - before[i]));
        let rounding = NOISE * (now[0].abs() + self.state.in_play[0] * self.problem.cell_size);
        if energy > rounding {
            let most = largest(&self.state.last_change).unwrap_or(0);
            self.stability.snaps.push(Snap { time: record.time, energy, largest: self.problem.name_of(most) });
        }
    }

    /// The largest motion of a node in the last increment.
    fn moved(&self) -> f64 {
        let nodes = self.problem.dofs.nodes() * self.problem.dofs.per_node();
        newton::largest(self.state.last_change[..nodes].iter().copied())
    }

    /// Makes a converged evaluation the state.
    fn commit(&mut self, converged: Converged, dt: f64) -> Result<(), Error> {
        let preconditioner = self.system.snapshot().map_err(|error| Error::Input(error.to_string()))?;
        let (state, mut evaluation) = (&mut self.state, converged.evaluation);
        learn(state, &converged.u, dt, self.problem.dofs.nodes() * self.problem.dofs.per_node());
        let along = |forces: &[f64]| forces.iter().zip(&state.last_change).map(|(f, change)| f * change).sum::<f64>();
        let [before, now] = [&state.internal, &evaluation.internal].map(|forces| along(forces));
        state.external_work += 0.5 * (before + now);
        if now.abs() > before.abs() {
            state.unresolved_work += 0.5 * CUBIC * (now - before).abs();
        }
        let counts = converged.held.is_empty() && brings_over_gaps(self.problem, state, &evaluation);
        for (total, new) in state.energies.iter_mut().zip(&evaluation.energies) {
            total.stored = new.stored;
            if !converged.held.is_empty() {
                // What nothing holds since it opened has set free what it stored.
                total.supplied += total.across.min(0.0);
            }
            total.across = if counts { new.across } else { 0.0 };
            total.supplied += if counts { new.supplied - new.across } else { new.supplied };
            total.residue += new.residue;
            total.dissipated += new.dissipated;
            total.bonds += new.bonds;
        }
        state.u = converged.u;
        state.held += usize::from(!converged.held.is_empty());
        if !converged.held.is_empty() && self.first_held.is_none() {
            self.first_held = Some((converged.held.join("; "), state.time));
        }
        std::mem::swap(&mut state.internal, &mut evaluation.internal);
        std::mem::swap(&mut state.load, &mut evaluation.load);
        let idle = self.problem.steps.get(state.step).map_or(&[][..], |step| &step.idle);
        let histories = state.histories.iter_mut().zip(&mut evaluation.histories).enumerate();
        for (_, (old, new)) in histories.filter(|(number, _)| !idle.contains(number)) {
            std::mem::swap(old, new);
        }
        state.leaving = evaluation.apart.drain(..).map(|(term, forces)| (term, added(forces))).collect();
        self.memory.spare = Some(evaluation);
        state.preconditioner = preconditioner;
        for (past, now) in state.in_play.iter_mut().zip(converged.in_play) {
            *past = past.max(now);
        }
        Ok(())
    }

    fn begin_next_step(&mut self) {
        let state = &mut self.state;
        if self.problem.steps[state.step].arc_length.is_some() && state.factor != 1.0 {
            state.load_factors.push((state.step, state.factor));
        }
        state.step += 1;
        state.entered = false;
        (state.step_increment, state.step_time) = (0, 0.0);
        state.last_dt = 0.0;
        state.caution = Caution::default();
        state.step_start.clone_from(&state.u);
        if let Some(next) = self.problem.steps.get(state.step) {
            state.next_dt = next.increments.first * next.duration;
        }
    }
}

/// Forces with those of one unknown added up in their order, zeros left out.
fn added(mut forces: Vec<(usize, f64)>) -> Vec<(usize, f64)> {
    forces.sort_by_key(|(dof, _)| *dof);
    let sum = |group: &[(usize, f64)]| (group[0].0, group.iter().map(|(_, force)| force).sum());
    forces.chunk_by(|a, b| a.0 == b.0).map(sum).filter(|(_, force)| *force != 0.0).collect()
}

/// Whether prescribed motions bring over the gaps of an increment what opens or closes in it, or what moves lay close: what a load brings over a gap has set free
/// what is missing.
fn brings_over_gaps(problem: &Problem, state: &State, evaluation: &Evaluation) -> bool {
    let across: f64 = evaluation.energies.iter().map(|energies| energies.across).sum();
    if across == 0.0 {
        return true;
    }
    let places = (0..state.last_change.len()).filter(|&dof| !problem.dofs.is_rotation(dof));
    let close = newton::largest(places.map(|dof| state.last_change[dof])) <= CLOSE * problem.cell_size;
    let reaction = |internal: &[f64], load: &[f64]| -> f64 {
        let forces = internal.iter().zip(load).map(|(internal, load)| internal - load);
        forces.zip(&state.last_change).map(|(force, change)| force * change).sum()
    };
    let driven = 0.5 * (reaction(&state.internal, &state.load) + reaction(&evaluation.internal, &evaluation.load));
    close || across.abs() <= driven.abs()
}

/// Energy that came from outside and that no term has taken up.
fn balance(state: &State) -> f64 {
    state.external_work - exchanged(state)[0]
}

/// Energy that the terms have taken up, and what heat has supplied.
fn exchanged(state: &State) -> [f64; 2] {
    let sum = |of: fn(&Energies) -> f64| state.energies.iter().map(of).sum();
    [sum(Energies::taken), sum(|energies| energies.supplied)]
}

/// Whether as many places touch at the end of an attempt as at its first guess: contact that lets go may snap to and fro.
fn keeps_contact(record: &AttemptRecord) -> bool {
    let ends = [record.iterations.first(), record.iterations.last()];
    let open = ends.map(|line| line.map(|line| line.branches.iter().map(|counts| counts.first()).collect::<Vec<_>>()));
    open[0] == open[1]
}
