//! Mesh files: Gmsh, Abaqus and CalculiX, and the triangles of STL.
//!
//! A reader collects nodes, elements and groups as the file lists them in a draft, and the draft becomes the mesh:
//! the elements of the highest dimension are its cells, those one dimension lower become sides of the cells behind
//! them. What a file says and the mesh does not hold is reported as a [`Note`], never dropped in silence. A file is
//! not trusted: no count in it makes the reader allocate more than the file could fill.
//!
//! To add a format: its module here, its `mod` line and its entry in [`ALL`].

mod abaqus;
mod draft;
mod gmsh;
mod note;
mod numbering;
pub mod stl;

pub use note::Note;

use super::Mesh;
use crate::error::{Error, visible};
use crate::files;
use std::path::Path;

/// Makes a mesh of a file's content; the path serves messages and included files only.
pub type Read = fn(path: &Path, bytes: &[u8]) -> Result<(Mesh, Vec<Note>), Error>;

/// One file format.
pub struct Format {
    /// Its name: `Gmsh`.
    pub name: &'static str,
    /// The extension of its files, in lower case: `msh`.
    pub extension: &'static str,
    /// Its reader.
    pub read: Read,
}

/// Every format the program reads.
pub static ALL: &[Format] = &[
    Format { name: "Gmsh", extension: "msh", read: gmsh::read },
    Format { name: "Abaqus/CalculiX", extension: "inp", read: abaqus::read },
];

/// Reads a mesh, its format chosen by the extension of the file.
///
/// # Errors
/// [`Error::File`] if the file cannot be opened; [`Error::Input`] if the extension is unknown or the content is wrong,
/// with file and line.
pub fn read(path: impl AsRef<Path>) -> Result<(Mesh, Vec<Note>), Error> {
    let path = path.as_ref();
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or("").to_ascii_lowercase();
    let Some(format) = ALL.iter().find(|format| format.extension == extension) else {
        let known: Vec<String> = ALL.iter().map(|format| format!(".{} ({})", format.extension, format.name)).collect();
        let path = path.display();
        return Err(Error::input(format!(
            "{path}: '.{extension}' is no known mesh format; use {}",
            known.join(" or ")
        )));
    };
    let (mesh, notes) = (format.read)(path, &files::read(path)?)?;
    check_names(path, &mesh)?;
    Ok((mesh, notes))
}

/// Names of groups become columns of tables and words on a terminal, which control characters would steer.
fn check_names(path: &Path, mesh: &Mesh) -> Result<(), Error> {
    let Some(name) = mesh.groups.keys().find(|name| name.contains(char::is_control)) else { return Ok(()) };
    let (path, name) = (path.display(), visible(name));
    Err(Error::input(format!("{path}: the name of the group '{name}' holds control characters; give it another")))
}
