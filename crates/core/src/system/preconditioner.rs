//! What the linear solver of an increment begins with: a matrix that was factorised in an earlier one. It belongs to the
//! accepted state, since it shows in the last digits of what comes.

use super::{Csr, Dofs, PackedPattern};
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
    /// Its pattern.
    pub pattern: PackedPattern,
    /// Its values, in the order of the pattern.
    pub values: Arc<Vec<f64>>,
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
    /// Its pattern; none where it is none of so many unknowns and values.
    pub fn pattern(&self) -> Option<Csr> {
        self.pattern.unpacked(self.free.len(), self.values.len())
    }
}

impl Preconditioner {
    /// Whether all of it can be one of a model with these unknowns.
    pub fn fits(&self, dofs: &Dofs) -> bool {
        let (free, near) = (&self.matrix.free, &self.near);
        let ascend = |list: &[usize], end: usize| {
            list.windows(2).all(|pair| pair[0] < pair[1]) && list.last().is_none_or(|last| *last < end)
        };
        self.matrix.pattern().is_some()
            && ascend(free, dofs.count())
            && ascend(&near.at, free.len())
            && ascend(&near.closed, free.len())
            && ascend(&near.columns, free.len())
    }
}
