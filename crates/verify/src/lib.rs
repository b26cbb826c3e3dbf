//! The cases in `cases/`: what is measured on each, and how it compares with what its source says.
//!
//! A case is a folder with a README (sketch, source, result), decks, and `expect.toml` with the reference figures and
//! the errors allowed; and a file in `src/cases/` that runs the decks and measures. Decks hold the coarse model of the
//! `quick` size, which is a test; the `full` size sets other numbers of cells and increments, as `--set` does. To add
//! a case: its folder, its file, its line in [`cases::ALL`].
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod bench;
pub mod cases;
pub mod expect;
pub mod fit;
mod hertz;
pub mod table;
pub mod von_karman;

use asperity::Error;
use bench::{Bench, Effort};
use expect::{Expectations, Line};
use std::time::Instant;

/// What is measured: a key of `expect.toml` and its value.
pub type Measured = Vec<(String, f64)>;

/// A case.
pub struct Case {
    /// Its folder in `cases/`, by which it is called.
    pub name: &'static str,
    /// Runs its decks and measures.
    pub measure: fn(&Bench) -> Result<Measured, Error>,
}

/// The two sizes of a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Size {
    /// Coarse, under ten seconds: a test.
    Quick,
    /// Fine: a figure of the verification report.
    Full,
}

/// A case that was run.
pub struct Report {
    /// Its name.
    pub name: &'static str,
    /// Its title, the first line of its README.
    pub title: String,
    /// Its lines.
    pub lines: Vec<Line>,
    /// Seconds that it took.
    pub seconds: f64,
    /// What its runs took.
    pub effort: Effort,
}

impl Report {
    /// Whether all lines lie within their limits.
    pub fn holds(&self) -> bool {
        self.lines.iter().all(|line| line.holds)
    }
}

impl Case {
    /// Runs the case and compares.
    ///
    /// # Errors
    /// What the deck, the run or `expect.toml` say.
    pub fn run(&self, size: Size) -> Result<Report, Error> {
        let start = Instant::now();
        let bench = Bench::new(self.name, size);
        let expectations = Expectations::read(&bench.folder().join("expect.toml"))?;
        let lines = expectations.compare(&(self.measure)(&bench)?, size)?;
        let (title, seconds, effort) = (bench.title()?, start.elapsed().as_secs_f64(), bench.effort());
        Ok(Report { name: self.name, title, lines, seconds, effort })
    }
}
