//! Any text as an input deck of Abaqus or CalculiX: translated into a deck that is read, or refused with messages that name
//! file and line, never a panic.
#![no_main]

use libfuzzer_sys::fuzz_target;
use std::path::Path;

fuzz_target!(|text: &str| {
    match inp::translate_text(Path::new("/nowhere/fuzzed.inp"), text, "mesh.inp") {
        Ok(translation) => {
            // Its mesh is not there; everything else of the deck is read.
            let _ = asperity::deck::read(&translation.deck, "fuzzed.toml", Path::new("/nowhere"), &[]);
        }
        Err(errors) => assert!(!errors.is_empty() && errors.iter().all(|error| !error.is_empty())),
    }
});
