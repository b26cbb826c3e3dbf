//! `asperity figure`: draw the pictures of a finished run anew.

use super::{Outcome, print};
use crate::arguments::Figure;
use asperity::output::figure::{FigureOptions, Window, draw_standard};

/// Draws from the files of a result directory, and says what it wrote.
pub fn figure(arguments: &Figure) -> Outcome {
    let window = arguments.window.as_ref().map(|w| Window { low: [w[0], w[2]], high: [w[1], w[3]] });
    let options = FigureOptions { times: arguments.at.clone(), window, resolution: arguments.resolution };
    let written = draw_standard(&arguments.directory, &options)?;
    print(&written.iter().map(|path| format!("{}\n", path.display())).collect::<String>())
}
