//! What can go wrong: an [`Error`] stops the run, a [`Failure`] only cuts the increment. Layer 0, used by all rooms.

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
    /// A file that cannot be read or written.
    pub fn file(path: impl AsRef<std::path::Path>, reason: impl fmt::Display) -> Self {
        Self::File { path: path.as_ref().display().to_string(), reason: reason.to_string() }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input(text) | Self::NotConverged(text) => f.write_str(text),
            Self::File { path, reason } => write!(f, "{path}: {reason}"),
            Self::Stopped => f.write_str("stopped on request; the checkpoint is written"),
            Self::Internal(text) => write!(f, "internal error: {text}; please report it"),
        }
    }
}

impl std::error::Error for Error {}

/// Why an attempt at an increment was given up; the increment is cut and tried again.
#[derive(Debug, Clone, PartialEq)]
pub struct Failure {
    /// In words, with the user's names: what happened and where.
    pub reason: String,
}

impl Failure {
    /// A failure with its reason in words.
    pub fn new(reason: impl Into<String>) -> Self {
        Self { reason: reason.into() }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.reason)
    }
}

impl std::error::Error for Failure {}
