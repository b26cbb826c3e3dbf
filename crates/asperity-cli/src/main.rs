//! The `asperity` command: reads its arguments, calls one verb of the library and ends with an exit code that scripts
//! can trust. It prints; the library does not. Mechanics is no business of this crate.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod arguments;
mod exit;
mod ranks;
mod screen;
mod signals;
mod verbs;
mod watch;

use arguments::{Command, Line};
use clap::Parser;
use exit::Exit;
use signals::Interrupts;
use std::process::ExitCode;
use verbs::Outcome;

fn main() -> ExitCode {
    let line = Line::parse();
    asperity::machine::give_back_large_arrays();
    umat::provide();
    Interrupts::listen()
        .map_or_else(
            |error| Exit::after(error.into()),
            |interrupts| ranks::obey(&line.command, |command| obey(command, &interrupts)),
        )
        .into()
}

fn obey(command: &Command, interrupts: &Interrupts) -> Outcome {
    match command {
        Command::Run(run) => verbs::run(run, interrupts),
        Command::Restart(restart) => verbs::restart(restart, interrupts),
        Command::Figure(figure) => verbs::figure(figure),
        Command::Report(report) => verbs::report(report),
        Command::Watch(watch) => verbs::watch(watch, interrupts),
        Command::Check(check) => verbs::check(check),
        Command::Info(info) => verbs::info(info),
        Command::Translate(translate) => verbs::translate(translate),
        Command::Schema(schema) => verbs::schema(schema),
        Command::Point(point) => verbs::point(point),
        Command::Laws => verbs::laws(),
        Command::Penalty(command) => verbs::penalty(command, interrupts),
        Command::Completions(completions) => verbs::completions(completions),
    }
}
