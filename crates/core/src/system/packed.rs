//! A pattern in few numbers, as it is kept and sent: unknowns of a node have rows alike, whose columns stand in ranges.

use super::Csr;
use serde::{Deserialize, Serialize};
use std::ops::Range;
use std::sync::Arc;

/// Stands for a row like the one before it.
const ALIKE: u32 = u32::MAX;

/// Rows of a [`Csr`], one after another: of each how many ranges of columns it has, then where each begins and how long it is, or a mark
/// that it is like the one before.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PackedPattern(pub Vec<u32>);

impl PackedPattern {
    /// These rows of a pattern of fewer than 2^32 unknowns.
    pub fn of(pattern: &Csr, rows: Range<usize>) -> Self {
        let mut words = Vec::new();
        for row in rows.clone() {
            let columns = pattern.row(row);
            if row > rows.start && columns == pattern.row(row - 1) {
                words.push(ALIKE);
                continue;
            }
            let at = words.len();
            words.push(0);
            for range in columns.chunk_by(|a, b| a + 1 == *b) {
                words.extend([range[0] as u32, range.len() as u32]);
                words[at] += 1;
            }
        }
        Self(words)
    }

    /// The pattern of so many rows and entries; none where these numbers are none of a pattern whose columns ascend in each row.
    pub fn unpacked(&self, rows: usize, entries: usize) -> Option<Csr> {
        let mut words = self.0.iter().map(|word| *word as usize);
        let (mut starts, mut columns, mut last) = (vec![0], Vec::with_capacity(entries), 0..0);
        while let Some(ranges) = words.next() {
            let (begin, alike) = (columns.len(), ranges == ALIKE as usize);
            if alike {
                columns.extend_from_within(last);
            }
            for _ in 0..if alike { 0 } else { ranges } {
                let (first, length) = (words.next()?, words.next()?);
                let follows = columns[begin..].last().is_none_or(|before| *before < first);
                if !follows || length == 0 || length > entries - columns.len() || first + length > rows {
                    return None;
                }
                columns.extend(first..first + length);
            }
            if columns.len() > entries || starts.len() > rows {
                return None;
            }
            last = begin..columns.len();
            starts.push(columns.len());
        }
        let fits = starts.len() == rows + 1 && columns.len() == entries;
        fits.then(|| Csr::new(Arc::new(starts), Arc::new(columns)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pattern_comes_back_from_its_parts_and_nothing_else_does() {
        let rows: [&[usize]; 5] = [&[0, 1, 2, 4], &[0, 1, 2, 4], &[0, 1, 2, 3], &[2, 3], &[0, 4]];
        let ends = rows.iter().scan(0, |end, row| {
            *end += row.len();
            Some(*end)
        });
        let starts: Vec<usize> = std::iter::once(0).chain(ends).collect();
        let csr = Csr::new(Arc::new(starts), Arc::new(rows.concat()));
        let packed = PackedPattern::of(&csr, 0..5);
        assert_eq!(packed.0, [2, 0, 3, 4, 1, ALIKE, 1, 0, 4, 1, 2, 2, 2, 0, 1, 4, 1]);
        assert_eq!(packed.unpacked(5, 16), Some(csr.clone()));
        // In parts, as ranks send them.
        let parts = [0..2, 2..5].map(|rows| PackedPattern::of(&csr, rows).0);
        assert_eq!(PackedPattern(parts.concat()), packed);
        assert_eq!(packed.unpacked(4, 16), None);
        assert_eq!(packed.unpacked(6, 16), None);
        assert_eq!(packed.unpacked(5, 15), None);
        for place in 0..packed.0.len() {
            for word in [0, 1, 5, 7, ALIKE] {
                let mut other = packed.clone();
                other.0[place] = word;
                // What fits has columns that ascend and lie within.
                if let Some(csr) = other.unpacked(5, 16) {
                    assert!(
                        (0..5).all(|row| csr.row(row).is_sorted() && csr.row(row).iter().all(|&column| column < 5))
                    );
                }
            }
        }
    }
}
