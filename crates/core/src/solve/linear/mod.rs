//! The linear systems of the iterations: what an engine must do, and all that is made of it.
//!
//! [`LinearSolver`] is what an engine does: it factorises a matrix and solves with the factor. [`Frontal`] is the library's own;
//! [`engine`] says how another takes its place. What saves factorisations is the same whatever the engine and stands above it, in
//! [`system`]: a factor that preconditions the matrices to come (inexact Newton-Krylov with recycled directions), put right by a
//! change of low rank near contact, and the compliance of contact that is found by it.

mod compliance;
mod demand;
pub mod engine;
mod frontal;
mod low_rank;
mod system;

pub use demand::{Demand, OfRanks};
pub use frontal::{Factors, Frontal, dense};
pub use system::SolverCounts;
pub(super) use system::{JumpSites, LinearSystem, Unsolved};

use crate::system::{Csr, Dofs};
use crate::{Failure, FailureKind};
use ::frontal::{LowRankChange, PivotSigns, Work};
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
            LinearError::Singular(_) | LinearError::Inaccurate(_) => FailureKind::Singular,
            LinearError::NotFinite(_) => FailureKind::NotFinite,
            LinearError::Memory(_) | LinearError::Input(_) | LinearError::Other(_) => FailureKind::Other,
        };
        Failure::new(error.to_string()).of(kind)
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
    /// For each free unknown, its node or tool, numbered as they come.
    pub fn owners(&self) -> Vec<usize> {
        let (mut number, mut last) = (0, None);
        let number = |&dof: &usize| {
            let owner = self.dofs.first_of_owner(dof);
            number += usize::from(last.is_some_and(|last| last != owner));
            last = Some(owner);
            number
        };
        self.free.iter().map(number).collect()
    }
}

/// What is known of a factor when it is made.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Factored {
    /// What the signs of the pivots say of the matrix, where they are known.
    pub signs: Option<PivotSigns>,
    /// What the factor took and a solution with it takes, as predicted and not by a clock; a factor of which that is not known
    /// preconditions no other matrix.
    pub work: Option<Work>,
}

/// An engine: what solves the linear systems of a run. The first three methods are asked of it; the others have what they do by
/// these, and an engine that can do better says so. Whatever it is, `tests/support/contract.rs` holds it to what is written here.
pub trait LinearSolver: Send {
    /// Prepares for the pattern of the matrices to come, over these unknowns. There is no factor then.
    ///
    /// # Errors
    /// When the pattern cannot be handled.
    fn set_pattern(&mut self, pattern: &Csr, unknowns: Unknowns) -> Result<(), LinearError>;
    /// Factorises the matrix with these values, in the order of the pattern.
    ///
    /// # Errors
    /// [`LinearError::Singular`] with the motion that meets no stiffness.
    fn factorise(&mut self, values: &[f64]) -> Result<Factored, LinearError>;
    /// Replaces the right-hand side by the solution with the matrix that was factorised last.
    ///
    /// # Errors
    /// When nothing is factorised or the solution cannot be trusted.
    fn solve(&mut self, rhs: &mut [f64]) -> Result<(), LinearError>;
    /// `x <- K^-1 x` by the factor there is, not refined. Else: solves.
    ///
    /// # Errors
    /// When nothing is factorised.
    fn substitute(&mut self, x: &mut [f64]) -> Result<(), LinearError> {
        self.solve(x)
    }
    /// `x <- (K + change)^-1 x` to the few digits that a preconditioner needs. Else: substitutes, once more for the change.
    ///
    /// # Errors
    /// When nothing is factorised.
    fn precondition(&mut self, change: Option<&LowRankChange>, x: &mut [f64]) -> Result<(), LinearError> {
        self.substitute(x)?;
        let Some(change) = change else { return Ok(()) };
        let mut pushed = vec![0.0; x.len()];
        change.push(&change.weights(|unknown| x[unknown]), &mut pushed);
        self.substitute(&mut pushed)?;
        x.iter_mut().zip(&pushed).for_each(|(x, pushed)| *x -= pushed);
        Ok(())
    }
    /// The compliance of some unknowns: solves for many loads, each given by unknowns and values that are added, to the digits of a
    /// preconditioner, and writes the solutions at the unknowns `at`, which ascend, load after load. Else: false, and one load after
    /// the other is preconditioned.
    ///
    /// # Errors
    /// When nothing is factorised.
    fn compliance(&mut self, _: &[Vec<(usize, f64)>], _at: &[usize], _x: &mut [f64]) -> Result<bool, LinearError> {
        Ok(false)
    }
}
