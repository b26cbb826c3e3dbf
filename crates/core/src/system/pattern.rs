//! Which free unknowns couple: the sparsity pattern, in compressed rows.

use super::{Constraints, Stencils};
use std::ops::Range;
use std::sync::Arc;

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
    /// Adds the unknowns of each stencil as a group.
    pub fn extend(&mut self, stencils: &Stencils) {
        stencils.list.iter().for_each(|stencil| self.push(stencils.dofs(stencil)));
    }
    /// Whether there is no group.
    pub fn is_empty(&self) -> bool {
        self.starts.is_empty()
    }
}

/// A structurally symmetric pattern with a full diagonal, or the rows of it that one rank owns, of which the others are empty then;
/// columns ascend in each row.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Csr {
    /// Row `i` holds `columns[starts[i]..starts[i + 1]]`.
    pub starts: Arc<Vec<usize>>,
    /// Columns of all rows.
    pub columns: Arc<Vec<usize>>,
    /// Place of the entry on the diagonal, row by row, or that behind the entries before it.
    diagonal: Vec<usize>,
}

impl Csr {
    /// From what its rows hold, each with its diagonal.
    pub fn new(starts: Arc<Vec<usize>>, columns: Arc<Vec<usize>>) -> Self {
        let before = |row: usize| columns[starts[row]..starts[row + 1]].partition_point(|&column| column < row);
        let diagonal = (0..starts.len() - 1).map(|row| starts[row] + before(row)).collect();
        Self { starts, columns, diagonal }
    }
    /// A matrix of this pattern and these values times a vector.
    pub fn times(&self, values: &[f64], x: &[f64]) -> Vec<f64> {
        let row =
            |row: usize| (self.starts[row]..self.starts[row + 1]).map(|at| values[at] * x[self.columns[at]]).sum();
        (0..x.len()).map(row).collect()
    }
    /// The symmetric part of a square matrix of this pattern, in which each entry has its mirror.
    pub fn symmetric_part(&self, values: &[f64]) -> Vec<f64> {
        let rows = 0..self.starts.len() - 1;
        let entries = rows.flat_map(|row| (self.starts[row]..self.starts[row + 1]).map(move |at| (row, at)));
        let mean = |(row, at): (usize, usize)| {
            let column = self.columns[at];
            let mirror =
                self.columns[self.starts[column]..self.starts[column + 1]].partition_point(|&other| other < row);
            0.5 * (values[at] + values[self.starts[column] + mirror])
        };
        entries.map(mean).collect()
    }
    /// The pattern of `groups` after elimination of the constrained unknowns, or its rows `own`.
    pub fn build(constraints: &Constraints, groups: &Couplings, own: Range<usize>) -> Self {
        Self::of_rows(constraints.free_count(), own, &Reduced::new(constraints, groups))
    }
    /// The pattern of `n` numbers that couple within groups.
    pub fn of(n: usize, reduced: &Reduced) -> Self {
        Self::of_rows(n, 0..n, reduced)
    }
    fn of_rows(n: usize, own: Range<usize>, reduced: &Reduced) -> Self {
        let starts = (0..=n).map(|row| row.clamp(own.start, own.end) - own.start).collect();
        Self::new(Arc::new(starts), Arc::new(own.collect())).joined(reduced, Vec::new())
    }
    /// Some rows of this pattern, the others empty, and where their entries stand among all.
    pub fn rows_only(&self, rows: Range<usize>) -> (Self, Range<usize>) {
        let entries = self.starts[rows.start]..self.starts[rows.end];
        let starts =
            self.starts.iter().map(|start| (*start).clamp(entries.start, entries.end) - entries.start).collect();
        (Self::new(Arc::new(starts), Arc::new(self.columns[entries.clone()].to_vec())), entries)
    }
    /// Place of the entry on the diagonal of a row; none where another rank owns that.
    pub fn diagonal(&self, row: usize) -> Option<usize> {
        (!self.row(row).is_empty()).then(|| self.diagonal[row])
    }
    /// This pattern and that of `groups` in one, whose columns are written over `memory`.
    pub fn with(&self, constraints: &Constraints, groups: &Couplings, memory: Vec<usize>) -> Self {
        self.joined(&Reduced::new(constraints, groups), memory)
    }
    fn joined(&self, reduced: &Reduced, memory: Vec<usize>) -> Self {
        let n = self.rows();
        let (member_starts, members) = invert(n, reduced);
        let mut marker = vec![usize::MAX; n];
        let (mut starts, mut columns, mut diagonal) = (Vec::with_capacity(n + 1), memory, Vec::with_capacity(n));
        starts.push(0);
        columns.clear();
        for row in 0..n {
            let (begin, own) = (columns.len(), self.row(row));
            columns.extend_from_slice(own);
            // Rows of others are empty.
            let groups = if own.is_empty() { &[] } else { &members[member_starts[row]..member_starts[row + 1]] };
            if !groups.is_empty() {
                own.iter().for_each(|&column| marker[column] = row);
            }
            for &column in groups.iter().flat_map(|&group| reduced.group(group)) {
                if marker[column] != row {
                    marker[column] = row;
                    columns.push(column);
                }
            }
            let mut before = self.diagonal[row] - self.starts[row];
            if columns.len() > begin + own.len() {
                columns[begin..].sort_unstable();
                before = columns[begin..].partition_point(|&column| column < row);
            }
            diagonal.push(begin + before);
            starts.push(columns.len());
        }
        Self { starts: Arc::new(starts), columns: Arc::new(columns), diagonal }
    }
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.starts.len() - 1
    }
    /// Columns of a row.
    pub fn row(&self, row: usize) -> &[usize] {
        &self.columns[self.starts[row]..self.starts[row + 1]]
    }
    /// Place of an entry of the pattern in its row; that behind the entries before it, where it is none.
    pub fn offset(&self, row: usize, column: usize) -> usize {
        self.row(row).partition_point(|&other| other < column)
    }
    /// Place of entry `(row, column)` among the values, if it is in the pattern.
    pub fn position(&self, row: usize, column: usize) -> Option<usize> {
        let begin = self.starts[row];
        self.columns[begin..self.starts[row + 1]].binary_search(&column).ok().map(|k| begin + k)
    }
    /// The same where it may stand so many entries from the beginning of the row; it is searched for where it does not.
    pub fn position_near(&self, row: usize, column: usize, offsets: [usize; 2]) -> Option<usize> {
        let (begin, end) = (self.starts[row], self.starts[row + 1]);
        let is_there = |place: &usize| *place < end && self.columns[*place] == column;
        offsets.map(|offset| begin + offset).into_iter().find(is_there).or_else(|| self.position(row, column))
    }
}

/// Groups in the numbering of the free unknowns, or of what they belong to.
#[derive(Debug)]
pub struct Reduced {
    starts: Vec<usize>,
    free: Vec<usize>,
}

impl Reduced {
    /// Groups after elimination of the constrained unknowns.
    pub fn new(constraints: &Constraints, groups: &Couplings) -> Self {
        let (mut starts, mut free) = (vec![0], Vec::with_capacity(groups.dofs.len()));
        for group in groups.iter() {
            free.extend(group.iter().flat_map(|&dof| constraints.followed(dof)).map(|(i, _)| i));
            starts.push(free.len());
        }
        Self { starts, free }
    }

    /// The same groups of the owners of the unknowns, each of them once in a group.
    pub fn owned_by(&self, owners: &[usize]) -> Self {
        let (mut starts, mut free, mut group) = (vec![0], Vec::new(), Vec::new());
        for i in 0..self.starts.len() - 1 {
            group.clear();
            group.extend(self.group(i).iter().map(|&i| owners[i]));
            group.sort_unstable();
            group.dedup();
            free.extend_from_slice(&group);
            starts.push(free.len());
        }
        Self { starts, free }
    }

    fn group(&self, i: usize) -> &[usize] {
        &self.free[self.starts[i]..self.starts[i + 1]]
    }
}

/// For every number, the groups it belongs to.
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
