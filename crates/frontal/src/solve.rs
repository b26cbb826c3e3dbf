//! Substitution with the factors: `P A = L U` front by front, and the transposed system.

use crate::assembly_tree::Front;
use crate::factor::Factor;
use crate::panels::{Backward, BackwardTransposed, Forward, ForwardTransposed, Panels, SparseForward, Step};
use crate::vector::Number;

/// Working memory of a solve, in elimination order.
pub(crate) struct Workspace<T> {
    x: Vec<T>,
    /// Gathered unknowns of one front.
    local: Vec<T>,
}

impl<T: Number> Workspace<T> {
    pub fn new(factor: &Factor) -> Self {
        let symbolic = &factor.symbolic;
        let zeros = |n| vec![T::round(0.0); n];
        Workspace { x: zeros(symbolic.pattern.len()), local: zeros(symbolic.prediction.largest_front) }
    }

    /// The vector.
    pub fn x(&mut self) -> &mut [T] {
        &mut self.x
    }
}

impl Factor {
    /// The factors as they were found.
    pub(crate) fn halves(&self) -> Halves<'_, f64> {
        Halves { factor: self, entries: &self.factors }
    }

    /// `x <- A^-1 x` for the equilibrated matrix as it was factorised, perturbed pivots included.
    pub(crate) fn substitute(&self, x: &mut [f64], work: &mut Workspace<f64>) {
        self.halves().substitute(x, work);
    }

    /// `x <- A^-T x`.
    pub(crate) fn substitute_transposed(&self, x: &mut [f64], work: &mut Workspace<f64>) {
        if self.symbolic.options.symmetric {
            return self.substitute(x, work);
        }
        let halves = self.halves();
        self.permuted(x, work, |work| {
            for front in &self.symbolic.tree.fronts {
                halves.at_front::<ForwardTransposed>(front, work);
            }
            for front in self.symbolic.tree.fronts.iter().rev() {
                halves.at_front::<BackwardTransposed>(front, work);
            }
        });
    }

    pub(crate) fn permuted<T: Number>(
        &self,
        x: &mut [f64],
        work: &mut Workspace<T>,
        solve: impl Fn(&mut Workspace<T>),
    ) {
        let order = &self.symbolic.tree.order;
        work.x.iter_mut().zip(order).for_each(|(permuted, &unknown)| *permuted = T::round(x[unknown as usize]));
        solve(work);
        work.x.iter().zip(order).for_each(|(permuted, &unknown)| x[unknown as usize] = (*permuted).into());
    }
}

/// The two halves of a substitution, in elimination order, by factors in this precision.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Halves<'a, T> {
    pub factor: &'a Factor,
    pub entries: &'a [T],
}

impl<T: Number> Halves<'_, T> {
    /// `x <- A^-1 x`.
    pub fn substitute(&self, x: &mut [f64], work: &mut Workspace<T>) {
        self.factor.permuted(x, work, |work| {
            self.forward(work);
            self.backward(work);
        });
    }

    /// The first half.
    pub fn forward(&self, work: &mut Workspace<T>) {
        self.factor.symbolic.tree.fronts.iter().for_each(|front| self.at_front::<Forward>(front, work));
    }

    /// The second half.
    pub fn backward(&self, work: &mut Workspace<T>) {
        self.factor.symbolic.tree.fronts.iter().rev().for_each(|front| self.at_front::<Backward>(front, work));
    }

    /// The first half where only the entries `from` are not zero.
    pub fn forward_from(&self, from: &[u32], work: &mut Workspace<T>) {
        let tree = &self.factor.symbolic.tree;
        for (front, _) in tree.fronts.iter().zip(tree.above(from)).filter(|(_, reached)| *reached) {
            self.at_front::<SparseForward>(front, work);
        }
    }

    /// The second half where only the entries `to` are needed.
    pub fn backward_to(&self, to: &[u32], work: &mut Workspace<T>) {
        let tree = &self.factor.symbolic.tree;
        for (front, _) in tree.fronts.iter().zip(tree.above(to)).rev().filter(|(_, needed)| *needed) {
            self.at_front::<Backward>(front, work);
        }
    }

    /// The factors of a front.
    pub fn panels(&self, front: &Front) -> Panels<'_, T> {
        let (left, right) = self.entries[front.factor_range()].split_at(front.left_len());
        let pivots = &self.factor.pivots[front.pivot_range()];
        Panels { left, right, pivots, m: front.size(), p: front.pivots, symmetric: front.symmetric }
    }

    /// Gathers the unknowns of a front, pivots first, takes a step on them and scatters them.
    pub fn at_front<S: Step>(&self, front: &Front, work: &mut Workspace<T>) {
        let symbolic = &self.factor.symbolic;
        let Workspace { x, local } = work;
        let local = &mut local[..front.size()];
        let (top, border) = local.split_at_mut(front.pivots);
        top.copy_from_slice(&x[front.pivot_range()]);
        for (value, &row) in border.iter_mut().zip(symbolic.tree.rows(front)) {
            *value = x[row as usize];
        }
        self.panels(front).take::<S>(local);
        let (top, border) = local.split_at(front.pivots);
        x[front.pivot_range()].copy_from_slice(top);
        for (value, &row) in border.iter().zip(symbolic.tree.rows(front)) {
            x[row as usize] = *value;
        }
    }
}
