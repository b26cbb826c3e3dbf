//! `asperity report`: one page of HTML from the results of a run.

use super::{Outcome, print};
use crate::arguments::Report;

/// Writes `report.html` into the result directory, and says so.
pub fn report(arguments: &Report) -> Outcome {
    let path = report::write(&arguments.directory)?;
    print(&format!("{}\n", path.display()))
}
