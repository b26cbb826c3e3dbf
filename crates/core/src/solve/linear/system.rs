//! The linear system of an iteration, whatever engine factorises: one that the accepted state's matrix preconditions, put right for
//! what has changed near contact, or one that is factorised.
//!
//! A factor that serves increment after increment is a part of the accepted state: every attempt begins with the matrix that the
//! state holds, its factor and what it has served for, whatever was solved since the state was accepted. So an attempt that is made
//! again, and a run that goes on from a checkpoint, arrive at the same bits.

use super::compliance::ContactCompliance;
use super::low_rank::Rows;
use super::{Factored, LinearError, LinearSolver, Unknowns, engine};
use crate::Failure;
use crate::system::{Csr, Dofs, Factorised, PackedPattern, Preconditioner, Shares};
use frontal::{LowRankChange, Pattern, PivotSigns, Policy, Recycler, Scaling, Work};
use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Where the matrix jumps: the free unknowns of contact.
pub trait JumpSites {
    /// Those near contact, ascending; where a factor is to serve for more than one matrix, those as well where contact may go.
    fn near(&self, wide: bool) -> Vec<usize>;
    /// Those of points whose stresses have slopes.
    ///
    /// # Errors
    /// When a law cannot answer.
    fn closed(&self) -> Result<BTreeSet<usize>, Failure>;
}

/// Why a system was not solved.
#[derive(Debug)]
pub enum Unsolved {
    /// The engine cannot.
    Engine(LinearError),
    /// A law cannot answer.
    Law(Failure),
}

impl From<LinearError> for Unsolved {
    fn from(error: LinearError) -> Self {
        Self::Engine(error)
    }
}

impl From<Failure> for Unsolved {
    fn from(failure: Failure) -> Self {
        Self::Law(failure)
    }
}

impl From<frontal::FrontalError> for LinearError {
    fn from(error: frontal::FrontalError) -> Self {
        match error {
            frontal::FrontalError::NotFinite { .. } => Self::NotFinite("the stiffness is not finite".into()),
            other => Self::Other(other.to_string()),
        }
    }
}

/// What was done so far, and the time that it took.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct SolverCounts {
    /// Analyses of a pattern.
    pub analyses: usize,
    /// Factorisations.
    pub factorisations: usize,
    /// Those of matrices that are symmetric, as L D L^T.
    pub symmetric: usize,
    /// Solutions with the factor of their own matrix,
    pub direct: usize,
    /// those by iterations with an older one,
    pub iterative: usize,
    /// and these iterations, those in vain included.
    pub iterations: usize,
    /// Time of analyses and factorisations,
    pub factorising: Duration,
    /// of solutions,
    pub solving: Duration,
    /// and of the compliance of contact and the changes of low rank.
    pub complying: Duration,
}

impl SolverCounts {
    /// All time that it took.
    pub fn time(&self) -> Duration {
        self.factorising + self.solving + self.complying
    }
}

/// An engine with what saves factorisations. Where several ranks run together each has its own rows of the matrices, and whole
/// vectors.
pub struct LinearSystem {
    engine: Box<dyn LinearSolver>,
    shares: Shares,
    recycler: Recycler,
    dofs: Dofs,
    /// Pattern and unknowns of the matrices to come, and the number that tells patterns apart; that of the one that the engine knows.
    pattern: Csr,
    free: Vec<usize>,
    number: usize,
    analysed: usize,
    /// The matrix that was factorised last, where it may precondition others, and its factors of rows and columns; whether the first
    /// rank has all rows for the accepted state.
    held: Option<Held>,
    collected: bool,
    scaling: Option<Scaling>,
    factored: Factored,
    /// Whether the matrix at hand is the one that was factorised.
    direct: bool,
    compliance: ContactCompliance,
    counts: SolverCounts,
}

/// A matrix that was factorised, as the accepted state has it and as its rows of this rank are read.
struct Held {
    matrix: Arc<Factorised>,
    starts: Arc<Vec<usize>>,
    columns: Arc<Vec<usize>>,
    /// Those of the rows first, on the first rank those of all then.
    values: Arc<Vec<f64>>,
}

impl Held {
    fn rows(&self) -> Rows<'_> {
        Rows { starts: &self.starts, columns: &self.columns, values: &self.values[..self.columns.len()] }
    }
}

impl LinearSystem {
    /// With an engine, over the unknowns of a model.
    pub fn new(engine: Box<dyn LinearSolver>, policy: Policy, dofs: Dofs) -> Self {
        Self {
            engine,
            shares: Shares::new(engine::others(), &dofs, &[]),
            recycler: Recycler::new(policy),
            dofs,
            pattern: Csr::new(Arc::new(vec![0]), Arc::default()),
            free: Vec::new(),
            number: 0,
            analysed: 0,
            held: None,
            collected: false,
            scaling: None,
            factored: Factored::default(),
            direct: false,
            compliance: ContactCompliance::default(),
            counts: SolverCounts::default(),
        }
    }

    /// Takes note of the pattern of the matrices to come, which its number, never zero, tells from others, and of the free unknowns;
    /// whether it is a new one. The factor there is may precondition matrices of another pattern of the same unknowns; an analysis
    /// comes before the next factorisation only.
    pub fn set_pattern(&mut self, number: usize, pattern: &Csr, free: &[usize]) -> bool {
        if self.number == number {
            return false;
        }
        if self.free != free || self.recycler.affordable_iterations() == 0 {
            self.recycler.refuse();
            self.compliance = ContactCompliance::default();
            self.free = free.to_vec();
            self.shares = Shares::new(self.shares.with(), &self.dofs, free);
        }
        self.recycler.change(None);
        (self.number, self.pattern) = (number, pattern.clone());
        true
    }

    /// Replaces the right-hand side by the solution with the matrix of these values, and says whether that was factorised: as good as
    /// the engine solves then; else to a residual of `tolerance` times the right-hand side.
    ///
    /// # Errors
    /// Those of the engine, [`LinearError::Singular`] among them, with the right-hand side undefined, and those of the laws.
    pub fn solve(
        &mut self,
        values: &[f64],
        sites: &dyn JumpSites,
        rhs: &mut [f64],
        tolerance: f64,
    ) -> Result<bool, Unsolved> {
        if self.recycler.affordable_iterations() > 0 {
            self.put_right(values, sites)?;
            self.direct = false;
            if self.iterate((values, false), rhs, tolerance)? {
                return Ok(false);
            }
        }
        self.factorise(values)?;
        let stays = self.recycler.affordable_iterations() > 0;
        let closed = if stays { Some(sites.closed()?) } else { None };
        self.compliance = ContactCompliance::new(sites.near(stays), closed);
        self.solve_directly(rhs)?;
        Ok(true)
    }

    /// The same for another right-hand side of the matrix of the last call, or of the one that was factorised for it; false, with the
    /// right-hand side as it was, where that takes a factor of its own.
    ///
    /// # Errors
    /// Those of the engine.
    pub fn solve_again(&mut self, values: &[f64], rhs: &mut [f64], tolerance: f64) -> Result<bool, LinearError> {
        if self.direct { self.solve_directly(rhs).map(|()| true) } else { self.iterate((values, true), rhs, tolerance) }
    }

    /// Motions of the unknowns `wanted`, which ascend, under loads, unknown after unknown, by the factor there is and what it is put
    /// right for.
    ///
    /// # Errors
    /// Those of the engine.
    pub fn compliance(&mut self, loads: &[frontal::Sparse], wanted: &[usize]) -> Result<Vec<f64>, LinearError> {
        let begun = Instant::now();
        self.compliance.cover(wanted);
        let motions = self.compliance.motions(loads, wanted, (self.engine.as_mut(), self.free.len()));
        self.counts.complying += begun.elapsed();
        motions
    }

    /// What the next increment begins with: the matrix whose factor there is, if that is to serve on. On the first rank it is whole.
    ///
    /// # Errors
    /// That ranks have come apart.
    pub fn snapshot(&mut self) -> Result<Option<Preconditioner>, LinearError> {
        let (Some(service), Some(held)) = (self.recycler.service(), &mut self.held) else { return Ok(None) };
        if let Some(with) = self.shares.with().filter(|_| !self.collected) {
            let words: Vec<f64> = held.matrix.pattern.0.iter().map(|word| f64::from(*word)).collect();
            let words = with.collect(&words).map_err(LinearError::Input)?;
            let values = with.collect(&held.values).map_err(LinearError::Input)?;
            self.collected = true;
            if with.rank() == 0 {
                let pattern = PackedPattern(words.into_iter().map(|word| word as u32).collect());
                held.values = Arc::new(values);
                let values = held.values.clone();
                held.matrix = Arc::new(Factorised { free: self.free.clone(), pattern, values });
            }
        }
        Ok(Some(Preconditioner { matrix: held.matrix.clone(), service, near: self.compliance.near() }))
    }

    /// Begins a sequence of matrices over these free unknowns with what was there when the state was accepted.
    pub fn restore(&mut self, held: Option<&Preconditioner>, free: &[usize]) {
        let held = held.filter(|held| held.matrix.free == free);
        if !held.is_some_and(|held| self.take_up(held)) {
            self.recycler.refuse();
        }
        self.recycler.begin();
    }

    /// Lets the factor there is not serve for the next matrix.
    pub fn invalidate_factor(&mut self) {
        self.recycler.refuse();
    }

    /// Factorises the matrix with these values. Nothing is known of contact in it.
    ///
    /// # Errors
    /// Those of the engine.
    pub fn factorise(&mut self, values: &[f64]) -> Result<(), LinearError> {
        let begun = Instant::now();
        self.compliance = ContactCompliance::new(Vec::new(), Some(BTreeSet::new()));
        let factorised = self.factorise_now(values);
        self.counts.factorising += begun.elapsed();
        factorised
    }

    /// What the signs of the pivots say of the matrix that was factorised last, where they are known.
    pub fn signs(&self) -> Option<PivotSigns> {
        self.factored.signs
    }

    /// `x <- K^-1 x` by the factor there is, not refined; false where there is none.
    pub fn substitute(&mut self, x: &mut [f64]) -> bool {
        self.engine.substitute(x).is_ok()
    }

    /// What was done so far.
    pub fn counts(&self) -> SolverCounts {
        SolverCounts { iterations: self.recycler.counts.iterations, ..self.counts }
    }

    fn factorise_now(&mut self, values: &[f64]) -> Result<(), LinearError> {
        if self.analysed != self.number {
            let unknowns = Unknowns { dofs: &self.dofs, free: &self.free };
            self.engine.set_pattern(&self.pattern, unknowns)?;
            self.analysed = self.number;
            self.counts.analyses += 1;
        }
        (self.held, self.scaling, self.factored, self.direct) = (None, None, Factored::default(), false);
        self.collected = false;
        self.recycler.forget();
        self.counts.factorisations += 1;
        self.factored = self.engine.factorise(values)?;
        self.direct = true;
        self.counts.symmetric += usize::from(self.factored.signs.is_some_and(|signs| signs.symmetric));
        self.recycler.factorised(self.work(), None);
        if self.recycler.service().is_some() {
            // Its factor may serve on.
            let pattern = PackedPattern::of(&self.pattern, self.shares.own());
            let values = Arc::new(values.to_vec());
            self.hold(Factorised { free: self.free.clone(), pattern, values: values.clone() }.into(), values);
        }
        Ok(())
    }

    fn hold(&mut self, matrix: Arc<Factorised>, values: Arc<Vec<f64>>) {
        let Csr { starts, columns, .. } = &self.pattern;
        self.held = Some(Held { matrix, starts: starts.clone(), columns: columns.clone(), values });
    }

    /// What the factor there is takes; of one that the engine does not say it of none is to precondition.
    fn work(&self) -> Work {
        self.factored.work.unwrap_or_default()
    }

    fn solve_directly(&mut self, rhs: &mut [f64]) -> Result<(), LinearError> {
        let begun = Instant::now();
        let solved = self.engine.solve(rhs);
        self.counts.direct += 1;
        self.counts.solving += begun.elapsed();
        solved
    }

    /// Puts the factor right for what has changed near contact.
    fn put_right(&mut self, values: &[f64], sites: &dyn JumpSites) -> Result<(), Unsolved> {
        let Some(held) = &self.held else { return Ok(()) };
        let (closed, begun) = (sites.closed()?, Instant::now());
        let now = Rows { starts: &self.pattern.starts, columns: &self.pattern.columns, values };
        self.compliance.cover(&sites.near(false));
        let engine = (self.engine.as_mut(), self.free.len());
        let change = self.compliance.low_rank_update([now, held.rows()], &self.shares, &closed, engine)?;
        self.recycler.change(change);
        self.counts.complying += begun.elapsed();
        Ok(())
    }

    /// Solves by iterations that the factor there is preconditions, with the `same` matrix as the last time or another.
    fn iterate(
        &mut self,
        (values, same): (&[f64], bool),
        rhs: &mut [f64],
        tolerance: f64,
    ) -> Result<bool, LinearError> {
        let Some(held) = &self.held else { return Ok(false) };
        let begun = Instant::now();
        let of =
            |starts: &Arc<Vec<usize>>, columns: &Arc<Vec<usize>>| Pattern::trusted(starts.clone(), columns.clone());
        let shares = &self.shares;
        // One rank alone is told by the iterations.
        let is_infinite = || values.iter().any(|value| !value.is_finite());
        if shares.with().is_some() && shares.any(is_infinite()).map_err(LinearError::Input)? {
            return Err(LinearError::NotFinite("the stiffness is not finite".into()));
        }
        if self.scaling.is_none() {
            let largest = |x: &mut [f64]| shares.largest(x).map_err(LinearError::Input);
            self.scaling = Some(Scaling::of(&of(&held.starts, &held.columns), held.rows().values, largest)?);
        }
        let Some(scaling) = &self.scaling else { return Ok(false) };
        // Each increment has its own, made by the same rules as the first.
        let pattern = of(&self.pattern.starts, &self.pattern.columns);
        let engine = &mut self.engine;
        let system = ((&pattern, values), scaling, same);
        let precondition = |change: Option<&LowRankChange>, x: &mut [f64]| engine.precondition(change, x);
        let complete = |x: &mut [f64]| shares.complete(x).map_err(LinearError::Input);
        let solved = self.recycler.iterate(system, (precondition, complete), rhs, tolerance);
        self.counts.solving += begun.elapsed();
        let solved: bool = solved?.is_some();
        self.counts.iterative += usize::from(solved);
        Ok(solved)
    }

    /// Sees to it that the factor is what it was when the state was accepted; false where the matrix has no factor, which
    /// is that of a damaged checkpoint then.
    fn take_up(&mut self, held: &Preconditioner) -> bool {
        let same = self.held.as_ref().is_some_and(|own| Arc::ptr_eq(&own.matrix, &held.matrix));
        if same && self.recycler.service() == Some(held.service) && self.compliance.near() == held.near {
            return true;
        }
        if !same && self.factorise_again(&held.matrix).is_err() {
            return false;
        }
        self.recycler.factorised(self.work(), Some(held.service));
        let resumed = ContactCompliance::resume(&held.near, (self.engine.as_mut(), self.free.len()));
        resumed.map(|compliance| self.compliance = compliance).is_ok()
    }

    fn factorise_again(&mut self, matrix: &Arc<Factorised>) -> Result<(), LinearError> {
        // Neither is that of the matrices to come, as far as is known.
        self.free.clone_from(&matrix.free);
        self.shares = Shares::new(self.shares.with(), &self.dofs, &self.free);
        let pattern = matrix.pattern().ok_or_else(|| LinearError::Other("a matrix without a pattern".into()))?;
        let mut entries = 0..matrix.values.len();
        (self.analysed, self.number, self.pattern) = (0, NONE, pattern);
        if self.shares.with().is_some() {
            // From a checkpoint all rows are there.
            (self.pattern, entries) = self.pattern.rows_only(self.shares.own());
        }
        self.factorise(&matrix.values[entries.clone()])?;
        self.number = 0;
        self.analysed = 0;
        let values = if entries.start == 0 { matrix.values.clone() } else { matrix.values[entries].to_vec().into() };
        self.hold(matrix.clone(), values);
        self.collected = true;
        Ok(())
    }
}

/// The number of no pattern of an attempt.
const NONE: usize = usize::MAX;
