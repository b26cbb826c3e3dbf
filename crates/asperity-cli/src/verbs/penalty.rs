//! `asperity penalty study`: what the penalty is worth.

use super::{Outcome, made, print};
use crate::arguments::{PenaltyCommand, Study};
use crate::exit::{Exit, Trouble};
use crate::screen::Screen;
use crate::signals::Interrupts;
use asperity::deck;
use asperity::model::Model;
use asperity::output::study::{Ends, extrapolate, forces, table};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Runs what is asked about penalties.
pub fn penalty(command: &PenaltyCommand, interrupts: &Interrupts) -> Outcome {
    match command {
        PenaltyCommand::Study(arguments) => study(arguments, interrupts),
    }
}

/// Runs the deck with its penalties and with softer ones, and prints the forces of a rigid interface with their errors.
fn study(arguments: &Study, interrupts: &Interrupts) -> Outcome {
    let (stiff, translated) = made(&arguments.deck)?;
    let loaded = match translated {
        Some(translated) => translated.load(&arguments.deck.sets)?,
        None => deck::load(&arguments.deck.path, &arguments.deck.sets)?,
    };
    let soft = deck::build(loaded.softened(&stiff.model, arguments.ratio)?)?;
    let stop = interrupts.heed();
    print(&format!("with penalties divided by {}:\n", arguments.ratio))?;
    let softer = solve(&soft.model, stop.clone())?;
    print("\nwith the penalties of the deck:\n")?;
    let stiffer = solve(&stiff.model, stop)?;
    let lines = extrapolate(&softer, &stiffer, arguments.ratio, stiff.model.problem.newton.tolerance);
    print(&table(&lines)).map(|_| Exit::Done)
}

fn solve(model: &Model, stop: Arc<AtomicBool>) -> Result<Ends, Trouble> {
    let mut screen = Screen::new(&model.problem, stop);
    let ends = forces(model, &mut screen);
    screen.close();
    Ok(ends?)
}
