//! `asperity point`: drive laws of solids along a path of strains and stresses, those of interfaces along one of slip.

use super::{Outcome, claim, print};
use crate::arguments::Point;
use crate::exit::tell;
use asperity::deck;
use asperity::point::{PointTangentCheck, draw, write};

/// Runs the deck of a point, writes its tables and pictures, and says what it wrote.
pub fn point(arguments: &Point) -> Outcome {
    let loaded = deck::load_driven(&arguments.deck.path, &arguments.deck.sets)?;
    tell(loaded.diagnostics());
    let (records, stopped) = loaded.follow();
    let (directory, _claim) = claim(arguments.out.as_deref(), &arguments.deck.path)?;
    let mut written = write(&records, &directory)?;
    let drawn = [&records[..], &loaded.surfaces(&records)].concat();
    written.extend(draw(&drawn, loaded.curves(), loaded.title(), &directory)?);
    if arguments.tangent {
        print(&loaded.tangents()?.iter().map(compared).collect::<String>())?;
    }
    let done = print(&written.iter().map(|path| format!("{}\n", path.display())).collect::<String>())?;
    // What was reached is written; that it is not all, and why, is said at last.
    stopped.map_or(Ok(done), |error| Err(error.into()))
}

/// What differences say of a law's tangents, in a line.
fn compared((name, check): &(String, PointTangentCheck)) -> String {
    let PointTangentCheck { worst, time, columns, corners } = check;
    let corners = if *corners > 0 { format!("; {corners} more at corners of the law") } else { String::new() };
    format!("{name}: tangent within {worst:.1e} of differences, worst at the time {time}, {columns} columns{corners}\n")
}
