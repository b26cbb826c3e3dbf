//! Text files that grow frame by frame and are whole after each: a head, blocks, and an end that moves on.

use crate::output::file::{self, Durability, write_atomic};
use asperity_core::Error;
use std::fs::OpenOptions;
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// A file that grows.
#[derive(Debug)]
pub struct Growing {
    path: PathBuf,
    tail: &'static str,
    /// Where the tail begins.
    length: u64,
}

impl Growing {
    /// A file with no block yet.
    ///
    /// # Errors
    /// [`Error::File`] when it cannot be written.
    pub fn create(path: &Path, head: &str, tail: &'static str) -> Result<Self, Error> {
        write_atomic(path, [head, tail].concat().as_bytes(), Durability::Process)?;
        Ok(Self { path: path.into(), tail, length: head.len() as u64 })
    }
    /// Continues a file after a restart with the blocks that `keep` accepts; a block begins with a line that begins with
    /// `mark`. A file with another head is begun anew.
    ///
    /// # Errors
    /// [`Error::File`] when it cannot be read or written.
    pub fn resume(
        path: &Path,
        (head, tail): (&str, &'static str),
        mark: &str,
        keep: impl Fn(&str) -> bool,
    ) -> Result<Self, Error> {
        if !path.exists() {
            return Self::create(path, head, tail);
        }
        let bytes = file::read(path)?;
        let text = String::from_utf8_lossy(&bytes);
        let Some(body) = text.strip_prefix(head) else { return Self::create(path, head, tail) };
        let body = body.strip_suffix(tail).unwrap_or(body);
        let mut kept = head.to_owned();
        let mut starts: Vec<usize> = body.match_indices(mark).map(|(at, _)| at).collect();
        starts.retain(|&at| at == 0 || body[..at].ends_with('\n'));
        let ends = starts.iter().skip(1).copied().chain([body.len()]);
        starts.iter().zip(ends).map(|(&start, end)| &body[start..end]).filter(|block| keep(block)).for_each(|block| {
            kept.push_str(block);
        });
        Self::create(path, &kept, tail)
    }
    /// Adds a block.
    ///
    /// # Errors
    /// [`Error::Write`] when it cannot be written.
    pub fn push(&mut self, block: &str) -> Result<(), Error> {
        let grow = || -> std::io::Result<()> {
            let mut file = OpenOptions::new().write(true).open(&self.path)?;
            file.seek(SeekFrom::Start(self.length))?;
            file.write_all([block, self.tail].concat().as_bytes())
        };
        grow().map_err(|error| Error::write(&self.path, error))?;
        self.length += block.len() as u64;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_whole_after_each_block_and_after_a_restart() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("f");
        let read = || std::fs::read_to_string(&path).unwrap();
        let mut file = Growing::create(&path, "head\n", "end\n").unwrap();
        assert_eq!(read(), "head\nend\n");
        for i in 1..4 {
            file.push(&format!("*{i}\nvalue\n")).unwrap();
        }
        assert_eq!(read(), "head\n*1\nvalue\n*2\nvalue\n*3\nvalue\nend\n");
        let mut file = Growing::resume(&path, ("head\n", "end\n"), "*", |block| block < "*3").unwrap();
        file.push("*4\n").unwrap();
        assert_eq!(read(), "head\n*1\nvalue\n*2\nvalue\n*4\nend\n");
    }
}
