//! The files of a result directory.

use asperity_core::Error;
use asperity_results::output::vtk::{Grid, read_grid, read_series};
use asperity_results::output::{Asked, Columns, Progress, SUMMARY, Summary, is_claimed};
use std::path::{Path, PathBuf};

/// A result directory.
pub struct Folder {
    /// Where it is.
    pub path: PathBuf,
    /// How the run ended, or stands.
    pub summary: Summary,
    /// What was asked; none for results of versions that did not say.
    pub asked: Option<Asked>,
    /// Where it stands, if it says so.
    pub progress: Option<Progress>,
    /// Whether a process is at work in it.
    pub runs: bool,
}

/// The frames of one kind of grid: times and files.
pub struct Frames(pub Vec<(f64, PathBuf)>);

impl Folder {
    /// Reads what is not frames.
    ///
    /// # Errors
    /// [`Error::File`] when the directory holds no results, or damaged ones.
    pub fn read(path: &Path) -> Result<Self, Error> {
        if !path.join(SUMMARY).exists() {
            let reason = "there are no results of a run here; `asperity run DECK` writes a directory NAME.results";
            return Err(Error::file(path, reason));
        }
        Ok(Self {
            path: path.to_path_buf(),
            summary: Summary::read(&path.join(SUMMARY))?,
            asked: Asked::read(path)?,
            progress: Progress::read(path).ok(),
            runs: is_claimed(path),
        })
    }

    /// A table, empty where there is none.
    ///
    /// # Errors
    /// [`Error::File`] when it is damaged.
    pub fn table(&self, name: &str) -> Result<Columns, Error> {
        let path = self.path.join(name);
        if path.exists() { Columns::read(&path) } else { Ok(Columns::default()) }
    }

    /// The frames of a kind of grid.
    ///
    /// # Errors
    /// [`Error::File`] when their list is damaged.
    pub fn frames(&self, name: &str) -> Result<Frames, Error> {
        let list = self.path.join(format!("{name}.pvd"));
        let frames = if list.exists() { read_series(&list)? } else { Vec::new() };
        Ok(Frames(frames.into_iter().map(|(time, file)| (time, self.path.join(file))).collect()))
    }
}

impl Frames {
    /// The grid at a time; none where there is none.
    ///
    /// # Errors
    /// [`Error::File`] when it cannot be read.
    pub fn at(&self, time: f64) -> Result<Option<Grid>, Error> {
        let found = self.0.iter().find(|(at, _)| *at == time);
        found.map(|(_, path)| read_grid(path)).transpose()
    }
}
