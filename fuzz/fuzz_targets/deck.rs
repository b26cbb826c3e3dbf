//! Any text as a deck, and any as an override of a good one: built, or refused with messages that can be drawn, never a
//! panic.
#![no_main]

use asperity::deck::{build, read};
use libfuzzer_sys::fuzz_target;
use std::path::Path;

const GOOD: &str = include_str!("../../crates/asperity/tests/decks/every_key_plane.toml");

/// Large meshes are allowed, but not what is tried here: no number of cells of more than two digits.
fn modest(text: &str) -> bool {
    let small = |word: &str| word.len() <= 2 || word.bytes().any(|byte| byte.is_ascii_alphabetic() && byte != b'x');
    !text.contains("cells") || text.split(|c: char| !c.is_ascii_alphanumeric()).all(small)
}

fuzz_target!(|text: &str| {
    if !modest(text) {
        return;
    }
    let whole = read(text, "fuzzed.toml", Path::new("/nowhere"), &[]);
    let set = read(GOOD, "good.toml", Path::new("/nowhere"), &[text.to_owned()]);
    for loaded in [whole, set] {
        if let Err(diagnostics) = loaded.and_then(build) {
            assert!(diagnostics.has_errors() && diagnostics.render(true).contains("error"));
        }
    }
});
