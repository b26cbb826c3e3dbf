//! Where a value was written: in the deck's file, in one `--set`, or in a mesh file.

use std::ops::Range;

/// A text that values are read from.
#[derive(Debug, Clone, PartialEq)]
pub struct SourceText {
    /// What messages call it: a path, or `--set`.
    pub name: String,
    /// The text: the whole of a deck, one line of a mesh file.
    pub text: String,
    /// The line at which it begins, from one.
    pub first_line: usize,
}

impl SourceText {
    /// A text from its first line on.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self { name: name.into(), text: text.into(), first_line: 1 }
    }
}

/// A stretch of a [`SourceText`], in bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Place {
    /// Position in the list of sources: 0 is the deck's file.
    pub source: usize,
    /// First byte.
    pub start: usize,
    /// One past the last byte.
    pub end: usize,
}

impl Place {
    /// A stretch of one source.
    pub fn new(source: usize, span: Range<usize>) -> Self {
        Self { source, start: span.start, end: span.end }
    }
}

/// A value and where it stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot<T> {
    /// The value.
    pub value: T,
    /// Where it stands; for a default, the table that does not say it.
    pub place: Place,
}

impl<T> std::ops::Deref for Spot<T> {
    type Target = T;
    fn deref(&self) -> &T {
        &self.value
    }
}
