//! `asperity figure`: draw the pictures of a finished run anew.

use super::{Outcome, print};
use crate::arguments::Figure;
use asperity::output::figure::{FigureOptions, draw_standard};

/// Draws from the files of a result directory, and says what it wrote.
pub fn figure(arguments: &Figure) -> Outcome {
    let options = FigureOptions {
        times: arguments.at.clone(),
        window: arguments.window,
        resolution: arguments.resolution,
        quantity: arguments.quantity.clone(),
        film: arguments.film,
    };
    let written = draw_standard(&arguments.directory, &options)?;
    print(&written.iter().map(|path| format!("{}\n", path.display())).collect::<String>())
}
