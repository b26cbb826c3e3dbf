//! From the numbers of a file to places: a table where the numbers are dense, as nearly always, and a map for the rest.

use std::collections::HashMap;

const NOWHERE: usize = usize::MAX;

/// The place of each number.
#[derive(Default)]
pub(super) struct Numbering {
    dense: Vec<usize>,
    sparse: HashMap<u64, usize>,
    count: usize,
}

impl Numbering {
    /// Enters a number; false if it was there already.
    pub(super) fn insert(&mut self, number: u64, place: usize) -> bool {
        if self.get(number).is_some() {
            return false;
        }
        self.count += 1;
        // The table never outgrows the numbers entered by more than a factor, whatever the file says.
        let bound = 2 * self.count as u64 + 1024;
        if number < bound {
            let length = self.dense.len().max(number as usize + 1);
            self.dense.resize(length, NOWHERE);
            self.dense[number as usize] = place;
        } else {
            self.sparse.insert(number, place);
        }
        true
    }

    pub(super) fn get(&self, number: u64) -> Option<usize> {
        let dense = usize::try_from(number).ok().and_then(|number| self.dense.get(number));
        match dense {
            Some(&place) if place != NOWHERE => Some(place),
            _ => self.sparse.get(&number).copied(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_found_in_whatever_order_they_came() {
        let numbers = [7, u64::MAX, 1_000_000, 3, 5000, 0, 2000];
        let mut numbering = Numbering::default();
        assert!(numbers.iter().enumerate().all(|(place, &number)| numbering.insert(number, place)));
        assert!(numbers.iter().enumerate().all(|(place, &number)| numbering.get(number) == Some(place)));
        assert!(numbers.iter().all(|&number| !numbering.insert(number, 9)));
        assert_eq!((numbering.get(1), numbering.get(999_999)), (None, None));
        assert!(numbering.dense.len() < 1100);
    }
}
