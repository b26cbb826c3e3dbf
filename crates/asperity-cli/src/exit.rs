//! How the program ends.

use asperity::Error;
use asperity::deck::Diagnostics;
use asperity::error::visible;
use std::io::IsTerminal;
use std::process::ExitCode;

/// How the program ends: scripts read the number, people the messages before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exit {
    /// Done; a run has converged to its end.
    Done = 0,
    /// A fault of the program itself, or of the system under it: a full disk.
    Fault = 1,
    /// The input is wrong.
    Input = 2,
    /// The increments shrank to nothing.
    NotConverged = 3,
    /// Stopped on request; the checkpoint is written.
    Stopped = 4,
    /// `check` found problems.
    Problems = 5,
    /// A run was completed, and a figure of its certificate is beyond its limit.
    Doubtful = 6,
}

/// What ends a verb early.
#[derive(Debug)]
pub enum Trouble {
    /// Messages about a deck.
    Deck(Diagnostics),
    /// Anything else.
    Other(Error),
}

impl From<Diagnostics> for Trouble {
    fn from(diagnostics: Diagnostics) -> Self {
        Self::Deck(diagnostics)
    }
}

impl From<Error> for Trouble {
    fn from(error: Error) -> Self {
        Self::Other(error)
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        ExitCode::from(exit as u8)
    }
}

impl Exit {
    /// Tells the user what ended the verb, and how the program ends for it.
    pub fn after(trouble: Trouble) -> Self {
        match &trouble {
            Trouble::Deck(diagnostics) => tell(diagnostics),
            // The page at the end of the run has said so.
            Trouble::Other(Error::Stopped) => {}
            Trouble::Other(error) => eprintln!("error: {}", visible(&error.to_string())),
        }
        Self::of_trouble(&trouble)
    }

    /// How the program ends for a trouble.
    pub fn of_trouble(trouble: &Trouble) -> Self {
        match trouble {
            Trouble::Deck(_) => Self::Input,
            Trouble::Other(error) => Self::of(error),
        }
    }

    fn of(error: &Error) -> Self {
        match error {
            Error::Input(_) | Error::File { .. } => Self::Input,
            Error::NotConverged(_) => Self::NotConverged,
            Error::Stopped => Self::Stopped,
            Error::Write { .. } | Error::Internal(_) => Self::Fault,
        }
    }
}

/// Prints messages on standard error, in colour for a person.
pub fn tell(diagnostics: &Diagnostics) {
    if !diagnostics.list.is_empty() {
        let colour = std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
        eprintln!("{}\n", diagnostics.render(colour));
    }
}
