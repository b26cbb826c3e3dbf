//! Where the entries of stencils that stay the same stand in the matrix.
//!
//! Unknowns of a stencil whose numbers follow each other, such as those of a node, stand next to each other in every row
//! that has them: one place a run of them is enough. Places count from the beginning of the row, so that a row keeps them
//! while others change.

use super::{Constraints, Csr, Row, Stencils};
use std::ops::Range;

/// Unknowns of a stencil whose numbers among the free ones follow each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Run {
    /// Place of the first one in the stencil.
    pub first: usize,
    /// Its number among the free ones.
    pub number: usize,
    /// How many there are.
    pub len: usize,
}

impl Run {
    /// Places in the stencil and numbers of its unknowns.
    pub fn unknowns(self) -> impl Iterator<Item = (usize, usize)> {
        (self.first..self.first + self.len).zip(self.number..)
    }
}

/// The places of a term's stencils.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Places {
    /// The runs of each stencil and the first of its offsets; none where a combined unknown takes part.
    stencils: Vec<Option<(Range<usize>, usize)>>,
    runs: Vec<Run>,
    /// Place in the row of the first unknown of every run, for every free unknown of every stencil whose row is there.
    offsets: Vec<u32>,
    /// The rows that are.
    own: Range<usize>,
}

impl Places {
    /// The runs of the given stencils, whose offsets in the rows `own` are yet to be [found](Self::find).
    pub fn new(constraints: &Constraints, stencils: &Stencils, own: Range<usize>) -> Self {
        let mut places = Self { own, ..Self::default() };
        for stencil in &stencils.list {
            let dofs = stencils.dofs(stencil);
            if dofs.iter().any(|&dof| matches!(constraints.row(dof), Row::Combined(_))) {
                places.stencils.push(None);
                continue;
            }
            let (begin, offsets) = (places.runs.len(), places.offsets.len());
            places.append_runs(constraints, dofs);
            let runs = &places.runs[begin..];
            let rows = runs.iter().flat_map(|run| run.unknowns()).filter(|(_, row)| places.own.contains(row)).count();
            places.offsets.resize(offsets + rows * runs.len(), 0);
            places.stencils.push(Some((begin..places.runs.len(), offsets)));
        }
        places
    }

    fn append_runs(&mut self, constraints: &Constraints, dofs: &[usize]) {
        let begin = self.runs.len();
        for (first, &dof) in dofs.iter().enumerate() {
            let Row::Free(number) = *constraints.row(dof) else { continue };
            match self.runs[begin..].last_mut() {
                Some(run) if (run.first + run.len, run.number + run.len) == (first, number) => run.len += 1,
                _ => self.runs.push(Run { first, number, len: 1 }),
            }
        }
    }

    /// Finds the offsets in the rows that are `wanted` of a pattern which holds all entries of the stencils.
    pub fn find(&mut self, pattern: &Csr, wanted: impl Fn(usize) -> bool) {
        let mut rest = self.offsets.as_mut_slice();
        for (runs, _) in self.stencils.iter().flatten() {
            let runs = &self.runs[runs.clone()];
            let own = runs.iter().flat_map(|run| run.unknowns()).filter(|(_, row)| self.own.contains(row));
            for (_, row) in own {
                let (here, behind) = rest.split_at_mut(runs.len());
                rest = behind;
                if wanted(row) {
                    here.iter_mut().zip(runs).for_each(|(to, run)| *to = pattern.offset(row, run.number) as u32);
                }
            }
        }
    }

    /// The runs of a stencil, and their offsets row by row of those that are there.
    pub fn of(&self, stencil: usize) -> Option<(&[Run], &[u32])> {
        let (runs, offsets) = self.stencils.get(stencil)?.clone()?;
        Some((&self.runs[runs], &self.offsets[offsets..]))
    }
}
