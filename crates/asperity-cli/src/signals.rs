//! Interrupts: the first asks the run to stop after its increment, a second one ends the program at once.

use asperity::Error;
use nix::sys::signal::{SigSet, Signal};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// What a shell takes for "ended by an interrupt".
const INTERRUPTED: i32 = 130;
/// Signals closer than this are one: `timeout` and batch systems signal a program and then its group.
const TOGETHER: Duration = Duration::from_secs(1);

/// A flag that the first interrupt raises.
///
/// To be called before any other thread begins. Every thread blocks the signals and one takes them off the queue: a
/// handler would not do, since METIS puts its own in the place of SIGTERM's while it orders.
pub fn listen() -> Result<Arc<AtomicBool>, Error> {
    let internal = |error: nix::Error| Error::Internal(error.to_string());
    let signals = SigSet::from_iter([Signal::SIGINT, Signal::SIGTERM]);
    signals.thread_block().map_err(internal)?;
    let stop = Arc::new(AtomicBool::new(false));
    let raised = stop.clone();
    std::thread::spawn(move || {
        let mut first = None;
        while signals.wait().is_ok() {
            if first.get_or_insert_with(Instant::now).elapsed() > TOGETHER {
                std::process::exit(INTERRUPTED);
            }
            raised.store(true, Ordering::Relaxed);
        }
    });
    Ok(stop)
}
