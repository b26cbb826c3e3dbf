//! What may stand on the command line.

use asperity::output::figure::{FigureOptions, Window};
use clap::{Args, Parser, Subcommand};
use clap_complete::Shell;
use std::num::NonZeroUsize;
use std::path::PathBuf;

/// Implicit finite elements for contact with friction under large displacements and strains.
#[derive(Debug, Parser)]
#[command(name = "asperity", version, arg_required_else_help = true, after_help = EXITS)]
pub struct Line {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

const EXITS: &str = "Exit codes: 0 done, 1 fault of the program or results that cannot be written, 2 wrong input, \
                     3 not converged, 4 stopped on request, 5 check found problems, 6 a run was completed but its \
                     certificate is doubtful.";

/// The verbs.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Solve a deck and write its results.
    Run(Run),
    /// Go on from a checkpoint in a deck's result directory, with the deck as it was or with what lies ahead changed.
    Restart(Restart),
    /// Draw the pictures of a finished run anew.
    Figure(Figure),
    /// Write the report of a run, one page of HTML, from its results.
    Report(Report),
    /// Serve the report of a run that goes, on this machine only, with curves that grow.
    Watch(Watch),
    /// Say everything that can be said about a deck before it is solved.
    Check(Check),
    /// Say what a mesh file holds, and what is wrong with it.
    Info(Info),
    /// Translate an input deck of Abaqus or CalculiX into a deck to read and to change.
    Translate(Translate),
    /// Drive laws of solids along a path of strains and stresses, or those of interfaces along a path of slip.
    Point(Point),
    /// List every law with its parameters.
    Laws,
    /// Say what the penalties of contacts are worth.
    #[command(subcommand)]
    Penalty(PenaltyCommand),
    /// Print the JSON Schema of decks, for editors, or the manual's page of all keys.
    Schema(Schema),
    /// Print the completions of a shell.
    Completions(Completions),
}

/// A deck and what is changed in it.
#[derive(Debug, Args)]
pub struct Deck {
    /// The deck, a TOML file; or an input deck of Abaqus or CalculiX (.inp), which is translated first.
    #[arg(value_name = "DECK")]
    pub path: PathBuf,
    /// Change one value of the deck: --set step.push.duration=2. May be given many times.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub sets: Vec<String>,
}

/// Arguments of `run` and `restart`.
#[derive(Debug, Args)]
pub struct Run {
    /// The deck.
    #[command(flatten)]
    pub deck: Deck,
    /// The result directory; by default NAME.results here for a deck NAME.toml.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Threads to use; by default all. Results do not depend on it.
    #[arg(long, value_name = "N")]
    pub threads: Option<NonZeroUsize>,
    /// Print errors only.
    #[arg(long, short, conflicts_with = "json")]
    pub quiet: bool,
    /// Print events as lines of JSON: `begin`, `iteration`, `attempt`, `end`.
    #[arg(long)]
    pub json: bool,
    /// Write no report.html at the end.
    #[arg(long)]
    pub no_report: bool,
}

/// Arguments of `restart`.
#[derive(Debug, Args)]
pub struct Restart {
    /// What is run.
    #[command(flatten)]
    pub run: Run,
    /// Go on from the end of a step, by its name or number, or from the last checkpoint up to a time, with a decimal point;
    /// what came after it is dropped. `output.checkpoints` says which are kept.
    #[arg(long, value_name = "STEP|TIME")]
    pub from: Option<String>,
    /// Branch: go on from the results in this directory, which stay as they are; those up to there are taken over.
    #[arg(long, value_name = "DIR")]
    pub of: Option<PathBuf>,
}

/// Arguments of `report`.
#[derive(Debug, Args)]
pub struct Report {
    /// The result directory.
    #[arg(value_name = "DIR")]
    pub directory: PathBuf,
}

/// Arguments of `watch`.
#[derive(Debug, Args)]
pub struct Watch {
    /// The result directory.
    #[arg(value_name = "DIR")]
    pub directory: PathBuf,
    /// The port of 127.0.0.1; by default one that is free.
    #[arg(long, value_name = "PORT", default_value_t = 0)]
    pub port: u16,
    /// Print the address alone, without the full-screen view, as where there is no terminal.
    #[arg(long)]
    pub plain: bool,
}

/// Arguments of `figure`.
#[derive(Debug, Args)]
pub struct Figure {
    /// The result directory.
    #[arg(value_name = "DIR")]
    pub directory: PathBuf,
    /// Times of the frames to show side by side; by default four, evenly over the run.
    #[arg(long, value_name = "TIME,..", value_delimiter = ',')]
    pub at: Vec<f64>,
    /// What of the plane is shown; by default everything.
    #[arg(long, value_name = "X0,X1,Y0,Y1", value_parser = window, allow_hyphen_values = true)]
    pub window: Option<Window>,
    /// Pixels of the PNG a point of the page.
    #[arg(long, value_name = "NUMBER", default_value_t = FigureOptions::default().resolution)]
    pub resolution: f64,
    /// Draw one quantity of the nodes in a picture of its own: `von_mises_averaged`, `displacement.y`, `displacement` (its
    /// length), `cauchy_stress_averaged.xy`.
    #[arg(long, value_name = "NAME")]
    pub quantity: Option<String>,
    /// Draw a film of this quantity, or of the equivalent stress, as an animated PNG: all written frames, 100 at most, or
    /// those of `--at`.
    #[arg(long)]
    pub film: bool,
}

/// Arguments of `check`.
#[derive(Debug, Args)]
pub struct Check {
    /// The deck.
    #[command(flatten)]
    pub deck: Deck,
    /// Predict the memory of each of N ranks of a cluster (`mpirun -n N asperity run DECK`) in place of that of a run on this
    /// machine; in programs without the part for clusters, too.
    #[arg(long, value_name = "N", value_parser = ranks)]
    pub ranks: Option<NonZeroUsize>,
}

/// Arguments of `info`.
#[derive(Debug, Args)]
pub struct Info {
    /// A mesh file, or an input deck.
    #[arg(value_name = "MESH")]
    pub mesh: PathBuf,
}

/// Arguments of `translate`.
#[derive(Debug, Args)]
pub struct Translate {
    /// The input deck.
    #[arg(value_name = "INPUT.inp")]
    pub input: PathBuf,
    /// The deck to write, its mesh beside it; by default NAME.toml and NAME.mesh.inp here for an input deck NAME.inp.
    #[arg(long, value_name = "DECK.toml")]
    pub out: Option<PathBuf>,
}

/// Arguments of `point`.
#[derive(Debug, Args)]
pub struct Point {
    /// The deck.
    #[command(flatten)]
    pub deck: Deck,
    /// Compare the tangents of laws of solids along the path with differences, and say how far they are off.
    #[arg(long)]
    pub tangent: bool,
    /// The result directory; by default NAME.results here for a deck NAME.toml.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// What may be asked about penalties.
#[derive(Debug, Subcommand)]
pub enum PenaltyCommand {
    /// Run a deck with its penalties and with softer ones, and print the forces of a rigid interface with their errors.
    Study(Study),
}

/// Arguments of `penalty study`.
#[derive(Debug, Args)]
pub struct Study {
    /// The deck.
    #[command(flatten)]
    pub deck: Deck,
    /// How many times softer the softer penalties are, more than 1.
    #[arg(long, value_name = "NUMBER", default_value_t = 4.0, value_parser = above_one)]
    pub ratio: f64,
}

/// Arguments of `schema`.
#[derive(Debug, Args)]
pub struct Schema {
    /// Print the manual's page of all keys, in Markdown.
    #[arg(long)]
    pub manual: bool,
    /// Print the manual's page of the keywords of input decks.
    #[arg(long, conflicts_with_all = ["manual", "point", "interface"])]
    pub keywords: bool,
    /// Of the decks of `point` for solids instead.
    #[arg(long, conflicts_with = "interface")]
    pub point: bool,
    /// Of the decks of `point` for interfaces instead.
    #[arg(long)]
    pub interface: bool,
}

/// Arguments of `completions`.
#[derive(Debug, Args)]
pub struct Completions {
    /// The shell.
    pub shell: Shell,
}

fn above_one(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number > 1.0 && number.is_finite() => Ok(number),
        _ => Err("a number above 1 is needed".into()),
    }
}

fn ranks(text: &str) -> Result<NonZeroUsize, String> {
    text.parse().map_err(|_| "a whole number of ranks is needed, 1 or more".into())
}

fn window(text: &str) -> Result<Window, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|number| number.trim().parse::<f64>()).collect();
    match numbers.map_err(|error| error.to_string())?.as_slice() {
        &[x0, x1, y0, y1] if x0 < x1 && y0 < y1 => Ok(Window { low: [x0, y0], high: [x1, y1] }),
        [_, _, _, _] => Err("the first of each pair must be the smaller one".into()),
        _ => Err("four numbers are needed, with commas between them".into()),
    }
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
