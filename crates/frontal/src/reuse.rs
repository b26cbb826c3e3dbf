//! Not factorising at all when an old factor will do.

use crate::change::LowRankChange;
use crate::direct::Direct;
use crate::error::FrontalError;
use crate::factor::{Factor, Report};
use crate::krylov::{Convergence, Krylov, Scaled, solve_recycling};
use crate::pattern::{Pattern, check_length};
use crate::recycle::Outer;
use crate::refine::Accuracy;
use crate::scaling::Scaling;
use crate::symbolic::{Prediction, Symbolic};
use serde::{Deserialize, Serialize};

/// Decades by which the affordable iterations must lower a residual, all together and those of one solution at the least.
const DECADES: f64 = 9.0;
const FEWEST: f64 = 3.0;

/// How long a factor may serve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Reuse {
    /// Every matrix is factorised.
    Never,
    /// Until [`Solver::begin`]: a sequence of solves that starts with a fresh factor depends on nothing before it.
    #[default]
    WithinSequence,
    /// As long as it pays: until a sequence takes more work than the sequences since the factorisation took on average,
    /// that of the factorisation included. Which matrix was factorised then shows in the last digits of what is solved
    /// later.
    AcrossSequences,
}

/// When to refactorise. Decisions follow from predicted costs and counted iterations, never from a clock, so that a
/// run can be repeated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Policy {
    /// How long a factor may serve.
    pub reuse: Reuse,
    /// Share of a factorisation's cost that one iterative solution may spend before it is given up.
    pub share: f64,
    /// Iterations that must be affordable for an old factor to be tried at all.
    pub least_iterations: usize,
}

impl Default for Policy {
    fn default() -> Self {
        Policy { reuse: Reuse::default(), share: 0.8, least_iterations: 9 }
    }
}

impl Policy {
    /// Iterations that one solution may take; zero if a fresh factor is the cheaper way from the start.
    pub fn affordable_iterations(&self, cost: Work) -> usize {
        let affordable = (self.share * cost.factorisation / cost.solution.max(1.0)) as usize;
        if self.reuse == Reuse::Never || affordable < self.least_iterations { 0 } else { affordable.min(40) }
    }
}

/// What a factor takes to be made and to be used, in one unit.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Work {
    /// Of a factorisation.
    pub factorisation: f64,
    /// Of a solution with it.
    pub solution: f64,
}

impl From<&Prediction> for Work {
    fn from(cost: &Prediction) -> Self {
        Work { factorisation: cost.factorisation_work(), solution: cost.solve_work() }
    }
}

/// What a solution took.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Outcome {
    /// The matrix was factorised and solved with refinement.
    Direct {
        /// What the factorisation met.
        report: Report,
        /// Accuracy of the solution.
        accuracy: Accuracy,
        /// Iterations spent in vain on the old factor.
        wasted: usize,
    },
    /// The factor of an earlier matrix was the preconditioner.
    Iterative(Convergence),
}

/// Counts since the solver was made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// Factorisations made, those as L D L^T included.
    pub factorisations: usize,
    /// Factorisations as L D L^T.
    pub symmetric: usize,
    /// Systems solved.
    pub solutions: usize,
    /// Iterations with an old factor, wasted ones included.
    pub iterations: usize,
}

/// What a factor has served for since it was made, as far as that decides on what comes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Service {
    /// Sequences, the one in which it was made included.
    sequences: usize,
    /// Iterations, and those of the sequence that began last.
    iterations: usize,
    latest: usize,
}

/// The policy at work, whatever makes the factor: whether that may serve for the next matrix, and the iterations that it
/// preconditions.
#[derive(Debug, Default)]
pub struct Recycler {
    policy: Policy,
    work: Work,
    /// Whether the factor may be used for the next matrix.
    usable: bool,
    /// Directions of the solutions since the sequence began.
    outer: Outer,
    /// Iterations spent on the matrix at hand.
    spent: usize,
    service: Service,
    /// What is known to have changed since.
    change: Option<LowRankChange>,
    /// Iterations since it was made, wasted ones included, and systems solved by them.
    pub counts: Counts,
}

impl Recycler {
    /// With a policy, and without a factor.
    pub fn new(policy: Policy) -> Self {
        Recycler { policy, ..Self::default() }
    }

    /// Begins a new sequence, such as the attempt of an increment: the next matrix is factorised, unless the policy
    /// reuses factors across sequences. Of the solutions before, nothing but the [`Service`] shows in those to come.
    pub fn begin(&mut self) {
        self.usable &= self.policy.reuse == Reuse::AcrossSequences && self.pays();
        self.service.sequences += 1;
        self.service.latest = 0;
        self.outer.clear();
    }

    /// Whether the last sequence took no more work than all since the factorisation did on average.
    fn pays(&self) -> bool {
        let work = |iterations: usize| self.work.solution * iterations as f64;
        let Service { sequences, iterations, latest } = self.service;
        work(latest) * sequences as f64 <= self.work.factorisation + work(iterations)
    }

    /// What the factor there is has served for, if it may serve for the next sequence too.
    pub fn service(&self) -> Option<Service> {
        let stays = self.policy.reuse == Reuse::AcrossSequences && self.affordable_iterations() > 0;
        (stays && self.pays()).then_some(self.service)
    }

    /// There is a new factor, or the making of one, which took so much, has begun anew for one that served for so much.
    pub fn factorised(&mut self, work: Work, service: Option<Service>) {
        (self.work, self.usable, self.change) = (work, true, None);
        match service {
            Some(service) => self.service = service,
            None => {
                self.outer.clear();
                self.service = Service { sequences: 1, ..Service::default() };
            }
        }
    }

    /// Has the next matrix factorised, whatever the policy.
    pub fn refuse(&mut self) {
        self.usable = false;
    }

    /// There is no factor any more.
    pub fn forget(&mut self) {
        self.refuse();
        self.outer.clear();
        self.change = None;
    }

    /// Iterations with the factor there is that the next solution may take; none if a fresh factor comes first.
    pub fn affordable_iterations(&self) -> usize {
        if self.usable { self.policy.affordable_iterations(self.work) } else { 0 }
    }

    /// Whether a factor that takes so much is to precondition at all.
    pub fn preconditions(&self, work: Work) -> bool {
        self.policy.affordable_iterations(work) > 0
    }

    /// Says by what the matrices to come differ from the one that was factorised, besides small changes: the factor is
    /// put right for that until the next factorisation or the next change.
    pub fn change(&mut self, change: Option<LowRankChange>) {
        self.change = change;
    }

    /// Solves `A x = b` in place with the factor there is as the preconditioner, until the residual is below `tolerance` times the
    /// right-hand side, as in [`Krylov::tolerance`], in the scale of the matrix that was factorised; `None`, with `rhs` as it was,
    /// if the policy has the matrix factorised, or if that took too many iterations. Of the `same` matrix as in the last call more
    /// is known: both together may take as many iterations as one alone. `precondition` does `x <- (A0 + change)^-1 x` with the
    /// matrix `A0` that was factorised; `complete` completes products of a matrix of which this process has only some rows, the others
    /// empty.
    ///
    /// # Errors
    /// [`FrontalError::WrongLength`], [`FrontalError::NotFinite`]; those of `precondition` and `complete`.
    pub fn iterate<E: From<FrontalError>>(
        &mut self,
        ((pattern, values), scaling, same): ((&Pattern, &[f64]), &Scaling, bool),
        (mut precondition, complete): (
            impl FnMut(Option<&LowRankChange>, &mut [f64]) -> Result<(), E>,
            impl FnMut(&mut [f64]) -> Result<(), E>,
        ),
        rhs: &mut [f64],
        tolerance: f64,
    ) -> Result<Option<Convergence>, E> {
        if !same {
            self.spent = 0;
            // With a change known a few iterations do, of which each takes less than the products with all earlier directions.
            if self.change.is_some() {
                self.outer.clear();
            }
        }
        let affordable = self.affordable_iterations();
        // Where a change is known other right-hand sides follow.
        let decades = if self.change.is_some() { (-tolerance.log10()).clamp(FEWEST, DECADES) } else { DECADES };
        let iterations = (affordable as f64 * decades / DECADES).ceil() as usize;
        let iterations = iterations.min(affordable.saturating_sub(self.spent));
        if iterations == 0 {
            return Ok(None);
        }
        let mut x = rhs.to_vec();
        let krylov = Krylov { tolerance, iterations, restart: iterations };
        let change = self.change.as_ref();
        let precondition = |x: &mut [f64]| precondition(change, x);
        let system = Scaled::new((pattern, values), scaling, (precondition, complete))?;
        let convergence = solve_recycling(system, &mut x, &krylov, (&mut self.outer, same))?;
        let Service { iterations, latest, .. } = &mut self.service;
        for count in [&mut self.counts.iterations, &mut self.spent, iterations, latest] {
            *count += convergence.iterations;
        }
        if !convergence.converged {
            return Ok(None);
        }
        self.counts.solutions += 1;
        rhs.copy_from_slice(&x);
        Ok(Some(convergence))
    }
}

/// A factor with a policy: solves a sequence of systems with one pattern and slowly changing values.
#[derive(Debug)]
pub struct Solver {
    direct: Direct,
    recycler: Recycler,
    /// Pattern of the matrices to come, where it is not the one that was analysed.
    other: Option<Pattern>,
}

impl Solver {
    /// Takes an analysis and makes room for one factor.
    pub fn new(symbolic: Symbolic, policy: Policy) -> Self {
        Solver { direct: Direct::new(symbolic), recycler: Recycler::new(policy), other: None }
    }

    /// The analysis.
    pub fn symbolic(&self) -> &Symbolic {
        self.direct.symbolic()
    }

    /// The factor of the last matrix that was factorised.
    pub fn factor(&self) -> &Factor {
        self.direct.factor()
    }

    /// What was done so far.
    pub fn counts(&self) -> Counts {
        self.recycler.counts
    }

    /// As [`Recycler::begin`].
    pub fn begin(&mut self) {
        self.recycler.begin();
    }

    /// As [`Recycler::service`].
    pub fn service(&self) -> Option<Service> {
        self.recycler.service()
    }

    /// Has the factor there is be one that has served for so much: what follows is the same to the bit as after that.
    pub fn resume(&mut self, service: Service) {
        self.recycler.factorised(self.work(), Some(service));
    }

    /// As [`Recycler::refuse`].
    pub fn refuse(&mut self) {
        self.recycler.refuse();
    }

    /// As [`Recycler::change`].
    pub fn change(&mut self, change: Option<LowRankChange>) {
        self.recycler.change(change);
    }

    fn work(&self) -> Work {
        Work::from(&self.symbolic().prediction())
    }

    /// Takes another analysis, and for its factor the memory of the one there was.
    pub fn replace(&mut self, symbolic: Symbolic) {
        self.recycler.forget();
        self.other = None;
        self.direct.replace(symbolic);
    }

    /// Has the matrices to come have another pattern, of the same unknowns: the factor there is may precondition them. They
    /// are not factorised by this solver.
    ///
    /// # Errors
    /// [`FrontalError::WrongLength`] for another number of unknowns.
    pub fn follow(&mut self, pattern: Pattern) -> Result<(), FrontalError> {
        check_length("rows of the pattern", self.symbolic().pattern().len(), pattern.len())?;
        self.recycler.change(None);
        self.other = (!self.symbolic().covers(&pattern)).then_some(pattern);
        Ok(())
    }

    /// Solves `A x = b` in place. With an old factor the residual is brought below `tolerance` times the right-hand
    /// side, as in [`Krylov::tolerance`]; with a fresh one the solution is as good as [`Factor::solve`] makes it.
    ///
    /// # Errors
    /// Those of [`Symbolic::factorise`] and [`Factor::solve`].
    pub fn solve(&mut self, values: &[f64], rhs: &mut [f64], tolerance: f64) -> Result<Outcome, FrontalError> {
        let before = self.counts().iterations;
        if let Some(convergence) = self.iterate(values, rhs, tolerance)? {
            return Ok(Outcome::Iterative(convergence));
        }
        let wasted = self.counts().iterations - before;
        let report = self.factorise(values)?;
        let accuracy = self.solve_directly(rhs)?;
        Ok(Outcome::Direct { report, accuracy, wasted })
    }

    /// Solves like [`Solver::solve`] if the policy has an old factor do; `None`, with `rhs` as it was, if not, or if
    /// that took too many iterations. [`Solver::factorise`] comes next then.
    ///
    /// # Errors
    /// [`FrontalError::WrongLength`], [`FrontalError::NotFinite`].
    pub fn iterate(
        &mut self,
        values: &[f64],
        rhs: &mut [f64],
        tolerance: f64,
    ) -> Result<Option<Convergence>, FrontalError> {
        self.iterate_on((values, false), rhs, tolerance)
    }

    /// The same for another right-hand side with the matrix of the last call: what the directions found then do of it is
    /// known without a substitution. Both together may take as many iterations as one alone.
    ///
    /// # Errors
    /// As those of [`Solver::iterate`].
    pub fn iterate_again(
        &mut self,
        values: &[f64],
        rhs: &mut [f64],
        tolerance: f64,
    ) -> Result<Option<Convergence>, FrontalError> {
        self.iterate_on((values, true), rhs, tolerance)
    }

    fn iterate_on(
        &mut self,
        (values, same): (&[f64], bool),
        rhs: &mut [f64],
        tolerance: f64,
    ) -> Result<Option<Convergence>, FrontalError> {
        if self.recycler.affordable_iterations() > 0 {
            self.direct.round();
        }
        let (direct, pattern) = (&self.direct, self.other.as_ref().unwrap_or(self.direct.symbolic().pattern()));
        let system = ((pattern, values), &direct.factor().scaling, same);
        let precondition = |change: Option<&LowRankChange>, x: &mut [f64]| direct.precondition(change, x);
        self.recycler.iterate(system, (precondition, |_: &mut [f64]| Ok(())), rhs, tolerance)
    }

    /// Factorises.
    ///
    /// # Errors
    /// Those of [`Symbolic::factorise`].
    pub fn factorise(&mut self, values: &[f64]) -> Result<Report, FrontalError> {
        self.recycler.forget();
        self.recycler.counts.factorisations += 1;
        self.recycler.counts.symmetric += usize::from(self.symbolic().prediction().symmetric);
        let report = self.direct.factorise(values)?;
        self.recycler.factorised(self.work(), None);
        Ok(report)
    }

    /// Solves with the matrix that was factorised last, whatever the policy.
    ///
    /// # Errors
    /// Those of [`Factor::solve`].
    pub fn solve_directly(&mut self, rhs: &mut [f64]) -> Result<Accuracy, FrontalError> {
        self.recycler.counts.solutions += 1;
        if self.recycler.affordable_iterations() > 0 {
            self.direct.round();
        }
        self.direct.solve(rhs)
    }

    /// [`Factor::influence`] with the factor there is, in single precision where other matrices are to be preconditioned by
    /// that.
    ///
    /// # Errors
    /// Those of [`Factor::influence`].
    pub fn influence(&self, loads: &[Vec<(usize, f64)>], at: &[usize], x: &mut [f64]) -> Result<(), FrontalError> {
        self.direct.influence(loads, at, x)
    }
}
