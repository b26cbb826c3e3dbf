//! `asperity run` and `asperity restart`: solve a deck and write its results.

use super::{Outcome, made, print, results_of};
use crate::arguments;
use crate::exit::{Exit, Trouble};
use crate::screen::{Screen, farewell};
use crate::signals;
use asperity::output::{Job, Start, simulate};

/// Runs a deck from its beginning.
pub fn run(arguments: &arguments::Run) -> Outcome {
    solve(arguments, Start::Beginning)
}

/// Goes on from the checkpoint in the result directory.
pub fn restart(arguments: &arguments::Run) -> Outcome {
    solve(arguments, Start::Checkpoint)
}

fn solve(arguments: &arguments::Run, start: Start) -> Outcome {
    // Before anything else: what comes first in need of threads decides their number.
    if let Some(threads) = arguments.threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.get()).build_global();
        pool.map_err(|error| asperity::Error::Internal(error.to_string()))?;
    }
    let made = made(&arguments.deck)?;
    let notes: Vec<String> = made.diagnostics.list.iter().map(|warning| warning.what.clone()).collect();
    let stop = signals::listen()?;
    let directory = arguments.out.clone().unwrap_or_else(|| results_of(&arguments.deck.path));
    let job =
        Job { directory: &directory, options: made.deck.output.options(), input: made.input, start, notes: &notes };
    let mut screen = Screen::new(&made.model.problem, stop);
    // On a thread of the pool: from outside, every parallel loop would hand over to it and wait.
    let simulated = rayon::scope(|_| simulate(&made.model, &job, &mut screen));
    screen.close();
    let (summary, ended) = simulated?;
    print(&farewell(&summary, &directory))?;
    ended.map(|()| Exit::Done).map_err(Trouble::from)
}
