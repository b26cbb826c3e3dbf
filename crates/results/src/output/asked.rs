//! `deck.json`: what was asked of a run, beside its results: the text of the deck, what was set over it, and what holds where
//! it says nothing.

use super::file::{self, Durability, write_atomic};
use asperity_core::Error;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Name of the file in the result directory.
pub const ASKED: &str = "deck.json";

/// What was asked of a run.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Asked {
    /// The deck's file, as it was named.
    pub path: String,
    /// The text of the deck.
    pub text: String,
    /// What `--set` changed, `KEY=VALUE` each.
    pub sets: Vec<String>,
    /// Keys that were not said, and what holds instead.
    pub defaults: Vec<(String, String)>,
}

impl Asked {
    /// Writes the file into a result directory.
    ///
    /// # Errors
    /// [`Error::Write`] when it cannot be written.
    pub fn write(&self, directory: &Path) -> Result<(), Error> {
        let path = directory.join(ASKED);
        let bytes = serde_json::to_vec_pretty(self).map_err(|error| Error::file(&path, error))?;
        write_atomic(&path, &bytes, Durability::Process)
    }
    /// Reads the file of a result directory; none where there is none.
    ///
    /// # Errors
    /// [`Error::File`] when it is damaged.
    pub fn read(directory: &Path) -> Result<Option<Self>, Error> {
        let path = directory.join(ASKED);
        if !path.exists() {
            return Ok(None);
        }
        serde_json::from_slice(&file::read(&path)?).map(Some).map_err(|error| Error::file(&path, error))
    }
}
