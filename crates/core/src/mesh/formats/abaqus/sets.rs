//! Sets of nodes or elements: numbers, ranges, other sets. Ranges stay ranges until the numbers of the file are known,
//! so that no line of text can ask for more memory than the mesh itself takes.

use super::Place;
use std::collections::BTreeMap;

/// More entries than this, over all sets, are taken for sets that copy one another without end.
const MOST_ENTRIES: usize = 20_000_000;

/// Sets by their names; names are found in any case and kept as first written.
#[derive(Default)]
pub(super) struct Sets {
    sets: BTreeMap<String, Set>,
    entries: usize,
}

/// One set.
pub(super) struct Set {
    pub name: String,
    entries: Vec<Entry>,
}

/// A range of numbers; a single number is a range of one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Entry {
    first: u64,
    last: u64,
    step: u64,
    place: Place,
}

/// What is there of the numbers of a set.
pub(super) struct Found {
    /// Places of nodes or elements, sorted, without repeats.
    pub members: Vec<usize>,
    /// How many numbers of ranges do not exist.
    pub missing: u64,
}

impl Sets {
    /// A set by its name, new if there is none.
    pub(super) fn open(&mut self, name: &str) -> &mut Set {
        let set = || Set { name: name.to_string(), entries: vec![] };
        self.sets.entry(name.to_ascii_uppercase()).or_insert_with(set)
    }

    pub(super) fn get(&self, name: &str) -> Option<&Set> {
        self.sets.get(&name.to_ascii_uppercase())
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &Set> {
        self.sets.values()
    }

    /// Adds a range to a set; a range that continues the last one by one number becomes part of it if it may.
    pub(super) fn add(&mut self, name: &str, range: [u64; 3], place: Place) -> Result<(), String> {
        let [first, last, step] = range;
        self.open(name).entries.push(Entry { first, last, step, place });
        self.grow(1)
    }

    /// Adds a number that is known to exist.
    pub(super) fn add_known(&mut self, name: &str, number: u64, place: Place) -> Result<(), String> {
        match self.open(name).entries.last_mut() {
            Some(entry) if entry.step == 1 && entry.last.checked_add(1) == Some(number) => {
                entry.last = number;
                Ok(())
            }
            _ => self.add(name, [number, number, 1], place),
        }
    }

    /// Adds what another set holds now.
    ///
    /// # Errors
    /// A sentence without its place if there is no such set, or if the sets grow out of all bounds.
    pub(super) fn include(&mut self, name: &str, other: &str) -> Result<(), String> {
        let Some(found) = self.get(other) else {
            let names = self.sets.values().map(|set| set.name.as_str());
            let hint = match crate::declare::nearest(other, names) {
                Some(near) => format!("did you mean '{near}'?"),
                None => "a set must be defined before it is used".into(),
            };
            return Err(format!("there is no set '{other}'; {hint}"));
        };
        let entries = found.entries.clone();
        let set = self.open(name);
        let before = set.entries.len();
        set.entries.extend(entries);
        set.entries.sort_unstable();
        set.entries.dedup();
        let added = set.entries.len() - before;
        self.grow(added)
    }

    fn grow(&mut self, added: usize) -> Result<(), String> {
        self.entries += added;
        match self.entries <= MOST_ENTRIES {
            true => Ok(()),
            false => Err("the sets hold too many entries; define them without copying one another".into()),
        }
    }
}

/// The numbers of nodes or elements, sorted, and where each stands.
pub(super) struct Index {
    sorted: Vec<(u64, usize)>,
}

impl Index {
    pub(super) fn of(numbers: impl Iterator<Item = u64>) -> Self {
        let mut sorted: Vec<(u64, usize)> = numbers.enumerate().map(|(place, number)| (number, place)).collect();
        sorted.sort_unstable();
        Self { sorted }
    }

    /// A number that stands there twice, if any, with both places.
    pub(super) fn repeated(&self) -> Option<(u64, [usize; 2])> {
        let pair = self.sorted.windows(2).find(|pair| pair[0].0 == pair[1].0)?;
        Some((pair[0].0, [pair[0].1, pair[1].1]))
    }

    pub(super) fn get(&self, number: u64) -> Option<usize> {
        let place = self.sorted.binary_search_by_key(&number, |entry| entry.0).ok()?;
        Some(self.sorted[place].1)
    }

    /// The members of a set.
    ///
    /// # Errors
    /// The number of a single entry that does not exist, and its place in the file.
    pub(super) fn members(&self, set: &Set) -> Result<Found, (u64, Place)> {
        let mut chosen = vec![false; self.sorted.len()];
        let mut missing = 0;
        for entry in &set.entries {
            let found = self.choose(entry, &mut chosen);
            let absent = ((entry.last - entry.first) / entry.step).saturating_add(1) - found;
            if absent > 0 && entry.first == entry.last {
                return Err((entry.first, entry.place));
            }
            missing += absent;
        }
        let mut members: Vec<usize> =
            self.sorted.iter().zip(chosen).filter(|(_, chosen)| *chosen).map(|(entry, _)| entry.1).collect();
        members.sort_unstable();
        Ok(Found { members, missing })
    }

    fn choose(&self, entry: &Entry, chosen: &mut [bool]) -> u64 {
        let start = self.sorted.partition_point(|found| found.0 < entry.first);
        let range = self.sorted[start..].iter().take_while(|found| found.0 <= entry.last);
        let mut count = 0;
        for (found, chosen) in range.zip(&mut chosen[start..]) {
            if (found.0 - entry.first).is_multiple_of(entry.step) {
                *chosen = true;
                count += 1;
            }
        }
        count
    }
}
