//! Which free unknowns couple: the sparsity pattern, in compressed rows.

use super::{Constraints, Row};

/// Groups of unknowns, each of which couples within itself.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Couplings {
    starts: Vec<usize>,
    dofs: Vec<usize>,
}

impl Couplings {
    /// Adds a group.
    pub fn push(&mut self, dofs: &[usize]) {
        self.dofs.extend_from_slice(dofs);
        self.starts.push(self.dofs.len());
    }
    /// The groups.
    pub fn iter(&self) -> impl Iterator<Item = &[usize]> {
        let begins = std::iter::once(0).chain(self.starts.iter().copied());
        begins.zip(&self.starts).map(|(begin, &end)| &self.dofs[begin..end])
    }
    /// Forgets all groups and keeps the memory.
    pub fn clear(&mut self) {
        self.starts.clear();
        self.dofs.clear();
    }
}

/// A structurally symmetric pattern with a full diagonal; columns ascend in each row.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Csr {
    /// Row `i` holds `columns[starts[i]..starts[i + 1]]`.
    pub starts: Vec<usize>,
    /// Columns of all rows.
    pub columns: Vec<usize>,
}

impl Csr {
    /// The pattern of `groups` after elimination of the constrained unknowns, in memory for so many entries at least.
    pub fn build(constraints: &Constraints, groups: &Couplings, room: usize) -> Self {
        let n = constraints.free_count();
        let reduced = reduce(constraints, groups);
        let (member_starts, members) = invert(n, &reduced);
        let mut marker = vec![usize::MAX; n];
        let (mut starts, mut columns) = (Vec::with_capacity(n + 1), Vec::with_capacity(room));
        starts.push(0);
        for row in 0..n {
            let begin = columns.len();
            marker[row] = row;
            columns.push(row);
            for &group in &members[member_starts[row]..member_starts[row + 1]] {
                for &column in reduced.group(group) {
                    if marker[column] != row {
                        marker[column] = row;
                        columns.push(column);
                    }
                }
            }
            columns[begin..].sort_unstable();
            starts.push(columns.len());
        }
        Self { starts, columns }
    }
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.starts.len() - 1
    }
    /// Place of entry `(row, column)` among the values, if it is in the pattern.
    pub fn position(&self, row: usize, column: usize) -> Option<usize> {
        let begin = self.starts[row];
        self.columns[begin..self.starts[row + 1]].binary_search(&column).ok().map(|k| begin + k)
    }
    /// The same where it may stand so many entries from the beginning of the row; it is searched for where it does not.
    pub fn position_near(&self, row: usize, column: usize, offset: usize) -> Option<usize> {
        let guess = self.starts[row] + offset;
        if guess < self.starts[row + 1] && self.columns[guess] == column {
            Some(guess)
        } else {
            self.position(row, column)
        }
    }
}

/// Groups in the numbering of the free unknowns.
struct Reduced {
    starts: Vec<usize>,
    free: Vec<usize>,
}

impl Reduced {
    fn group(&self, i: usize) -> &[usize] {
        &self.free[self.starts[i]..self.starts[i + 1]]
    }
}

fn reduce(constraints: &Constraints, groups: &Couplings) -> Reduced {
    let (mut starts, mut free) = (vec![0], Vec::with_capacity(groups.dofs.len()));
    for group in groups.iter() {
        for &dof in group {
            match constraints.row(dof) {
                Row::Free(i) => free.push(*i),
                Row::Fixed => {}
                Row::Combined(terms) => free.extend(terms.iter().map(|t| t.0)),
            }
        }
        starts.push(free.len());
    }
    Reduced { starts, free }
}

/// For every free unknown, the groups it belongs to.
fn invert(n: usize, reduced: &Reduced) -> (Vec<usize>, Vec<usize>) {
    let mut starts = vec![0; n + 2];
    reduced.free.iter().for_each(|&i| starts[i + 2] += 1);
    for i in 2..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut members = vec![0; reduced.free.len()];
    for group in 0..reduced.starts.len() - 1 {
        for &i in reduced.group(group) {
            members[starts[i + 1]] = group;
            starts[i + 1] += 1;
        }
    }
    (starts, members)
}
