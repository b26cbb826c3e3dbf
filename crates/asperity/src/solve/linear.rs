//! Solving the linear system of an iteration: the trait, and the multifrontal solver behind it.

use crate::system::Csr;
use frontal::{Factor, Options, Pattern, Symbolic};
use std::fmt;

/// Why a linear system was not solved.
#[derive(Debug, Clone, PartialEq)]
pub enum LinearError {
    /// The matrix has no inverse; motions that meet no stiffness, each over the unknowns of the system.
    Singular(Vec<Vec<f64>>),
    /// Anything else, in words.
    Other(String),
}

impl fmt::Display for LinearError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Singular(_) => f.write_str("the matrix is singular"),
            Self::Other(text) => f.write_str(text),
        }
    }
}

/// A direct solver in three phases.
pub trait LinearSolver: Send {
    /// Prepares for a pattern; `nodes[i]` is the node that unknown `i` belongs to.
    ///
    /// # Errors
    /// When the pattern cannot be handled.
    fn analyse(&mut self, pattern: &Csr, nodes: Vec<usize>) -> Result<(), LinearError>;
    /// Factorises the matrix with these values, in the order of the pattern.
    ///
    /// # Errors
    /// [`LinearError::Singular`] with the motion that meets no stiffness.
    fn factorise(&mut self, values: &[f64]) -> Result<(), LinearError>;
    /// Replaces the right-hand side by the solution.
    ///
    /// # Errors
    /// When nothing is factorised or the solution cannot be trusted.
    fn solve(&mut self, rhs: &mut [f64]) -> Result<(), LinearError>;
}

/// The multifrontal solver of the crate `frontal`.
#[derive(Debug, Default)]
pub struct Frontal {
    symbolic: Option<Symbolic>,
    factor: Option<Factor>,
}

fn translate(error: frontal::Error) -> LinearError {
    match error {
        frontal::Error::Singular(singular) => {
            LinearError::Singular(singular.null_vectors.into_iter().map(|v| v.entries).collect())
        }
        other => LinearError::Other(other.to_string()),
    }
}

impl LinearSolver for Frontal {
    fn analyse(&mut self, pattern: &Csr, nodes: Vec<usize>) -> Result<(), LinearError> {
        let pattern = Pattern::new(pattern.starts.clone(), pattern.columns.clone())
            .and_then(|p| p.with_nodes(nodes))
            .map_err(translate)?;
        let symbolic = Symbolic::analyse(&pattern, &Options::default()).map_err(translate)?;
        self.factor = Some(symbolic.new_factor());
        self.symbolic = Some(symbolic);
        Ok(())
    }

    fn factorise(&mut self, values: &[f64]) -> Result<(), LinearError> {
        let (Some(symbolic), Some(factor)) = (&self.symbolic, &mut self.factor) else {
            return Err(LinearError::Other("nothing is analysed".into()));
        };
        symbolic.factorise(values, factor).map(drop).map_err(translate)
    }

    fn solve(&mut self, rhs: &mut [f64]) -> Result<(), LinearError> {
        let Some(factor) = &mut self.factor else {
            return Err(LinearError::Other("nothing is factorised".into()));
        };
        factor.solve(rhs).map(drop).map_err(translate)
    }
}
