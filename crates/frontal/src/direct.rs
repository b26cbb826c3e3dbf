//! Factors of one pattern after another behind one face: an analysis, the memory of one factor, and the same factor in single precision
//! where it preconditions.

use crate::change::LowRankChange;
use crate::error::FrontalError;
use crate::factor::{Factor, Report};
use crate::refine::Accuracy;
use crate::rounded::Rounded;
use crate::symbolic::Symbolic;

/// The multifrontal factor of the matrix that was factorised last.
#[derive(Debug)]
pub struct Direct {
    symbolic: Symbolic,
    factor: Factor,
    /// The factor in single precision, which is enough to precondition.
    rounded: Rounded,
}

impl Direct {
    /// Takes an analysis and makes room for one factor.
    pub fn new(symbolic: Symbolic) -> Self {
        Direct { factor: symbolic.new_factor(), symbolic, rounded: Rounded::default() }
    }

    /// The analysis.
    pub fn symbolic(&self) -> &Symbolic {
        &self.symbolic
    }

    /// The factor of the last matrix that was factorised.
    pub fn factor(&self) -> &Factor {
        &self.factor
    }

    /// Takes another analysis, and for its factor the memory of the one there was. No factor is there then.
    pub fn replace(&mut self, symbolic: Symbolic) {
        self.rounded.forget();
        self.factor = symbolic.new_factor_in(self.factor.take_memory());
        self.symbolic = symbolic;
    }

    /// Factorises.
    ///
    /// # Errors
    /// Those of [`Symbolic::factorise`].
    pub fn factorise(&mut self, values: &[f64]) -> Result<Report, FrontalError> {
        self.rounded.forget();
        self.symbolic.factorise(values, &mut self.factor)
    }

    /// Solves with the matrix that was factorised last, refined.
    ///
    /// # Errors
    /// Those of [`Factor::solve`].
    pub fn solve(&self, rhs: &mut [f64]) -> Result<Accuracy, FrontalError> {
        self.factor.solve(rhs)
    }

    /// Has the factor there is precondition from now on: in single precision where that spoils little, which the factor alone
    /// decides.
    pub fn round(&mut self) {
        if !self.rounded.settled() {
            // What the copy may need.
            self.factor.release();
            self.rounded.settle(&self.factor);
        }
    }

    /// `x <- (A + change)^-1 x` by substitution with the factor there is, not refined.
    ///
    /// # Errors
    /// Those of [`Factor::apply_inverse`].
    pub fn precondition(&self, change: Option<&LowRankChange>, x: &mut [f64]) -> Result<(), FrontalError> {
        match self.rounded.known(&self.factor) {
            Some(single) => single.apply_inverse(change, x),
            None => self.factor.halves().apply_inverse(change, x),
        }
    }

    /// [`Factor::influence`] with the factor there is, in single precision where that preconditions.
    ///
    /// # Errors
    /// Those of [`Factor::influence`].
    pub fn influence(&self, loads: &[Vec<(usize, f64)>], at: &[usize], x: &mut [f64]) -> Result<(), FrontalError> {
        match self.rounded.known(&self.factor) {
            Some(single) => single.influence(loads, at, x),
            None => self.factor.influence(loads, at, x),
        }
    }
}
