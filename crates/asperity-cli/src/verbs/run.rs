//! `asperity run` and `asperity restart`: solve a deck and write its results.

use super::{Outcome, claim, made, made_quietly, print, results_of, translate};
use crate::arguments;
use crate::exit::{Exit, Trouble};
use crate::ranks;
use crate::screen::{Screen, Voice, farewell};
use crate::signals::Interrupts;
use asperity::Error;
use asperity::deck::Made;
#[cfg(feature = "cluster")]
use asperity::output::Simulation;
use asperity::output::{CHECKPOINT, Job, Resume, RunStatus, SUMMARY, Start, Summary, branch, resumed, simulate};
use serde_json::json;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

/// Runs a deck from its beginning.
pub fn run(arguments: &arguments::Run, interrupts: &Interrupts) -> Outcome {
    solve(arguments, interrupts, None)
}

/// Goes on from a checkpoint in the result directory, or from one of another in a branch.
pub fn restart(arguments: &arguments::Restart, interrupts: &Interrupts) -> Outcome {
    solve(&arguments.run, interrupts, Some(arguments))
}

/// Where a run goes on: the directory of the results and the checkpoint in it, which fits.
fn source(restart: &arguments::Restart, made: &Made) -> Result<(PathBuf, PathBuf), Error> {
    let source = restart.of.clone().unwrap_or_else(|| results_in(&restart.run));
    let steps: Vec<&str> = made.model.problem.steps.iter().map(|step| step.name.as_str()).collect();
    let meant = restart.from.as_deref().map(|from| Resume::parse(from, &steps)).transpose();
    let path = match meant.map_err(|reason| Error::Input(format!("--from: {reason}")))? {
        Some(meant) => meant.find(&source)?,
        None => Job::checkpoint_in(&source)?,
    };
    resumed(&path, &made.model.problem, &made.parts)?;
    Ok((source, path))
}

/// The checkpoint in the result directory of a run that goes on; a branch takes it over first.
fn taken((source, path): (PathBuf, PathBuf), directory: &Path) -> Result<PathBuf, Error> {
    if source.canonicalize().ok() == directory.canonicalize().ok() {
        return Ok(path);
    }
    branch(&source, directory, &path)?;
    Ok(directory.join(CHECKPOINT))
}

/// Whether there is a run to go on with. A new directory in `--out` needs `--of`, which says with which.
fn there_is_a_checkpoint(restart: &arguments::Restart) -> Result<(), Error> {
    let directory = restart.of.clone().unwrap_or_else(|| results_in(&restart.run));
    let beside = results_of(&restart.run.deck.path);
    let elsewhere = restart.of.is_none() && restart.run.out.is_some() && Job::checkpoint_in(&beside).is_ok();
    Job::checkpoint_in(&directory).map(drop).map_err(|error| match elsewhere {
        true => {
            let (there, beside) = (directory.display(), beside.display());
            Error::Input(format!(
                "{there} holds no run to go on with: `--out` is where results go; say `--of {beside}` to branch of the run there"
            ))
        }
        false => error,
    })
}

/// The result directory of a run.
fn results_in(arguments: &arguments::Run) -> PathBuf {
    arguments.out.clone().unwrap_or_else(|| results_of(&arguments.deck.path))
}

/// The command that goes on from the checkpoint, as a shell takes it, with one more setting if there is one.
fn again(arguments: &arguments::Run, more: Option<&str>) -> String {
    let sets = arguments.deck.sets.iter().map(String::as_str).chain(more);
    let sets = sets.flat_map(|set| ["--set".to_owned(), set.to_owned()]);
    let out = arguments.out.iter().flat_map(|out| ["--out".to_owned(), out.display().to_string()]);
    let deck = arguments.deck.path.display().to_string();
    let words = ["asperity".to_owned(), "restart".to_owned(), deck].into_iter().chain(sets).chain(out);
    words.map(|word| quoted(&word)).collect::<Vec<_>>().join(" ")
}

/// A word in quotes where a shell would read more in it than letters.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "._-/=+:,@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

/// Threads a processor that can still take turns.
const MOST_THREADS: usize = 32;

/// Limits the threads, before the deck is read: what comes first in need of threads decides their number.
fn set_threads(arguments: &arguments::Run) -> Result<(), Error> {
    let Some(threads) = arguments.threads else { return Ok(()) };
    let most = MOST_THREADS * std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    if threads.get() > most {
        return Err(Error::Input(format!("{threads} threads are too many for this machine: give at most {most}")));
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.get()).build_global();
    pool.map_err(|error| {
        Error::Input(format!("no {threads} threads, for want of memory or of processes allowed: {error}"))
    })
}

/// What a rank does that is not the first: it solves what that one solves, and writes nothing.
#[cfg(feature = "cluster")]
pub fn follow(arguments: &arguments::Run, restart: Option<&arguments::Restart>) -> Outcome {
    /// Stops with the others.
    struct Follower;
    impl asperity::solve::Observer for Follower {
        fn stops(&self, _: bool) -> bool {
            ranks::any(false)
        }
    }
    set_threads(arguments)?;
    let (made, _) = made_quietly(&arguments.deck)?;
    let problem = &made.model.problem;
    let state = match restart {
        Some(restart) => resumed(&source(restart, &made)?.1, problem, &made.parts)?.0,
        None => problem.initial_state(),
    };
    // Only now may the first change what is in the directory.
    ranks::any(false);
    let mut simulation = Simulation::in_memory(&made.model, state, &made.deck.limits.limits, &[])?;
    let ended = rayon::scope(|_| {
        loop {
            match simulation.advance(&mut Follower) {
                Ok(Some(_)) => {}
                Ok(None) => break Ok(Exit::Done),
                Err(error) => break Err(error.into()),
            }
        }
    });
    ranks::arrive();
    ended
}

fn solve(arguments: &arguments::Run, interrupts: &Interrupts, restart: Option<&arguments::Restart>) -> Outcome {
    set_threads(arguments)?;
    if let Some(restart) = restart {
        there_is_a_checkpoint(restart)?;
    }
    let voice = if arguments.quiet {
        Voice::Quiet
    } else if arguments.json {
        Voice::Json
    } else {
        Voice::Page
    };
    let (made, translated) =
        if voice == Voice::Quiet { made_quietly(&arguments.deck)? } else { made(&arguments.deck)? };
    let notes: Vec<String> = made.diagnostics.list.iter().map(|warning| warning.what.clone()).collect();
    let source = restart.map(|restart| source(restart, &made)).transpose()?;
    ranks::any(false);
    let (directory, _claim) = claim(arguments.out.as_deref(), &arguments.deck.path)?;
    if let Some(translated) = translated {
        translated.write(&directory.join(format!("{}.toml", translate::stem(&arguments.deck.path))))?;
    }
    let (options, limits) = (made.results.clone(), &made.deck.limits.limits);
    let facts = asperity::deck::facts(&made);
    let checkpoint = source.map(|source| taken(source, &directory)).transpose()?;
    let start = checkpoint.as_deref().map_or(Start::Beginning, Start::Kept);
    let (input, parts, asked) = (made.input, &made.parts[..], made.asked());
    let (notes, facts) = (&notes, &facts);
    let job = Job { directory: &directory, options, input, parts, asked: Some(&asked), start, limits, notes, facts };
    let mut screen = Screen::new(&made.model.problem, interrupts.heed()).speaking(voice);
    screen.begin(&made.model.title, &directory);
    // On a thread of the pool: from outside, every parallel loop would hand over to it and wait.
    let simulated = rayon::scope(|_| simulate(&made.model, &job, &mut screen));
    screen.close();
    let (mut summary, ended) = simulated?;
    // A restart of a run that had come to its end writes nothing, but for a note that only the screen gets.
    let written = Summary::read(&directory.join(SUMMARY)).is_ok_and(|told| told.notes == summary.notes);
    if !arguments.no_report && written && summary.status != RunStatus::FileError {
        report::conclude(&mut summary, &directory);
    }
    match voice {
        Voice::Page => {
            // What was told before the run is not told once more.
            let mut told = summary.clone();
            told.notes.retain(|note| !notes.contains(note));
            print(&farewell(&told, &directory, &|more| again(arguments, more)))?
        }
        Voice::Json => print(&format!("{}\n", json!({ "event": "end", "directory": directory, "summary": summary })))?,
        Voice::Quiet => Exit::Done,
    };
    let exit = if summary.status == RunStatus::Doubtful { Exit::Doubtful } else { Exit::Done };
    ended.map(|()| exit).map_err(Trouble::from)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arguments::{Command, Line};
    use clap::Parser;

    #[test]
    fn the_command_that_goes_on_says_all_that_was_said() {
        let words = ["asperity", "run", "my deck.toml", "--set", "step.push.increments={count=4}", "--out", "here"];
        let Command::Run(run) = Line::parse_from(words).command else { panic!("not a run") };
        assert_eq!(
            again(&run, None),
            "asperity restart 'my deck.toml' --set 'step.push.increments={count=4}' --out here"
        );
        assert_eq!(quoted("it's"), r"'it'\''s'");
    }
}
