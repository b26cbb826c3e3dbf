//! What the linear solver of an increment begins with: a matrix that was factorised in an earlier one. It belongs to the
//! accepted state, since it shows in the last digits of what comes.

use super::{Csr, Dofs};
use frontal::Service;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A matrix whose factor preconditions those of the increments to come.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Preconditioner {
    /// The matrix.
    pub matrix: Arc<Factorised>,
    /// What its factor has served for.
    pub service: Service,
    /// What is known of its inverse.
    pub near: Near,
}

/// A matrix that was factorised.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Factorised {
    /// Its unknowns, those that were free.
    pub free: Vec<usize>,
    /// Its pattern, as in a [`Csr`].
    pub starts: Arc<Vec<usize>>,
    /// Columns of all rows.
    pub columns: Arc<Vec<usize>>,
    /// Its values, in the order of the pattern.
    pub values: Vec<f64>,
}

/// Unknowns near contact, each list ascending.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Near {
    /// Free unknowns whose motions the columns of the inverse hold, by their numbers among the free ones.
    pub at: Vec<usize>,
    /// Those of stencils that were closed in the matrix.
    pub closed: Vec<usize>,
    /// Those whose columns were found.
    pub columns: Vec<usize>,
    /// Loads that were solved for instead.
    pub loads: usize,
}

impl Factorised {
    /// Its pattern.
    pub fn pattern(&self) -> Csr {
        Csr::new(self.starts.clone(), self.columns.clone())
    }
}

impl Preconditioner {
    /// Whether all of it can be one of a model with these unknowns.
    pub fn fits(&self, dofs: &Dofs) -> bool {
        let (Factorised { free, starts, columns, values }, near) = (&*self.matrix, &self.near);
        let ascend = |list: &[usize], end: usize| {
            list.windows(2).all(|pair| pair[0] < pair[1]) && list.last().is_none_or(|last| *last < end)
        };
        let entries = columns.len();
        let rows =
            starts.len() == free.len() + 1 && starts[0] == 0 && starts[free.len()] == entries && starts.is_sorted();
        let row = |range: &[usize]| ascend(&columns[range[0]..range[1]], free.len());
        rows && starts.windows(2).all(row)
            && entries == values.len()
            && ascend(free, dofs.count())
            && ascend(&near.at, free.len())
            && ascend(&near.closed, free.len())
            && ascend(&near.columns, free.len())
    }
}
