//! How the columns of a front lie in memory.

/// Columns of a stripe: wide enough for dense products at full speed, narrow enough that little above the diagonal is kept.
pub(crate) const WIDTH: usize = 96;

/// The lower trapezoid of a matrix of `rows` x `columns`, no more columns than rows, in stripes of `width` columns. A stripe has the
/// rows from its first column on and is stored column by column; one stripe as wide as the matrix is the whole matrix.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stripes {
    rows: usize,
    columns: usize,
    width: usize,
}

/// Some consecutive columns, in the rows from the first of them on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stripe {
    /// First column, and first row.
    pub first: usize,
    pub columns: usize,
    /// Number of rows, the leading dimension.
    pub rows: usize,
    /// Place of its first number.
    pub start: usize,
}

impl Stripe {
    /// Place after its last number.
    pub fn end(&self) -> usize {
        self.start + self.rows * self.columns
    }

    /// Place of an entry.
    pub fn place(&self, row: usize, column: usize) -> usize {
        self.start + (column - self.first) * self.rows + row - self.first
    }
}

impl Stripes {
    /// All of a matrix.
    pub fn whole(rows: usize, columns: usize) -> Self {
        Stripes { rows, columns, width: columns.max(1) }
    }

    /// Its lower trapezoid.
    pub fn lower(rows: usize, columns: usize) -> Self {
        Stripes { rows, columns, width: WIDTH }
    }

    /// Numbers that are stored.
    pub fn len(&self) -> usize {
        let (whole, rest) = (self.columns / self.width, self.columns % self.width);
        self.start(whole) + rest * (self.rows - whole * self.width)
    }

    /// Place of the first number of a stripe.
    fn start(&self, stripe: usize) -> usize {
        let above = self.width * (stripe * stripe.saturating_sub(1) / 2);
        self.width * (stripe * self.rows - above)
    }

    /// The stripe of a column.
    pub fn of(&self, column: usize) -> Stripe {
        let stripe = column / self.width;
        let first = stripe * self.width;
        let columns = self.width.min(self.columns - first);
        Stripe { first, columns, rows: self.rows - first, start: self.start(stripe) }
    }

    /// All stripes, from left to right.
    pub fn iter(self) -> impl Iterator<Item = Stripe> {
        (0..self.columns).step_by(self.width).map(move |column| self.of(column))
    }

    /// Place of an entry.
    pub fn place(&self, row: usize, column: usize) -> usize {
        self.of(column).place(row, column)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_entry_has_a_place_of_its_own() {
        for (rows, columns) in [(1, 1), (7, 3), (300, 300), (300, 128), (400, 129), (5, 0), (0, 0)] {
            for layout in [Stripes::whole(rows, columns), Stripes::lower(rows, columns)] {
                let mut next = 0;
                for stripe in layout.iter() {
                    assert_eq!(stripe.start, next, "{layout:?}");
                    next = stripe.end();
                }
                assert_eq!(layout.len(), next, "{layout:?}");
                let mut places: Vec<usize> =
                    (0..columns).flat_map(|j| (j..rows).map(move |i| layout.place(i, j))).collect();
                let count = places.len();
                places.sort_unstable();
                places.dedup();
                assert!(places.len() == count && places.last().is_none_or(|last| *last < next), "{layout:?}");
            }
        }
    }
}
