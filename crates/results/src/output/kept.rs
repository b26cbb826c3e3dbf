//! Checkpoints that are kept besides the last one, how one of them is found again, and a result directory that begins as a
//! copy of another.

use super::checkpoint::{self, Head};
use super::export::{DAT, FRD, XDMF};
use super::file::{self, make_directory};
use super::input::Kept;
use super::results::{CHECKPOINT, probe_tables, series};
use asperity_core::Error;
use std::path::{Path, PathBuf};

/// The folder of kept checkpoints in a result directory.
pub const KEPT: &str = "checkpoints";
/// How their names end.
const END: &str = ".checkpoint";

/// Which checkpoints are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Keep {
    /// The last one.
    #[default]
    Last,
    /// Those at the ends of steps too.
    Steps,
    /// All that are written.
    All,
}

/// From where a run goes on.
#[derive(Debug, Clone, PartialEq)]
pub enum Resume {
    /// From the end of a step, numbered from one.
    Step(usize),
    /// From the last checkpoint up to a time.
    Time(f64),
}

/// The path of the checkpoint that is kept after an increment.
pub fn path_of(directory: &Path, increment: usize) -> PathBuf {
    directory.join(KEPT).join(format!("{increment:06}{END}"))
}

impl Resume {
    /// What a user writes: the name of a step, its number, or a time with a decimal point.
    ///
    /// # Errors
    /// In words, when it is none of them.
    pub fn parse(text: &str, steps: &[&str]) -> Result<Self, String> {
        if let Some(step) = steps.iter().position(|name| *name == text) {
            return Ok(Self::Step(step + 1));
        }
        if let Ok(number) = text.parse::<usize>() {
            let known = (1..=steps.len()).contains(&number);
            let none =
                || format!("there is no step {number}: the deck has {}; a time has a decimal point", steps.len());
            return if known { Ok(Self::Step(number)) } else { Err(none()) };
        }
        match text.parse::<f64>() {
            Ok(time) if time.is_finite() && time >= 0.0 => Ok(Self::Time(time)),
            _ => Err(format!(
                "`{text}` is no step and no time: give the name of a step ({}), its number, or a time with a decimal point",
                steps.join(", ")
            )),
        }
    }

    fn words(&self) -> String {
        match self {
            Self::Step(step) => format!("at the end of step {step}"),
            Self::Time(time) => format!("up to time {time}"),
        }
    }

    /// The checkpoint of a result directory that is meant.
    ///
    /// # Errors
    /// [`Error::File`] with those that are kept, when it is not among them, or one cannot be read.
    pub fn find(&self, directory: &Path) -> Result<PathBuf, Error> {
        let kept = all(directory)?;
        let found = match self {
            Self::Step(step) => kept.iter().find(|(_, head, first)| head.stamp.step == *step as u64 && *first),
            Self::Time(time) => kept.iter().rfind(|(_, head, _)| head.stamp.time <= time * (1.0 + 1e-9)),
        };
        found.map(|(path, ..)| path.clone()).ok_or_else(|| {
            let told = |(_, head, first): &(PathBuf, Head, bool)| match (first, head.stamp.step) {
                (true, step @ 1..) => format!("the end of step {step} (time {})", head.stamp.time),
                _ => format!("time {}", head.stamp.time),
            };
            let told = kept.iter().map(told).collect::<Vec<_>>().join(", ");
            let there = if told.is_empty() { "none is there".to_owned() } else { format!("kept are {told}") };
            let reason = format!(
                "no checkpoint {} is kept: {there}; `output.checkpoints = \"steps\"` keeps those of all steps' ends, \
                 \"all\" every one",
                self.words()
            );
            Error::file(directory, reason)
        })
    }
}

/// All checkpoints of a result directory, by increment, and whether each is the first of its step.
fn all(directory: &Path) -> Result<Vec<(PathBuf, Head, bool)>, Error> {
    let mut paths = of_folder(&directory.join(KEPT))?;
    paths.extend(Some(directory.join(CHECKPOINT)).filter(|path| path.exists()));
    let mut kept = Vec::new();
    for path in paths {
        let (head, of) = checkpoint::read::<Kept>(&path)?;
        kept.push((path, head, of.state.step_increment == 0));
    }
    kept.sort_by_key(|(_, head, _)| head.stamp.increment);
    kept.dedup_by_key(|(_, head, _)| head.stamp.increment);
    Ok(kept)
}

/// The checkpoints in the folder of kept ones.
fn of_folder(folder: &Path) -> Result<Vec<PathBuf>, Error> {
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let failed = |error: std::io::Error| Error::file(folder, error);
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let ours = path.file_name().is_some_and(|name| name.to_string_lossy().ends_with(END));
        paths.extend(Some(path).filter(|_| ours));
    }
    Ok(paths)
}

/// Removes the kept checkpoints after an increment, or all.
///
/// # Errors
/// [`Error::File`] when one cannot be removed.
pub fn drop_after(directory: &Path, increment: Option<usize>) -> Result<(), Error> {
    let folder = directory.join(KEPT);
    for path in of_folder(&folder)? {
        let number = path.file_stem().and_then(|stem| stem.to_string_lossy().parse::<usize>().ok());
        if number.is_some_and(|number| increment.is_none_or(|last| number > last)) {
            std::fs::remove_file(&path).map_err(|error| Error::file(&path, error))?;
        }
    }
    Ok(())
}

/// Single files that a branch takes over, besides what its probes have read.
const TABLES: [&str; 7] = ["history.csv", "certificate.csv", "increments.csv", "iterations.csv", FRD, XDMF, DAT];

/// Makes `to` a copy of the results in `from`, for a branch: tables, files for other programs, frames, and `checkpoint` as its
/// only one. Frames are never written twice, so that they are linked where the file system can.
///
/// # Errors
/// [`Error::File`] or [`Error::Write`] when something cannot be read or written.
pub fn branch(from: &Path, to: &Path, checkpoint: &Path) -> Result<(), Error> {
    make_directory(to)?;
    let copy = |name: &str| {
        let (source, target) = (from.join(name), to.join(name));
        file::remove(to, [name.to_owned()])?;
        if source.exists() {
            std::fs::copy(&source, &target).map_err(|error| Error::write(&target, error))?;
        }
        Ok::<_, Error>(())
    };
    for folder in series() {
        copy(&format!("{folder}.pvd"))?;
        let source = from.join(folder);
        if !source.is_dir() {
            continue;
        }
        make_directory(&to.join(folder))?;
        for entry in std::fs::read_dir(&source).map_err(|error| Error::file(&source, error))? {
            let entry = entry.map_err(|error| Error::file(&source, error))?;
            let target = to.join(folder).join(entry.file_name());
            if target.exists() {
                std::fs::remove_file(&target).map_err(|error| Error::file(&target, error))?;
            }
            let copied =
                std::fs::hard_link(entry.path(), &target).or_else(|_| std::fs::copy(entry.path(), &target).map(drop));
            copied.map_err(|error| Error::write(&target, error))?;
        }
    }
    file::remove(to, probe_tables(to))?;
    TABLES.iter().try_for_each(|name| copy(name))?;
    probe_tables(from).iter().try_for_each(|name| copy(name))?;
    drop_after(to, None)?;
    let target = to.join(CHECKPOINT);
    std::fs::copy(checkpoint, &target).map_err(|error| Error::write(&target, error)).map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn where_a_run_goes_on_from() {
        let steps = ["clamp", "draw"];
        assert_eq!(Resume::parse("draw", &steps), Ok(Resume::Step(2)));
        assert_eq!(Resume::parse("1", &steps), Ok(Resume::Step(1)));
        assert_eq!(Resume::parse("1.0", &steps), Ok(Resume::Time(1.0)));
        assert!(Resume::parse("3", &steps).unwrap_err().contains("no step 3"));
        assert!(Resume::parse("drow", &steps).unwrap_err().contains("clamp, draw"));
        assert!(Resume::parse("nan", &steps).is_err());
    }

    #[test]
    fn what_is_not_kept_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let told = Resume::Step(1).find(folder.path()).unwrap_err().to_string();
        assert!(told.contains("none is there") && told.contains("output.checkpoints"), "{told}");
    }
}
