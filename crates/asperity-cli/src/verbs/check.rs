//! `asperity check`: everything that can be said before solving.

use super::{Outcome, print};
use crate::arguments::Check;
use crate::exit::{Exit, tell};
use std::fmt::Write;

/// Reads the deck, prints what it makes, and what was not said.
pub fn check(arguments: &Check) -> Outcome {
    let loaded = asperity::deck::load(&arguments.deck.path, &arguments.deck.sets)?;
    tell(&loaded.diagnostics);
    let mut text = String::from("not said in the deck, and what holds instead:\n");
    for unsaid in &loaded.unsaid {
        // Writing into a String cannot fail.
        let _ = writeln!(text, "  {} = {}", unsaid.path, unsaid.instead);
    }
    print(&text)?;
    Ok(if loaded.diagnostics.list.is_empty() { Exit::Done } else { Exit::Problems })
}
