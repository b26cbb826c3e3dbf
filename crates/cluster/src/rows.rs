//! Who owns which rows of a matrix, and the rows of one rank as PETSc takes them.
//!
//! Unknowns stand in blocks of as many as a node has, so that multigrid knows the motions of a node as such; a place whose
//! unknown is prescribed is held by a row of its own. Each rank owns a run of blocks, with as many entries as the others.

use crate::petsc::{PetscInt, Result, int};
use asperity_core::solve::Unknowns;
use asperity_core::system::Csr;
use std::ops::Range;
use std::os::raw::c_int;

/// The rows of all ranks.
pub struct Rows {
    /// Unknowns of a block.
    pub block: usize,
    /// The place of each unknown.
    pub places: Vec<usize>,
    /// Where the places of each rank begin, and end.
    starts: Vec<usize>,
    rank: usize,
}

/// The entries of one rank's rows.
pub struct Entries {
    /// Where each row begins, and the last ends.
    pub starts: Vec<PetscInt>,
    /// The place of each entry.
    pub columns: Vec<PetscInt>,
    /// Which value of the matrix each is; none where a place is held.
    from: Vec<Option<usize>>,
    /// The values.
    pub values: Vec<f64>,
}

impl Rows {
    /// Places for unknowns, shared out by the entries of a pattern.
    pub fn new(unknowns: &Unknowns, pattern: &Csr, (rank, size): (usize, usize)) -> Self {
        let block = unknowns.dofs.per_node();
        let (mut places, mut next, mut of) = (Vec::with_capacity(unknowns.free.len()), 0, None);
        for &dof in unknowns.free {
            let first = unknowns.first_of_owner(dof);
            if of.is_some_and(|(before, _)| before != first) {
                next = end_of_block(&places, block);
            }
            let (_, begin) = *of.filter(|(before, _)| *before == first).get_or_insert((first, next));
            of = Some((first, begin));
            places.push(begin + dof - first);
        }
        let end = end_of_block(&places, block);
        let entries = pattern.columns.len();
        // The first block that begins at or behind a share of the entries.
        let start = |share: usize| {
            let row = pattern.starts.partition_point(|&start| start * size < entries * share).min(places.len());
            places.get(row).map_or(end, |place| place / block * block)
        };
        let mut starts: Vec<usize> = (0..size).map(start).collect();
        starts.push(end);
        starts[0] = 0;
        Self { block, places, starts, rank }
    }

    /// How many places there are.
    pub fn count(&self) -> usize {
        self.starts[self.starts.len() - 1]
    }
    /// The places of this rank.
    pub fn own(&self) -> Range<usize> {
        self.starts[self.rank]..self.starts[self.rank + 1]
    }
    /// How many places each rank has.
    pub fn lengths(&self) -> Vec<c_int> {
        self.starts.windows(2).map(|ends| (ends[1] - ends[0]) as c_int).collect()
    }
    /// How many of these places, which ascend, each rank has.
    pub fn shares(&self, places: &[usize]) -> Vec<usize> {
        let before = |start: &usize| places.partition_point(|place| place < start);
        self.starts.windows(2).map(|ends| before(&ends[1]) - before(&ends[0])).collect()
    }

    /// The rows of this rank.
    pub fn entries(&self, pattern: &Csr) -> Result<Entries> {
        let own = self.own();
        let (mut starts, mut columns, mut from) = (vec![0], Vec::new(), Vec::new());
        let mut unknown = self.places.partition_point(|&place| place < own.start);
        for place in own {
            if self.places.get(unknown) == Some(&place) {
                let range = pattern.starts[unknown]..pattern.starts[unknown + 1];
                for entry in range {
                    columns.push(int(self.places[pattern.columns[entry]])?);
                    from.push(Some(entry));
                }
                unknown += 1;
            } else {
                columns.push(int(place)?);
                from.push(None);
            }
            starts.push(int(columns.len())?);
        }
        let values = vec![0.0; from.len()];
        Ok(Entries { starts, columns, from, values })
    }
}

impl Entries {
    /// Takes up the values of a matrix, and what places without an unknown are held by.
    pub fn fill(&mut self, values: &[f64], held: f64) {
        let pairs = self.values.iter_mut().zip(&self.from);
        pairs.for_each(|(value, from)| *value = from.map_or(held, |entry| values[entry]));
    }
}

/// The first place behind the block of the last one.
fn end_of_block(places: &[usize], block: usize) -> usize {
    places.last().map_or(0, |last| (last / block + 1) * block)
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_core::system::Dofs;
    use std::sync::Arc;

    #[test]
    fn unknowns_stand_in_blocks_and_every_rank_has_its_own() {
        // Two nodes in space, one held along y, and a tool that only shifts along x and turns about y.
        let dofs = Dofs::new(3, 3, 1);
        let free = [0, 2, 6, 7, 8, 9, 13];
        let full = Csr::new(Arc::new((0..=7).map(|row| 7 * row).collect()), Arc::new((0..49).map(|k| k % 7).collect()));
        let unknowns = Unknowns { dofs: &dofs, free: &free };
        let rows = |rank| Rows::new(&unknowns, &full, (rank, 2));
        assert_eq!(rows(0).places, [0, 2, 3, 4, 5, 6, 10]);
        assert_eq!((rows(0).own(), rows(1).own(), rows(0).count()), (0..3, 3..12, 12));
        let entries = rows(0).entries(&full).unwrap();
        assert_eq!((entries.starts, entries.columns[7]), (vec![0, 7, 8, 15], 1));
        assert_eq!(rows(1).shares(&[0, 2, 3, 6]), [2, 2]);
    }
}
