//! The verbs, one file each.

mod check;
mod completions;
mod figure;
mod info;
mod laws;
mod penalty;
mod point;
mod report;
mod run;
mod schema;
mod translate;
mod watch;

pub use check::check;
pub use completions::completions;
pub use figure::figure;
pub use info::info;
pub use laws::laws;
pub use penalty::penalty;
pub use point::point;
pub use report::report;
#[cfg(feature = "cluster")]
pub use run::follow;
pub use run::{restart, run};
pub use schema::schema;
pub use translate::translate;
pub use watch::watch;

use crate::arguments;
use crate::exit::{Exit, Trouble, tell};
use asperity::deck::{self, Loaded, Made};
use asperity::error::visible;
use asperity::output::{Others, ResultsClaim};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use translate::Translated;

/// How a verb ends.
pub type Outcome = Result<Exit, Trouble>;

/// Prints on standard output. A reader that has seen enough (`| head`) is no fault.
fn print(text: &str) -> Outcome {
    match std::io::stdout().write_all(visible(text).as_bytes()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(asperity::Error::file("standard output", error).into())
        }
        _ => Ok(Exit::Done),
    }
}

/// Reads a deck; an input deck is translated first.
fn loaded(arguments: &arguments::Deck) -> Result<(Loaded, Option<Translated>), Trouble> {
    if !translate::is_input(&arguments.path) {
        return Ok((deck::load(&arguments.path, &arguments.sets)?, None));
    }
    let translated = translate::translated(&arguments.path, &arguments.path)?;
    Ok((translated.load(&arguments.sets)?, Some(translated)))
}

/// Reads a deck and makes its model; warnings are told, notes are for `check`.
fn made(arguments: &arguments::Deck) -> Result<(Made, Option<Translated>), Trouble> {
    made_quietly(arguments).inspect(|(made, translated)| {
        if let Some(translated) = translated {
            tell(&translated.notes());
        }
        tell(&made.diagnostics);
    })
}

/// The same without a word about warnings.
fn made_quietly(arguments: &arguments::Deck) -> Result<(Made, Option<Translated>), Trouble> {
    let (loaded, translated) = loaded(arguments)?;
    let mut made = deck::build(loaded)?;
    made.diagnostics.list = deck::warnings(&made);
    Ok((made, translated))
}

/// The result directory of a deck, which is claimed for it.
fn claim(out: Option<&Path>, deck: &Path) -> Result<(PathBuf, ResultsClaim), asperity::Error> {
    let directory = out.map_or_else(|| results_of(deck), Path::to_path_buf);
    let claim = ResultsClaim::take(&directory, deck, if out.is_some() { Others::Replace } else { Others::Spare })?;
    Ok((directory, claim))
}

/// `tube.results` beside the user, for a deck `anywhere/tube.toml`.
fn results_of(deck: &Path) -> PathBuf {
    let mut name = deck.file_stem().unwrap_or_default().to_os_string();
    name.push(".results");
    PathBuf::from(name)
}
