//! The numeric factorisation: assemble, eliminate, pass on, from the leaves to the roots.

use crate::assembly_tree::{Entry, Front};
use crate::dense::{Pivot, PivotRule, eliminate};
use crate::symbolic::Inner;

/// Factorises all fronts in postorder.
pub(crate) fn factorise(
    symbolic: &Inner,
    values: &[f64],
    rule: PivotRule,
    factors: &mut [f64],
    pivots: &mut [Pivot],
    stack: &mut [f64],
) {
    for (s, front) in symbolic.tree.fronts.iter().enumerate() {
        let factor = &mut factors[front.factor_range()];
        assemble_entries(factor, symbolic.tree.entries(s), values);
        let (block, children) = split_stack(front, symbolic.stack.offsets[s], stack);
        block.fill(0.0);
        for &child in symbolic.tree.children(s) {
            let relative = symbolic.tree.relative(&symbolic.tree.fronts[child as usize]);
            let offset = symbolic.stack.offsets[child as usize] - children.offset;
            let contribution = &children.stack[offset..offset + relative.len() * relative.len()];
            extend_add(front, factor, block, contribution, relative);
        }
        eliminate(front, factor, block, &mut pivots[front.pivot_range()], rule);
    }
}

fn assemble_entries(factor: &mut [f64], entries: &[Entry], values: &[f64]) {
    factor.fill(0.0);
    for entry in entries {
        factor[entry.place as usize] += values[entry.value as usize];
    }
}

/// The side of the stack with the children's blocks.
struct Children<'a> {
    stack: &'a [f64],
    offset: usize,
}

/// The block of a front at one side of the stack, and the other side, which holds its children's.
fn split_stack<'a>(front: &Front, offset: usize, stack: &'a mut [f64]) -> (&'a mut [f64], Children<'a>) {
    let len = front.border * front.border;
    if front.depth.is_multiple_of(2) {
        let (low, high) = stack.split_at_mut(offset + len);
        (&mut low[offset..], Children { stack: high, offset: offset + len })
    } else {
        let (low, high) = stack.split_at_mut(offset);
        (&mut high[..len], Children { stack: low, offset: 0 })
    }
}

/// Adds a child's contribution; `relative` are its rows in the front, in ascending order.
fn extend_add(front: &Front, factor: &mut [f64], block: &mut [f64], contribution: &[f64], relative: &[u32]) {
    let (m, p, b) = (front.size(), front.pivots, front.border);
    let (left, right) = factor.split_at_mut(m * p);
    let summed = relative.partition_point(|&row| (row as usize) < p);
    for (column, &j) in contribution.chunks_exact(relative.len().max(1)).zip(relative) {
        let j = j as usize;
        if j < p {
            scatter(&mut left[m * j..m * (j + 1)], column, relative, 0);
        } else {
            for (value, &i) in column[..summed].iter().zip(relative) {
                right[b * i as usize + j - p] += value;
            }
            scatter(&mut block[b * (j - p)..b * (j - p + 1)], &column[summed..], &relative[summed..], p);
        }
    }
}

/// `target[rows - shift] += values`.
fn scatter(target: &mut [f64], values: &[f64], rows: &[u32], shift: usize) {
    for (value, &row) in values.iter().zip(rows) {
        target[row as usize - shift] += value;
    }
}
