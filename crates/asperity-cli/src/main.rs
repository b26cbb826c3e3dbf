//! The `asperity` command: reads its arguments, calls one verb of the library and ends with an exit code that scripts
//! can trust. It prints; the library does not. Mechanics is no business of this crate.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod arguments;
mod exit;
mod screen;
mod signals;
mod verbs;

use arguments::{Command, Line};
use clap::Parser;
use exit::Exit;
use std::process::ExitCode;

fn main() -> ExitCode {
    let line = Line::parse();
    let exit = match line.command {
        Command::Run(run) => verbs::run(&run),
        Command::Restart(run) => verbs::restart(&run),
        Command::Figure(figure) => verbs::figure(&figure),
        Command::Check(check) => verbs::check(&check),
        Command::Info(info) => verbs::info(&info),
        Command::Schema(schema) => verbs::schema(&schema),
        Command::Point(point) => verbs::point(&point),
        Command::Laws => verbs::laws(),
        Command::Penalty(command) => verbs::penalty(&command),
        Command::Completions(completions) => verbs::completions(&completions),
    };
    exit.unwrap_or_else(Exit::after).into()
}
