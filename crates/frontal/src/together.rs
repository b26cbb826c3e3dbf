//! Substitution for several vectors at once: large fronts by matrix products, which read the factor once for all.

use crate::assembly_tree::Front;
use crate::factor::Factor;
use crate::panels::{Backward, Panels, SparseForward};
use crate::solve::Workspace;
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{solve_unit_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::{Accum, MatMut, MatRef, Par};

/// Fronts with fewer entries of the factor are done vector by vector.
const LARGE: usize = 2048;

impl Factor {
    /// `x <- A^-1 x` for several vectors, one after the other in elimination order, passing the fronts that none of the
    /// entries `from` reaches and those that none of the entries `to` needs.
    pub(crate) fn substitute_between(&self, from: &[u32], to: &[u32], work: &mut Workspace) {
        let fronts = &self.symbolic.tree.fronts;
        let count = work.count(self);
        for (front, _) in fronts.iter().zip(self.symbolic.tree.above(from)).filter(|(_, reached)| *reached) {
            match blocked(front, count) {
                true => self.at_front_together(front, work, forward_together),
                false => self.halves().at_front::<SparseForward>(front, work),
            }
        }
        for (front, _) in fronts.iter().zip(self.symbolic.tree.above(to)).rev().filter(|(_, needed)| *needed) {
            match blocked(front, count) {
                true => self.at_front_together(front, work, backward_together),
                false => self.halves().at_front::<Backward>(front, work),
            }
        }
    }

    /// Gathers the unknowns of a front for all vectors, lets `step` work on them and scatters them.
    fn at_front_together(&self, front: &Front, work: &mut Workspace, step: impl Fn(&Panels<f64>, MatMut<'_, f64>)) {
        let halves = self.halves();
        let (panels, rows) = (halves.panels(front), self.symbolic.tree.rows(front));
        let (x, local) = work.vectors_and_local();
        let (n, m, p) = (self.symbolic.pattern.len(), front.size(), front.pivots);
        let count = x.len() / n;
        let local = &mut local[..m * count];
        for (local, x) in local.chunks_exact_mut(m).zip(x.chunks_exact(n)) {
            local[..p].copy_from_slice(&x[front.pivot_range()]);
            local[p..].iter_mut().zip(rows).for_each(|(local, &row)| *local = x[row as usize]);
        }
        step(&panels, MatMut::from_column_major_slice_mut(local, m, count));
        for (local, x) in local.chunks_exact(m).zip(x.chunks_exact_mut(n)) {
            x[front.pivot_range()].copy_from_slice(&local[..p]);
            local[p..].iter().zip(rows).for_each(|(local, &row)| x[row as usize] = *local);
        }
    }
}

fn blocked(front: &Front, count: usize) -> bool {
    count > 1 && !front.symmetric && front.size() * front.pivots >= LARGE
}

/// `[L11; L21]` downwards.
fn forward_together(panels: &Panels<f64>, mut x: MatMut<'_, f64>) {
    for column in 0..x.ncols() {
        for (k, pivot) in panels.pivots.iter().enumerate() {
            let other = pivot.row as usize;
            (x[(k, column)], x[(other, column)]) = (x[(other, column)], x[(k, column)]);
        }
    }
    let left = MatRef::from_column_major_slice(panels.left, panels.m, panels.p);
    let (top, bottom) = left.split_at_row(panels.p);
    let (mut x, rest) = x.split_at_row_mut(panels.p);
    solve_unit_lower_triangular_in_place(top, x.as_mut(), Par::Seq);
    matmul(rest, Accum::Add, bottom, x.as_ref(), -1.0, Par::Seq);
}

/// `[U11 U12]` upwards.
fn backward_together(panels: &Panels<f64>, x: MatMut<'_, f64>) {
    let top = MatRef::from_column_major_slice(panels.left, panels.m, panels.p).subrows(0, panels.p);
    let right = MatRef::from_column_major_slice(panels.right, panels.m - panels.p, panels.p);
    let (mut x, rest) = x.split_at_row_mut(panels.p);
    matmul(x.as_mut(), Accum::Add, right.transpose(), rest.as_ref(), -1.0, Par::Seq);
    solve_upper_triangular_in_place(top, x, Par::Seq);
}
