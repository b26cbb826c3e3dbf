//! The verbs, one file each.

mod check;
mod completions;
mod info;
mod schema;

pub use check::check;
pub use completions::completions;
pub use info::info;
pub use schema::schema;

use crate::exit::{Exit, Trouble};
use std::io::{ErrorKind, Write};

/// How a verb ends.
pub type Outcome = Result<Exit, Trouble>;

/// Prints on standard output. A reader that has seen enough (`| head`) is no fault.
fn print(text: &str) -> Outcome {
    match std::io::stdout().write_all(text.as_bytes()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(asperity::Error::file("standard output", error).into())
        }
        _ => Ok(Exit::Done),
    }
}
