//! Decks: what a user writes, read with all its faults at once, and made into a model.
//!
//! The text becomes a tree of values that know their places ([`tree`]); `--set` changes the tree (`overrides`); the
//! declared tables of [`keys`] read it into a [`Deck`] and describe it ([`schema`]); names are looked for
//! in the deck and in the mesh (`names`). Every message goes through [`diagnose`]. What is not said has a default that
//! is known and can be printed; what is said is used, or is an error.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod build;
mod degree;
pub mod diagnose;
mod facts;
pub mod form;
pub mod keys;
mod kind;
mod names;
mod overrides;
mod parts;
mod point;
mod prints;
mod reader;
mod review;
pub mod schema;
mod slide;
mod softer;
pub mod source;
pub mod tree;

pub use build::{Made, build};
pub use diagnose::{Diagnostic, Diagnostics, Severity};
pub use facts::facts;
pub use keys::{Deck, InterfaceDeck, PointDeck};
pub use point::{LoadedPoint, load_point, read_point};
pub use reader::{Name, Unsaid};
pub use review::{Review, review, review_for, warnings};
pub use slide::{Driven, LoadedInterface, load_driven, read_driven, read_interface};

use asperity_core::error::Error;
use asperity_core::files;
use asperity_core::mesh::Mesh;
use asperity_results::output::Part;
use form::KeyTable;
use kind::Kind;
use reader::Reader;
use source::SourceText;
use std::path::{Path, PathBuf};
use tree::Node;

/// A deck that was read, with its mesh.
#[derive(Debug)]
#[non_exhaustive]
pub struct Loaded {
    /// The deck.
    pub deck: Deck,
    /// Its mesh, with the groups that the deck adds.
    pub mesh: Mesh,
    /// Where the files that it names are looked for.
    pub folder: PathBuf,
    /// Whether another program is to run it, with parts that this one may lack.
    pub elsewhere: bool,
    /// What was not said, and what holds instead.
    pub unsaid: Vec<Unsaid>,
    /// Fingerprints of its parts.
    pub parts: Vec<Part>,
    /// Warnings and notes, and the texts that later messages point into.
    pub diagnostics: Diagnostics,
}

/// Reads a deck from its file.
///
/// # Errors
/// [`Diagnostics`] with everything that is wrong in it. A file that cannot be read is one of them.
pub fn load(path: &Path, sets: &[String]) -> Result<Loaded, Diagnostics> {
    let (name, text) = text_of(path)?;
    read(&text, &name, folder_of(path), sets)
}

/// Where the files that a deck names are looked for.
fn folder_of(deck: &Path) -> &Path {
    deck.parent().unwrap_or(Path::new(""))
}

/// The name and the text of a file.
fn text_of(path: &Path) -> Result<(String, String), Diagnostics> {
    let name = path.display().to_string();
    let lost = |why: String| Diagnostics { sources: vec![], list: vec![Diagnostic::error(format!("{name}: {why}"))] };
    let bytes = files::read(path).map_err(|error| match error {
        Error::File { reason, .. } => lost(reason),
        other => lost(other.to_string()),
    })?;
    let text = String::from_utf8(bytes).map_err(|error| {
        let line = 1 + error.as_bytes()[..error.utf8_error().valid_up_to()].iter().filter(|&&b| b == b'\n').count();
        lost(format!("line {line} is not UTF-8 text; save the file as UTF-8"))
    })?;
    Ok((name, text))
}

/// Reads a deck from text that messages call `name`; mesh files are looked for in `folder`.
///
/// # Errors
/// [`Diagnostics`] with everything that is wrong in it.
pub fn read(text: &str, name: &str, folder: &Path, sets: &[String]) -> Result<Loaded, Diagnostics> {
    read_with(text, name, folder, sets, None)
}

/// The same with a mesh that stands for what `mesh.file` names, which then is a mere name and no file.
///
/// # Errors
/// [`Diagnostics`] with everything that is wrong in it.
pub fn read_with(
    text: &str,
    name: &str,
    folder: &Path,
    sets: &[String],
    mesh: Option<Mesh>,
) -> Result<Loaded, Diagnostics> {
    let wanted = |tree: &Node, reader: &mut Reader| everything(tree, folder, mesh, reader);
    let (read, reader) = understood(text, name, sets, Kind::Model, wanted);
    let diagnostics = gathered(reader.sources, reader.diagnostics);
    match read {
        Some((deck, mesh, parts)) if !diagnostics.has_errors() => {
            let (folder, elsewhere, unsaid) = (folder.to_path_buf(), false, reader.unsaid);
            Ok(Loaded { deck, mesh, folder, elsewhere, unsaid, parts, diagnostics })
        }
        _ => Err(diagnostics.without_notes()),
    }
}

/// What `read` makes of a text of the `wanted` kind with `sets` over it, and the reader with what was found.
fn understood<T>(
    text: &str,
    name: &str,
    sets: &[String],
    wanted: Kind,
    read: impl FnOnce(&Node, &mut Reader) -> Option<T>,
) -> (Option<T>, Reader) {
    let mut reader = Reader::new(SourceText::new(name, text));
    let (mut tree, faults) = tree::parse(text, 0);
    let torn = faults.iter().any(|fault| fault.what.contains("not valid TOML"));
    reader.diagnostics.extend(faults);
    for set in sets {
        reader.diagnostics.extend(overrides::apply(set, reader.sources.len(), &mut tree).err());
        reader.sources.push(SourceText::new("--set", set));
    }
    // Text that is not TOML may hide the rest of its table: what would be said about that is not to be trusted.
    let mistaken = kind::mistaken(&tree, wanted).filter(|_| !torn);
    let value = if torn || mistaken.is_some() { None } else { read(&tree, &mut reader) };
    reader.diagnostics.extend(mistaken);
    (value, reader)
}

fn gathered(sources: Vec<SourceText>, list: Vec<Diagnostic>) -> Diagnostics {
    let mut diagnostics = Diagnostics { sources, list };
    diagnostics.sort();
    diagnostics
}

/// Deck and mesh; faults of the one do not hide those of the other.
fn everything(tree: &Node, folder: &Path, given: Option<Mesh>, reader: &mut Reader) -> Option<(Deck, Mesh, Vec<Part>)> {
    let deck = Deck::read(tree, reader);
    let mesh = parts::mesh(tree, folder, given, reader);
    names::resolve(mesh.as_ref(), reader);
    let mesh = mesh?;
    let parts = prints::of(tree, &mesh);
    Some((deck?, mesh, parts))
}

impl From<Diagnostics> for Error {
    fn from(diagnostics: Diagnostics) -> Self {
        Error::Input(diagnostics.render(false))
    }
}
