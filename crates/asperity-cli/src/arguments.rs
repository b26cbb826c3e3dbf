//! What may stand on the command line.

use clap::{Args, Parser, Subcommand};
use clap_complete::Shell;
use std::path::PathBuf;

/// Implicit finite elements for contact with friction under large displacements and strains.
#[derive(Debug, Parser)]
#[command(name = "asperity", version, arg_required_else_help = true, after_help = EXITS)]
pub struct Line {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

const EXITS: &str = "Exit codes: 0 done, 1 fault of the program, 2 wrong input, 3 not converged, 4 stopped on \
                     request, 5 check found problems.";

/// The verbs.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Say everything that can be said about a deck before it is solved.
    Check(Check),
    /// Say what a mesh file holds, and what is wrong with it.
    Info(Info),
    /// Print the JSON Schema of decks, for editors, or the manual's page of all keys.
    Schema(Schema),
    /// Print the completions of a shell.
    Completions(Completions),
}

/// A deck and what is changed in it.
#[derive(Debug, Args)]
pub struct Deck {
    /// The deck, a TOML file.
    #[arg(value_name = "DECK")]
    pub path: PathBuf,
    /// Change one value of the deck: --set step.push.duration=2. May be given many times.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub sets: Vec<String>,
}

/// Arguments of `check`.
#[derive(Debug, Args)]
pub struct Check {
    /// The deck.
    #[command(flatten)]
    pub deck: Deck,
}

/// Arguments of `info`.
#[derive(Debug, Args)]
pub struct Info {
    /// A mesh file.
    #[arg(value_name = "MESH")]
    pub mesh: PathBuf,
}

/// Arguments of `schema`.
#[derive(Debug, Args)]
pub struct Schema {
    /// Print the manual's page of all keys, in Markdown.
    #[arg(long)]
    pub manual: bool,
}

/// Arguments of `completions`.
#[derive(Debug, Args)]
pub struct Completions {
    /// The shell.
    pub shell: Shell,
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_arguments_are_consistent() {
        Line::command().debug_assert();
    }
}
