//! Reading the files that a user names: ordinary ones, and no more of them than memory holds.

use crate::{Error, machine};
use std::fs::{File, FileType, Metadata};
use std::io::Read;
use std::path::Path;

/// Part of the memory of the machine that one file may fill: its content is kept beside what is made of it.
const SHARE: u64 = 2;

/// Reads a whole file.
///
/// A pipe without a writer would be waited for without end, and a device may never end: neither is opened.
///
/// # Errors
/// [`Error::File`] with what the system said; for what is no ordinary file, and for one that would not fit into memory.
pub fn read(path: impl AsRef<Path>) -> Result<Vec<u8>, Error> {
    let path = path.as_ref();
    let failed = |error: std::io::Error| Error::file(path, error);
    refuse(path, &std::fs::metadata(path).map_err(failed)?)?;
    let file = File::open(path).map_err(failed)?;
    let most = most();
    let mut bytes = Vec::new();
    file.take(most + 1).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > most { Err(too_long(path, bytes.len() as u64)) } else { Ok(bytes) }
}

fn most() -> u64 {
    machine::memory().map_or(u64::MAX - 1, |bytes| bytes / SHARE)
}

fn too_long(path: &Path, length: u64) -> Error {
    let gigabytes = length as f64 / 1e9;
    Error::file(path, format!("this file of {gigabytes:.1} GB does not fit into the memory of this machine"))
}

fn refuse(path: &Path, found: &Metadata) -> Result<(), Error> {
    if found.is_dir() {
        return Err(Error::file(path, "this is a directory, and a file is needed"));
    }
    if !found.is_file() {
        let kind = kind(found.file_type());
        return Err(Error::file(
            path,
            format!("this is a {kind} and no ordinary file; copy what it gives into a file"),
        ));
    }
    if found.len() > most() { Err(too_long(path, found.len())) } else { Ok(()) }
}

#[cfg(unix)]
fn kind(kind: FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    if kind.is_fifo() {
        "pipe"
    } else if kind.is_socket() {
        "socket"
    } else {
        "device"
    }
}

#[cfg(not(unix))]
fn kind(_: FileType) -> &'static str {
    "device"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read_whole_and_a_directory_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        std::fs::write(&path, "words").unwrap();
        assert_eq!(read(&path).unwrap(), b"words");
        assert!(read(folder.path()).unwrap_err().to_string().contains("this is a directory"));
        assert!(read(folder.path().join("none")).unwrap_err().to_string().contains("none: "));
    }

    /// A file that only says that it is long takes no time to refuse.
    #[test]
    fn a_file_longer_than_memory_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("long.msh");
        if machine::memory().is_none() || File::create(&path).unwrap().set_len(1 << 42).is_err() {
            return;
        }
        assert!(read(&path).unwrap_err().to_string().contains("does not fit into the memory"));
    }

    #[cfg(unix)]
    #[test]
    fn what_never_ends_is_not_read() {
        let zero = read("/dev/zero").unwrap_err().to_string();
        assert!(zero.contains("this is a device and no ordinary file"), "{zero}");
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe.toml");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        assert!(read(&pipe).unwrap_err().to_string().contains("this is a pipe"));
    }
}
