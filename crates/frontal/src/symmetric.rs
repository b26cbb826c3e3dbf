//! Elimination of one symmetric front: L D L^T with the pivots from the diagonal in their order, stripe by stripe.

use crate::assembly_tree::Front;
use crate::dense::{Panel, Pivot, PivotRule};
use crate::stripes::{Stripe, Stripes};
use crate::vector::subtract;
use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use pulp::Arch;
use rayon::prelude::*;

/// Below this many multiplications simple loops beat the set-up of blocked kernels.
const SMALL: usize = 1024;

/// Columns that are updated, and where they lie in the front.
struct Target<'a> {
    first: usize,
    rows: usize,
    entries: &'a mut [f64],
}

/// Eliminates the pivots of an assembled front; `block` becomes the contribution to the parent. Every stripe is factorised and
/// taken from all stripes after it, those of the block included; these are the same whether or not they are
/// computed in parallel. `scratch` has [`Front::scratch_len`] numbers.
pub(crate) fn eliminate(
    front: &Front,
    (left, block): (&mut [f64], &mut [f64]),
    scratch: &mut [f64],
    pivots: &mut [Pivot],
    (rule, parallel): (PivotRule, bool),
) {
    for stripe in front.left().iter() {
        let (done, later) = left.split_at_mut(stripe.end());
        let own = &mut done[stripe.start..];
        let columns = stripe.first..stripe.first + stripe.columns;
        Panel { left: own, m: stripe.rows, p: stripe.columns, rule, symmetric: true, parallel: false }
            .factorise(0..stripe.columns, &mut pivots[columns]);
        let below = stripe.rows - stripe.columns;
        let scaled = &mut scratch[..below * stripe.columns];
        scale(own, stripe, scaled);
        let (own, scaled) = (&*own, &*scaled);
        let take = |target: Target| update(own, stripe, scaled, target);
        let within = targets(later, front.left(), stripe.first + stripe.columns, 0);
        let targets = within.chain(targets(block, front.block(), 0, front.pivots));
        if parallel {
            targets.collect::<Vec<_>>().into_par_iter().for_each(take);
        } else {
            targets.for_each(take);
        }
    }
}

/// The stripes of a layout from a column on; columns count from `shift` in the front.
fn targets(entries: &mut [f64], layout: Stripes, from: usize, shift: usize) -> impl Iterator<Item = Target<'_>> {
    let mut rest = entries;
    layout.iter().filter(move |stripe| stripe.first >= from).map(move |stripe| {
        let (entries, later) = std::mem::take(&mut rest).split_at_mut(stripe.rows * stripe.columns);
        rest = later;
        Target { first: shift + stripe.first, rows: stripe.rows, entries }
    })
}

/// `L D` for the rows below the square of a stripe, column by column.
fn scale(own: &[f64], stripe: Stripe, scaled: &mut [f64]) {
    let Stripe { rows, columns, .. } = stripe;
    if rows == columns {
        return;
    }
    for (k, column) in scaled.chunks_exact_mut(rows - columns).enumerate() {
        let (pivot, lower) = (own[rows * k + k], &own[rows * k + columns..rows * (k + 1)]);
        column.iter_mut().zip(lower).for_each(|(scaled, lower)| *scaled = pivot * lower);
    }
}

/// `target <- target - L (L D)^T`, the rows of the target from its first column on.
fn update(own: &[f64], stripe: Stripe, scaled: &[f64], target: Target) {
    let (rows, columns, below) = (stripe.rows, stripe.columns, stripe.rows - stripe.columns);
    let width = target.entries.len() / target.rows.max(1);
    let top = target.first - stripe.first;
    if width * target.rows * columns <= SMALL {
        return Arch::new().dispatch(
            #[inline(always)]
            || {
                for (j, column) in target.entries.chunks_exact_mut(target.rows).enumerate() {
                    for k in 0..columns {
                        let factor = scaled[below * k + top - columns + j];
                        subtract(&mut column[j..], factor, &own[rows * k + top + j..rows * (k + 1)]);
                    }
                }
            },
        );
    }
    let lower = MatRef::from_column_major_slice(own, rows, columns).subrows(top, target.rows);
    let scaled = MatRef::from_column_major_slice(scaled, below, columns).subrows(top - columns, width);
    let entries = MatMut::from_column_major_slice_mut(target.entries, target.rows, width);
    matmul(entries, Accum::Add, lower, scaled.transpose(), -1.0, Par::Seq);
}
