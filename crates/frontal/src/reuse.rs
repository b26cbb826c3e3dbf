//! Not factorising at all when an old factor will do.

use crate::change::{Change, Preconditioner};
use crate::error::Error;
use crate::factor::{Factor, Report};
use crate::krylov::{Convergence, Krylov};
use crate::pattern::{Pattern, check_length};
use crate::recycle::Outer;
use crate::refine::Accuracy;
use crate::rounded::Rounded;
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
    pub fn affordable_iterations(&self, cost: &Prediction) -> usize {
        let affordable = (self.share * cost.factorisation_work() / cost.solve_work().max(1.0)) as usize;
        if self.reuse == Reuse::Never || affordable < self.least_iterations { 0 } else { affordable.min(40) }
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
    /// Whether it preconditions in single precision, where that was found out.
    single: Option<bool>,
}

/// A factor with a policy: solves a sequence of systems with one pattern and slowly changing values.
#[derive(Debug)]
pub struct Solver {
    symbolic: Symbolic,
    /// The same analysis for values of the other kind, where there were any.
    other_kind: Option<Symbolic>,
    factor: Factor,
    policy: Policy,
    /// Whether the factor may be used for the next matrix.
    usable: bool,
    /// Directions of the solutions since the sequence began.
    outer: Outer,
    /// The factor in single precision, which is enough to precondition.
    rounded: Rounded,
    /// Iterations spent on the matrix at hand.
    spent: usize,
    service: Service,
    /// What is known to have changed since.
    change: Option<Change>,
    /// Pattern of the matrices to come, where it is not the one that was analysed.
    other: Option<Pattern>,
    counts: Counts,
}

impl Solver {
    /// Takes an analysis and makes room for one factor.
    pub fn new(symbolic: Symbolic, policy: Policy) -> Self {
        let factor = symbolic.new_factor();
        let (outer, rounded, counts) = (Outer::default(), Rounded::default(), Counts::default());
        Solver {
            symbolic,
            other_kind: None,
            factor,
            policy,
            usable: false,
            outer,
            rounded,
            spent: 0,
            service: Service::default(),
            change: None,
            other: None,
            counts,
        }
    }

    /// The analysis.
    pub fn symbolic(&self) -> &Symbolic {
        &self.symbolic
    }

    /// The factor of the last matrix that was factorised.
    pub fn factor(&self) -> &Factor {
        &self.factor
    }

    /// What was done so far.
    pub fn counts(&self) -> Counts {
        self.counts
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
        let cost = self.symbolic.prediction();
        let work = |iterations: usize| cost.solve_work() * iterations as f64;
        let Service { sequences, iterations, latest, .. } = self.service;
        work(latest) * sequences as f64 <= cost.factorisation_work() + work(iterations)
    }

    /// What the factor there is has served for, if it may serve for the next sequence too.
    pub fn service(&self) -> Option<Service> {
        let stays = self.policy.reuse == Reuse::AcrossSequences && self.affordable_iterations() > 0;
        (stays && self.pays()).then(|| Service { single: self.rounded.fit(), ..self.service })
    }

    /// Has the factor there is be one that has served for so much: what follows is the same to the bit as after that.
    pub fn resume(&mut self, service: Service) {
        self.usable = true;
        self.service = service;
        self.make_room();
        self.rounded.settle(&self.factor, service.single);
        self.change = None;
    }

    /// Has the next matrix factorised, whatever the policy.
    pub fn refuse(&mut self) {
        self.usable = false;
    }

    /// Iterations with the factor there is that the next solution may take; none if a fresh factor comes first.
    pub fn affordable_iterations(&self) -> usize {
        if self.usable { self.policy.affordable_iterations(&self.symbolic.prediction()) } else { 0 }
    }

    /// Says by what the matrices to come differ from the one that was factorised, besides small changes: the factor is
    /// put right for that until the next factorisation or the next change.
    pub fn change(&mut self, change: Option<Change>) {
        self.change = change;
    }

    /// Takes another analysis, and for its factor the memory of the one there was.
    pub fn replace(&mut self, symbolic: Symbolic) {
        self.other_kind = None;
        self.exchange(symbolic);
    }

    /// The analysis for values that are symmetric, or are not.
    ///
    /// # Errors
    /// Those of [`Symbolic::for_values`].
    pub fn analysis(&self, symmetric: bool) -> Result<Symbolic, Error> {
        match &self.other_kind {
            Some(other) if other.prediction().symmetric == symmetric => Ok(other.clone()),
            _ => self.symbolic.for_values(symmetric),
        }
    }

    /// Takes the analysis of [`Solver::analysis`]; the one there was is kept. The next matrix is factorised.
    pub fn expect(&mut self, symbolic: Symbolic) {
        if symbolic.prediction().symmetric != self.symbolic.prediction().symmetric {
            self.other_kind = Some(self.symbolic.clone());
            self.exchange(symbolic);
        }
    }

    fn exchange(&mut self, symbolic: Symbolic) {
        self.refuse();
        self.outer.clear();
        self.rounded.forget();
        (self.change, self.other) = (None, None);
        self.factor = symbolic.new_factor_in(self.factor.take_memory());
        self.symbolic = symbolic;
    }

    /// Has the matrices to come have another pattern, of the same unknowns: the factor there is may precondition them. They
    /// are not factorised by this solver.
    ///
    /// # Errors
    /// [`Error::WrongLength`] for another number of unknowns.
    pub fn follow(&mut self, pattern: Pattern) -> Result<(), Error> {
        check_length("rows of the pattern", self.symbolic.pattern().len(), pattern.len())?;
        self.change = None;
        self.other = (!self.symbolic.covers(&pattern)).then_some(pattern);
        Ok(())
    }

    /// Solves `A x = b` in place. With an old factor the residual is brought below `tolerance` times the right-hand
    /// side, as in [`Krylov::tolerance`]; with a fresh one the solution is as good as [`Factor::solve`] makes it.
    ///
    /// # Errors
    /// Those of [`Symbolic::factorise`] and [`Factor::solve`].
    pub fn solve(&mut self, values: &[f64], rhs: &mut [f64], tolerance: f64) -> Result<Outcome, Error> {
        let before = self.counts.iterations;
        if let Some(convergence) = self.iterate(values, rhs, tolerance)? {
            return Ok(Outcome::Iterative(convergence));
        }
        let wasted = self.counts.iterations - before;
        let report = self.factorise(values)?;
        let accuracy = self.solve_directly(rhs)?;
        Ok(Outcome::Direct { report, accuracy, wasted })
    }

    /// Solves like [`Solver::solve`] if the policy has an old factor do; `None`, with `rhs` as it was, if not, or if
    /// that took too many iterations. [`Solver::factorise`] comes next then.
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::NotFinite`].
    pub fn iterate(&mut self, values: &[f64], rhs: &mut [f64], tolerance: f64) -> Result<Option<Convergence>, Error> {
        self.spent = 0;
        // With a change known a few iterations do, of which each takes less than the products with all earlier directions.
        if self.change.is_some() {
            self.outer.clear();
        }
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
    ) -> Result<Option<Convergence>, Error> {
        self.iterate_on((values, true), rhs, tolerance)
    }

    fn iterate_on(
        &mut self,
        (values, same): (&[f64], bool),
        rhs: &mut [f64],
        tolerance: f64,
    ) -> Result<Option<Convergence>, Error> {
        let affordable = self.affordable_iterations();
        // Where a change is known other right-hand sides follow.
        let decades = if self.change.is_some() { (-tolerance.log10()).clamp(FEWEST, DECADES) } else { DECADES };
        let iterations = (affordable as f64 * decades / DECADES).ceil() as usize;
        let iterations = iterations.min(affordable.saturating_sub(self.spent));
        if iterations == 0 {
            return Ok(None);
        }
        self.make_room();
        let mut x = rhs.to_vec();
        let krylov = Krylov { tolerance, iterations, restart: iterations };
        let preconditioner =
            Preconditioner { single: self.rounded.of(&self.factor, rhs), change: self.change.as_ref() };
        let pattern = self.other.as_ref().unwrap_or(self.symbolic.pattern());
        let system = ((pattern, values), preconditioner);
        let convergence = self.factor.solve_recycling(system, &mut x, &krylov, (&mut self.outer, same))?;
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

    /// Factorises.
    ///
    /// # Errors
    /// Those of [`Symbolic::factorise`].
    pub fn factorise(&mut self, values: &[f64]) -> Result<Report, Error> {
        self.usable = false;
        self.outer.clear();
        self.rounded.forget();
        self.change = None;
        self.counts.factorisations += 1;
        self.counts.symmetric += usize::from(self.symbolic.prediction().symmetric);
        self.service = Service { sequences: 1, ..Service::default() };
        let report = self.symbolic.factorise(values, &mut self.factor)?;
        self.usable = true;
        Ok(report)
    }

    /// Solves with the matrix that was factorised last, whatever the policy.
    ///
    /// # Errors
    /// Those of [`Factor::solve`].
    pub fn solve_directly(&mut self, rhs: &mut [f64]) -> Result<Accuracy, Error> {
        self.counts.solutions += 1;
        if self.affordable_iterations() > 0 && rhs.len() == self.symbolic.pattern().len() {
            self.make_room();
            self.rounded.of(&self.factor, rhs);
        }
        self.factor.solve(rhs)
    }

    /// Gives back what the factor in single precision may need.
    fn make_room(&mut self) {
        if !self.rounded.settled() {
            self.factor.release();
        }
    }

    /// [`Factor::influence`] with the factor there is, in single precision where other matrices are to be preconditioned by
    /// that.
    ///
    /// # Errors
    /// Those of [`Factor::influence`].
    pub fn influence(&self, loads: &[Vec<(usize, f64)>], at: &[usize], x: &mut [f64]) -> Result<(), Error> {
        match self.rounded.known(&self.factor) {
            Some(single) => single.influence(loads, at, x),
            None => self.factor.influence(loads, at, x),
        }
    }
}
