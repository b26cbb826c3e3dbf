//! `asperity watch`: the report of a run that goes.

use super::{Outcome, print};
use crate::arguments::Watch;
use crate::exit::Exit;
use crate::signals::Interrupts;
use crate::watch::{Server, show};
use std::io::IsTerminal;
use std::sync::atomic::Ordering;

/// Serves the page on the loopback address until it is interrupted; in a terminal with a full-screen view beside it.
pub fn watch(arguments: &Watch, interrupts: &Interrupts) -> Outcome {
    // What cannot be shown is told before anything is served.
    report::status(&arguments.directory)?;
    let server = Server::open(&arguments.directory, arguments.port)?;
    let address = server.address();
    let stop = interrupts.heed();
    if !arguments.plain && std::io::stdin().is_terminal() && std::io::stdout().is_terminal() {
        return std::thread::scope(|scope| {
            let served = scope.spawn(|| server.serve(&stop));
            let shown = show(&arguments.directory, &address, &stop);
            stop.store(true, Ordering::Relaxed);
            served.join().unwrap_or(Ok(()))?;
            Ok(shown.map(|()| Exit::Done)?)
        });
    }
    print(&format!(
        "{address}\nopen this address in a browser on this machine; Ctrl-C ends the server, not the run\n"
    ))?;
    server.serve(&stop)?;
    Ok(Exit::Done)
}
