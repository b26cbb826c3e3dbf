//! The places of a sparse matrix that may be nonzero.

use crate::error::FrontalError;
use std::sync::Arc;

/// A square, structurally symmetric pattern in compressed rows, with the columns of each row in ascending order.
///
/// Values that go with it are given in the same order, row by row. The diagonal need not be stored. Clones share their
/// memory.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pattern {
    starts: Arc<Vec<usize>>,
    columns: Arc<Vec<usize>>,
    node_of: Option<Arc<Vec<usize>>>,
}

impl Pattern {
    /// Takes the row starts (`n + 1` numbers) and the columns of all rows.
    ///
    /// # Errors
    /// [`FrontalError::InvalidStarts`], [`FrontalError::InvalidColumn`] or [`FrontalError::NotSymmetric`], at the first offence.
    pub fn new(starts: Vec<usize>, columns: Vec<usize>) -> Result<Self, FrontalError> {
        Self::sharing(Arc::new(starts), Arc::new(columns))
    }

    /// The same with memory that the caller keeps too.
    ///
    /// # Errors
    /// As [`Pattern::new`].
    pub fn sharing(starts: Arc<Vec<usize>>, columns: Arc<Vec<usize>>) -> Result<Self, FrontalError> {
        check_starts(&starts, columns.len())?;
        check_columns(&starts, &columns)?;
        check_symmetry(&starts, &columns)?;
        Ok(Pattern { starts, columns, node_of: None })
    }

    /// The same for a pattern that is known to keep the rules, which only debug builds check.
    ///
    /// # Panics
    /// Later, where it does not.
    pub fn trusted(starts: Arc<Vec<usize>>, columns: Arc<Vec<usize>>) -> Self {
        debug_assert!(Self::sharing(starts.clone(), columns.clone()).is_ok(), "a pattern that breaks the rules");
        Pattern { starts, columns, node_of: None }
    }

    /// Names the node of every unknown, so that the ordering works on the smaller graph of the nodes. Nodes may be
    /// numbered in any way and may have any number of unknowns.
    ///
    /// # Errors
    /// [`FrontalError::WrongLength`] unless there is one node per unknown; [`FrontalError::InvalidOrder`] if a node's number is not
    /// below the number of unknowns.
    pub fn with_nodes(mut self, node_of: Vec<usize>) -> Result<Self, FrontalError> {
        check_length("node_of", self.len(), node_of.len())?;
        if let Some(unknown) = node_of.iter().position(|&node| node >= self.len()) {
            return Err(FrontalError::InvalidOrder { unknown });
        }
        self.node_of = Some(Arc::new(node_of));
        Ok(self)
    }

    /// Says that every `k` consecutive unknowns are those of one node.
    ///
    /// # Errors
    /// [`FrontalError::WrongLength`] if the number of unknowns is not a multiple of `k`.
    pub fn with_block(self, k: usize) -> Result<Self, FrontalError> {
        let n = self.len();
        if k == 0 || !n.is_multiple_of(k) {
            return Err(FrontalError::WrongLength { what: "a block of unknowns", expected: n, found: k });
        }
        self.with_nodes((0..n).map(|unknown| unknown / k).collect())
    }

    /// Number of unknowns.
    #[allow(clippy::len_without_is_empty)]
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of entries stored.
    pub fn nonzeros(&self) -> usize {
        self.columns.len()
    }

    /// Where each row starts in [`Pattern::columns`]: `n + 1` numbers.
    pub fn starts(&self) -> &[usize] {
        &self.starts
    }

    /// The columns of all rows.
    pub fn columns(&self) -> &[usize] {
        &self.columns
    }

    /// The columns of one row.
    pub(crate) fn row(&self, row: usize) -> &[usize] {
        &self.columns[self.starts[row]..self.starts[row + 1]]
    }

    /// The entries of one row: index among the values, and column.
    pub(crate) fn entries(&self, row: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        let range = self.starts[row]..self.starts[row + 1];
        range.clone().zip(self.columns[range].iter().copied())
    }

    /// For every entry the index of its mirror image.
    pub(crate) fn mirrors(&self) -> Vec<u32> {
        let mut next = self.starts[..self.len()].to_vec();
        let mut mirror = vec![0; self.nonzeros()];
        for row in 0..self.len() {
            for (at, column) in self.entries(row) {
                // Rows come in order, so each meets the entries of a column's own row one after the other.
                mirror[at] = next[column] as u32;
                next[column] += 1;
            }
        }
        mirror
    }

    /// Whether values, in the pattern's order, are symmetric: mirrored ones differ by no more than `tolerance` of the geometric
    /// mean of their two diagonal entries. It ends at the first that do not.
    ///
    /// # Panics
    /// Unless there is a value for each entry.
    pub fn is_symmetric(&self, values: &[f64], tolerance: f64) -> bool {
        assert_eq!(values.len(), self.nonzeros(), "one value for each entry");
        let own = |row: usize| self.row(row).binary_search(&row).map_or(0.0, |k| values[self.starts[row] + k].abs());
        let diagonal: Vec<f64> = (0..self.len()).map(own).collect();
        // Rows come in order, so each meets the entries of a column's own row one after the other.
        let mut next = self.starts[..self.len()].to_vec();
        (0..self.len()).all(|row| {
            (next[row]..self.starts[row + 1]).all(|at| {
                let column = self.columns[at];
                let mirror = next[column];
                next[column] += 1;
                let difference = values[at] - values[mirror];
                difference * difference <= tolerance * tolerance * diagonal[row] * diagonal[column]
            })
        })
    }

    /// Refuses values, in the pattern's order, of which one is not finite.
    pub(crate) fn check_finite(&self, values: &[f64]) -> Result<(), FrontalError> {
        let Some(at) = values.iter().position(|value| !value.is_finite()) else { return Ok(()) };
        let row = self.starts.partition_point(|&start| start <= at) - 1;
        Err(FrontalError::NotFinite { row, column: self.columns[at] })
    }

    /// The node of each unknown, if it was given.
    pub(crate) fn node_of(&self) -> Option<&[usize]> {
        self.node_of.as_ref().map(|nodes| &nodes[..])
    }
}

/// Refuses a slice of the wrong length.
pub(crate) fn check_length(what: &'static str, expected: usize, found: usize) -> Result<(), FrontalError> {
    if expected == found { Ok(()) } else { Err(FrontalError::WrongLength { what, expected, found }) }
}

fn check_starts(starts: &[usize], nonzeros: usize) -> Result<(), FrontalError> {
    if starts.first() != Some(&0) {
        return Err(FrontalError::InvalidStarts { row: 0 });
    }
    if let Some(row) = starts.windows(2).position(|pair| pair[0] > pair[1]) {
        return Err(FrontalError::InvalidStarts { row: row + 1 });
    }
    let row = starts.len() - 1;
    if starts[row] == nonzeros { Ok(()) } else { Err(FrontalError::InvalidStarts { row }) }
}

fn check_columns(starts: &[usize], columns: &[usize]) -> Result<(), FrontalError> {
    let n = starts.len() - 1;
    for row in 0..n {
        let mut least = 0;
        for &column in &columns[starts[row]..starts[row + 1]] {
            if column < least || column >= n {
                return Err(FrontalError::InvalidColumn { row, column });
            }
            least = column + 1;
        }
    }
    Ok(())
}

/// Walks the rows in order; `seen[c]` counts the entries of row `c` that have met their mirror images. As rows are
/// sorted, the entry `(r, c)` must meet the next entry of row `c` not met so far.
fn check_symmetry(starts: &[usize], columns: &[usize]) -> Result<(), FrontalError> {
    let mut seen = starts[..starts.len() - 1].to_vec();
    for row in 0..seen.len() {
        for &column in &columns[starts[row]..starts[row + 1]] {
            let mirror = seen[column];
            if mirror == starts[column + 1] || columns[mirror] > row {
                return Err(FrontalError::NotSymmetric { row, column });
            }
            if columns[mirror] < row {
                return Err(FrontalError::NotSymmetric { row: column, column: columns[mirror] });
            }
            seen[column] += 1;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offences_are_named() {
        assert_eq!(Pattern::new(vec![], vec![]), Err(FrontalError::InvalidStarts { row: 0 }));
        assert_eq!(Pattern::new(vec![0, 2, 1], vec![0]), Err(FrontalError::InvalidStarts { row: 2 }));
        assert_eq!(Pattern::new(vec![0, 1], vec![1]), Err(FrontalError::InvalidColumn { row: 0, column: 1 }));
        assert_eq!(Pattern::new(vec![0, 2, 2], vec![1, 1]), Err(FrontalError::InvalidColumn { row: 0, column: 1 }));
        assert_eq!(Pattern::new(vec![0, 1, 1], vec![1]), Err(FrontalError::NotSymmetric { row: 0, column: 1 }));
        assert_eq!(Pattern::new(vec![0, 0, 1], vec![0]), Err(FrontalError::NotSymmetric { row: 1, column: 0 }));
    }

    #[test]
    fn a_pattern_may_be_empty() {
        assert_eq!(Pattern::new(vec![0], vec![]).map(|pattern| pattern.len()), Ok(0));
    }
}
