//! What can go wrong, in the caller's numbering.

use crate::diagnose::Singular;
use std::fmt;

/// Why a matrix was refused or could not be solved. Rows, columns and unknowns count from zero in the caller's numbering.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum FrontalError {
    /// A slice does not have the length that the pattern asks for.
    WrongLength {
        /// Name of the slice.
        what: &'static str,
        /// Length that the pattern asks for.
        expected: usize,
        /// Length that was given.
        found: usize,
    },
    /// The row starts of a pattern must begin at zero, never decrease and end at the number of columns stored.
    InvalidStarts {
        /// First row whose start is wrong.
        row: usize,
    },
    /// A column lies outside the matrix, or is not greater than the one before it in its row.
    InvalidColumn {
        /// Row of the entry.
        row: usize,
        /// Column of the entry.
        column: usize,
    },
    /// An entry is in the pattern and its mirror image is not.
    NotSymmetric {
        /// Row of the entry.
        row: usize,
        /// Column of the entry.
        column: usize,
    },
    /// The given elimination order, or the list of unknowns to eliminate last, repeats an unknown or names one that
    /// does not exist.
    InvalidOrder {
        /// The offending unknown.
        unknown: usize,
    },
    /// The matrix has more entries than 32-bit indices can count, or a front would have.
    TooLarge,
    /// The library that orders did not return an ordering.
    OrderingFailed,
    /// The ordering asked for was not built in: see the features of this crate.
    OrderingNotBuilt,
    /// The factorisation needs more memory than [`Options::memory_limit`](crate::Options::memory_limit) allows.
    MemoryLimit {
        /// Bytes that the factorisation needs.
        needed: usize,
        /// Bytes allowed.
        limit: usize,
    },
    /// A value is infinite or not a number.
    NotFinite {
        /// Row of the value; for a right-hand side, its index.
        row: usize,
        /// Column of the value; for a right-hand side, the number of the vector.
        column: usize,
    },
    /// The factor was made by another [`Symbolic`](crate::Symbolic).
    ForeignFactor,
    /// The factor holds no values: nothing was factorised, or the last factorisation failed.
    NotFactorised,
    /// The matrix is singular to working precision.
    Singular(Box<Singular>),
    /// Pivots from the diagonal in their order, as symmetric values get them, lose too much accuracy; the same values factorised
    /// as unsymmetric ones get pivots that are chosen.
    Unstable,
    /// The solution does not satisfy the equations, whatever refinement could do.
    Inaccurate {
        /// Componentwise backward error reached.
        backward_error: f64,
        /// Unknowns whose pivots were perturbed.
        unknowns: Vec<usize>,
    },
}

impl fmt::Display for FrontalError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FrontalError::WrongLength { what, expected, found } => {
                write!(f, "{what} has length {found}, the pattern asks for {expected}")
            }
            FrontalError::InvalidStarts { row } => write!(f, "the start of row {row} is out of order"),
            FrontalError::InvalidColumn { row, column } => {
                write!(f, "column {column} of row {row} is out of range or out of order")
            }
            FrontalError::NotSymmetric { row, column } => {
                write!(f, "entry ({row}, {column}) is in the pattern but ({column}, {row}) is not")
            }
            FrontalError::InvalidOrder { unknown } => {
                write!(f, "unknown {unknown} is repeated, missing or out of range in the given order")
            }
            FrontalError::TooLarge => write!(f, "the matrix or one of its fronts has more than 2^32 entries"),
            FrontalError::OrderingFailed => write!(f, "the ordering library returned no ordering"),
            FrontalError::OrderingNotBuilt => write!(f, "this ordering needs a feature that was not built in"),
            FrontalError::MemoryLimit { needed, limit } => {
                write!(f, "the factorisation needs {needed} bytes and may use {limit}")
            }
            FrontalError::NotFinite { row, column } => write!(f, "the value at ({row}, {column}) is not finite"),
            FrontalError::ForeignFactor => write!(f, "the factor belongs to another analysis"),
            FrontalError::NotFactorised => write!(f, "the factor holds no values"),
            FrontalError::Unstable => write!(f, "pivots from the diagonal lose too much accuracy"),
            FrontalError::Singular(singular) => singular.fmt(f),
            FrontalError::Inaccurate { backward_error, unknowns } => {
                write!(f, "backward error {backward_error:.1e} after refinement; perturbed pivots: {unknowns:?}")
            }
        }
    }
}

impl std::error::Error for FrontalError {}
