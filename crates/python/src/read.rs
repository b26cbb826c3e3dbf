//! Decks from files, text, dicts and arrays.

use crate::arrays::MeshArrays;
use crate::trouble::{raised, refused};
use asperity::deck::{self, Diagnostics, Loaded, Made};
use pyo3::prelude::*;
use std::path::{Path, PathBuf};

/// What a deck is read from, as `asperity._deck` hands it over.
#[derive(FromPyObject)]
pub struct Given {
    /// Its text, where it comes from no file.
    #[pyo3(item)]
    pub text: Option<String>,
    /// Its file, or what messages call it.
    #[pyo3(item)]
    pub path: PathBuf,
    /// Where the files that it names are.
    #[pyo3(item)]
    pub folder: PathBuf,
    /// What is set over it, `KEY=VALUE` each.
    #[pyo3(item)]
    pub sets: Vec<String>,
    /// Its mesh, where it is in arrays.
    #[pyo3(item)]
    pub mesh: Option<MeshArrays>,
}

/// An input deck's translation, which goes into the result directory.
pub struct Translated {
    stem: String,
    translation: inp::Translation,
}

/// Why a deck makes no model.
pub enum Refusal {
    Deck(Diagnostics),
    Other(asperity::Error),
}

impl From<Diagnostics> for Refusal {
    fn from(diagnostics: Diagnostics) -> Self {
        Self::Deck(diagnostics)
    }
}

impl From<asperity::Error> for Refusal {
    fn from(error: asperity::Error) -> Self {
        Self::Other(error)
    }
}

impl Refusal {
    /// The exception.
    pub fn raised(self, py: Python<'_>) -> PyErr {
        match self {
            Self::Deck(diagnostics) => refused(py, &diagnostics),
            Self::Other(error) => raised(py, &error),
        }
    }
}

/// What is made of arguments in Python.
pub fn given<'py>(
    py: Python<'py>,
    deck: &Bound<'py, PyAny>,
    set: &Bound<'py, PyAny>,
    folder: Option<PathBuf>,
) -> PyResult<Given> {
    let understood = py.import("asperity._deck")?.call_method1("understood", (deck, set, folder))?;
    understood.extract()
}

fn is_input(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("inp"))
}

fn translated(path: &Path, sets: &[String]) -> Result<(Loaded, Translated), Refusal> {
    let stem = path.file_stem().map_or_else(|| "deck".into(), |stem| stem.to_string_lossy().into_owned());
    let translation = inp::translate(path, &format!("{stem}.mesh.inp")).map_err(|errors| {
        let list = errors.into_iter().map(deck::Diagnostic::error).collect();
        Diagnostics { sources: vec![], list }
    })?;
    let translated = Translated { stem, translation };
    let folder = tempfile::tempdir().map_err(|error| asperity::Error::write("a temporary folder", error))?;
    translated.write_mesh(folder.path())?;
    let name = format!("{} (translated)", path.display());
    Ok((deck::read(&translated.translation.deck, &name, folder.path(), sets)?, translated))
}

impl Translated {
    /// Writes deck and mesh into a result directory.
    pub fn write(&self, directory: &Path) -> Result<(), asperity::Error> {
        self.write_mesh(directory)?;
        let path = directory.join(format!("{}.toml", self.stem));
        std::fs::write(&path, &self.translation.deck).map_err(|error| asperity::Error::write(&path, error))
    }
    fn write_mesh(&self, folder: &Path) -> Result<(), asperity::Error> {
        let path = folder.join(format!("{}.mesh.inp", self.stem));
        std::fs::write(&path, &self.translation.mesh).map_err(|error| asperity::Error::write(&path, error))
    }
}

/// The model of what was given.
pub fn built(given: &Given, mesh: Option<asperity::mesh::Mesh>) -> Result<(Made, Option<Translated>), Refusal> {
    let (loaded, translated) = match &given.text {
        None if is_input(&given.path) => {
            translated(&given.path, &given.sets).map(|(loaded, text)| (loaded, Some(text)))?
        }
        None => (deck::load(&given.path, &given.sets)?, None),
        Some(text) => {
            let name = given.path.display().to_string();
            (deck::read_with(text, &name, &given.folder, &given.sets, mesh)?, None)
        }
    };
    let mut made = deck::build(loaded)?;
    made.diagnostics.list = deck::warnings(&made);
    if let Some(translated) = &translated {
        made.diagnostics.list.extend(translated.translation.notes.iter().map(deck::Diagnostic::note));
    }
    Ok((made, translated))
}
