//! `asperity watch`: the report of a run that goes.

use super::{Outcome, print};
use crate::arguments::Watch;
use crate::exit::Exit;
use crate::signals::Interrupts;
use crate::watch::Server;

/// Serves the page on the loopback address until it is interrupted.
pub fn watch(arguments: &Watch, interrupts: &Interrupts) -> Outcome {
    // What cannot be shown is told before anything is served.
    report::status(&arguments.directory)?;
    let server = Server::open(&arguments.directory, arguments.port)?;
    let address = server.address();
    print(&format!(
        "{address}\nopen this address in a browser on this machine; Ctrl-C ends the server, not the run\n"
    ))?;
    server.serve(&interrupts.heed())?;
    Ok(Exit::Done)
}
