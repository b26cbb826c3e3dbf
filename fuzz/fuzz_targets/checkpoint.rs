//! Any bytes as a checkpoint, and any as the state of one whose head and checksum are right: read, or refused in one
//! sentence, never a panic.
#![no_main]

use asperity::output::checkpoint::{Head, InputHash, Stamp, load, save};
use asperity::system::State;
use libfuzzer_sys::fuzz_target;
use sha2::{Digest, Sha256};
use std::path::Path;

/// Bytes before the state.
const HEAD: usize = 76;

fn sealed(path: &Path, input: InputHash, packed: &[u8]) -> Vec<u8> {
    let stamp = Stamp { step: 0, increment: 0, time: 0.0 };
    save(path, &Head { input, stamp }, &State::default()).expect("a temporary directory that can be written");
    let mut bytes = std::fs::read(path).expect("what was just written");
    bytes.truncate(HEAD);
    let body = zstd::bulk::compress(packed, 1).expect("bytes can be compressed");
    bytes[HEAD - 8..].copy_from_slice(&(body.len() as u64).to_le_bytes());
    bytes.extend_from_slice(&body);
    let sum = Sha256::digest(&bytes);
    bytes.extend_from_slice(&sum);
    bytes
}

fuzz_target!(|bytes: &[u8]| {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let path = directory.path().join("fuzzed.checkpoint");
    let input = InputHash::of(&[b"deck"]);
    for content in [bytes.to_vec(), sealed(&path, input, bytes)] {
        std::fs::write(&path, content).expect("a temporary directory that can be written");
        if let Err(error) = load::<State>(&path, &input) {
            let text = error.to_string();
            assert!(text.contains("fuzzed.checkpoint") && !text.contains('\n'), "{text}");
        }
    }
});
