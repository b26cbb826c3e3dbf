//! A factorised matrix.

use crate::assembly_tree::Front;
use crate::dense::{Pivot, PivotRule};
use crate::diagnose;
use crate::error::FrontalError;
use crate::huge;
use crate::numeric::Numeric;
use crate::pattern::check_length;
use crate::plan::Plan;
use crate::scaling::Scaling;
use crate::solve::Workspace;
use crate::symbolic::{Inner, Symbolic};
use crate::vector::{norm, subtract};
use std::mem::take;
use std::sync::{Arc, Mutex, PoisonError};

/// Perturbed pivots get this share of the largest value: the square root of the unit round-off balances the error
/// made against the growth allowed (Li & Demmel, ACM TOMS 29, 2003).
const PERTURBATION: f64 = 1.5e-8;
/// Part of a right-hand side that a solution with an indefinite L D L^T may leave; refinement then needs few steps.
const UNSTABLE: f64 = 1e-8;

/// L and U, or L and D, with a copy of the equilibrated matrix for refinement and the working memory of the next factorisation.
#[derive(Debug)]
pub struct Factor {
    pub(crate) symbolic: Arc<Inner>,
    pub(crate) factors: Vec<f64>,
    pub(crate) pivots: Vec<Pivot>,
    pub(crate) scaling: Scaling,
    /// Values of the equilibrated matrix, in the pattern's order.
    pub(crate) values: Vec<f64>,
    /// The largest of them, in size.
    largest: f64,
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

/// What the signs of the pivots say of a matrix.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PivotSigns {
    /// Whether its values were factorised as symmetric ones.
    pub symmetric: bool,
    /// Number of its negative eigenvalues where it is symmetric (Sylvester's law of inertia); one else if its determinant is
    /// negative, and zero if not.
    pub negative: usize,
}

/// So many numbers: in the memory there is, or in new memory of which nothing is touched yet.
fn fit(numbers: &mut Vec<f64>, len: usize) {
    if numbers.capacity() < len {
        *numbers = Vec::new();
        *numbers = vec![0.0; len];
        huge::ask(numbers);
    } else {
        numbers.resize(len, 0.0);
    }
}

/// Bytes of working memory from which on it is given back between factorisations where other memory is wanted.
pub(crate) const LARGE: usize = 1 << 28;

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
    /// [`FrontalError::WrongLength`], [`FrontalError::NotFinite`]; [`FrontalError::ForeignFactor`] unless the factor came from this
    /// analysis; [`FrontalError::Singular`] with the unknowns responsible; [`FrontalError::Unstable`] where pivots from the diagonal will not do
    /// for symmetric values. After an error the factor holds no values.
    pub fn factorise(&self, values: &[f64], factor: &mut Factor) -> Result<Report, FrontalError> {
        if !Arc::ptr_eq(&self.inner, &factor.symbolic) {
            return Err(FrontalError::ForeignFactor);
        }
        factor.ready = false;
        check_length("values", self.inner.pattern.nonzeros(), values.len())?;
        factor.load(values)?;
        factor.ready = true;
        if !factor.perturbed.is_empty() {
            diagnose::check_regular(factor).inspect_err(|_| factor.ready = false)?;
            // The last pivots of a free body of n unknowns are n times rounding, and those of a slender one that is held may be as small.
            if factor.pivots.iter().any(|pivot| pivot.perturbed && pivot.sound) {
                factor.eliminate(true);
            }
        }
        if self.inner.options.symmetric && !factor.stable() {
            factor.ready = false;
            return Err(FrontalError::Unstable);
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
        fit(&mut factors, symbolic.tree.factor_len());
        fit(&mut values, symbolic.pattern.nonzeros());
        fit(&mut shared, plan.shared_len());
        stacks.resize_with(plan.stacks(), Vec::new);
        stacks.iter_mut().for_each(|stack| fit(stack, plan.stack_len + plan.scratch_len));
        Factor {
            factors,
            pivots: vec![Pivot::default(); n],
            scaling: Scaling::identity(n),
            values,
            largest: 0.0,
            shared,
            stacks: Mutex::new(stacks),
            plan,
            perturbed: Vec::new(),
            ready: false,
            symbolic,
        }
    }

    /// Gives working memory back until the next factorisation, if it is large.
    pub(crate) fn release(&mut self) {
        if 8 * self.plan.len() > LARGE {
            self.shared = Vec::new();
            self.stacks.get_mut().unwrap_or_else(PoisonError::into_inner).clear();
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

    /// Signs of the pivots; None where nothing is factorised or a pivot was perturbed.
    pub fn signs(&self) -> Option<PivotSigns> {
        let symmetric = self.symbolic.options.symmetric;
        let negative = self.pivots.iter().filter(|pivot| pivot.negative).count();
        let exchanged = || {
            let own = |front: &Front| {
                (0..).zip(&self.pivots[front.pivot_range()]).filter(|(k, pivot)| *k != pivot.row).count()
            };
            self.symbolic.tree.fronts.iter().map(own).sum::<usize>()
        };
        let negative = if symmetric { negative } else { (negative + exchanged()) % 2 };
        (self.ready && self.perturbed.is_empty()).then_some(PivotSigns { symmetric, negative })
    }

    /// Whether pivots from the diagonal did: always where all are positive, and else where a solution comes out well.
    fn stable(&self) -> bool {
        if !self.pivots.iter().any(|pivot| pivot.negative || pivot.perturbed) {
            return true;
        }
        let b: Vec<f64> = (0..self.pivots.len()).map(|k| diagnose::start(k, 0)).collect();
        let mut x = b.clone();
        self.substitute(&mut x, &mut Workspace::new(self));
        let mut residual = self.times(&x);
        subtract(&mut residual, 1.0, &b);
        self.perturbed.is_empty() && norm(&residual) <= UNSTABLE * norm(&b)
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

    pub(crate) fn check_ready(&self) -> Result<(), FrontalError> {
        if self.ready { Ok(()) } else { Err(FrontalError::NotFactorised) }
    }

    fn load(&mut self, values: &[f64]) -> Result<(), FrontalError> {
        let Inner { pattern, options, .. } = &*self.symbolic;
        pattern.check_finite(values)?;
        if options.equilibrate {
            self.scaling.equilibrate(pattern, values);
            if options.symmetric {
                self.scaling.columns.clone_from(&self.scaling.rows);
            }
        }
        self.largest = self.scaling.apply(pattern, values, &mut self.values);
        self.eliminate(false);
        Ok(())
    }

    /// Factorises the values that are loaded; `regular`: they are known to be those of a regular matrix.
    fn eliminate(&mut self, regular: bool) {
        // A matrix of zeros only is singular, not a division by zero.
        let largest = if self.largest > 0.0 { self.largest } else { 1.0 };
        let rule = PivotRule {
            smallest: self.symbolic.options.pivot_threshold * largest,
            rounding: f64::EPSILON * largest,
            share: PERTURBATION,
            replacement: PERTURBATION * largest,
            regular,
        };
        fit(&mut self.shared, self.plan.shared_len());
        let numeric =
            Numeric { symbolic: &self.symbolic, plan: &self.plan, values: &self.values, rule, stacks: &self.stacks };
        numeric.factorise(&mut self.factors, &mut self.pivots, &mut self.shared);
        self.collect_perturbed();
    }

    fn collect_perturbed(&mut self) {
        self.perturbed.clear();
        let order = &self.symbolic.tree.order;
        let unknowns = self.pivots.iter().zip(order).filter(|(pivot, _)| pivot.perturbed);
        self.perturbed.extend(unknowns.map(|(_, &unknown)| unknown as usize));
    }
}
