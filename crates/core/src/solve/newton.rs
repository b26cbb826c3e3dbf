//! One attempt at an increment: Newton's iterations from the first guess of the predictor. All iterations of a run go through
//! [`Newton::iterate`], those of a path of arc length and those of a relaxation too.

use super::constants::convergence::{CORRECTION, LOCAL, NEGLIGIBLE};
use super::constants::iterations::{NAMED, PATIENCE, STALLED, STALLS};
use super::constants::regularisation::{PUSHED, STEADY};
use super::convergence::{Norms, ResidualScale};
use super::cycle::{Cycle, CycleDetector};
use super::linear::{Factors, LinearSystem};
use super::observer::{AttemptRecord, IterationRecord, Observer};
use super::path::{Path, Reached};
use super::problem::Problem;
use super::progress::Progress;
use super::relax::PseudoTime;
use super::schedule::Step;
use super::semismooth::MipStress;
use super::step::forcing;
use crate::system::{Assembly, Evaluation, Instant, Kinks, State, Tangent, Trial, Workspace, apart};
use crate::{Error, Failure, FailureKind};
use std::sync::Arc;
use std::time::Duration;

/// Which matrix the iterations use.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variant {
    /// A new one for every iteration.
    Full,
    /// That of the attempt's first iteration.
    Modified,
}

/// What becomes of a motion that nothing holds and nothing drives, as of a body that has lost its contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum IfFree {
    /// What has lost its hold stays where it is until something touches it, and so does in the first increment what lies close to
    /// something that it may touch; what else nothing held then ends the run.
    Auto,
    /// The run ends and names it.
    Stop,
    /// What is free stays where it is until something touches it.
    Hold,
}

/// Options of the iterations.
#[derive(Debug, Clone, PartialEq)]
pub struct NewtonOptions {
    /// Which matrix is used.
    pub variant: Variant,
    /// What is factorised with [`Variant::Full`].
    pub factors: Factors,
    /// Whether the tangent is exact or found by perturbation.
    pub perturbation: bool,
    /// Largest unbalanced force over the yardstick.
    pub tolerance: f64,
    /// Iterations after which an attempt is given up.
    pub iterations: usize,
    /// Whether a step is put right for the stencils that bend over it.
    pub piecewise: bool,
    /// Whether steps are shortened that would make matters worse.
    pub line_search: bool,
    /// Whether an increment of a model with contact that cutting does not help is relaxed to an equilibrium beyond an
    /// instability.
    pub relax: bool,
    /// What becomes of what nothing holds any more.
    pub if_free: IfFree,
    /// Bytes of memory that the process may take; what the machine gives where nothing is said.
    pub memory: Option<u64>,
    /// What an engine from outside is told, in its own words.
    pub engine: Option<Arc<str>>,
    /// Every attempt is made twice and the second kept, which must not change a bit. A check of the program itself.
    pub rehearse: bool,
}

impl Default for NewtonOptions {
    fn default() -> Self {
        Self {
            variant: Variant::Full,
            factors: Factors::Auto,
            perturbation: false,
            tolerance: 1e-6,
            iterations: 25,
            piecewise: true,
            line_search: true,
            relax: true,
            if_free: IfFree::Auto,
            memory: None,
            engine: None,
            rehearse: false,
        }
    }
}

impl NewtonOptions {
    /// When an older factor preconditions: never where one matrix serves a whole attempt.
    pub(super) fn policy(&self) -> frontal::Policy {
        match self.variant {
            Variant::Full => self.factors.policy(),
            Variant::Modified => Factors::Fresh.policy(),
        }
    }
}

/// Time that the procedure took, but for its linear systems.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Spent {
    /// Opening the terms of attempts and their patterns.
    pub opening: Duration,
    /// Evaluating the terms: search, stencils, forces and matrices.
    pub evaluating: Duration,
    /// The contact points over the steps, without their linear systems.
    pub contact: Duration,
}

/// Memory of the iterations that lives through the run.
#[derive(Debug, Default)]
pub struct Memory {
    /// Pattern, places and buffers.
    pub workspace: Workspace,
    /// Whether there is a factor that [`Variant::Modified`] uses on.
    pub(super) current: bool,
    /// Contact points.
    pub(super) kinks: Kinks,
    pub(super) mip: MipStress,
    /// Unknowns of tools that nothing bore where the last attempt failed.
    pub(super) unborne: Vec<usize>,
    /// The evaluation of the last accepted increment: room for the next.
    pub spare: Option<Evaluation>,
    /// Room for the forces of the loads of a path.
    pub(super) other: Option<Evaluation>,
    /// What took how long.
    pub spent: Spent,
}

/// Why an attempt ended without a solution.
#[derive(Debug)]
pub enum SolveError {
    /// A smaller increment may help.
    Failure(Failure),
    /// Nothing smaller helps: the run does not go on.
    End(Failure),
    /// Something else ends the run.
    Error(Error),
}

impl From<Failure> for SolveError {
    fn from(failure: Failure) -> Self {
        if failure.kind == FailureKind::Apart { Self::End(failure) } else { Self::Failure(failure) }
    }
}

/// A converged attempt.
pub struct Converged {
    /// All unknowns.
    pub u: Vec<f64>,
    /// Evaluation at these unknowns.
    pub evaluation: Evaluation,
    /// Force and moment in play.
    pub in_play: [f64; 2],
    /// Motions that nothing held, and that were held still, in words.
    pub held: Vec<String>,
    /// Where it came to on the path of a step that follows one.
    pub reached: Option<Reached>,
}

/// One attempt.
pub struct Newton<'a> {
    pub(super) problem: &'a Problem,
    pub(super) state: &'a State,
    pub(super) step: &'a Step,
    pub(super) assembly: Assembly<'a>,
    pub(super) at: Instant,
    pub(super) memory: &'a mut Memory,
    pub(super) system: &'a mut LinearSystem,
    pub(super) evaluation: Evaluation,
    /// Whether the matrix belongs to the state that was evaluated last.
    pub(super) linearised: bool,
    pub(super) residual: Vec<f64>,
    pub(super) stiffness: f64,
    /// Largest coefficient of a displacement in each equation.
    pub(super) coefficients: Vec<f64>,
    /// Whether the line search is strict.
    pub(super) strict: bool,
    /// Whether what nothing held when that was asked last lies close to something that it may touch.
    pub(super) free_is_close: bool,
    /// Motions that the last matrix was regularised against, in words.
    pub(super) regularised: Vec<String>,
    /// Whether any matrix of the attempt was singular.
    pub(super) was_singular: bool,
    /// Iterations in a row over which no contact changed.
    pub(super) steady: i32,
    /// Whether contact points that were closed are held so.
    pub(super) holding: bool,
    /// The implicit step through a viscous medium that is being made.
    pub(super) medium: Option<PseudoTime>,
    /// The path that the step follows.
    pub(super) path: Option<Path<'a>>,
}

/// Unknowns, and what prescribed ones still miss there, if anything.
pub(super) type Iterate = (Vec<f64>, Option<Vec<f64>>);

/// What iterations are to reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Goal {
    /// Equilibrium at the end of the increment.
    Equilibrium,
    /// Less of the unbalanced forces: a part of those at the beginning, or of the tolerance where that is more, within so many
    /// iterations after the first evaluation.
    Less { part: f64, of_tolerance: f64, most: usize },
    /// This part of the tolerance, or rounding, within so many iterations none of which leaves more than the one before.
    Balance { of_tolerance: f64, most: usize },
}

/// A sequence of iterations: what they went through so far.
#[derive(Debug, Default)]
pub(super) struct Sequence {
    cycles: CycleDetector,
    progress: Progress,
    /// Iterations so far, and when they began anew since multipliers were improved, how often that was.
    count: usize,
    begun: usize,
    augmentation: usize,
    /// Largest displacement of all iterations, and that of the last over it.
    change: f64,
    correction: f64,
    /// Which part of its step the last iteration took, whether its matrix was factorised and contact found no states over it, and the
    /// unbalanced forces that it began with and, at the first, all began with.
    taken: f64,
    factorised: bool,
    lost: bool,
    ratio: f64,
    first: f64,
    /// Iterations in a row that stalled.
    stalls: usize,
}

impl Sequence {
    /// Begins anew after multipliers were improved.
    fn improved(&mut self) {
        (self.augmentation, self.begun) = (self.augmentation + 1, self.count);
        (self.correction, self.taken, self.factorised, self.ratio) = (0.0, 0.0, false, 0.0);
    }
    /// Whether what is left of the unbalanced forces would move little beside what the increment has moved: as much as the last iteration did,
    /// as often as these became less in it. Forces that are small beside those elsewhere bend what is soft or slender.
    fn has_settled(&self, norms: &Norms) -> bool {
        if self.count <= 1 {
            return norms.ratio <= NEGLIGIBLE * norms.allowed && norms.rounding <= norms.allowed;
        }
        let left = if self.ratio > 0.0 { norms.ratio / self.ratio } else { 0.0 };
        let settled = left.min(1.0) * self.correction <= CORRECTION && norms.local <= LOCAL * self.change;
        settled || norms.ratio <= norms.rounding
    }
    /// Iterations so far.
    pub fn solutions(&self) -> usize {
        self.count.saturating_sub(1)
    }
}

impl<'a> Newton<'a> {
    /// Opens all terms at the accepted state.
    pub fn open(
        problem: &'a Problem,
        state: &'a State,
        dt: f64,
        memory: &'a mut Memory,
        system: &'a mut LinearSystem,
    ) -> Result<Self, Failure> {
        let begun = std::time::Instant::now();
        let step = &problem.steps[state.step];
        let time = (state.step_time + dt, state.time + dt);
        let factor = step.arc_length.as_ref().map(|_| state.factor);
        let at = Instant { step: state.step, step_time: time.0, time: time.1, dt, factor };
        let attempts = problem.open(state, at)?;
        let (terms, dofs) = (&problem.terms, &problem.dofs);
        // The next step may do without any of them.
        let apart =
            if step.arc_length.is_some() || step.ends_at(at.step_time) { problem.removable.clone() } else { 0..0 };
        let assembly = Assembly { terms, attempts, dofs, constraints: &step.constraints, apart };
        memory.workspace.prepare(&assembly, state)?;
        memory.mip.begin(&assembly, &memory.workspace);
        let evaluation = memory.spare.take().unwrap_or_else(|| Evaluation::new(&problem.terms, state));
        let residual = vec![0.0; step.constraints.free_count()];
        memory.spent.opening += begun.elapsed();
        Ok(Self {
            problem,
            state,
            step,
            assembly,
            at,
            memory,
            system,
            evaluation,
            linearised: false,
            residual,
            stiffness: 0.0,
            coefficients: Vec::new(),
            strict: false,
            free_is_close: false,
            regularised: Vec::new(),
            was_singular: false,
            steady: 0,
            holding: false,
            medium: None,
            path: None,
        })
    }

    /// Iterates to the solution.
    pub fn solve(mut self, record: &mut AttemptRecord, observer: &mut dyn Observer) -> Result<Converged, SolveError> {
        let mut at = match &self.step.arc_length {
            Some(arc) => (self.begin_path(arc)?, None),
            None => self.predict()?,
        };
        self.begin_sequence();
        let (mut sequence, mut still) = (Sequence::default(), false);
        while let Some(norms) =
            self.iterate(&mut at, Goal::Equilibrium, &mut sequence, (&mut *record, &mut *observer))?
        {
            let u = &at.0;
            let may_rest = !still && self.path.is_none();
            if may_rest && let Some(begin) = self.at_rest(u, record, norms.reference[0])? {
                (at, still) = (self.begin(begin)?, true);
                continue;
            }
            self.is_stable(u, norms.reference[0])?;
            if !self.augment(u)? {
                return Ok(self.converged(at.0, norms));
            }
            sequence.improved();
            self.strict = false;
        }
        self.memory.unborne = self.unborne();
        let kind = if sequence.cycles.cycle().is_some() { FailureKind::Cycle } else { FailureKind::Iterations };
        Err(Failure::new(self.why_not(record, &sequence.cycles)).of(kind).into())
    }

    /// Begins a sequence of matrices with the factor that the accepted state holds.
    pub(super) fn begin_sequence(&mut self) {
        self.system.restore(self.state.preconditioner.as_ref(), self.step.constraints.free());
    }

    /// The attempt as it has converged.
    pub(super) fn converged(mut self, u: Vec<f64>, norms: Norms) -> Converged {
        let reached = self.reached(&u);
        Converged { u, evaluation: self.evaluation, in_play: norms.in_play, held: self.regularised, reached }
    }

    /// Newton's iterations from an iterate that is evaluated to a goal: what is left there of the unbalanced forces; none where they
    /// are given up. Every iteration of a run is one of these.
    pub(super) fn iterate(
        &mut self,
        (u, missing): &mut Iterate,
        goal: Goal,
        sequence: &mut Sequence,
        (record, observer): (&mut AttemptRecord, &mut dyn Observer),
    ) -> Result<Option<Norms>, SolveError> {
        let options = &self.problem.newton;
        let main = goal == Goal::Equilibrium;
        loop {
            let iteration = sequence.count;
            if self.medium.is_none() {
                self.refresh_stiffness()?;
            }
            let norms = self.measure();
            if iteration == 0 {
                sequence.first = norms.ratio;
            }
            sequence.cycles.push(&self.evaluation.branches);
            let line = self.describe(iteration, &norms, sequence);
            if main {
                self.steady = if iteration > 0 && line.changes == 0 { self.steady + 1 } else { 0 };
            }
            observer.iteration(record, &line);
            record.iterations.push(line);
            sequence.count += 1;
            if missing.is_none() && !self.holds()? && self.reaches(goal, &norms, sequence, u)? {
                return Ok(Some(norms));
            }
            if !norms.ratio.is_finite() {
                return Err(Failure::new("the forces are not finite").of(FailureKind::NotFinite).into());
            }
            let since = iteration - sequence.begun;
            if main {
                sequence.progress.push(since == 0, norms.ratio, (sequence.taken, sequence.lost));
                // Where flow is not associated a step need not lower the slope: only contact is to be calmed.
                if since >= PATIENCE && !self.problem.contacts.is_empty() {
                    self.strict = true;
                }
            }
            let grows = norms.ratio > sequence.ratio.max(norms.allowed) && iteration > 0;
            let given_up = match goal {
                // Where no smaller increment may follow there is nothing to save the rest for.
                Goal::Equilibrium => {
                    let vain = sequence.progress.wanders(self.flows()) && self.step.may_halve(self.at.dt);
                    since == options.iterations || vain
                }
                Goal::Less { most, .. } => iteration == most,
                Goal::Balance { most, .. } => iteration == most || grows,
            };
            if given_up {
                return Ok(None);
            }
            if observer.wants_stop() {
                return Err(SolveError::Error(Error::Stopped));
            }
            if main && self.steady > STEADY && !self.regularised.is_empty() && norms.ratio > PUSHED * sequence.ratio {
                return Err(self.pushed().into());
            }
            let stalls = !sequence.factorised && norms.ratio > STALLED * sequence.ratio;
            sequence.stalls = if stalls { sequence.stalls + 1 } else { 0 };
            if main && sequence.stalls == STALLS {
                sequence.stalls = 0;
                self.system.invalidate_factor();
            }
            let loose = forcing(norms.ratio, sequence.ratio, if main { norms.allowed } else { 0.0 });
            let step = if self.path.is_some() {
                self.linearise_on_path((iteration, u), loose)?
            } else {
                self.complete(u, missing.as_deref())?;
                self.linearise((iteration, u), missing.as_deref(), loose)?
            };
            let tangent = if main { self.wanted(&norms, sequence.ratio) } else { self.tangent() };
            (sequence.factorised, sequence.ratio, sequence.lost) = (step.factorised, norms.ratio, step.lost);
            let from = u.clone();
            self.hold(false);
            sequence.taken = match self.path {
                Some(_) => self.advance_on_path(u, (&step, tangent))?,
                None => self.advance(u, (&step, tangent), missing.as_deref())?,
            };
            if main && sequence.taken < step.part && !step.factorised {
                self.system.invalidate_factor();
            }
            let change = largest(u.iter().zip(&self.state.u).map(|(a, b)| a - b));
            sequence.change = change;
            sequence.correction = largest(u.iter().zip(&from).map(|(a, b)| a - b)) / change.max(f64::MIN_POSITIVE);
            let rest = 1.0 - sequence.taken;
            *missing = missing.take().filter(|_| rest > 0.0).map(|m| m.iter().map(|m| m * rest).collect());
        }
    }

    /// Whether an iterate that misses nothing has reached a goal.
    fn reaches(&mut self, goal: Goal, norms: &Norms, sequence: &Sequence, u: &[f64]) -> Result<bool, Failure> {
        let iterated = sequence.count > 1;
        match goal {
            Goal::Equilibrium => {
                Ok(norms.converged_from(sequence.ratio) && sequence.has_settled(norms) && self.arrives(u)?)
            }
            Goal::Less { part, of_tolerance, .. } => {
                Ok(iterated && norms.ratio <= (of_tolerance * norms.allowed).max(part * sequence.first))
            }
            Goal::Balance { of_tolerance, .. } => {
                Ok(iterated && norms.ratio <= (of_tolerance * norms.allowed).max(norms.rounding))
            }
        }
    }

    /// Completes the histories of an iterate that has converged, lets the terms improve what they hold besides the unknowns, and
    /// evaluates anew if any did.
    pub(super) fn augment(&mut self, u: &[f64]) -> Result<bool, Failure> {
        let (mut again, histories) = (false, &mut self.evaluation.histories);
        self.memory.workspace.share_histories(histories)?;
        let energies = self.state.energies.iter().zip(&self.evaluation.energies);
        let bodies = energies.zip(self.assembly.terms).filter(|(_, term)| !term.bends()).map(|(energies, _)| energies);
        let taken = bodies.fold([0.0; 2], |[then, sum], (before, now)| {
            [then + before.stored + before.dissipated, sum + now.stored + now.dissipated + before.dissipated]
        });
        for (attempt, new) in self.assembly.attempts.iter_mut().zip(histories) {
            again |= attempt.augment(u, new, taken)?;
        }
        if again {
            self.evaluate(u, None, self.tangent())?;
        }
        Ok(again)
    }

    pub(super) fn tangent(&self) -> Tangent {
        if self.problem.newton.perturbation {
            Tangent::Perturbation(1e-6 * self.problem.cell_size)
        } else {
            Tangent::Exact
        }
    }

    /// What the end of a step is to be evaluated with, from the unbalanced forces at its beginning and an iteration before:
    /// nothing but forces where they will have converged if they fall as fast again.
    fn wanted(&self, norms: &Norms, before: f64) -> Tangent {
        let last = self.regularised.is_empty() && norms.ratio * norms.ratio < before * norms.allowed;
        if last { Tangent::None } else { self.tangent() }
    }

    /// Finds the matrix at `u`, where the terms were evaluated last, if it was not found there.
    pub(super) fn complete(&mut self, u: &[f64], missing: Option<&[f64]>) -> Result<(), Failure> {
        if self.linearised { Ok(()) } else { self.evaluate(u, missing, self.tangent()) }
    }

    /// All terms at `u` with the derivative of their forces there.
    pub(super) fn derivative_at(mut self, u: &[f64]) -> Result<Evaluation, Failure> {
        let trial = Trial::at(u, self.tangent());
        self.memory.workspace.evaluate(&self.assembly, &trial, &mut self.evaluation)?;
        self.add_to_terms(u, true);
        Ok(self.evaluation)
    }

    pub(super) fn evaluate(&mut self, u: &[f64], missing: Option<&[f64]>, tangent: Tangent) -> Result<(), Failure> {
        self.linearised = tangent != Tangent::None;
        let (origin, from) = self.memory.mip.origin();
        let trial = Trial { u, missing, tangent, acting: self.memory.mip.acting(), origin, from };
        let begun = std::time::Instant::now();
        let evaluated = self.memory.workspace.evaluate(&self.assembly, &trial, &mut self.evaluation);
        self.memory.spent.evaluating += begun.elapsed();
        evaluated?;
        self.add_to_terms(u, self.linearised);
        Ok(())
    }

    /// Adds to forces and matrix of the terms what acts beside these, and finds the unbalanced forces.
    fn add_to_terms(&mut self, u: &[f64], linearised: bool) {
        self.let_go();
        self.stop(u, linearised);
        let unbalanced: Vec<f64> = (0..u.len()).map(|dof| self.evaluation.residual(dof)).collect();
        self.step.constraints.gather(&unbalanced, &mut self.residual);
        self.resist(u, linearised);
    }

    /// Adds what is left of the forces that held before the step, and goes with its time.
    fn let_go(&mut self) {
        let left = 1.0 - (self.at.step_time / self.step.duration).min(1.0);
        let Evaluation { load, magnitude, .. } = &mut self.evaluation;
        for ((load, magnitude), handed) in load.iter_mut().zip(magnitude).zip(&self.state.handed) {
            *load += left * handed;
            *magnitude += (left * handed).abs();
        }
    }

    pub(super) fn measure(&self) -> Norms {
        let scale = ResidualScale {
            past: self.state.in_play,
            coefficients: &self.coefficients,
            size: self.problem.size,
            tolerance: self.problem.newton.tolerance,
        };
        let numbering = (&self.problem.dofs, &self.step.constraints, &*self.problem.wholes);
        Norms::measure(&self.evaluation, &self.residual, numbering, &scale)
    }

    /// Largest diagonal entry of a displacement, and the largest coefficient of one in each equation, where the matrix was
    /// found.
    pub(super) fn refresh_stiffness(&mut self) -> Result<(), Failure> {
        let (pattern, shares) = (self.memory.workspace.pattern(), self.memory.workspace.shares());
        if !self.linearised {
            return Ok(());
        }
        let (free, values) = (self.step.constraints.free(), &self.evaluation.values);
        let displacements = free.iter().enumerate().filter(|(_, dof)| !self.problem.dofs.is_rotation(**dof));
        let diagonal = displacements.filter_map(|(row, _)| pattern.diagonal(row));
        let mut stiffness = [diagonal.map(|place| values[place].abs()).fold(0.0, f64::max)];
        shares.largest(&mut stiffness).map_err(apart)?;
        [self.stiffness] = stiffness;
        self.coefficients.clear();
        self.coefficients.extend((0..free.len()).map(|row| {
            let places = pattern.starts[row]..pattern.starts[row + 1];
            let displacements = places.filter(|&place| !self.problem.dofs.is_rotation(free[pattern.columns[place]]));
            displacements.map(|place| values[place].abs()).fold(0.0, f64::max)
        }));
        shares.complete(&mut self.coefficients).map_err(apart)
    }

    fn describe(&self, iteration: usize, norms: &Norms, sequence: &Sequence) -> IterationRecord {
        let changes = || sequence.cycles.changed();
        let counts = self.problem.terms.iter().zip(&self.evaluation.branches).map(|(term, branches)| {
            let mut counts = vec![0; term.branches().len()];
            if !counts.is_empty() {
                branches.iter().for_each(|(branch, _)| counts[usize::from(*branch)] += 1);
            }
            counts
        });
        IterationRecord {
            iteration,
            residual: norms.ratio,
            tolerance: norms.allowed,
            rounding: norms.rounding,
            worst: norms.worst,
            branches: counts.collect(),
            changes: changes().count(),
            changed: changes().last(),
            correction: sequence.correction,
            step: sequence.taken,
            factorised: sequence.factorised,
            augmentation: sequence.augmentation,
        }
    }

    fn why_not(&self, record: &AttemptRecord, cycles: &CycleDetector) -> String {
        let Some(last) = record.iterations.last() else { return "no iteration was made".into() };
        let mut text = format!(
            "the largest unbalanced force is {:.1e} of the forces in play after {} iterations (at most {:.0e}), at {}",
            last.residual,
            last.iteration,
            last.tolerance,
            self.problem.name_of(last.worst.dof)
        );
        if last.residual <= last.tolerance {
            let moved = last.correction;
            text += &format!(
                ", which is little, but the last iteration still moved something soft by {moved:.1e} of the increment"
            );
        }
        if let Some(cycle) = cycles.cycle() {
            text += &format!("; contact states repeat every {} iterations: {}", cycle.period, self.name_cycle(&cycle));
        } else if let Some((term, stencil)) = last.changed {
            let name = self.problem.terms[term].name_of(stencil);
            let noun = if last.changes == 1 { "state" } else { "states" };
            text += &format!("; {} contact {noun} still changed, the last at {name}", last.changes);
        }
        text
    }

    /// The first stencils of a cycle, and what they go through.
    fn name_cycle(&self, cycle: &Cycle) -> String {
        let named = cycle.members.iter().take(NAMED).map(|member| {
            let term = &self.problem.terms[member.term];
            // A choice counts from one; zero is none.
            let state = |&(branch, choice): &(u8, u32)| {
                let word = term.branches().get(usize::from(branch)).copied().unwrap_or_default();
                if choice == 0 { word.to_owned() } else { format!("{word} on segment {choice}") }
            };
            let states: Vec<String> = member.through.iter().map(state).collect();
            format!("{} ({})", term.name_of(member.stencil), states.join(", "))
        });
        let mut text = named.collect::<Vec<_>>().join("; ");
        if cycle.members.len() > NAMED {
            text += &format!("; and {} more", cycle.members.len() - NAMED);
        }
        text
    }
}

/// The largest size of these numbers.
pub(super) fn largest(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(0.0, |most: f64, x| most.max(x.abs()))
}
