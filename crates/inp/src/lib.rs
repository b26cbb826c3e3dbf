//! Input decks of Abaqus and CalculiX, translated into decks of Asperity.
//!
//! [`source`] cuts a file and those it includes into blocks: a keyword with its parameters and data lines. Every keyword
//! is declared once in [`keywords`], with its parameters and the function that reads it; checks and the manual's page
//! come from the same declarations. `read` makes a `model::Model` of the blocks, instances of parts laid out; `write`
//! makes a deck and a mesh of the model. All that is wrong is told at once, each with file and line.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod elements;
pub mod keywords;
pub mod message;
mod model;
mod read;
pub mod source;
mod vector;
mod write;

pub use keywords::manual;
pub use message::{InputPlace, Message, Messages};

use std::path::Path;

/// A deck of ours and its mesh.
#[derive(Debug)]
pub struct Translation {
    /// The deck, in TOML.
    pub deck: String,
    /// The mesh that the deck names: nodes, elements, sets and surfaces, in the format of CalculiX.
    pub mesh: String,
    /// What was left out or became something else, and why.
    pub notes: Vec<String>,
}

/// Translates the input deck at `path` into a deck that names its mesh `mesh_file`.
///
/// # Errors
/// Everything that is wrong or has no counterpart, one sentence each with its place: `block.inp:12: ...`.
pub fn translate(path: &Path, mesh_file: &str) -> Result<Translation, Vec<String>> {
    let mut messages = Messages::default();
    let blocks = source::blocks(path, &mut messages);
    translated(path, &blocks, mesh_file, messages)
}

/// The same of a text as if it stood in the file at `path`.
///
/// # Errors
/// As [`translate`].
pub fn translate_text(path: &Path, text: &str, mesh_file: &str) -> Result<Translation, Vec<String>> {
    let mut messages = Messages::default();
    let blocks = source::blocks_of(path, text, &mut messages);
    translated(path, &blocks, mesh_file, messages)
}

fn translated(
    path: &Path,
    blocks: &[source::KeywordBlock],
    mesh_file: &str,
    mut messages: Messages,
) -> Result<Translation, Vec<String>> {
    let model = read::model(blocks, &mut messages);
    if messages.has_errors() {
        return Err(messages.errors());
    }
    let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    // From wherever the deck is read, a library of laws lies beside the input deck.
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let library = folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf()).join("umat.so");
    let written = write::deck(&model, &name, (mesh_file, &library.to_string_lossy()), &mut messages);
    if messages.has_errors() {
        return Err(messages.errors());
    }
    Ok(Translation { deck: written.deck, mesh: written.mesh, notes: messages.notes() })
}
