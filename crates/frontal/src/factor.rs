//! A factorised matrix.

use crate::dense::{Pivot, PivotRule};
use crate::diagnose;
use crate::error::Error;
use crate::numeric::Numeric;
use crate::pattern::check_length;
use crate::plan::Plan;
use crate::scaling::Scaling;
use crate::symbolic::{Inner, Symbolic};
use std::mem::take;
use std::sync::{Arc, Mutex, PoisonError};

/// Perturbed pivots get this share of the largest value: the square root of the unit round-off balances the error
/// made against the growth allowed (Li & Demmel, ACM TOMS 29, 2003).
const PERTURBATION: f64 = 1.5e-8;

/// L and U, with a copy of the equilibrated matrix for refinement and the working memory of the next factorisation.
#[derive(Debug)]
pub struct Factor {
    pub(crate) symbolic: Arc<Inner>,
    pub(crate) factors: Vec<f64>,
    pub(crate) pivots: Vec<Pivot>,
    pub(crate) scaling: Scaling,
    /// Values of the equilibrated matrix, in the pattern's order.
    pub(crate) values: Vec<f64>,
    plan: Plan,
    shared: Vec<f64>,
    stacks: Mutex<Vec<Vec<f64>>>,
    perturbed: Vec<usize>,
    pub(crate) ready: bool,
}

/// The large arrays of a factor.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    factors: Vec<f64>,
    values: Vec<f64>,
    shared: Vec<f64>,
    stacks: Vec<Vec<f64>>,
}

/// What a factorisation met.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct Report {
    /// Unknowns whose pivots were too small and were perturbed; solutions are refined to make up for it.
    pub perturbed: Vec<usize>,
}

impl Symbolic {
    /// Factorises the matrix with these values, in the order of [`Pattern::columns`](crate::Pattern::columns).
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::NotFinite`]; [`Error::ForeignFactor`] unless the factor came from this
    /// analysis; [`Error::Singular`] with the unknowns responsible. After an error the factor holds no values.
    pub fn factorise(&self, values: &[f64], factor: &mut Factor) -> Result<Report, Error> {
        if !Arc::ptr_eq(&self.inner, &factor.symbolic) {
            return Err(Error::ForeignFactor);
        }
        factor.ready = false;
        check_length("values", self.inner.pattern.nonzeros(), values.len())?;
        factor.load(values)?;
        factor.collect_perturbed();
        factor.ready = true;
        if !factor.perturbed.is_empty() {
            diagnose::check_regular(factor).inspect_err(|_| factor.ready = false)?;
        }
        Ok(Report { perturbed: factor.perturbed.clone() })
    }
}

impl Factor {
    /// Room for a factorisation, in the memory of an earlier one.
    pub(crate) fn new(symbolic: Arc<Inner>, threads: usize, memory: Memory) -> Self {
        let n = symbolic.pattern.len();
        let plan = symbolic.plan(threads);
        let Memory { mut factors, mut values, mut shared, mut stacks } = memory;
        factors.resize(symbolic.tree.factor_len(), 0.0);
        values.resize(symbolic.pattern.nonzeros(), 0.0);
        shared.resize(plan.shared_len(), 0.0);
        stacks.resize_with(plan.stacks(), Vec::new);
        stacks.iter_mut().for_each(|stack| stack.resize(plan.stack_len + plan.scratch_len, 0.0));
        Factor {
            factors,
            pivots: vec![Pivot::default(); n],
            scaling: Scaling::identity(n),
            values,
            shared,
            stacks: Mutex::new(stacks),
            plan,
            perturbed: Vec::new(),
            ready: false,
            symbolic,
        }
    }

    /// Gives the memory away; the factor holds no values then.
    pub(crate) fn take_memory(&mut self) -> Memory {
        self.ready = false;
        let stacks = self.stacks.get_mut().unwrap_or_else(PoisonError::into_inner);
        Memory {
            factors: take(&mut self.factors),
            values: take(&mut self.values),
            shared: take(&mut self.shared),
            stacks: take(stacks),
        }
    }

    /// Unknowns whose pivots were perturbed by the last factorisation.
    pub fn perturbed(&self) -> &[usize] {
        &self.perturbed
    }

    /// Columns and values of a row of the matrix that was factorised.
    ///
    /// # Panics
    /// If there is no such row.
    pub fn row(&self, row: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let pattern = &self.symbolic.pattern;
        let range = pattern.starts()[row]..pattern.starts()[row + 1];
        let entries = pattern.columns()[range.clone()].iter().zip(&self.values[range]);
        let Scaling { rows, columns, .. } = &self.scaling;
        entries.map(move |(&column, value)| (column, value / (rows[row] * columns[column])))
    }

    pub(crate) fn check_ready(&self) -> Result<(), Error> {
        if self.ready { Ok(()) } else { Err(Error::NotFactorised) }
    }

    fn load(&mut self, values: &[f64]) -> Result<(), Error> {
        let Inner { pattern, options, .. } = &*self.symbolic;
        pattern.check_finite(values)?;
        if options.equilibrate {
            self.scaling.equilibrate(pattern, values);
        }
        let largest = self.scaling.apply(pattern, values, &mut self.values);
        // A matrix of zeros only is singular, not a division by zero.
        let largest = if largest > 0.0 { largest } else { 1.0 };
        let rule = PivotRule { smallest: options.pivot_threshold * largest, replacement: PERTURBATION * largest };
        let numeric =
            Numeric { symbolic: &self.symbolic, plan: &self.plan, values: &self.values, rule, stacks: &self.stacks };
        numeric.factorise(&mut self.factors, &mut self.pivots, &mut self.shared);
        Ok(())
    }

    fn collect_perturbed(&mut self) {
        self.perturbed.clear();
        let order = &self.symbolic.tree.order;
        let unknowns = self.pivots.iter().zip(order).filter(|(pivot, _)| pivot.perturbed);
        self.perturbed.extend(unknowns.map(|(_, &unknown)| unknown as usize));
    }
}
