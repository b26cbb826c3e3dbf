//! Adding the matrices of stencils up, in bands of rows: a thread each.
//!
//! Every band goes through all stencils in their order, so that no sum depends on how many bands there are.

use super::places::{Places, Run};
use super::sink::{Miss, Round, take};
use super::{Constraints, Csr, Row, Shares};
use rayon::prelude::*;
use std::ops::Range;

/// What the matrices of a term are added by.
pub struct Frame<'a> {
    /// How unknowns follow from the free ones.
    pub constraints: &'a Constraints,
    /// The pattern.
    pub pattern: &'a Csr,
    /// Places of the stencils, where they are known.
    pub places: Option<&'a Places>,
    /// What of the matrix this rank owns.
    pub shares: &'a Shares,
    /// Plus or minus one.
    pub sign: f64,
}

/// Values of some rows.
struct Band<'a> {
    rows: Range<usize>,
    values: &'a mut [f64],
    /// Where in a row the columns of a stencil were found last.
    offsets: Vec<usize>,
}

impl Frame<'_> {
    /// Whether the matrix of a stencil of these unknowns has rows of this rank.
    pub fn has(&self, dofs: &[usize]) -> bool {
        self.shares.has(self.constraints, dofs)
    }

    /// Adds the matrices of a round to the values of the pattern.
    pub fn add(&self, round: &Round, values: &mut [f64]) -> Result<(), Miss> {
        let mut bands = self.bands(values, rayon::current_num_threads().min(round.chunks.len()));
        match bands.as_mut_slice() {
            [band] => band.add(self, round),
            bands => bands.par_iter_mut().map(|band| band.add(self, round)).reduce(|| Ok(()), Result::and),
        }
    }

    /// Cuts the values into so many bands of about as many entries.
    fn bands<'a>(&self, mut values: &'a mut [f64], count: usize) -> Vec<Band<'a>> {
        let (starts, entries, own) = (&self.pattern.starts, values.len(), self.shares.own());
        let (mut bands, mut first) = (Vec::with_capacity(count), own.start);
        for number in 1..=count {
            let end = starts.partition_point(|&start| start < entries * number / count).clamp(first, own.end);
            let (band, rest) = values.split_at_mut(starts[end] - starts[first]);
            bands.push(Band { rows: first..end, values: band, offsets: Vec::new() });
            (values, first) = (rest, end);
        }
        bands
    }
}

impl Band<'_> {
    fn add(&mut self, by: &Frame, round: &Round) -> Result<(), Miss> {
        let mut result = Ok(());
        for (chunk, stencils) in round.parts() {
            let mut rest = chunk.tangents.as_slice();
            for index in stencils {
                let dofs = round.stencils.dofs(&round.stencils.list[index]);
                if !by.has(dofs) {
                    continue;
                }
                let matrix = take(&mut rest, dofs.len() * dofs.len());
                match by.places.and_then(|places| places.of(index)) {
                    Some(runs) => self.add_runs(by, runs, matrix),
                    None => result = self.add_long_way(by, dofs, matrix).and(result),
                }
            }
        }
        result
    }

    /// Adds a matrix whose entries stand in runs.
    fn add_runs(&mut self, by: &Frame, (runs, offsets): (&[Run], &[u32]), matrix: &[f64]) {
        let (own, n) = (by.shares.own(), matrix.len().isqrt());
        let (starts, first) = (&by.pattern.starts, by.pattern.starts[self.rows.start]);
        let there = runs.iter().flat_map(|run| run.unknowns()).filter(|(_, row)| own.contains(row));
        let rows = there.zip(offsets.chunks_exact(runs.len().max(1)));
        for ((k, row), offsets) in rows.filter(|((_, row), _)| self.rows.contains(row)) {
            let values = &mut self.values[starts[row] - first..starts[row + 1] - first];
            let entries = &matrix[k * n..(k + 1) * n];
            for (run, &offset) in runs.iter().zip(offsets) {
                let values = &mut values[offset as usize..][..run.len];
                values.iter_mut().zip(&entries[run.first..]).for_each(|(value, entry)| *value += by.sign * entry);
            }
        }
    }

    fn add_long_way(&mut self, by: &Frame, dofs: &[usize], matrix: &[f64]) -> Result<(), Miss> {
        let (starts, first) = (&by.pattern.starts, by.pattern.starts[self.rows.start]);
        self.offsets.clear();
        self.offsets.resize(dofs.len(), 0);
        for (entries, &dof) in matrix.chunks_exact(dofs.len().max(1)).zip(dofs) {
            let own = terms(by.constraints.row(dof));
            if !own.as_slice().iter().any(|(i, _)| self.rows.contains(i)) {
                continue;
            }
            // The rows of a node have the same columns, and its columns stand next to each other.
            let (mut next, columns) = (0, dofs.iter().zip(&mut self.offsets));
            for (&value, (&other, offset)) in entries.iter().zip(columns).filter(|(value, _)| **value != 0.0) {
                for &(i, ci) in own.as_slice().iter().filter(|(i, _)| self.rows.contains(i)) {
                    for &(j, cj) in terms(by.constraints.row(other)).as_slice() {
                        let place = by.pattern.position_near(i, j, [*offset, next]).ok_or(Miss)?;
                        *offset = place - starts[i];
                        next = *offset + 1;
                        self.values[place - first] += by.sign * ci * cj * value;
                    }
                }
            }
        }
        Ok(())
    }
}

/// The free unknowns a row depends on, without allocation for the usual ones.
enum RowTerms<'a> {
    One([(usize, f64); 1]),
    Many(&'a [(usize, f64)]),
}

impl RowTerms<'_> {
    fn as_slice(&self) -> &[(usize, f64)] {
        match self {
            Self::One(one) => one,
            Self::Many(many) => many,
        }
    }
}

fn terms(row: &Row) -> RowTerms<'_> {
    match row {
        Row::Free(i) => RowTerms::One([(*i, 1.0)]),
        Row::Fixed => RowTerms::Many(&[]),
        Row::Combined(terms) => RowTerms::Many(terms),
    }
}
