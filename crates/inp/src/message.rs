//! What is said about an input deck: errors, and notes of what was left out; each with its place, each once.

use std::collections::BTreeSet;

/// A line of one of the files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub struct InputPlace {
    /// Number of the file among those that were opened.
    pub file: usize,
    /// Its line, counted from 1.
    pub line: usize,
}

/// One sentence about a place.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Message {
    /// Where.
    pub place: InputPlace,
    /// What.
    pub text: String,
}

/// More errors than this are not told: a binary file has one a line.
const MOST_TOLD: usize = 50;

/// All messages about a deck. What is said twice of one place, as of each instance of a part, is kept once.
#[derive(Debug, Default)]
pub struct Messages {
    files: Vec<String>,
    errors: BTreeSet<Message>,
    notes: BTreeSet<Message>,
}

impl Messages {
    /// Makes a file known; the number of its places.
    pub fn open(&mut self, name: String) -> usize {
        self.files.push(name);
        self.files.len() - 1
    }

    /// How many files were opened.
    pub fn files(&self) -> usize {
        self.files.len()
    }

    /// Something is wrong.
    pub fn error(&mut self, place: InputPlace, text: impl Into<String>) {
        self.errors.insert(Message { place, text: text.into() });
    }

    /// Something was left out or became something else.
    pub fn note(&mut self, place: InputPlace, text: impl Into<String>) {
        self.notes.insert(Message { place, text: text.into() });
    }

    /// Whether anything is wrong.
    pub fn has_errors(&self) -> bool {
        !self.errors.is_empty()
    }

    /// Whether anything is wrong at a place.
    pub fn has_error_at(&self, place: InputPlace) -> bool {
        let first = Message { place, text: String::new() };
        self.errors.range(first..).next().is_some_and(|error| error.place == place)
    }

    /// All errors in order of their places, `file:line: what`; of very many the first.
    pub fn errors(&self) -> Vec<String> {
        let mut lines: Vec<String> = self.errors.iter().take(MOST_TOLD).map(|error| self.line(error)).collect();
        if self.errors.len() > MOST_TOLD {
            lines.push(format!("and {} more like these", self.errors.len() - MOST_TOLD));
        }
        lines
    }

    /// All notes in order of their places.
    pub fn notes(&self) -> Vec<String> {
        self.notes.iter().map(|note| self.line(note)).collect()
    }

    /// A place in words: `block.inp:12`.
    pub fn at(&self, place: InputPlace) -> String {
        format!("{}:{}", self.files.get(place.file).map_or("", String::as_str), place.line)
    }

    fn line(&self, message: &Message) -> String {
        format!("{}: {}", self.at(message.place), message.text)
    }
}

/// Words that mean `name`, if one of the known names is near: ` ; did you mean 'TOP'?`.
pub fn suggestion<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> String {
    let wanted = name.to_ascii_uppercase();
    let near = known.map(|other| (distance(&wanted, &other.to_ascii_uppercase()), other)).min();
    match near {
        Some((off, other)) if off <= 1 + wanted.chars().count() / 4 => format!("; did you mean '{other}'?"),
        _ => String::new(),
    }
}

/// How many letters must be put in, taken out or changed to make one word of the other (Levenshtein).
fn distance(one: &str, other: &str) -> usize {
    let other: Vec<char> = other.chars().take(80).collect();
    let mut row: Vec<usize> = (0..=other.len()).collect();
    for (i, a) in one.chars().take(80).enumerate() {
        let mut corner = i;
        row[0] = i + 1;
        for (j, &b) in other.iter().enumerate() {
            let best = (corner + usize::from(a != b)).min(row[j] + 1).min(row[j + 1] + 1);
            corner = row[j + 1];
            row[j + 1] = best;
        }
    }
    row[other.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_names_are_found() {
        assert_eq!(suggestion("elstic", ["ELASTIC", "PLASTIC"].into_iter()), "; did you mean 'ELASTIC'?");
        assert_eq!(suggestion("zzz", ["ELASTIC"].into_iter()), "");
        assert_eq!((distance("", "ab"), distance("abc", "abc"), distance("kitten", "sitting")), (2, 0, 3));
    }
}
