//! Interrupts: the first asks the run to stop after its increment, a second one ends the program at once.

use asperity::Error;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// What a shell takes for "ended by an interrupt".
const INTERRUPTED: i32 = 130;

/// A flag that the first interrupt raises.
pub fn listen() -> Result<Arc<AtomicBool>, Error> {
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        // Order matters: the first signal finds the flag down, raises it, and lives.
        let at_once = flag::register_conditional_shutdown(signal, INTERRUPTED, stop.clone());
        let registered = at_once.and_then(|_| flag::register(signal, stop.clone()));
        registered.map_err(|error| Error::Internal(error.to_string()))?;
    }
    Ok(stop)
}
