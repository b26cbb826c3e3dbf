//! One attempt at an increment: Newton's iterations from the first guess of the predictor.

use super::convergence::{Norms, Yardstick};
use super::influences::Influences;
use super::linear::{Factors, LinearSolver};
use super::mixed::Mixed;
use super::observer::{AttemptRecord, IterationRecord, Observer};
use super::path::{Path, Reached};
use super::problem::Problem;
use super::progress::Progress;
use super::relax::Drag;
use super::schedule::Step;
use super::step::forcing;
use super::trail::{Cycle, Trail};
use crate::system::{Assembly, Evaluation, Factorised, Instant, Kinks, State, Tangent, Trial, Workspace};
use crate::{Error, Failure, Kind};
use std::sync::Arc;
use std::time::Duration;

/// Which matrix the iterations use.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variant {
    /// A new one for every iteration.
    Full,
    /// That of the attempt's first iteration.
    Modified,
    /// The one of an earlier increment while it serves. Results then depend on what was computed before, to within the
    /// tolerance: restart and repetition are no longer identical to the bit.
    Kept,
}

/// What becomes of a motion that nothing holds and nothing drives, as of a body that has lost its contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum IfFree {
    /// What has lost its hold stays where it is until something touches it; what nothing held in the first increment ends the run.
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
    /// What a user must know of these options when reading the results.
    pub fn notes(&self) -> Option<String> {
        (self.variant == Variant::Kept).then(|| {
            "newton = \"kept\": matrices are kept across increments; results agree with those of a restarted run to the \
             tolerance only, not to the bit"
                .into()
        })
    }
}

/// Memory of the iterations that lives through the run.
#[derive(Debug, Default)]
pub struct Memory {
    /// Pattern, places and buffers.
    pub workspace: Workspace,
    /// Pattern that was analysed, pattern that the solver was told of, and the unknowns of both.
    pub(super) analysed: usize,
    pub(super) followed: usize,
    pub(super) free: Vec<usize>,
    /// Whether there is a factor that [`Variant::Modified`] and [`Variant::Kept`] may use again.
    pub(super) current: bool,
    /// The matrix that was factorised last, where an accepted state may hold it.
    pub(super) factorised: Option<Arc<Factorised>>,
    /// Stencils that bend.
    pub(super) kinks: Kinks,
    pub(super) mixed: Mixed,
    pub(super) influences: Influences,
    /// Unknowns of tools that nothing bore where the last attempt failed.
    pub(super) unborne: Vec<usize>,
    /// The evaluation of the last accepted increment: room for the next.
    pub spare: Option<Evaluation>,
    /// Room for the evaluation of another first guess.
    pub(super) other: Option<Evaluation>,
    /// Analyses of the solver so far.
    pub analyses: usize,
    /// Factorisations so far.
    pub factorisations: usize,
    /// Those of matrices that are symmetric, as L D L^T.
    pub symmetric: usize,
    /// Time that they took.
    pub factorising: Duration,
}

/// Why an attempt ended without a solution.
#[derive(Debug)]
pub enum Trouble {
    /// A smaller increment may help.
    Failure(Failure),
    /// Nothing smaller helps: the run does not go on.
    End(Failure),
    /// Something else ends the run.
    Error(Error),
}

impl From<Failure> for Trouble {
    fn from(failure: Failure) -> Self {
        Self::Failure(failure)
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
    pub(super) solver: &'a mut dyn LinearSolver,
    pub(super) evaluation: Evaluation,
    /// Whether the matrix belongs to the state that was evaluated last.
    pub(super) linearised: bool,
    pub(super) residual: Vec<f64>,
    pub(super) stiffness: f64,
    /// Largest coefficient of a displacement in each equation.
    pub(super) coefficients: Vec<f64>,
    /// Multiple of the initial slope that the line search allows at the end of a step.
    pub(super) bound: f64,
    /// Motions that the last matrix was propped against, in words.
    pub(super) propped: Vec<String>,
    /// Iterations in a row over which no contact changed.
    pub(super) steady: i32,
    /// What the unknowns are dragged through.
    pub(super) medium: Option<Drag>,
    /// The path that the step follows.
    pub(super) path: Option<Path<'a>>,
}

/// The line search takes a step at whose end the slope is at most this multiple of the initial one: a point that
/// closes over the step raises it a little and is dealt with by the next iteration; only what goes far astray is
/// shortened.
const SLOPE: f64 = 10.0;
/// An iteration with an old factor stalls that leaves more than this part of the unbalanced forces; so many in a row, and
/// the next has a fresh one.
const STALLED: f64 = 0.5;
const STALLS: usize = 2;
/// Iterations after which the line search turns strict: a step must then lower the slope,
const PATIENCE: usize = 8;
/// to this part of the initial one. Points that slip to and fro in turn are held by it.
const STRICT: f64 = 0.5;
/// Points of a cycle that a message names.
const NAMED: usize = 3;

impl<'a> Newton<'a> {
    /// Opens all terms at the accepted state.
    pub fn open(
        problem: &'a Problem,
        state: &'a State,
        dt: f64,
        memory: &'a mut Memory,
        solver: &'a mut dyn LinearSolver,
    ) -> Result<Self, Failure> {
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
        memory.mixed.begin(&assembly, &memory.workspace);
        let evaluation = memory.spare.take().unwrap_or_else(|| Evaluation::new(&problem.terms, state));
        let residual = vec![0.0; step.constraints.free_count()];
        Ok(Self {
            problem,
            state,
            step,
            assembly,
            at,
            memory,
            solver,
            evaluation,
            linearised: false,
            residual,
            stiffness: 0.0,
            coefficients: Vec::new(),
            bound: SLOPE,
            propped: Vec::new(),
            steady: 0,
            medium: None,
            path: None,
        })
    }

    /// Iterates to the solution.
    pub fn solve(mut self, record: &mut AttemptRecord, observer: &mut dyn Observer) -> Result<Converged, Trouble> {
        let options = &self.problem.newton;
        let (mut u, mut missing) = match &self.step.arc_length {
            Some(arc) => (self.begin_path(arc)?, None),
            None => self.predict()?,
        };
        let (mut correction, mut taken, mut factorised, mut ratio) = (0.0, 0.0, false, 0.0);
        self.begin_sequence();
        let (mut trail, mut progress, mut still) = (Trail::default(), Progress::default(), false);
        let (mut augmentation, mut begun, mut stalls) = (0, 0, 0);
        for iteration in 0.. {
            self.refresh_stiffness();
            let norms = self.measure();
            trail.push(&self.evaluation.branches);
            let mut line = self.describe(iteration, &norms, &trail);
            self.steady = if iteration > 0 && line.changes == 0 { self.steady + 1 } else { 0 };
            (line.correction, line.step, line.factorised) = (correction, taken, factorised);
            line.augmentation = augmentation;
            observer.iteration(record, &line);
            record.iterations.push(line);
            if missing.is_none() && norms.converged_from(ratio) && self.arrives(&u)? {
                if !still && self.path.is_none() && self.drifts(&u, record, norms.reference[0])? {
                    (u, missing) = self.begin(self.state.u.clone())?;
                    still = true;
                    continue;
                }
                self.stands(&u, norms.reference[0])?;
                if !self.augment(&u)? {
                    let reached = self.reached(&u);
                    let Self { evaluation, propped, .. } = self;
                    return Ok(Converged { u, evaluation, in_play: norms.in_play, held: propped, reached });
                }
                (augmentation, begun, self.bound) = (augmentation + 1, iteration + 1, SLOPE);
                (correction, taken, factorised, ratio) = (0.0, 0.0, false, 0.0);
                continue;
            }
            if !norms.ratio.is_finite() {
                return Err(Failure::new("the forces are not finite").of(Kind::NotFinite).into());
            }
            progress.push(iteration == begun, norms.ratio, taken);
            if iteration - begun == options.iterations || progress.wanders() {
                break;
            }
            // Where flow is not associated a step need not lower the slope: only contact is to be calmed.
            if iteration - begun >= PATIENCE && !self.problem.contacts.is_empty() {
                self.bound = STRICT;
            }
            stalls = if factorised || norms.ratio <= STALLED * ratio { 0 } else { stalls + 1 };
            if stalls == STALLS {
                (stalls, _) = (0, self.solver.refuse());
            }
            let loose = forcing(norms.ratio, ratio, norms.allowed);
            let motion = if self.path.is_some() {
                self.linearise_on_path((iteration, &u), loose)?
            } else {
                self.complete(&u, missing.as_deref())?;
                self.linearise((iteration, &u), missing.as_deref(), loose)?
            };
            let tangent = self.wanted(&norms, ratio);
            (factorised, ratio) = (motion.factorised, norms.ratio);
            let from = u.clone();
            taken = match self.path {
                Some(_) => self.advance_on_path(&mut u, (&motion, tangent))?,
                None => self.advance(&mut u, (&motion, tangent), missing.as_deref())?,
            };
            if taken < motion.part && !factorised {
                self.solver.refuse();
            }
            let largest = |v: &mut dyn Iterator<Item = f64>| v.fold(0.0_f64, |m, x| m.max(x.abs()));
            let change = largest(&mut u.iter().zip(&self.state.u).map(|(a, b)| a - b));
            correction = largest(&mut u.iter().zip(&from).map(|(a, b)| a - b)) / change.max(f64::MIN_POSITIVE);
            missing = missing.filter(|_| taken < 1.0).map(|m| m.iter().map(|m| m * (1.0 - taken)).collect());
        }
        self.memory.unborne = self.unborne();
        let kind = if trail.cycle().is_some() { Kind::Cycle } else { Kind::Iterations };
        Err(Failure::new(self.why_not(record, &trail)).of(kind).into())
    }

    /// Lets the terms improve what they hold besides the unknowns, and evaluates anew if any did.
    pub(super) fn augment(&mut self, u: &[f64]) -> Result<bool, Failure> {
        let (mut again, histories) = (false, &mut self.evaluation.histories);
        for (attempt, new) in self.assembly.attempts.iter_mut().zip(histories) {
            again |= attempt.augment(u, new)?;
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
        let last = self.propped.is_empty() && norms.ratio * norms.ratio < before * norms.allowed;
        if last { Tangent::None } else { self.tangent() }
    }

    /// Finds the matrix at `u`, where the terms were evaluated last, if it was not found there.
    pub(super) fn complete(&mut self, u: &[f64], missing: Option<&[f64]>) -> Result<(), Failure> {
        if self.linearised { Ok(()) } else { self.evaluate(u, missing, self.tangent()) }
    }

    pub(super) fn evaluate(&mut self, u: &[f64], missing: Option<&[f64]>, tangent: Tangent) -> Result<(), Failure> {
        self.linearised = tangent != Tangent::None;
        let trial = Trial { u, missing, tangent, acting: self.memory.mixed.acting() };
        self.memory.workspace.evaluate(&self.assembly, &trial, &mut self.evaluation)?;
        self.let_go();
        self.stop(u, tangent != Tangent::None);
        let unbalanced: Vec<f64> = (0..u.len()).map(|dof| self.evaluation.residual(dof)).collect();
        self.step.constraints.gather(&unbalanced, &mut self.residual);
        self.drag(u, tangent != Tangent::None);
        Ok(())
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
        let yardstick = Yardstick {
            past: self.state.in_play,
            coefficients: &self.coefficients,
            size: self.problem.size,
            tolerance: self.problem.newton.tolerance,
        };
        let numbering = (&self.problem.dofs, &self.step.constraints, &*self.problem.wholes);
        Norms::measure(&self.evaluation, &self.residual, numbering, &yardstick)
    }

    /// Largest diagonal entry of a displacement, and the largest coefficient of one in each equation, where the matrix was
    /// found.
    pub(super) fn refresh_stiffness(&mut self) {
        let pattern = self.memory.workspace.pattern();
        if !self.linearised {
            return;
        }
        let free = self.step.constraints.free().iter().enumerate();
        let displacements = free.filter(|(_, dof)| !self.problem.dofs.is_rotation(**dof));
        let diagonal = displacements.map(|(row, _)| pattern.diagonal[row]);
        self.stiffness = diagonal.map(|place| self.evaluation.values[place].abs()).fold(0.0, f64::max);
        let (free, values) = (self.step.constraints.free(), &self.evaluation.values);
        self.coefficients.clear();
        self.coefficients.extend((0..free.len()).map(|row| {
            let places = pattern.starts[row]..pattern.starts[row + 1];
            let displacements = places.filter(|&place| !self.problem.dofs.is_rotation(free[pattern.columns[place]]));
            displacements.map(|place| values[place].abs()).fold(0.0, f64::max)
        }));
    }

    pub(super) fn describe(&self, iteration: usize, norms: &Norms, trail: &Trail) -> IterationRecord {
        let changes = || trail.changed();
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
            ..IterationRecord::default()
        }
    }

    fn why_not(&self, record: &AttemptRecord, trail: &Trail) -> String {
        let Some(last) = record.iterations.last() else { return "no iteration was made".into() };
        let mut text = format!(
            "the largest unbalanced force is {:.1e} of the forces in play after {} iterations (at most {:.0e}), at {}",
            last.residual,
            last.iteration,
            last.tolerance,
            self.problem.name_of(last.worst.dof)
        );
        if let Some(cycle) = trail.cycle() {
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
