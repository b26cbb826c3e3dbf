//! `asperity translate`, and input decks of Abaqus and CalculiX in place of decks.

use super::{Outcome, print};
use crate::arguments;
use crate::exit::{Trouble, tell};
use asperity::Error;
use asperity::deck::{self, Diagnostic, Diagnostics, Loaded};
use std::path::{Path, PathBuf};

/// The first words of every translated deck.
const MARK: &str = "# Translated from ";

/// An input deck, translated.
pub struct Translated {
    /// The input deck's path.
    path: PathBuf,
    mesh_file: String,
    translation: inp::Translation,
}

/// Whether a path is that of an input deck.
pub fn is_input(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("inp"))
}

/// Whether a file is an input deck with parts or steps, and no mere mesh.
pub fn has_model(path: &Path) -> bool {
    let blocks = inp::source::blocks(path, &mut inp::Messages::default());
    is_input(path) && blocks.iter().any(|block| matches!(block.name.as_str(), "STEP" | "PART"))
}

/// Translates an input deck into one whose files are called after `name`.
///
/// # Errors
/// Everything in it that is wrong or has no counterpart.
pub fn translated(path: &Path, name: &Path) -> Result<Translated, Trouble> {
    let mesh_file = format!("{}.mesh.inp", stem(name));
    let translation = inp::translate(path, &mesh_file).map_err(|errors| {
        let list = errors.into_iter().map(Diagnostic::error).collect();
        Trouble::from(Diagnostics { sources: vec![], list })
    })?;
    Ok(Translated { path: path.to_path_buf(), mesh_file, translation })
}

impl Translated {
    /// What was left out or became something else.
    pub fn notes(&self) -> Diagnostics {
        let list = self.translation.notes.iter().map(Diagnostic::note).collect();
        Diagnostics { sources: vec![], list }
    }

    /// The deck as if it had been read from a file.
    pub fn load(&self, sets: &[String]) -> Result<Loaded, Trouble> {
        let folder = tempfile::tempdir().map_err(|error| Error::write(Path::new("a temporary folder"), error))?;
        self.write_mesh(folder.path())?;
        let name = format!("{} (translated)", self.path.display());
        Ok(deck::read(&self.translation.deck, &name, folder.path(), sets)?)
    }

    /// Writes deck and mesh, to be read and changed; the path of the mesh.
    pub fn write(&self, deck: &Path) -> Result<PathBuf, Error> {
        let mesh = self.write_mesh(deck.parent().unwrap_or(Path::new("")))?;
        std::fs::write(deck, &self.translation.deck).map_err(|error| Error::write(deck, error))?;
        Ok(mesh)
    }

    fn write_mesh(&self, folder: &Path) -> Result<PathBuf, Error> {
        let path = folder.join(&self.mesh_file);
        std::fs::write(&path, &self.translation.mesh).map_err(|error| Error::write(&path, error))?;
        Ok(path)
    }
}

/// Translates an input deck into a deck and its mesh.
pub fn translate(arguments: &arguments::Translate) -> Outcome {
    let deck = arguments.out.clone().unwrap_or_else(|| PathBuf::from(format!("{}.toml", stem(&arguments.input))));
    let translated = translated(&arguments.input, &deck)?;
    if std::fs::read_to_string(&deck).is_ok_and(|text| !text.starts_with(MARK)) {
        let what =
            format!("{} is there and was not translated from an input deck; name another by --out", deck.display());
        return Err(Error::input(what).into());
    }
    let mesh = translated.write(&deck)?;
    tell(&translated.notes());
    print(&format!("{}\n{}\n", deck.display(), mesh.display()))
}

/// The name of a file without its extension.
pub fn stem(path: &Path) -> String {
    path.file_stem().map_or_else(|| "deck".into(), |stem| stem.to_string_lossy().into_owned())
}
