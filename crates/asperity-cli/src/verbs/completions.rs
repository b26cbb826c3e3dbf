//! `asperity completions`: what a shell may complete.

use super::{Outcome, print};
use crate::arguments::{Completions, Line};
use clap::CommandFactory;

/// Prints the completions of a shell.
pub fn completions(arguments: &Completions) -> Outcome {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Line::command(), "asperity", &mut script);
    print(&String::from_utf8_lossy(&script))
}
