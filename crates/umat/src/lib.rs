//! Laws of solids from shared libraries, in Fortran or C, with the customary interface of UMAT: loads them for decks and calls
//! them. This is the only crate of the workspace that calls what others wrote, and with `frontal`'s METIS the only one with
//! `unsafe`.
//!
//! A library may call `XIT`, `STDB_ABQERR`, `GETOUTDIR`, `GETJOBNAME`, `ROTSIG`, `SINV`, `SPRINC` and `SPRIND`, which the program
//! exports (see [`SYMBOLS`]). What stops the law stops the increment and not the program; where the law crashes the program
//! dies as it would, after a line that names the library.
#![warn(missing_docs)]
#![deny(unsafe_op_in_unsafe_fn)]

mod arguments;
mod guard;
mod utilities;

pub use utilities::SYMBOLS;

use arguments::{Arguments, Function, UNTOUCHED};
use asperity_core::Failure;
use asperity_core::material::external::{self, Call, Library, UserLaw};
use std::cell::RefCell;
use std::error::Error;
use std::sync::{Arc, Mutex, PoisonError};

/// Names under which a library may have the law: as Fortran writes it and as C does.
const NAMES: [&str; 2] = ["umat_", "umat"];

/// Held while a law is called that is not safe in threads: libraries share the runtime of their language.
static SERIAL: Mutex<()> = Mutex::new(());

/// Values behind the states of a call, so that a law that has more of them than its deck says is told.
const ROOM: usize = 1024;

thread_local! {
    /// States of a call, with room behind them.
    static STATES: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) };
}

/// Lets decks name laws of shared libraries.
pub fn provide() {
    utilities::keep();
    external::provide(load);
}

/// A law of a library that was loaded.
struct Umat {
    function: Function,
    /// What messages call it.
    called: String,
    /// CMNAME, filled up with blanks.
    name: [u8; 80],
    properties: Vec<f64>,
    thread_safe: bool,
}

fn load(library: &Library) -> Result<Arc<dyn UserLaw>, String> {
    let shown = library.path.display();
    // A name without a folder would be looked for where the system keeps its libraries.
    let path = std::path::absolute(&library.path).map_err(|error| format!("{shown}: {error}"))?;
    let refused = |error: libloading::Error| {
        let why = error.source().map_or_else(|| error.to_string(), ToString::to_string);
        format!("{shown} cannot be loaded as a shared library: {why}")
    };
    guard::listen();
    // SAFETY: what a library does when it is loaded is its author's business, and the user named it.
    let loaded = unsafe { open(&path) }.map_err(refused)?;
    // It stays: it may have threads, or functions that run at the end of the program.
    let loaded: &'static libloading::Library = Box::leak(Box::new(loaded));
    // SAFETY: the type is that of the interface; nothing can check it.
    let found = NAMES.iter().find_map(|name| unsafe { loaded.get::<Function>(name.as_bytes()) }.ok());
    let function = *found.ok_or_else(|| format!("{shown} has no function `umat_` or `umat`"))?;
    let mut name = [b' '; 80];
    name.iter_mut().zip(library.name.bytes()).for_each(|(place, byte)| *place = byte);
    let (properties, thread_safe) = (library.properties.clone(), library.thread_safe);
    Ok(Arc::new(Umat { function, called: format!("the law of {shown}"), name, properties, thread_safe }))
}

/// Opens a library with all its symbols found, so that a missing one is told at once.
#[cfg(unix)]
unsafe fn open(path: &std::path::Path) -> Result<libloading::Library, libloading::Error> {
    use libloading::os::unix::{Library, RTLD_LOCAL, RTLD_NOW};
    // SAFETY: as the caller's.
    unsafe { Library::open(Some(path), RTLD_NOW | RTLD_LOCAL) }.map(Into::into)
}

#[cfg(not(unix))]
unsafe fn open(path: &std::path::Path) -> Result<libloading::Library, libloading::Error> {
    // SAFETY: as the caller's.
    unsafe { libloading::Library::new(path) }
}

impl UserLaw for Umat {
    fn name(&self) -> &str {
        &self.called
    }

    fn call(&self, call: &mut Call) -> Result<(), Failure> {
        STATES.with_borrow_mut(|states| {
            states.clear();
            states.extend_from_slice(call.states);
            states.resize(call.states.len() + ROOM, UNTOUCHED);
            let mut arguments = Arguments::of(call, states, &self.name, &self.properties);
            let one = (!self.thread_safe).then(|| SERIAL.lock().unwrap_or_else(PoisonError::into_inner));
            let called = guard::call(&self.called, || arguments.call(self.function));
            drop(one);
            called.map_err(|why| Failure::new(format!("it gives up: {why}")))?;
            if let Some(why) = arguments.overrun() {
                return Err(Failure::new(why));
            }
            let part = arguments.new_time;
            if part < 1.0 || part.is_nan() {
                return Err(Failure::new(format!("it asks for a smaller increment (PNEWDT = {part})")));
            }
            (call.stress, call.tangent, call.energies) = arguments.answers();
            call.states.copy_from_slice(&states[..call.states.len()]);
            Ok(())
        })
    }
}
