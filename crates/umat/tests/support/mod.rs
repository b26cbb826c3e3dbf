//! Libraries that are built when a compiler is there.

use std::path::{Path, PathBuf};
use std::process::Command;

/// The folder of the examples.
pub fn examples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/umat")
}

/// A shared library of a source file in a folder; nothing, and a line that says so, without a compiler for it.
pub fn library(source: &Path, folder: &Path) -> Option<PathBuf> {
    let compiler = if source.extension().is_some_and(|extension| extension == "f90") { "gfortran" } else { "cc" };
    let built = folder.join(source.file_stem().unwrap()).with_extension("so");
    let mut command = Command::new(compiler);
    command.args(["-O2", "-shared", "-fPIC", "-o"]).arg(&built).arg(source).arg("-lm");
    match command.output() {
        Ok(output) => assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr)),
        Err(_) => {
            eprintln!("skipped: there is no {compiler}");
            return None;
        }
    }
    Some(built)
}

/// The same of a text.
#[allow(dead_code)]
pub fn library_of(text: &str, name: &str, folder: &Path) -> Option<PathBuf> {
    let source = folder.join(name);
    std::fs::write(&source, text).unwrap();
    library(&source, folder)
}
