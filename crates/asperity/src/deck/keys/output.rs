//! What is written.

use crate::deck::form::{Form, Words, table, whole, word};
use crate::output::{Keep, ResultOptions};

table! {
    /// What is written, and how often.
    pub struct Output {
        /// A frame of fields every so many increments; the last of a step always.
        every: usize = whole(1..=1_000_000).or("1"),
        /// A checkpoint every so many increments, and at the end of each step.
        checkpoint_every: usize = whole(1..=1_000_000).or("10"),
        /// Which checkpoints stay in the result directory, to go on from.
        checkpoints: Keep = word().or("\"last\""),
    }
}

impl Words for Keep {
    fn words() -> Vec<(Self, &'static str, &'static str)> {
        vec![
            (Self::Last, "last", "the last one"),
            (Self::Steps, "steps", "those at the ends of steps too, for `asperity restart --from STEP`"),
            (Self::All, "all", "every one that is written, for `asperity restart --from TIME`"),
        ]
    }
}

impl Output {
    /// The options of the results.
    pub fn options(&self) -> ResultOptions {
        let Self { every, checkpoint_every, checkpoints, .. } = *self;
        ResultOptions { every, checkpoint_every, keep: checkpoints, ..ResultOptions::default() }
    }
}
