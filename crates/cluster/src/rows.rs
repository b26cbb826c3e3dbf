//! Who owns which rows of a matrix, and the rows of one rank as PETSc takes them.
//!
//! Unknowns stand in blocks of as many as a node has, so that multigrid knows the motions of a node as such; a place whose
//! unknown is prescribed is held by a row of its own. Each rank owns the blocks of the unknowns that it owns.

use crate::petsc::{PetscInt, Result, int};
use asperity_core::solve::Unknowns;
use asperity_core::system::{Csr, Shares};
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
    /// Which of them hold places without an unknown; the others are those of the matrix.
    pub held: Vec<usize>,
}

impl Rows {
    /// Places for unknowns, of each rank for its share.
    pub fn new(unknowns: &Unknowns, shares: &Shares) -> Self {
        let block = unknowns.dofs.per_node();
        let (mut places, mut next, mut of) = (Vec::with_capacity(unknowns.free.len()), 0, None);
        for &dof in unknowns.free {
            let first = unknowns.dofs.first_of_owner(dof);
            if of.is_some_and(|(before, _)| before != first) {
                next = end_of_block(&places, block);
            }
            let (_, begin) = *of.filter(|(before, _)| *before == first).get_or_insert((first, next));
            of = Some((first, begin));
            places.push(begin + dof - first);
        }
        let end = end_of_block(&places, block);
        let start = |row: &usize| places.get(*row).map_or(end, |place| place / block * block);
        let starts = shares.rows().iter().map(start).collect();
        Self { block, places, starts, rank: shares.rank() }
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
        let (mut starts, mut columns, mut held) = (vec![0], Vec::with_capacity(pattern.columns.len()), Vec::new());
        let mut unknown = self.places.partition_point(|&place| place < own.start);
        for place in own {
            if self.places.get(unknown) == Some(&place) {
                for &column in pattern.row(unknown) {
                    columns.push(int(self.places[column])?);
                }
                unknown += 1;
            } else {
                held.push(columns.len());
                columns.push(int(place)?);
            }
            starts.push(int(columns.len())?);
        }
        Ok(Entries { starts, columns, held })
    }
}

/// The values of a matrix, with those by which places without an unknown are held where they stand among them.
pub fn with_held(values: &[f64], places: &[usize], held: f64) -> Vec<f64> {
    let (mut all, mut rest) = (Vec::with_capacity(values.len() + places.len()), values);
    for &place in places {
        let (before, behind) = rest.split_at(place - all.len());
        all.extend_from_slice(before);
        all.push(held);
        rest = behind;
    }
    all.extend_from_slice(rest);
    all
}

/// The first place behind the block of the last one.
fn end_of_block(places: &[usize], block: usize) -> usize {
    places.last().map_or(0, |last| (last / block + 1) * block)
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_core::system::{Communicator, Dofs};
    use std::sync::Arc;

    /// One of two ranks that have nothing to tell.
    struct One(usize);

    static PAIR: [One; 2] = [One(0), One(1)];

    impl Communicator for One {
        fn rank(&self) -> usize {
            self.0
        }
        fn size(&self) -> usize {
            2
        }
        fn agree(&self, _: &[f64]) -> Result<()> {
            Ok(())
        }
        fn gather(&self, piece: &[f64]) -> Result<(Vec<f64>, Vec<usize>)> {
            Ok((piece.to_vec(), vec![0, piece.len()]))
        }
        fn collect(&self, piece: &[f64]) -> Result<Vec<f64>> {
            Ok(piece.to_vec())
        }
    }

    #[test]
    fn unknowns_stand_in_blocks_and_every_rank_has_its_own() {
        // Two nodes in space, one held along y, and a tool that only shifts along x and turns about y.
        let dofs = Dofs::new(3, 3, 1);
        let free = [0, 2, 6, 7, 8, 9, 13];
        let full = Csr::new(Arc::new((0..=7).map(|row| 7 * row).collect()), Arc::new((0..49).map(|k| k % 7).collect()));
        let unknowns = Unknowns { dofs: &dofs, free: &free };
        let shares = [0, 1].map(|rank| Shares::new(Some(&PAIR[rank]), &dofs, &free));
        let rows = |rank: usize| Rows::new(&unknowns, &shares[rank]);
        assert_eq!(rows(0).places, [0, 2, 3, 4, 5, 6, 10]);
        assert_eq!((rows(0).own(), rows(1).own(), rows(0).count()), (0..3, 3..12, 12));
        let entries = rows(0).entries(&full.rows_only(shares[0].own()).0).unwrap();
        assert_eq!((entries.starts, entries.columns[7]), (vec![0, 7, 8, 15], 1));
        assert_eq!(entries.held, [7]);
        assert_eq!(rows(1).shares(&[0, 2, 3, 6]), [2, 2]);
        assert_eq!(with_held(&[1.0, 2.0, 3.0], &[0, 3], 9.0), [9.0, 1.0, 2.0, 9.0, 3.0]);
    }
}
