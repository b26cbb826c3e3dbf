//! What has jumped in the matrix near contact since it was factorised, as a change of low rank by which the factor is put
//! right.

use super::super::constants::low_rank::{CHANGED, MOST};
use super::LinearError;
use super::compliance::{ContactCompliance, Engine, add_multiple};
use crate::system::Shares;
use frontal::{LowRankChange, Sparse};
use std::collections::{BTreeMap, BTreeSet};

/// A matrix by rows.
#[derive(Clone, Copy)]
pub(super) struct Rows<'a> {
    pub starts: &'a [usize],
    pub columns: &'a [usize],
    pub values: &'a [f64],
}

impl Rows<'_> {
    fn row(&self, row: usize) -> (&[usize], &[f64]) {
        let range = self.starts[row]..self.starts[row + 1];
        (&self.columns[range.clone()], &self.values[range])
    }
}

impl ContactCompliance {
    /// What a matrix is beyond the one that was factorised among the unknowns of points that are closed or were; None if that is
    /// nothing, or too much.
    ///
    /// # Errors
    /// When a solution with the factor fails.
    pub fn low_rank_update(
        &mut self,
        [now, then]: [Rows; 2],
        shares: &Shares,
        closed: &BTreeSet<usize>,
        engine: Engine,
    ) -> Result<Option<LowRankChange>, LinearError> {
        self.change = None;
        let mut near: Vec<usize> = self.closed.union(closed).copied().collect();
        near.retain(|unknown| self.at.binary_search(unknown).is_ok());
        let own = shares.own();
        let changed = near.iter().filter(|row| own.contains(row)).filter_map(|&row| {
            let change = difference(now.row(row), then.row(row), &near)?;
            Some((row, change))
        });
        let changed = of_all_ranks(shares, changed.collect())?;
        let (unknowns, rows): (BTreeSet<usize>, Vec<Sparse>) = changed.into_iter().unzip();
        if unknowns.is_empty() || unknowns.len() > MOST {
            return Ok(None);
        }
        self.find(&unknowns, engine)?;
        let unknowns: Vec<usize> = unknowns.into_iter().collect();
        let forces = unknowns.iter().map(|&unknown| vec![(unknown, 1.0)]).collect();
        let capacitance = self.capacitance(&rows, &unknowns);
        let change = LowRankChange::new(forces, rows, capacitance);
        self.change = change.clone().map(|change| (unknowns, change));
        Ok(change)
    }

    /// `I + V^T K0^-1 U` by rows.
    fn capacitance(&self, rows: &[Sparse], unknowns: &[usize]) -> Vec<f64> {
        let columns: Vec<&Vec<f64>> = unknowns.iter().map(|unknown| &self.columns[unknown]).collect();
        let mut inverse: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
        let mut entries = vec![0.0; rows.len() * rows.len()];
        for (i, (row, sums)) in rows.iter().zip(entries.chunks_exact_mut(rows.len())).enumerate() {
            sums[i] = 1.0;
            for &(unknown, value) in row {
                let place = self.place(unknown);
                let inverse = inverse.entry(place).or_insert_with(|| columns.iter().map(|c| c[place]).collect());
                add_multiple(sums, value, inverse);
            }
        }
        entries
    }
}

/// Rows with their numbers, those of all ranks from those of each.
fn of_all_ranks(shares: &Shares, own: Vec<(usize, Sparse)>) -> Result<Vec<(usize, Sparse)>, LinearError> {
    let Some(with) = shares.with() else { return Ok(own) };
    let mut piece = Vec::new();
    for (number, row) in own {
        piece.extend([number as f64, row.len() as f64]);
        piece.extend(row.into_iter().flat_map(|(column, value)| [column as f64, value]));
    }
    let (all, _) = with.gather(&piece).map_err(LinearError::Input)?;
    let (mut rows, mut rest) = (Vec::new(), all.as_slice());
    while let [number, length, behind @ ..] = rest {
        let (row, next) = behind.split_at(2 * *length as usize);
        rows.push((*number as usize, row.chunks_exact(2).map(|pair| (pair[0] as usize, pair[1])).collect()));
        rest = next;
    }
    Ok(rows)
}

/// What has changed of a row among these unknowns, if that is much; all are in ascending order.
fn difference(
    (columns, now): (&[usize], &[f64]),
    (before, then): (&[usize], &[f64]),
    among: &[usize],
) -> Option<Sparse> {
    let largest = now.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    let then = before.iter().zip(then).map(|(&column, value)| (column, -value));
    let mut changed: Sparse = then.chain(columns.iter().copied().zip(now.iter().copied())).collect();
    changed.retain(|(column, _)| among.binary_search(column).is_ok());
    changed.sort_by_key(|(column, _)| *column);
    changed.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        kept.1 += if same { next.1 } else { 0.0 };
        same
    });
    changed.retain(|(_, value)| *value != 0.0);
    changed.iter().any(|(_, value)| value.abs() > CHANGED * largest).then_some(changed)
}
