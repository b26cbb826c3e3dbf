//! `asperity check`: everything that can be said before solving.

use super::{Outcome, loaded, print};
use crate::arguments::Check;
use crate::exit::{Exit, tell};
use asperity::deck::{self, Diagnostics};

/// Makes the model, prints what it is and what wants attention. Exit code 5 when something does.
pub fn check(arguments: &Check) -> Outcome {
    let (mut loaded, translated) = loaded(&arguments.deck)?;
    if let Some(translated) = translated {
        tell(&translated.notes());
    }
    // A cluster has its own program and memory.
    loaded.elsewhere = arguments.ranks.is_some();
    let made = deck::build(loaded)?;
    let review = deck::review_for(&made, arguments.ranks)?;
    print(&review.text)?;
    let exit = if review.problems.is_empty() { Exit::Done } else { Exit::Problems };
    tell(&Diagnostics { list: review.problems, ..made.diagnostics });
    Ok(exit)
}
