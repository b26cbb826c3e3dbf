//! Interrupts: the first asks a run to stop after its increment, one that comes more than a second later ends the program
//! at once, as the first does where nothing runs.

use asperity::Error;
use nix::sys::signal::{SigSet, Signal};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// What a shell adds to the number of a signal that ended a program.
const ENDED: i32 = 128;
/// Signals closer than this are one: `timeout` and batch systems signal a program and then its group.
const TOGETHER: Duration = Duration::from_secs(1);

/// What became of interrupts.
pub struct Interrupts {
    raised: Arc<AtomicBool>,
    heeded: Arc<AtomicBool>,
}

impl Interrupts {
    /// Takes interrupts from here on.
    ///
    /// To be called before any other thread begins. Every thread blocks the signals and one takes them off the queue: a
    /// handler would not do, since METIS puts its own in the place of SIGTERM's while it orders.
    pub fn listen() -> Result<Self, Error> {
        let internal = |error: std::io::Error| Error::Internal(error.to_string());
        let signals = SigSet::from_iter([Signal::SIGINT, Signal::SIGTERM]);
        signals.thread_block().map_err(|error| internal(error.into()))?;
        // A file that grows beyond a limit is an error of its writer, not the end of the program.
        SigSet::from(Signal::SIGXFSZ).thread_block().map_err(|error| internal(error.into()))?;
        let interrupts = Self { raised: Arc::default(), heeded: Arc::default() };
        let (raised, heeded) = (interrupts.raised.clone(), interrupts.heeded.clone());
        let take = move || {
            let mut first = None;
            while let Ok(signal) = signals.wait() {
                let patient = first.get_or_insert_with(Instant::now).elapsed() <= TOGETHER;
                if !(patient && heeded.load(Ordering::Relaxed)) {
                    std::process::exit(ENDED + signal as i32);
                }
                raised.store(true, Ordering::Relaxed);
            }
        };
        std::thread::Builder::new().spawn(take).map_err(internal)?;
        Ok(interrupts)
    }

    /// A flag that the first interrupt raises from now on.
    pub fn heed(&self) -> Arc<AtomicBool> {
        self.heeded.store(true, Ordering::Relaxed);
        self.raised.clone()
    }
}
