//! Writing a file so that a reader never meets half of it: the bytes go to a temporary file in the same directory,
//! which then takes the name in one step of the file system.

use asperity_core::Error;
use std::io::Write;
use std::path::Path;
use tempfile::NamedTempFile;

/// How the names of temporary files begin.
const TEMPORARY: &str = ".writing-";

/// Whether a write must outlive a crash of the machine, or only of the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Durability {
    /// The program may be killed at any time; the file is whole or old. Costs no wait for the disk.
    Process,
    /// The machine may lose its power: the bytes are on the disk before the name changes.
    Machine,
}

/// Writes `bytes` to `path`, replacing what stood there in one step.
///
/// # Errors
/// [`Error::Write`] with what the system said; the old file is then untouched.
pub fn write_atomic(path: &Path, bytes: &[u8], durability: Durability) -> Result<(), Error> {
    write_in_parts(path, durability, |out| out.write_all(bytes))
}

/// The same with what `write` makes, part after part.
///
/// # Errors
/// As those of [`write_atomic`].
pub fn write_in_parts(
    path: &Path,
    durability: Durability,
    write: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
) -> Result<(), Error> {
    let directory = match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    let failed = |error: &dyn std::fmt::Display| Error::write(path, error);
    let mut file = NamedTempFile::with_prefix_in(TEMPORARY, directory).map_err(|e| failed(&e))?;
    write(file.as_file_mut()).map_err(|e| failed(&e))?;
    share_with_others(&file).map_err(|e| failed(&e))?;
    if durability == Durability::Machine {
        file.as_file().sync_all().map_err(|e| failed(&e))?;
    }
    file.persist(path).map_err(|e| failed(&e.error))?;
    if durability == Durability::Machine {
        sync_directory(directory).map_err(|e| failed(&e))?;
    }
    Ok(())
}

/// Removes the temporary files that a killed run left in a directory.
///
/// # Errors
/// [`Error::File`] when the directory cannot be read or a file not removed.
pub fn sweep(directory: &Path) -> Result<(), Error> {
    for entry in std::fs::read_dir(directory).map_err(|error| Error::file(directory, error))? {
        let path = entry.map_err(|error| Error::file(directory, error))?.path();
        let name = path.file_name().map(|name| name.to_string_lossy());
        if name.is_some_and(|name| name.starts_with(TEMPORARY)) {
            std::fs::remove_file(&path).map_err(|error| Error::file(&path, error))?;
        }
    }
    Ok(())
}

/// Removes those of the files that are there.
///
/// # Errors
/// [`Error::File`] when one cannot be removed.
pub fn remove(directory: &Path, names: impl IntoIterator<Item = String>) -> Result<(), Error> {
    names
        .into_iter()
        .map(|name| directory.join(name))
        .filter(|path| path.exists())
        .try_for_each(|path| std::fs::remove_file(&path).map_err(|error| Error::file(&path, error)))
}

/// Makes a directory and its parents.
///
/// # Errors
/// [`Error::File`] with what the system said.
pub fn make_directory(path: &Path) -> Result<(), Error> {
    if path.is_file() {
        let reason = "this is a file, and results need a directory: name another with --out, or move the file";
        return Err(Error::file(path, reason));
    }
    std::fs::create_dir_all(path).map_err(|error| Error::file(path, error))
}

/// Reads a whole file.
///
/// # Errors
/// [`Error::File`] with what the system said.
pub fn read(path: &Path) -> Result<Vec<u8>, Error> {
    asperity_core::files::read(path)
}

/// A temporary file is made for its owner only; results are ordinary files that colleagues may read.
#[cfg(unix)]
fn share_with_others(file: &NamedTempFile) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.as_file().set_permissions(std::fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn share_with_others(_: &NamedTempFile) -> std::io::Result<()> {
    Ok(())
}

/// A new name is safe only when the directory itself is on the disk.
#[cfg(unix)]
fn sync_directory(directory: &Path) -> std::io::Result<()> {
    std::fs::File::open(directory)?.sync_all()
}

#[cfg(not(unix))]
fn sync_directory(_: &Path) -> std::io::Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_write_replaces_and_leaves_nothing_else() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("a.txt");
        for (text, durability) in [("one", Durability::Process), ("two", Durability::Machine)] {
            write_atomic(&path, text.as_bytes(), durability).unwrap();
            assert_eq!(read(&path).unwrap(), text.as_bytes());
        }
        assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_file_in_the_way_of_a_directory_is_told() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("results");
        std::fs::write(&path, "mine").unwrap();
        assert!(make_directory(&path).unwrap_err().to_string().contains("this is a file"));
        make_directory(&directory.path().join("other/results")).unwrap();
        assert_eq!(read(&path).unwrap(), b"mine");
    }

    #[test]
    fn a_missing_directory_is_told_by_name() {
        let error = write_atomic(Path::new("/no/such/place/a.txt"), b"x", Durability::Process).unwrap_err();
        assert!(error.to_string().starts_with("/no/such/place/a.txt: "), "{error}");
    }
}
