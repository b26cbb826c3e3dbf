//! The multifrontal solver of the crate `frontal` as the engine of a run.

use super::super::constants::frontal::{SMALL, SYMMETRIC};
use super::demand::{single, too_much};
use super::{Factored, LinearError, LinearSolver, Unknowns};
use crate::machine::room;
use crate::system::Csr;
use frontal::{Direct, LowRankChange, Options, Pattern, Policy, Reuse, Symbolic, Work};

/// What is factorised when every iteration has a matrix of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Factors {
    /// As few as possible, each of which preconditions the iterative solution of the others; every matrix where that is
    /// predicted to be cheaper, as in the plane.
    #[default]
    Auto,
    /// Every matrix.
    Fresh,
    /// As few as possible, whatever the prediction: a factor serves later increments too.
    Kept,
}

impl Factors {
    pub(in crate::solve) fn policy(self) -> Policy {
        let reuse = if self == Self::Fresh { Reuse::Never } else { Reuse::AcrossSequences };
        let share = if self == Self::Kept { f64::INFINITY } else { Policy::default().share };
        Policy { reuse, share, ..Policy::default() }
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
    direct: Option<Direct>,
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
        let direct = self.direct()?;
        if direct.symbolic().prediction().symmetric == symmetric {
            return Ok(());
        }
        let symbolic = direct.symbolic().for_values(symmetric).map_err(translate)?;
        self.check_memory(&symbolic)?;
        self.direct()?.replace(symbolic);
        Ok(())
    }
    fn direct(&mut self) -> Result<&mut Direct, LinearError> {
        self.direct.as_mut().ok_or_else(|| LinearError::Other("nothing is analysed".into()))
    }
    /// The factor as it preconditions.
    fn preconditioner(&mut self) -> Result<&mut Direct, LinearError> {
        let policy = self.factors.policy();
        let direct = self.direct()?;
        if policy.affordable_iterations(Work::from(&direct.symbolic().prediction())) > 0 {
            direct.round();
        }
        Ok(direct)
    }
}

fn translate(error: frontal::FrontalError) -> LinearError {
    match error {
        frontal::FrontalError::Singular(singular) => {
            LinearError::Singular(singular.null_vectors.into_iter().map(|v| v.entries).collect())
        }
        frontal::FrontalError::Inaccurate { backward_error, .. } => {
            LinearError::Inaccurate(format!("the matrix is nearly singular: a backward error of {backward_error:.1e}"))
        }
        frontal::FrontalError::NotFinite { .. } => LinearError::NotFinite("the stiffness is not finite".into()),
        other => LinearError::Other(other.to_string()),
    }
}

/// Entries from which on a row of a matrix of so many is dense, and its unknown better eliminated last: the rule of minimum
/// degree orderings (Amestoy, Davis & Duff, ACM TOMS 30, 2004).
pub fn dense(rows: usize) -> f64 {
    16.0_f64.max(10.0 * (rows as f64).sqrt())
}

/// Unknowns that couple to very many others, such as those of a tool's reference node.
fn dense_rows(pattern: &Csr) -> Vec<usize> {
    let many = dense(pattern.rows());
    let length = |row: &usize| pattern.starts[row + 1] - pattern.starts[*row];
    (0..pattern.rows()).filter(|row| length(row) as f64 > many).collect()
}

impl LinearSolver for Frontal {
    fn set_pattern(&mut self, pattern: &Csr, unknowns: Unknowns) -> Result<(), LinearError> {
        let mut options = Options::default();
        options.last = dense_rows(pattern);
        // What the values are shows when they come; nothing is touched before.
        options.symmetric = self.direct.as_ref().is_none_or(|direct| direct.symbolic().prediction().symmetric);
        let pattern = Pattern::sharing(pattern.starts.clone(), pattern.columns.clone());
        let pattern = pattern.and_then(|pattern| pattern.with_nodes(unknowns.owners())).map_err(translate)?;
        if self.direct.as_ref().is_some_and(|direct| *direct.symbolic().pattern() == pattern) {
            return Ok(());
        }
        let symbolic = Symbolic::analyse(&pattern, &options).map_err(translate)?;
        self.check_memory(&symbolic)?;
        match &mut self.direct {
            Some(direct) => direct.replace(symbolic),
            None => self.direct = Some(Direct::new(symbolic)),
        }
        Ok(())
    }

    /// As L D L^T where the values are symmetric, which they alone decide, so that what came before does not show.
    fn factorise(&mut self, values: &[f64]) -> Result<Factored, LinearError> {
        let symmetric = self.direct()?.symbolic().pattern().is_symmetric(values, SYMMETRIC);
        if !symmetric && values.iter().any(|value| !value.is_finite()) {
            return Err(translate(frontal::FrontalError::NotFinite { row: 0, column: 0 }));
        }
        self.expect(symmetric)?;
        match self.direct()?.factorise(values) {
            Err(frontal::FrontalError::Unstable) => {
                self.expect(false)?;
                self.direct()?.factorise(values)
            }
            factorised => factorised,
        }
        .map_err(translate)?;
        let direct = self.direct()?;
        let work = Some(Work::from(&direct.symbolic().prediction()));
        Ok(Factored { signs: direct.factor().signs(), work })
    }

    fn solve(&mut self, rhs: &mut [f64]) -> Result<(), LinearError> {
        self.direct()?.solve(rhs).map(drop).map_err(translate)
    }

    fn substitute(&mut self, x: &mut [f64]) -> Result<(), LinearError> {
        self.direct()?.factor().apply_inverse(x).map_err(translate)
    }

    /// In single precision where that spoils little.
    fn precondition(&mut self, change: Option<&LowRankChange>, x: &mut [f64]) -> Result<(), LinearError> {
        self.preconditioner()?.precondition(change, x).map_err(translate)
    }

    fn compliance(&mut self, loads: &[Vec<(usize, f64)>], at: &[usize], x: &mut [f64]) -> Result<bool, LinearError> {
        self.preconditioner()?.influence(loads, at, x).map(|()| true).map_err(translate)
    }
}
