//! `status.json`: where a run stands, replaced in one step after every attempt at an increment; and files by which another
//! process asks something of the run.

use super::certificate::Occasion;
use super::file::{self, Durability, write_atomic};
use super::summary::RunStatus;
use asperity_core::Error;
use asperity_core::solve::{AttemptRecord, Problem};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::time::{Instant, SystemTime, UNIX_EPOCH};

/// Name of the status in the result directory.
pub const PROGRESS: &str = "status.json";

/// The content of `status.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Progress {
    /// How the run stands, as in `summary.json`.
    pub status: RunStatus,
    /// The process that runs.
    pub process: u32,
    /// Name of the step.
    pub step: String,
    /// Number of the step, from one.
    pub step_number: usize,
    /// Steps there are.
    pub steps: usize,
    /// Accepted increments.
    pub increment: usize,
    /// Time of the last accepted increment.
    pub time: f64,
    /// Time at the end of the last step.
    pub end_time: f64,
    /// Length of the last attempt.
    pub dt: f64,
    /// Iterations of the last attempt.
    pub last_iterations: usize,
    /// Newton iterations, those of rejected attempts included.
    pub iterations: usize,
    /// Attempts that were cut.
    pub cuts: usize,
    /// Why the last cut was made.
    pub last_cut: Option<String>,
    /// Unknown with the largest unbalanced force in the last iteration.
    pub worst_unknown: String,
    /// Figures of the certificate that are beyond their limits.
    pub beyond: Vec<String>,
    /// The figure nearest to its limit or farthest beyond, where and when.
    pub worst: Option<(String, Occasion)>,
    /// Seconds since the run began, in this process.
    pub elapsed: f64,
    /// Seconds until its end, if time goes on as it did since the run began here; null where nothing is known yet.
    pub remaining: Option<f64>,
    /// When this was written, in seconds since 1970.
    pub written: u64,
}

/// Keeps `status.json` of a run.
#[derive(Debug)]
pub struct Reporter {
    path: PathBuf,
    begun: Instant,
    /// Time of the model when this process took it up.
    from: Option<f64>,
    /// What the file says.
    pub progress: Progress,
}

/// What another process may ask of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Request {
    /// A checkpoint, and the end.
    Stop,
    /// A checkpoint after this increment.
    Checkpoint,
}

impl Reporter {
    /// The status of a run that begins or goes on.
    pub fn new(directory: &Path, problem: &Problem) -> Self {
        let progress = Progress {
            status: RunStatus::Running,
            process: std::process::id(),
            step: problem.steps.first().map_or_else(String::new, |step| step.name.clone()),
            step_number: 1,
            steps: problem.steps.len(),
            increment: 0,
            time: 0.0,
            end_time: problem.steps.iter().map(|step| step.duration).sum(),
            dt: 0.0,
            last_iterations: 0,
            iterations: 0,
            cuts: 0,
            last_cut: None,
            worst_unknown: String::new(),
            beyond: Vec::new(),
            worst: None,
            elapsed: 0.0,
            remaining: None,
            written: 0,
        };
        Self { path: directory.join(PROGRESS), begun: Instant::now(), from: None, progress }
    }

    /// Takes an attempt.
    pub fn attempt(&mut self, problem: &Problem, record: &AttemptRecord) {
        let progress = &mut self.progress;
        self.from.get_or_insert(record.time - record.dt);
        progress.step = problem.steps.get(record.step).map_or_else(String::new, |step| step.name.clone());
        (progress.step_number, progress.dt) = (record.step + 1, record.dt);
        progress.last_iterations = record.solutions();
        progress.iterations += record.solutions();
        progress.worst_unknown =
            record.iterations.last().map_or_else(String::new, |last| problem.name_of(last.worst.dof));
        match &record.failure {
            Some(why) => {
                progress.cuts += 1;
                progress.last_cut = Some(why.clone());
            }
            None => (progress.increment, progress.time) = (record.increment, record.time),
        }
        progress.elapsed = self.begun.elapsed().as_secs_f64();
        let done = progress.time - self.from.unwrap_or(0.0);
        let left = (progress.end_time - progress.time).max(0.0);
        progress.remaining = (done > 0.0).then(|| progress.elapsed * left / done);
    }

    /// Writes the file.
    ///
    /// # Errors
    /// [`Error::Write`] when it cannot be written.
    pub fn write(&mut self) -> Result<(), Error> {
        self.progress.written = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
        let bytes = serde_json::to_vec(&self.progress).map_err(|error| Error::file(&self.path, error))?;
        write_atomic(&self.path, &bytes, Durability::Process)
    }
}

impl Progress {
    /// Reads the status of a result directory.
    ///
    /// # Errors
    /// [`Error::File`] when there is none, or it is damaged.
    pub fn read(directory: &Path) -> Result<Self, Error> {
        let path = directory.join(PROGRESS);
        serde_json::from_slice(&file::read(&path)?).map_err(|error| Error::file(&path, error))
    }
}

impl Request {
    /// Each request has a file of its own, so that one cannot take away another.
    pub const ALL: [Self; 2] = [Self::Stop, Self::Checkpoint];

    /// The name of its file in the result directory; what the file holds is not read.
    pub fn file(self) -> &'static str {
        match self {
            Self::Stop => "stop.request",
            Self::Checkpoint => "checkpoint.request",
        }
    }
    /// Leaves the request in a result directory; the run there finds it after its increment.
    ///
    /// # Errors
    /// [`Error::Write`] when it cannot be written.
    pub fn leave(self, directory: &Path) -> Result<(), Error> {
        write_atomic(&directory.join(self.file()), b"", Durability::Process)
    }
    /// Whether the request was left in a result directory.
    pub fn is_left(self, directory: &Path) -> bool {
        directory.join(self.file()).exists()
    }
    /// Takes the requests out of a result directory.
    ///
    /// # Errors
    /// [`Error::File`] when one cannot be removed.
    pub fn clear(directory: &Path) -> Result<(), Error> {
        file::remove(directory, Self::ALL.map(|request| request.file().to_owned()))
    }
    /// Takes this request, if it was left: what is asked from then on is a new one.
    ///
    /// # Errors
    /// [`Error::File`] when it cannot be removed.
    pub(super) fn take(self, directory: &Path) -> Result<bool, Error> {
        let left = self.is_left(directory);
        if left {
            file::remove(directory, [self.file().to_owned()])?;
        }
        Ok(left)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_request_is_taken_once_and_takes_no_other_with_it() {
        let folder = tempfile::tempdir().unwrap();
        let left = |request: Request| request.is_left(folder.path());
        assert!(!Request::ALL.into_iter().any(left));
        Request::ALL.into_iter().for_each(|request| request.leave(folder.path()).unwrap());
        assert!(Request::Checkpoint.take(folder.path()).unwrap());
        assert!(!Request::Checkpoint.take(folder.path()).unwrap() && left(Request::Stop));
        Request::clear(folder.path()).unwrap();
        assert!(!Request::ALL.into_iter().any(left));
    }
}
