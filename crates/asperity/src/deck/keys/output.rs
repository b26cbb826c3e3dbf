//! What is written.

use crate::deck::form::{Form, table, whole};
use crate::output::ResultOptions;

table! {
    /// What is written, and how often.
    pub struct Output {
        /// A frame of fields every so many increments; the last of a step always.
        every: usize = whole(1..=1_000_000).or("1"),
        /// A checkpoint every so many increments.
        checkpoint_every: usize = whole(1..=1_000_000).or("10"),
    }
}

impl Output {
    /// The options of the results.
    pub fn options(&self) -> ResultOptions {
        ResultOptions { every: self.every, checkpoint_every: self.checkpoint_every, ..ResultOptions::default() }
    }
}
