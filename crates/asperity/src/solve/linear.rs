//! Solving the linear system of an iteration: the trait, and the multifrontal solver behind it.

use super::demand::{single, too_much};
use crate::machine::room;
use crate::system::{Csr, Dofs};
use crate::{Failure, Kind};
use frontal::{Change, Options, Pattern, Policy, Reuse, Service, Signs, Solver, Symbolic};
use std::fmt;

/// Why a linear system was not solved.
#[derive(Debug, Clone, PartialEq)]
pub enum LinearError {
    /// The matrix has no inverse; motions that meet no stiffness, each over the unknowns of the system.
    Singular(Vec<Vec<f64>>),
    /// The matrix is so nearly singular that its solution is not accurate; how much, in words.
    Inaccurate(String),
    /// A value of the matrix or of the right-hand side is infinite or not a number, as far from equilibrium.
    NotFinite(String),
    /// The factors do not fit into the memory there is, in words.
    Memory(String),
    /// What was asked of the solver cannot be, in words.
    Input(String),
    /// Anything else, in words.
    Other(String),
}

impl fmt::Display for LinearError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Singular(_) => f.write_str("the matrix is singular"),
            Self::Inaccurate(text) | Self::NotFinite(text) => f.write_str(text),
            Self::Memory(text) | Self::Input(text) | Self::Other(text) => f.write_str(text),
        }
    }
}

impl From<&LinearError> for Failure {
    /// Why an attempt fails of it, where a smaller increment may help.
    fn from(error: &LinearError) -> Self {
        let kind = match error {
            LinearError::Singular(_) | LinearError::Inaccurate(_) => Kind::Singular,
            LinearError::NotFinite(_) => Kind::NotFinite,
            LinearError::Memory(_) | LinearError::Input(_) | LinearError::Other(_) => Kind::Other,
        };
        Failure::new(error.to_string()).of(kind)
    }
}

/// What is factorised when every iteration has a matrix of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Factors {
    /// As few as possible, each of which preconditions the iterative solution of the others; every matrix where that is
    /// predicted to be cheaper, as in the plane.
    #[default]
    Auto,
    /// Every matrix.
    Fresh,
    /// The matrix of an attempt's first iteration, whatever the prediction.
    Attempt,
    /// As few as possible, whatever the prediction: a factor serves later increments too.
    Kept,
}

impl Factors {
    pub(super) fn policy(self) -> Policy {
        let forced = Policy { share: f64::INFINITY, ..Policy::default() };
        match self {
            Self::Auto => Policy { reuse: Reuse::AcrossSequences, ..Policy::default() },
            Self::Fresh => Policy { reuse: Reuse::Never, ..Policy::default() },
            Self::Attempt => Policy { reuse: Reuse::WithinSequence, ..forced },
            Self::Kept => Policy { reuse: Reuse::AcrossSequences, ..forced },
        }
    }
}

/// What the unknowns of a linear system are: those of all that are free, ascending.
#[derive(Debug, Clone, Copy)]
pub struct Unknowns<'a> {
    /// The numbering of all.
    pub dofs: &'a Dofs,
    /// The free ones.
    pub free: &'a [usize],
}

impl Unknowns<'_> {
    /// The first unknown, free or not, of the node or tool that has this one.
    pub fn first_of_owner(&self, dof: usize) -> usize {
        match dof.checked_sub(self.dofs.tool(0)) {
            None => dof / self.dofs.per_node() * self.dofs.per_node(),
            Some(beyond) => self.dofs.tool(beyond / self.dofs.per_tool()),
        }
    }

    /// For each free unknown, its node or tool, numbered as they come.
    pub fn owners(&self) -> Vec<usize> {
        let (mut number, mut last) = (0, None);
        let number = |&dof: &usize| {
            let owner = self.first_of_owner(dof);
            number += usize::from(last.is_some_and(|last| last != owner));
            last = Some(owner);
            number
        };
        self.free.iter().map(number).collect()
    }
}

/// A direct solver in three phases, which may also solve by iterations with the factor of an earlier matrix; or any other that
/// passes `tests/support/contract.rs`. [`engine`](super::engine) says how another takes the place of [`Frontal`].
pub trait LinearSolver: Send {
    /// Prepares for a pattern over these unknowns.
    ///
    /// # Errors
    /// When the pattern cannot be handled.
    fn analyse(&mut self, pattern: &Csr, unknowns: Unknowns) -> Result<(), LinearError>;
    /// Takes note that the matrices to come have another pattern, of the same unknowns, and says whether the factor there is
    /// may serve for them all the same; [`analyse`](Self::analyse) comes before the next factorisation then.
    fn follow(&mut self, _pattern: &Csr) -> bool {
        false
    }
    /// Factorises the matrix with these values, in the order of the pattern.
    ///
    /// # Errors
    /// [`LinearError::Singular`] with the motion that meets no stiffness.
    fn factorise(&mut self, values: &[f64]) -> Result<(), LinearError>;
    /// What the signs of the pivots say of the matrix that was factorised last, where they are known.
    fn signs(&self) -> Option<Signs> {
        None
    }
    /// `x <- K^-1 x` with the factor there is, not refined; false where there is none.
    fn substitute(&self, _x: &mut [f64]) -> bool {
        false
    }
    /// Replaces the right-hand side by the solution with the matrix that was factorised last.
    ///
    /// # Errors
    /// When nothing is factorised or the solution cannot be trusted.
    fn solve(&mut self, rhs: &mut [f64]) -> Result<(), LinearError>;
    /// Solves for many loads, each given by unknowns and values that are added, with the factor there is and to the
    /// accuracy of that factor, and writes the solutions at the unknowns `at`, which ascend, load after load.
    ///
    /// # Errors
    /// When nothing is factorised.
    fn influence(&self, loads: &[Vec<(usize, f64)>], at: &[usize], x: &mut [f64]) -> Result<(), LinearError>;
    /// Columns and values of a row of the matrix that was factorised last.
    fn row(&self, _row: usize) -> Vec<(usize, f64)> {
        Vec::new()
    }
    /// Begins a sequence of related matrices, such as those of an attempt: nothing of what was solved before is to show in
    /// its solutions but the factor there is, if that serves on, and its [`service`](Self::service).
    fn begin(&mut self) {}
    /// What the factor there is has served for, if it may serve for the next sequence too.
    fn service(&self) -> Option<Service> {
        None
    }
    /// Has the factor there is be one that has served for so much.
    fn resume(&mut self, _service: Service) {}
    /// Whether [`iterate`](Self::iterate) will try with the factor there is.
    fn iterates(&self) -> bool {
        false
    }
    /// Says by what the matrices to come differ from the one that was factorised, besides small changes.
    fn change(&mut self, _change: Option<Change>) {}
    /// Lets the factor there is not serve for the next matrix.
    fn refuse(&mut self) {}
    /// Replaces the right-hand side by the solution with the matrix of these values, to a residual of `tolerance` times
    /// the right-hand side, without factorising it; `false`, with the right-hand side as it was, where that does not
    /// pay.
    ///
    /// # Errors
    /// When values or right-hand side are not finite.
    fn iterate(&mut self, _values: &[f64], _rhs: &mut [f64], _tolerance: f64) -> Result<bool, LinearError> {
        Ok(false)
    }
    /// The same for another right-hand side with the matrix of the last call, of which more is known then.
    ///
    /// # Errors
    /// As those of [`iterate`](Self::iterate).
    fn iterate_again(&mut self, values: &[f64], rhs: &mut [f64], tolerance: f64) -> Result<bool, LinearError> {
        self.iterate(values, rhs, tolerance)
    }
}

/// The multifrontal solver of the crate `frontal`.
#[derive(Debug, Default)]
pub struct Frontal {
    factors: Factors,
    /// Bytes that the process may take, if the user says so.
    memory: Option<u64>,
    /// Bytes of the factor there is, which the next one may have.
    held: u64,
    solver: Option<Solver>,
}

impl Frontal {
    /// A solver that factorises when it is told to.
    pub fn new(factors: Factors) -> Self {
        Self { factors, ..Self::default() }
    }
    /// The same within so many bytes of memory of the process, if given; in what the machine has else.
    pub fn within(self, memory: Option<u64>) -> Self {
        Self { memory, ..self }
    }
    /// Whether a factor of that size fits into memory.
    fn check_memory(&mut self, symbolic: &Symbolic) -> Result<(), LinearError> {
        let cost = symbolic.prediction();
        let needed = cost.bytes as u64 + single(&self.factors.policy(), &cost);
        let room = if needed > SMALL { room(self.memory) } else { None };
        match room.filter(|room| needed > room.left() + self.held) {
            Some(room) => Err(LinearError::Memory(too_much(room.taken + needed - self.held, &room))),
            None => {
                self.held = self.held.max(needed);
                Ok(())
            }
        }
    }
    /// Makes room for a factor of values that are symmetric, or are not.
    fn expect(&mut self, symmetric: bool) -> Result<(), LinearError> {
        let solver = self.solver()?;
        if solver.symbolic().prediction().symmetric == symmetric {
            return Ok(());
        }
        let symbolic = solver.analysis(symmetric).map_err(translate)?;
        self.check_memory(&symbolic)?;
        self.solver()?.expect(symbolic);
        Ok(())
    }
    /// What was done so far.
    pub fn counts(&self) -> frontal::Counts {
        self.solver.as_ref().map_or_else(Default::default, Solver::counts)
    }
    fn solver(&mut self) -> Result<&mut Solver, LinearError> {
        self.solver.as_mut().ok_or_else(|| LinearError::Other("nothing is analysed".into()))
    }
}

fn translate(error: frontal::Error) -> LinearError {
    match error {
        frontal::Error::Singular(singular) => {
            LinearError::Singular(singular.null_vectors.into_iter().map(|v| v.entries).collect())
        }
        frontal::Error::Inaccurate { backward_error, .. } => {
            LinearError::Inaccurate(format!("the matrix is nearly singular: a backward error of {backward_error:.1e}"))
        }
        frontal::Error::NotFinite { .. } => LinearError::NotFinite("the stiffness is not finite".into()),
        other => LinearError::Other(other.to_string()),
    }
}

/// Difference of mirrored values over the geometric mean of their diagonal entries up to which they are the same: thousands
/// of roundings, and far less than any friction.
const SYMMETRIC: f64 = 1e-12;
/// Bytes of a factor of which no question is asked.
const SMALL: u64 = 1 << 26;

/// Entries from which on a row of a matrix of so many is dense, and its unknown better eliminated last: the rule of minimum
/// degree orderings (Amestoy, Davis & Duff, ACM TOMS 30, 2004).
pub(super) fn dense(rows: usize) -> f64 {
    16.0_f64.max(10.0 * (rows as f64).sqrt())
}

/// Unknowns that couple to very many others, such as those of a tool's reference node.
fn dense_rows(pattern: &Csr) -> Vec<usize> {
    let many = dense(pattern.rows());
    let length = |row: &usize| pattern.starts[row + 1] - pattern.starts[*row];
    (0..pattern.rows()).filter(|row| length(row) as f64 > many).collect()
}

impl LinearSolver for Frontal {
    fn analyse(&mut self, pattern: &Csr, unknowns: Unknowns) -> Result<(), LinearError> {
        let mut options = Options::default();
        options.last = dense_rows(pattern);
        // What the values are shows when they come; nothing is touched before.
        options.symmetric = self.solver.as_ref().is_none_or(|solver| solver.symbolic().prediction().symmetric);
        let pattern = Pattern::sharing(pattern.starts.clone(), pattern.columns.clone());
        let pattern = pattern.and_then(|pattern| pattern.with_nodes(unknowns.owners())).map_err(translate)?;
        if let Some(solver) = self.solver.as_mut().filter(|solver| *solver.symbolic().pattern() == pattern) {
            solver.refuse();
            return solver.follow(pattern).map_err(translate);
        }
        let symbolic = Symbolic::analyse(&pattern, &options).map_err(translate)?;
        self.check_memory(&symbolic)?;
        match &mut self.solver {
            Some(solver) => solver.replace(symbolic),
            None => self.solver = Some(Solver::new(symbolic, self.factors.policy())),
        }
        Ok(())
    }

    fn follow(&mut self, pattern: &Csr) -> bool {
        let Some(solver) = self.solver.as_mut().filter(|solver| solver.affordable_iterations() > 0) else {
            return false;
        };
        // Each increment has its own, made by the same rules as the first.
        solver.follow(Pattern::trusted(pattern.starts.clone(), pattern.columns.clone())).is_ok()
    }

    /// As L D L^T where the values are symmetric, which they alone decide, so that what came before does not show.
    fn factorise(&mut self, values: &[f64]) -> Result<(), LinearError> {
        let symmetric = self.solver()?.symbolic().pattern().is_symmetric(values, SYMMETRIC);
        if !symmetric && values.iter().any(|value| !value.is_finite()) {
            self.solver()?.refuse();
            return Err(translate(frontal::Error::NotFinite { row: 0, column: 0 }));
        }
        self.expect(symmetric)?;
        let factorised = match self.solver()?.factorise(values) {
            Err(frontal::Error::Unstable) => {
                self.expect(false)?;
                self.solver()?.factorise(values)
            }
            factorised => factorised,
        };
        factorised.map(drop).map_err(translate)
    }

    fn signs(&self) -> Option<Signs> {
        self.solver.as_ref().and_then(|solver| solver.factor().signs())
    }

    fn substitute(&self, x: &mut [f64]) -> bool {
        self.solver.as_ref().is_some_and(|solver| solver.factor().apply_inverse(x).is_ok())
    }

    fn solve(&mut self, rhs: &mut [f64]) -> Result<(), LinearError> {
        self.solver()?.solve_directly(rhs).map(drop).map_err(translate)
    }

    fn influence(&self, loads: &[Vec<(usize, f64)>], at: &[usize], x: &mut [f64]) -> Result<(), LinearError> {
        let solver = self.solver.as_ref().ok_or_else(|| LinearError::Other("nothing is analysed".into()))?;
        solver.influence(loads, at, x).map_err(translate)
    }

    fn row(&self, row: usize) -> Vec<(usize, f64)> {
        self.solver.as_ref().map_or_else(Vec::new, |solver| solver.factor().row(row).collect())
    }

    fn begin(&mut self) {
        self.solver.iter_mut().for_each(Solver::begin);
    }

    fn refuse(&mut self) {
        self.solver.iter_mut().for_each(Solver::refuse);
    }

    fn service(&self) -> Option<Service> {
        self.solver.as_ref().and_then(Solver::service)
    }

    fn resume(&mut self, service: Service) {
        self.solver.iter_mut().for_each(|solver| solver.resume(service));
    }

    fn iterates(&self) -> bool {
        self.solver.as_ref().is_some_and(|solver| solver.affordable_iterations() > 0)
    }

    fn change(&mut self, change: Option<Change>) {
        if let Some(solver) = &mut self.solver {
            solver.change(change);
        }
    }

    fn iterate(&mut self, values: &[f64], rhs: &mut [f64], tolerance: f64) -> Result<bool, LinearError> {
        self.solver()?.iterate(values, rhs, tolerance).map(|found| found.is_some()).map_err(translate)
    }

    fn iterate_again(&mut self, values: &[f64], rhs: &mut [f64], tolerance: f64) -> Result<bool, LinearError> {
        self.solver()?.iterate_again(values, rhs, tolerance).map(|found| found.is_some()).map_err(translate)
    }
}
