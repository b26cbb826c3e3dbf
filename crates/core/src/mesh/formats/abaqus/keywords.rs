//! Keywords that must not be passed over.

use crate::declare::nearest;

/// Keywords that say nothing worth a note.
pub(super) const SILENT: [&str; 2] = ["HEADING", "PREPRINT"];

/// Keywords that are read.
const READ: [&str; 6] = ["NODE", "ELEMENT", "NSET", "ELSET", "SURFACE", "INCLUDE"];

const FLATTEN: &str = "write the model flat (in Abaqus/CAE: Model > Edit Attributes > Do not use parts and assemblies \
                       in input files)";
const WRITE_OUT: &str = "write the nodes and elements out";

/// Keywords that change the mesh, and what to do instead.
const REFUSED: &[(&str, &str)] = &[
    ("PART", FLATTEN),
    ("INSTANCE", FLATTEN),
    ("ASSEMBLY", FLATTEN),
    ("NGEN", WRITE_OUT),
    ("NFILL", WRITE_OUT),
    ("NCOPY", WRITE_OUT),
    ("NMAP", WRITE_OUT),
    ("ELGEN", WRITE_OUT),
    ("ELCOPY", WRITE_OUT),
    ("SYSTEM", "give all coordinates in the global system"),
    ("PARAMETER", "write the numbers out"),
    ("IMPORT", WRITE_OUT),
    ("SUBSTRUCTURE GENERATE", WRITE_OUT),
];

/// Refuses a keyword that changes the mesh, or that looks like a misspelt one that is read.
///
/// # Errors
/// A sentence without its place.
pub(super) fn refuse(name: &str) -> Result<(), String> {
    if let Some((_, advice)) = REFUSED.iter().find(|entry| entry.0 == name) {
        return Err(format!("*{name} changes the mesh and is not read; {advice}"));
    }
    match nearest(name, READ) {
        Some(near) if !name.contains(' ') => Err(format!("*{name} is no keyword; did you mean *{near}?")),
        _ => Ok(()),
    }
}
