//! A series of frames: `NAME.pvd` beside a folder `NAME/` of numbered `.vtu` files. The `.pvd` is written anew after
//! each frame, in one step, so that a viewer may follow a run.

use super::grid::Grid;
use super::write::{Encoding, escape};
use crate::output::file::{self, Durability, write_atomic, write_in_parts};
use asperity_core::Error;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Writes the frames of one kind of grid.
#[derive(Debug, Clone, PartialEq)]
pub struct PvdSeries {
    directory: PathBuf,
    name: String,
    encoding: Encoding,
    frames: Vec<(f64, String)>,
}

impl PvdSeries {
    /// Begins a series in a directory; no file is written before the first frame. Frames of an earlier run are removed.
    ///
    /// # Errors
    /// [`Error::File`] when the folder of the frames cannot be made, or an old file not removed.
    pub fn create(directory: &Path, name: &str, encoding: Encoding) -> Result<Self, Error> {
        let series = Self { directory: directory.into(), name: name.into(), encoding, frames: Vec::new() };
        file::make_directory(&directory.join(name))?;
        if series.path().exists() {
            std::fs::remove_file(series.path()).map_err(|error| Error::file(series.path(), error))?;
        }
        series.clear()?;
        Ok(series)
    }
    /// Continues a series after a restart: the frames up to `time` stay, later ones leave the list.
    ///
    /// # Errors
    /// [`Error::File`] when the folder or an existing list cannot be read.
    pub fn resume(directory: &Path, name: &str, encoding: Encoding, time: f64) -> Result<Self, Error> {
        let mut series = Self { directory: directory.into(), name: name.into(), encoding, frames: Vec::new() };
        file::make_directory(&directory.join(name))?;
        if series.path().exists() {
            series.frames = read_series(&series.path())?;
            series.frames.retain(|(at, _)| *at <= time);
        }
        write_atomic(&series.path(), series.list().as_bytes(), Durability::Process)?;
        series.clear()?;
        Ok(series)
    }
    /// Removes frames that the list does not name, and nothing else.
    fn clear(&self) -> Result<(), Error> {
        let folder = self.directory.join(&self.name);
        file::sweep(&folder)?;
        let failed = |error: std::io::Error| Error::file(&folder, error);
        for entry in std::fs::read_dir(&folder).map_err(failed)? {
            let entry = entry.map_err(failed)?;
            let name = entry.file_name().to_string_lossy().into_owned();
            let ours = name.strip_prefix(&format!("{}_", self.name)).and_then(|rest| rest.strip_suffix(".vtu"));
            let numbered = ours.is_some_and(|number| number.bytes().all(|b| b.is_ascii_digit()));
            let listed = self.frames.iter().any(|(_, file)| *file == format!("{}/{name}", self.name));
            if numbered && !listed {
                std::fs::remove_file(entry.path()).map_err(|error| Error::file(entry.path(), error))?;
            }
        }
        Ok(())
    }
    /// Writes the next frame and the list.
    ///
    /// # Errors
    /// [`Error::Write`] when a file cannot be written; the frames before stay listed and readable.
    pub fn push(&mut self, grid: &Grid) -> Result<(), Error> {
        let relative = format!("{0}/{0}_{1:06}.vtu", self.name, self.frames.len());
        let path = self.directory.join(&relative);
        // Whole before the list names it; readers go by the list.
        let vtu = grid.to_vtu(self.encoding)?;
        write_in_parts(&path, Durability::Process, |out| vtu.write(out))?;
        self.frames.push((grid.time, relative));
        write_atomic(&self.path(), self.list().as_bytes(), Durability::Process)
    }
    /// The `.pvd` file.
    pub fn path(&self) -> PathBuf {
        self.directory.join(format!("{}.pvd", self.name))
    }
    /// Number of frames.
    pub fn len(&self) -> usize {
        self.frames.len()
    }
    /// Whether there is no frame yet.
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }
    fn list(&self) -> String {
        let mut text = String::from(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n",
        );
        for (time, file) in &self.frames {
            let file = escape(file);
            let _ = writeln!(text, "<DataSet timestep=\"{time}\" group=\"\" part=\"0\" file=\"{file}\"/>");
        }
        text.push_str("</Collection>\n</VTKFile>\n");
        text
    }
}

/// The times and files (relative to the list's directory) of a `.pvd` written by this program.
///
/// # Errors
/// [`Error::File`] when it cannot be read or is damaged.
pub fn read_series(path: &Path) -> Result<Vec<(f64, String)>, Error> {
    let bytes = file::read(path)?;
    let text = std::str::from_utf8(&bytes).map_err(|error| Error::file(path, error))?;
    let line = |tag: &str| -> Option<(f64, String)> {
        let value = |name: &str| tag.split(&format!("{name}=\"")).nth(1)?.split('"').next();
        Some((value("timestep")?.parse().ok()?, value("file")?.to_owned()))
    };
    let frames: Option<Vec<_>> = text.split("<DataSet ").skip(1).map(line).collect();
    frames.ok_or_else(|| Error::file(path, "a line of the list is damaged"))
}
