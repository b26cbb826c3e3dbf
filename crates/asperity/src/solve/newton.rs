//! One attempt at an increment: predictor, Newton's iterations, line search.
//!
//! The predictor carries all unknowns on with the last accepted increment. What prescribed unknowns still miss enters
//! the first solution as known motion (`K_ff dq = -(r + K_fc missing)`), so that a driven row takes the elements
//! behind it along instead of turning them inside out.

use super::convergence::{Norms, Yardstick};
use super::linear::{Factors, LinearError, LinearSolver};
use super::observer::{AttemptRecord, IterationRecord, Observer};
use super::path::{Path, Progress};
use super::run::Problem;
use super::schedule::Step;
use crate::system::{Aid, Assembly, Dofs, Evaluation, Instant, State, Tangent, Trial, Workspace};
use crate::{Error, Failure};

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

/// Options of the iterations.
#[derive(Debug, Clone, Copy, PartialEq)]
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
    /// Whether the first iterations are helped: by the pattern of contact of the accepted state, and by softer penalties
    /// where that does not serve. The set of closed points settles sooner.
    pub continuation: bool,
    /// Whether steps are shortened that would make matters worse.
    pub line_search: bool,
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
            continuation: true,
            line_search: true,
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
    analysed: usize,
    factorised: bool,
    /// The evaluation of the last accepted increment: room for the next.
    pub spare: Option<Evaluation>,
    /// Analyses of the solver so far.
    pub analyses: usize,
    /// Factorisations so far.
    pub factorisations: usize,
}

/// Why an attempt ended without a solution.
#[derive(Debug)]
pub enum Trouble {
    /// A smaller increment may help.
    Failure(Failure),
    /// Nothing smaller helps.
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
    /// Yardsticks of force and moment.
    pub reference: [f64; 2],
}

/// One attempt.
pub struct Newton<'a> {
    problem: &'a Problem,
    state: &'a State,
    step: &'a Step,
    assembly: Assembly<'a>,
    at: Instant,
    memory: &'a mut Memory,
    solver: &'a mut dyn LinearSolver,
    evaluation: Evaluation,
    residual: Vec<f64>,
    stiffness: f64,
    /// Multiple of the initial slope that the line search allows at the end of a step.
    bound: f64,
    /// Motions that the last matrix was propped against, in words.
    propped: Vec<String>,
}

/// Below this part of the increment's prescribed motion, what the predictor misses is rounding.
const ROUNDING: f64 = 1e-12;
/// The line search takes a step at whose end the slope is at most this multiple of the initial one: a point that
/// closes over the step raises it a little and is dealt with by the next iteration; only what goes far astray is
/// shortened.
const SLOPE: f64 = 10.0;
/// Slope, as a part of the initial one, at which the search for a shorter step ends.
const GOOD: f64 = 0.8;
/// Iterations after which the line search turns strict: a step must then lower the slope,
const PATIENCE: usize = 8;
/// to this part of the initial one. Points that slip to and fro in turn are held by it.
const STRICT: f64 = 0.5;
/// Bounds of what an iterative solution may leave of its right-hand side.
const LOOSEST: f64 = 1e-3;
const TIGHTEST: f64 = 1e-8;
/// Stiffness that props an iterate in which something is free, over the largest in the matrix.
const PROP: f64 = 1e-4;
/// Force over the reference force that holds what meets no stiffness.
const RESISTANCE: f64 = 1e-3;
/// Shortest step of the line search.
const SHORTEST: f64 = 0.01;

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
        let at = Instant { step: state.step, step_time: state.step_time + dt, time: state.time + dt, dt };
        let opened = problem.terms.iter().zip(&state.histories).map(|(term, history)| term.attempt(state, history, at));
        let attempts = opened.collect::<Result<Vec<_>, _>>()?;
        let assembly =
            Assembly { terms: &problem.terms, attempts, dofs: &problem.dofs, constraints: &step.constraints };
        memory.workspace.prepare(&assembly, state)?;
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
            residual,
            stiffness: 0.0,
            bound: SLOPE,
            propped: Vec::new(),
        })
    }

    /// Iterates to the solution.
    pub fn solve(mut self, record: &mut AttemptRecord, observer: &mut dyn Observer) -> Result<Converged, Trouble> {
        let options = self.problem.newton;
        let helped = options.continuation && self.problem.terms.iter().any(|term| term.softens());
        let mut path = Path::begin(helped, self.state.last_dt > 0.0);
        self.memory.workspace.aid = path.aid();
        let (mut u, mut missing) = self.predict()?;
        let (mut correction, mut taken, mut factorised, mut ratio) = (0.0, 0.0, false, 0.0);
        self.solver.begin();
        let mut before: Vec<Vec<(u8, u32)>> = Vec::new();
        for iteration in 0..=options.iterations {
            self.refresh_stiffness();
            let mut norms = self.measure();
            if missing.is_none() {
                let (residual, converged, changed) = (norms.ratio, norms.converged(), self.changed(&before));
                norms =
                    self.follow(&mut path, &Progress { iteration, residual, taken, changed, converged }, norms, &u)?;
            }
            let mut line = self.describe(iteration, &norms, &before);
            (line.correction, line.step, line.factorised) = (correction, taken, factorised);
            line.helped = !path.is_free();
            observer.iteration(record, &line);
            record.iterations.push(line);
            if missing.is_none() && path.is_free() && norms.converged() {
                self.stands(&u, norms.reference[0])?;
                return Ok(Converged { u, evaluation: self.evaluation, reference: norms.reference });
            }
            if !norms.ratio.is_finite() {
                return Err(Failure::new("the forces are not finite").into());
            }
            if iteration == options.iterations {
                break;
            }
            if iteration >= PATIENCE {
                self.bound = STRICT;
            }
            before.clone_from(&self.evaluation.branches);
            let (direction, slope, fresh) =
                self.direction(iteration, missing.as_deref(), forcing(norms.ratio, ratio))?;
            (factorised, ratio) = (fresh, norms.ratio);
            taken = self.advance(&mut u, &direction, slope, missing.as_deref())?;
            let largest = |v: &mut dyn Iterator<Item = f64>| v.fold(0.0_f64, |m, x| m.max(x.abs()));
            let change = largest(&mut u.iter().zip(&self.state.u).map(|(a, b)| a - b));
            correction = largest(&mut direction.iter().map(|d| d * taken)) / change.max(f64::MIN_POSITIVE);
            missing = missing.filter(|_| taken < 1.0).map(|m| m.iter().map(|m| m * (1.0 - taken)).collect());
        }
        Err(Failure::new(self.why_not(record)).into())
    }

    /// Part of the stencils with several branches whose branch or discrete choice is not what it was.
    fn changed(&self, before: &[Vec<(u8, u32)>]) -> f64 {
        let several = |t: &usize| !self.problem.terms[*t].branches().is_empty();
        let (mut changed, mut all) = (0, 0);
        for t in (0..before.len()).filter(several) {
            let (now, then) = (&self.evaluation.branches[t], &before[t]);
            changed += now.iter().zip(then).filter(|(now, then)| now != then).count();
            all += now.len();
        }
        changed as f64 / all.max(1) as f64
    }

    /// Goes along the path, evaluating anew where it turns.
    fn follow(&mut self, path: &mut Path, at: &Progress, norms: Norms, u: &[f64]) -> Result<Norms, Failure> {
        let Some(aid) = path.advance(at) else { return Ok(norms) };
        self.memory.workspace.aid = aid;
        self.evaluate(u, None, self.tangent())?;
        self.memory.workspace.aid = path.aid();
        // The factor of the helped problem is no good any more.
        self.solver.begin();
        Ok(self.measure())
    }

    fn tangent(&self) -> Tangent {
        if self.problem.newton.perturbation {
            Tangent::Perturbation(1e-6 * self.problem.cell_size)
        } else {
            Tangent::Exact
        }
    }

    fn evaluate(&mut self, u: &[f64], missing: Option<&[f64]>, tangent: Tangent) -> Result<(), Failure> {
        let trial = Trial { u, missing, tangent };
        self.memory.workspace.evaluate(&self.assembly, &trial, &mut self.evaluation)?;
        let unbalanced: Vec<f64> = (0..u.len()).map(|dof| self.evaluation.residual(dof)).collect();
        self.step.constraints.gather(&unbalanced, &mut self.residual);
        Ok(())
    }

    /// First guess, evaluated, and what the prescribed unknowns still miss there.
    fn predict(&mut self) -> Result<(Vec<f64>, Option<Vec<f64>>), Trouble> {
        let tangent = self.tangent();
        if self.state.last_dt > 0.0 {
            let part = self.at.dt / self.state.last_dt;
            let mut u: Vec<f64> = self.state.u.iter().zip(&self.state.last_change).map(|(u, d)| u + part * d).collect();
            let missing = self.missing(&mut u);
            if self.evaluate(&u, missing.as_deref(), tangent).is_ok() {
                return Ok((u, missing));
            }
        }
        let mut u = self.state.u.clone();
        let missing = self.missing(&mut u);
        self.evaluate(&u, missing.as_deref(), tangent)?;
        Ok((u, missing))
    }

    /// What prescribed unknowns miss at `u`; where that is rounding, it is put right in `u` at once.
    fn missing(&self, u: &mut [f64]) -> Option<Vec<f64>> {
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

    fn measure(&self) -> Norms {
        let yardstick = Yardstick {
            past: self.state.reference,
            stiffness: self.stiffness,
            size: self.problem.size,
            tolerance: self.problem.newton.tolerance,
        };
        let numbering = (&self.problem.dofs, &self.step.constraints);
        Norms::measure(&self.evaluation, &self.residual, numbering, &yardstick)
    }

    /// Largest diagonal entry of a displacement.
    fn refresh_stiffness(&mut self) {
        let pattern = self.memory.workspace.pattern();
        if self.evaluation.values.len() != pattern.columns.len() {
            return;
        }
        let free = self.step.constraints.free().iter().enumerate();
        let displacements = free.filter(|(_, dof)| !self.problem.dofs.is_rotation(**dof));
        let diagonal = displacements.filter_map(|(row, _)| pattern.position(row, row));
        self.stiffness = diagonal.map(|place| self.evaluation.values[place].abs()).fold(0.0, f64::max);
    }

    fn describe(&self, iteration: usize, norms: &Norms, before: &[Vec<(u8, u32)>]) -> IterationRecord {
        let mut line = IterationRecord {
            iteration,
            residual: norms.ratio,
            tolerance: norms.allowed,
            rounding: norms.rounding,
            worst: norms.worst,
            ..IterationRecord::default()
        };
        for (t, (term, branches)) in self.problem.terms.iter().zip(&self.evaluation.branches).enumerate() {
            let mut counts = vec![0; term.branches().len()];
            if !counts.is_empty() {
                branches.iter().for_each(|(branch, _)| counts[usize::from(*branch)] += 1);
            }
            line.branches.push(counts);
            if let Some(before) = before.get(t) {
                let changed = branches.iter().zip(before).enumerate().filter(|(_, (now, then))| now != then);
                for (stencil, _) in changed {
                    line.changes += 1;
                    line.changed = Some((t, stencil));
                }
            }
        }
        line
    }

    /// Analyses the pattern if it is new.
    fn analyse(&mut self, iteration: usize) -> Result<(), Trouble> {
        let analysis = self.memory.workspace.analysis();
        if self.memory.analysed != analysis {
            let nodes = owners(&self.problem.dofs, self.step.constraints.free());
            let pattern = self.memory.workspace.pattern();
            self.solver.analyse(pattern, nodes).map_err(|e| self.explain(e, iteration))?;
            (self.memory.analysed, self.memory.factorised) = (analysis, false);
            self.memory.analyses += 1;
        }
        Ok(())
    }

    /// Factorises if this iteration asks for it, and says whether it did.
    fn factorise(&mut self, iteration: usize) -> Result<bool, Trouble> {
        let keep = match self.problem.newton.variant {
            Variant::Full => false,
            Variant::Modified => iteration > 0,
            Variant::Kept => iteration != 4,
        };
        if keep && self.memory.factorised {
            return Ok(false);
        }
        self.memory.factorisations += 1;
        self.memory.factorised = false;
        self.propped.clear();
        match self.solver.factorise(&self.evaluation.values) {
            Err(LinearError::Singular(motions)) if self.may_close() => self.prop(&motions, iteration)?,
            factorised => {
                factorised.map_err(|e| self.explain(e, iteration))?;
                self.memory.factorised = true;
            }
        }
        Ok(true)
    }

    /// Whether there are terms that may yet hold what is free: contacts.
    fn may_close(&self) -> bool {
        self.problem.terms.iter().any(|term| term.softens())
    }

    /// Factorises with a small stiffness on every unknown, since an iterate may lose a contact that the solution has.
    /// The solution itself must stand without it.
    fn prop(&mut self, motions: &[Vec<f64>], iteration: usize) -> Result<(), Trouble> {
        self.propped = self.name_motions(motions);
        let pattern = self.memory.workspace.pattern();
        for row in 0..pattern.starts.len() - 1 {
            let columns = &pattern.columns[pattern.starts[row]..pattern.starts[row + 1]];
            if let Ok(diagonal) = columns.binary_search(&row) {
                self.evaluation.values[pattern.starts[row] + diagonal] += PROP * self.stiffness;
            }
        }
        self.solver.factorise(&self.evaluation.values).map_err(|e| self.explain(e, iteration))
    }

    /// A solution that was reached with a propped matrix must stand without the prop: what still meets no stiffness must
    /// meet a force when it moves by more than it did in the increment, as when everything slips and would slip back.
    fn stands(&mut self, u: &[f64], reference: f64) -> Result<(), Trouble> {
        if self.propped.is_empty() {
            return Ok(());
        }
        let motions = match self.solver.factorise(&self.evaluation.values) {
            Err(LinearError::Singular(motions)) => motions,
            factorised => return factorised.map_err(|e| self.explain(e, 1)),
        };
        for motion in motions {
            if !self.is_held(u, &motion, reference)? {
                return Err(Failure::new(self.name_motions(&[motion]).join("; ")).into());
            }
        }
        Ok(self.evaluate(u, None, self.tangent())?)
    }

    /// Whether finite motion to either side meets a force.
    fn is_held(&mut self, u: &[f64], motion: &[f64], reference: f64) -> Result<bool, Failure> {
        let mut full = vec![0.0; u.len()];
        self.step.constraints.expand(motion, &mut full);
        let largest = |v: &mut dyn Iterator<Item = f64>| v.fold(0.0_f64, |m, x| m.max(x.abs()));
        let change = largest(&mut u.iter().zip(&self.state.u).map(|(a, b)| a - b));
        let unit = largest(&mut full.iter().copied());
        for side in [1.0, -1.0] {
            let moved: Vec<f64> = u.iter().zip(&full).map(|(u, d)| u + side * 2.0 * change / unit * d).collect();
            self.evaluate(&moved, None, Tangent::None)?;
            if self.slope(&full).abs() <= RESISTANCE * unit * reference {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Newton's direction on all unknowns, the slope of the work of the unbalanced forces along it, and whether a matrix
    /// was factorised for it; if not, the direction satisfies its equations to within `forcing`.
    fn direction(
        &mut self,
        iteration: usize,
        missing: Option<&[f64]>,
        forcing: f64,
    ) -> Result<(Vec<f64>, f64, bool), Trouble> {
        let constraints = &self.step.constraints;
        let mut rhs = vec![0.0; self.residual.len()];
        let mut direction = vec![0.0; self.state.u.len()];
        if let Some(missing) = missing {
            constraints.gather(&self.evaluation.carried, &mut rhs);
            direction.copy_from_slice(missing);
        }
        rhs.iter_mut().zip(&self.residual).for_each(|(rhs, r)| *rhs = -(*rhs + r));
        let factorised = self.solve_linear(iteration, &mut rhs, forcing)?;
        let slope = rhs.iter().zip(&self.residual).map(|(q, r)| q * r).sum();
        constraints.expand(&rhs, &mut direction);
        Ok((direction, slope, factorised))
    }

    /// Solves with the present matrix or that of the variant, and says whether a matrix was factorised.
    fn solve_linear(&mut self, iteration: usize, rhs: &mut [f64], forcing: f64) -> Result<bool, Trouble> {
        self.analyse(iteration)?;
        if self.problem.newton.variant == Variant::Full {
            let solved = self.solver.iterate(&self.evaluation.values, rhs, forcing);
            if solved.map_err(|e| self.explain(e, 1))? {
                return Ok(false);
            }
        }
        let factorised = self.factorise(iteration)?;
        self.solver.solve(rhs).map_err(|e| self.explain(e, 1))?;
        Ok(factorised)
    }

    /// Moves `u` along the direction, evaluates there, and returns the part that was taken.
    fn advance(
        &mut self,
        u: &mut Vec<f64>,
        direction: &[f64],
        slope: f64,
        missing: Option<&[f64]>,
    ) -> Result<f64, Failure> {
        let begin = u.clone();
        let along = |part: f64| -> Vec<f64> { begin.iter().zip(direction).map(|(u, d)| u + part * d).collect() };
        let rest = |part: f64| missing.filter(|_| part < 1.0).map(|m| m.iter().map(|m| m * (1.0 - part)).collect());
        let mut part = 1.0;
        loop {
            *u = along(part);
            let missing: Option<Vec<f64>> = rest(part);
            match self.evaluate(u, missing.as_deref(), self.tangent()) {
                Ok(()) => break,
                Err(failure) if part <= SHORTEST => return Err(failure),
                Err(_) => part *= 0.5,
            }
        }
        if !self.problem.newton.line_search || missing.is_some() || part < 1.0 {
            return Ok(part);
        }
        let end = self.slope(direction);
        if end.abs() <= self.bound * slope.abs() {
            return Ok(part);
        }
        part = self.search(&along, direction, (slope, end))?;
        *u = along(part);
        self.evaluate(u, None, self.tangent())?;
        Ok(part)
    }

    /// Work of the present unbalanced forces along a direction.
    fn slope(&self, direction: &[f64]) -> f64 {
        let free = self.step.constraints.free().iter();
        free.zip(&self.residual).map(|(&dof, r)| direction[dof] * r).sum()
    }

    /// Looks for a part of the step where the slope is small: regula falsi (Illinois) where it changes sign, halving
    /// where it only grows.
    fn search(
        &mut self,
        along: &dyn Fn(f64) -> Vec<f64>,
        direction: &[f64],
        (begin, end): (f64, f64),
    ) -> Result<f64, Failure> {
        let (mut low, mut high) = ((0.0, begin), (1.0, end));
        let mut best = (end.abs(), 1.0);
        for _ in 0..6 {
            let crosses = low.1 * high.1 < 0.0;
            let part = if crosses { high.0 - high.1 * (high.0 - low.0) / (high.1 - low.1) } else { 0.5 * high.0 };
            let part = part.max(SHORTEST);
            self.evaluate(&along(part), None, Tangent::None)?;
            let slope = self.slope(direction);
            if slope.abs() < best.0 {
                best = (slope.abs(), part);
            }
            if slope.abs() <= GOOD * begin.abs() || part <= SHORTEST {
                break;
            }
            if slope * high.1 < 0.0 {
                low = (part, slope);
                high.1 *= 0.5;
            } else {
                high = (part, slope);
            }
        }
        Ok(best.1)
    }

    /// What a linear system that cannot be solved means in the user's words.
    fn explain(&self, error: LinearError, iteration: usize) -> Trouble {
        let LinearError::Singular(motions) = &error else {
            return Trouble::Error(Error::Internal(error.to_string()));
        };
        let text = self.name_motions(motions).join("; ");
        if iteration == 0 {
            Trouble::Error(Error::NotConverged(format!(
                "{text}: nothing holds it; support it, or bring it into contact"
            )))
        } else {
            Trouble::Failure(Failure::new(format!("{text} in iteration {iteration}")))
        }
    }

    fn name_motions(&self, motions: &[Vec<f64>]) -> Vec<String> {
        let mut named: Vec<String> = Vec::new();
        for motion in motions {
            let mut full = vec![0.0; self.state.u.len()];
            self.step.constraints.expand(motion, &mut full);
            let names = self.problem.terms.iter().filter_map(|term| term.describe_motion(&full)).collect::<Vec<_>>();
            named.extend(if names.is_empty() { vec![self.problem.name_of_largest(&full)] } else { names });
        }
        named.sort();
        named.dedup();
        named
    }

    /// Motions that meet no stiffness at the accepted state, in words: what would stop the first iteration.
    pub fn free_motions(mut self) -> Result<Vec<String>, Trouble> {
        let u = self.state.u.clone();
        self.memory.workspace.aid = Aid::NONE;
        self.evaluate(&u, None, Tangent::Exact)?;
        let nodes = owners(&self.problem.dofs, self.step.constraints.free());
        let pattern = self.memory.workspace.pattern();
        let solved = self.solver.analyse(pattern, nodes).and_then(|()| self.solver.factorise(&self.evaluation.values));
        match solved {
            Ok(()) => Ok(Vec::new()),
            Err(LinearError::Singular(motions)) => Ok(self.name_motions(&motions)),
            Err(other) => Err(Trouble::Error(Error::Internal(other.to_string()))),
        }
    }

    fn why_not(&self, record: &AttemptRecord) -> String {
        let Some(last) = record.iterations.last() else { return "no iteration was made".into() };
        let mut text = format!(
            "the largest unbalanced force is {:.1e} of the forces in play after {} iterations (at most {:.0e}), at {}",
            last.residual,
            last.iteration,
            last.tolerance,
            self.problem.name_of(last.worst.dof)
        );
        if let Some((term, stencil)) = last.changed {
            let name = self.problem.terms[term].name_of(stencil);
            text += &format!("; {} contact states still changed, the last at {name}", last.changes);
        }
        text
    }
}

/// Residual of an iterative solution over its right-hand side, from the unbalanced forces now and an iteration before:
/// what the linear system leaves is no more than what the next iteration finds anyway, so that the order stays
/// quadratic (Eisenstat & Walker, SIAM J. Sci. Comput. 17, 1996, their second choice).
fn forcing(now: f64, before: f64) -> f64 {
    (now / before.max(f64::MIN_POSITIVE)).powi(2).clamp(TIGHTEST, LOOSEST)
}

/// For each free unknown, its node or tool, numbered as they come.
fn owners(dofs: &Dofs, free: &[usize]) -> Vec<usize> {
    let owner = |dof: usize| match dof.checked_sub(dofs.node(dofs.nodes())) {
        None => dof / dofs.per_node(),
        Some(beyond) => dofs.nodes() + beyond / dofs.per_tool(),
    };
    let (mut number, mut last) = (0, None);
    let number = |&dof: &usize| {
        number += usize::from(last.is_some_and(|last| last != owner(dof)));
        last = Some(owner(dof));
        number
    };
    free.iter().map(number).collect()
}
