//! What can go wrong: an [`Error`] stops the run, a [`Failure`] only cuts the increment. Layer 0, used by all rooms.

use std::borrow::Cow;
use std::fmt;

/// Something that stops the run and that the user must be told in words.
#[derive(Debug, Clone, PartialEq)]
pub enum Error {
    /// The input is wrong; the text carries file, line, what, the nearest valid name and what to do.
    Input(String),
    /// A file cannot be read or written.
    File {
        /// The file.
        path: String,
        /// What the system said.
        reason: String,
    },
    /// A result cannot be written: the disk is full, or a limit is reached.
    Write {
        /// The file.
        path: String,
        /// What the system said.
        reason: String,
    },
    /// The increments shrank to nothing; the last failure says why.
    NotConverged(String),
    /// The run was asked to stop and has written its checkpoint.
    Stopped,
    /// A fault of the program itself.
    Internal(String),
}

impl Error {
    /// An input error.
    pub fn input(text: impl Into<String>) -> Self {
        Self::Input(text.into())
    }
    /// A result that cannot be written.
    pub fn write(path: impl AsRef<std::path::Path>, reason: impl fmt::Display) -> Self {
        Self::Write { path: path.as_ref().display().to_string(), reason: reason.to_string() }
    }
    /// A file that cannot be read or written.
    pub fn file(path: impl AsRef<std::path::Path>, reason: impl fmt::Display) -> Self {
        Self::File { path: path.as_ref().display().to_string(), reason: reason.to_string() }
    }
}

/// A text as it may be shown on a terminal: characters that would steer the terminal or turn the direction of writing are
/// replaced by others of the same length in UTF-8, so that places in the text stay what they are.
pub fn visible(text: &str) -> Cow<'_, str> {
    let shown = |(at, c): (usize, char)| match c {
        '\n' | '\t' => c,
        '\r' if text[at + 1..].starts_with('\n') => c,
        c if c.is_ascii_control() => '?',
        c if c.is_control() => '\u{bf}',
        '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => '\u{fffd}',
        c => c,
    };
    let shown = || text.char_indices().map(shown);
    if shown().eq(text.chars()) { text.into() } else { shown().collect::<String>().into() }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input(text) | Self::NotConverged(text) => f.write_str(text),
            Self::File { path, reason } | Self::Write { path, reason } => write!(f, "{path}: {reason}"),
            Self::Stopped => f.write_str("stopped on request; the checkpoint is written"),
            Self::Internal(text) => write!(f, "internal error: {text}; please report it"),
        }
    }
}

impl std::error::Error for Error {}

/// Why an attempt at an increment was given up; the increment is cut and tried again.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Failure {
    /// In words, with the user's names: what happened and where.
    pub reason: String,
    /// What of, for a diagnosis.
    pub kind: FailureKind,
}

/// What an attempt fails of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum FailureKind {
    /// Anything else.
    #[default]
    Other,
    /// A rigid motion that nothing holds.
    Free,
    /// Cells deform without resistance.
    Hourglass,
    /// A cell is turned inside out.
    Inverted,
    /// The law of a solid has no answer.
    Material,
    /// The iterations do not end.
    Iterations,
    /// Contact states go round in circles.
    Cycle,
    /// Forces or stiffnesses are not finite.
    NotFinite,
    /// The stiffness is lost but for rounding.
    Singular,
    /// Something passed through something, or lies too deep in it.
    Passage,
    /// A tool turns too far in one increment.
    Turn,
    /// Multipliers do not take the penetration out.
    Multipliers,
    /// The step has used up its increments.
    TooMany,
    /// Ranks that run together have come to different things.
    Apart,
    /// A load moves what nothing holds.
    Pushed,
}

impl FailureKind {
    /// All kinds, in this order.
    pub(crate) const ALL: [Self; 15] = [
        Self::Other,
        Self::Free,
        Self::Hourglass,
        Self::Inverted,
        Self::Material,
        Self::Iterations,
        Self::Cycle,
        Self::NotFinite,
        Self::Singular,
        Self::Passage,
        Self::Turn,
        Self::Multipliers,
        Self::TooMany,
        Self::Apart,
        Self::Pushed,
    ];
}

impl Failure {
    /// A failure with its reason in words.
    pub fn new(reason: impl Into<String>) -> Self {
        Self { reason: reason.into(), kind: FailureKind::Other }
    }
    /// The same of a kind.
    pub fn of(self, kind: FailureKind) -> Self {
        Self { kind, ..self }
    }
    /// The same with the name of the place before its reason.
    pub fn at(self, place: impl fmt::Display) -> Self {
        Self { reason: format!("{place}: {}", self.reason), ..self }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.reason)
    }
}

impl std::error::Error for Failure {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_steers_a_terminal_is_shown_as_something_else() {
        assert_eq!(visible("a\u{1b}[31mre\rd\r\n\tend"), "a?[31mre?d\r\n\tend");
        for text in ["\u{9b}2J", "\u{202e}gnp.exe", "plain"] {
            assert_eq!(visible(text).len(), text.len());
            assert!(!visible(text).contains(['\u{9b}', '\u{202e}']));
        }
        assert!(matches!(visible("plain é"), Cow::Borrowed(_)));
    }
}
