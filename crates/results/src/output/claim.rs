//! Whose a result directory is: one process at a time writes into it, and it remembers which deck the results are of.
//!
//! The file `run.lock` names the deck. While a process works it holds a lock on that file, which the system lets go of
//! when the process ends, however it ends: a crash leaves no lock behind.

use super::file::make_directory;
use asperity_core::{Error, files};
use std::fs::{File, OpenOptions, TryLockError};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Name of the file in the result directory.
const LOCK: &str = "run.lock";

/// How often a lock that is held is tried again, and after what time.
const LOOKS: usize = 5;
const LOOK: Duration = Duration::from_millis(5);

/// The right to write into a result directory, as long as it lives.
#[derive(Debug)]
pub struct ResultsClaim {
    _lock: File,
}

/// Whether results of another deck may be replaced.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Others {
    /// The user named the directory.
    Replace,
    /// The directory goes by the name of the deck: one of the same name elsewhere may have come before.
    Spare,
}

impl ResultsClaim {
    /// Makes the directory and claims it for the results of `deck`.
    ///
    /// # Errors
    /// [`Error::File`] when the directory cannot be made, when another process is writing into it, or when it holds what is
    /// to be [spared](Others::Spare): results of another deck that is still there.
    pub fn take(directory: &Path, deck: &Path, others: Others) -> Result<Self, Error> {
        make_directory(directory)?;
        let path = directory.join(LOCK);
        let failed = |error: std::io::Error| Error::write(&path, error);
        let mut lock = OpenOptions::new().create(true).truncate(false).write(true).open(&path).map_err(failed)?;
        let mut locked = lock.try_lock();
        // Whoever only looks whether a process is at work holds the lock for a moment.
        for _ in 0..LOOKS {
            if !matches!(locked, Err(TryLockError::WouldBlock)) {
                break;
            }
            std::thread::sleep(LOOK);
            locked = lock.try_lock();
        }
        match locked {
            // Some file systems have no locks: there nobody is kept out.
            Ok(()) | Err(TryLockError::Error(_)) => {}
            Err(TryLockError::WouldBlock) => {
                let reason =
                    "another process is writing its results here; wait for it, or name another directory with --out";
                return Err(Error::file(directory, reason));
            }
        }
        let deck = deck.canonicalize().unwrap_or_else(|_| deck.to_path_buf());
        if let Some(other) = owner(&path).filter(|other| others == Others::Spare && *other != deck && other.exists()) {
            let other = other.display();
            let reason =
                format!("these are results of {other}; name another directory with --out, or this one to replace them");
            return Err(Error::file(directory, reason));
        }
        lock.set_len(0).and_then(|()| lock.write_all(deck.as_os_str().as_encoded_bytes())).map_err(failed)?;
        Ok(Self { _lock: lock })
    }
}

/// Whether a process is writing into a result directory now.
pub fn is_claimed(directory: &Path) -> bool {
    let lock = File::open(directory.join(LOCK));
    lock.is_ok_and(|lock| matches!(lock.try_lock_shared(), Err(TryLockError::WouldBlock)))
}

/// The deck that the file names.
fn owner(path: &Path) -> Option<PathBuf> {
    let text = String::from_utf8(files::read(path).ok()?).ok()?;
    (!text.is_empty()).then(|| text.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder() -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("a.toml"), "").unwrap();
        std::fs::write(folder.path().join("b.toml"), "").unwrap();
        folder
    }

    #[test]
    fn one_at_a_time() {
        let folder = folder();
        let (results, deck) = (folder.path().join("results"), folder.path().join("a.toml"));
        let first = ResultsClaim::take(&results, &deck, Others::Spare).unwrap();
        let refused = ResultsClaim::take(&results, &deck, Others::Replace).unwrap_err().to_string();
        assert!(refused.contains("another process is writing"), "{refused}");
        drop(first);
        ResultsClaim::take(&results, &deck, Others::Spare).unwrap();
    }

    #[test]
    fn results_of_another_deck_are_spared_while_it_is_there() {
        let folder = folder();
        let [a, b] = ["a.toml", "b.toml"].map(|name| folder.path().join(name));
        let results = folder.path().join("results");
        drop(ResultsClaim::take(&results, &a, Others::Spare).unwrap());
        let refused = ResultsClaim::take(&results, &b, Others::Spare).unwrap_err().to_string();
        assert!(refused.contains("these are results of") && refused.contains("a.toml"), "{refused}");
        drop(ResultsClaim::take(&results, &b, Others::Replace).unwrap());
        std::fs::remove_file(&b).unwrap();
        ResultsClaim::take(&results, &a, Others::Spare).unwrap();
    }
}
