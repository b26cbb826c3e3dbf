//! Checkpoints with damage: every truncation, every flipped bit, foreign bytes with a right checksum, checkpoints of
//! other decks and of other formats. Each is refused in one sentence or read as what was written; nothing panics, and
//! nothing that does not fit its model is run.

mod support;

use asperity::deck::{build, read};
use asperity::diagnosis::Facts;
use asperity::output::checkpoint::{self, Head, InputHash, Stamp};
use asperity::output::{Job, Kept, Start, simulate};
use asperity::solve::Silent;
use asperity::system::{Energies, History, State};
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};

/// Bytes before the state, and of the checksum behind it.
const HEAD: usize = 76;
const SUM: usize = 32;

fn state() -> State {
    let wave = |n: usize| (0..n).map(|i| (i as f64).sin()).collect::<Vec<_>>();
    State {
        step: 1,
        increment: 7,
        u: wave(60),
        last_change: wave(60),
        energies: vec![Energies { stored: 1.0, dissipated: 0.5, ..Energies::default() }],
        histories: vec![History { starts: vec![0, 3, 9], data: wave(9) }],
        ..State::default()
    }
}

fn input() -> InputHash {
    InputHash::of(&[b"deck", b"mesh"])
}

struct File {
    _directory: tempfile::TempDir,
    path: PathBuf,
    sound: Vec<u8>,
}

fn saved() -> File {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("run.checkpoint");
    let stamp = Stamp { step: 1, increment: 7, time: 0.5 };
    checkpoint::save(&path, &Head { input: input(), stamp }, &state()).unwrap();
    let sound = std::fs::read(&path).unwrap();
    File { _directory: directory, path, sound }
}

impl File {
    /// What reading these bytes gives; an error must be one sentence that names the file.
    fn load(&self, bytes: &[u8]) -> Result<State, String> {
        std::fs::write(&self.path, bytes).unwrap();
        let loaded = checkpoint::read::<State>(&self.path);
        loaded.map(|(_, state)| state).map_err(|error| {
            let text = error.to_string();
            assert!(text.contains("run.checkpoint") && !text.contains('\n') && text.len() < 400, "{text}");
            text
        })
    }

    /// The same with a checksum and a length that fit, as an attacker or another program would write.
    fn load_sealed(&self, mut bytes: Vec<u8>) -> Result<State, String> {
        bytes.truncate(bytes.len() - SUM);
        let length = (bytes.len().saturating_sub(HEAD)) as u64;
        bytes[HEAD - 8..HEAD].copy_from_slice(&length.to_le_bytes());
        let sum = Sha256::digest(&bytes);
        bytes.extend_from_slice(&sum);
        self.load(&bytes)
    }
}

#[test]
fn every_truncation_and_every_flipped_byte_is_refused() {
    let file = saved();
    for length in 0..file.sound.len() {
        assert!(file.load(&file.sound[..length]).is_err(), "{length} bytes");
    }
    for place in 0..file.sound.len() {
        let mut bytes = file.sound.clone();
        bytes[place] ^= 1 << (place % 8);
        let text = file.load(&bytes).unwrap_err();
        let wanted = match place {
            0..8 => "not a checkpoint",
            8..12 => "is of format",
            _ => "damaged",
        };
        assert!(text.contains(wanted), "byte {place}: {text}");
    }
    assert_eq!(file.load(&file.sound).unwrap(), state());
}

#[test]
fn damage_under_a_right_checksum_does_not_panic() {
    let file = saved();
    let mut dice = 0x9e37_79b9_7f4a_7c15_u64;
    let mut roll = |below: usize| {
        dice ^= dice << 13;
        dice ^= dice >> 7;
        dice ^= dice << 17;
        (dice >> 16) as usize % below
    };
    let (mut read, mut refused) = (0, 0);
    for _ in 0..3000 {
        let mut bytes = file.sound.clone();
        for _ in 0..=roll(3) {
            // Between the head and the sum: the compressed state.
            let place = HEAD + roll(bytes.len() - HEAD - SUM);
            match roll(3) {
                0 => bytes[place] = roll(256) as u8,
                1 => drop(bytes.remove(place)),
                _ => bytes.insert(place, roll(256) as u8),
            }
        }
        match file.load_sealed(bytes) {
            Ok(_) => read += 1,
            Err(_) => refused += 1,
        }
    }
    assert!(refused > 1000, "{read} read, {refused} refused");
}

#[test]
fn a_state_that_announces_too_much_is_refused() {
    let file = saved();
    // A vector of 2^62 numbers after the first four values.
    let mut packed = vec![0_u8; 2];
    packed.extend([0x01; 1]);
    packed.extend([0; 16]);
    packed.extend([0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x3f]);
    let body = zstd::bulk::compress(&packed, 3).unwrap();
    let bytes = [&file.sound[..HEAD], &body, &[0; SUM]].concat();
    assert!(file.load_sealed(bytes).is_err());
}

const DECK: &str = r#"
version = 1
space = "plane-strain"
mesh.part.block.rectangle = { from = [0.0, 0.0], to = [2.0, 1.0], cells = [2, 1], cell = "quad4" }
material.steel.elastic = { young = 210e3, poisson = 0.3 }
body.block.material = "steel"
[[step]]
displacement."block.bottom" = { x = 0.0, y = 0.0 }
displacement."block.top" = { y = 0.01 }
"#;

/// Restarts a deck in a directory; the words of the error.
fn restart(deck: &str, directory: &Path) -> String {
    let made = read(deck, "deck.toml", Path::new(""), &[]).and_then(build).unwrap_or_else(|d| panic!("{d:?}"));
    let facts = Facts::default();
    let job = Job { start: Start::Checkpoint, ..support::job(&made, directory, &facts) };
    simulate(&made.model, &job, &mut Silent).unwrap_err().to_string()
}

#[test]
fn a_checkpoint_of_another_deck_or_of_another_model_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("run.checkpoint");
    let missing = restart(DECK, directory.path());
    assert!(missing.contains("run.checkpoint"), "{missing}");
    let made = read(DECK, "deck.toml", Path::new(""), &[]).and_then(build).unwrap_or_else(|d| panic!("{d:?}"));
    let head = Head { input: made.input, stamp: Stamp { step: 0, increment: 1, time: 0.1 } };
    let terms = made.model.problem.terms.iter().map(|term| term.name().to_owned()).collect();
    let kept = Kept { parts: made.parts.clone(), terms, state: made.model.problem.initial_state() };
    checkpoint::save(&path, &head, &kept).unwrap();
    let other = restart(&DECK.replace("210e3", "200e3"), directory.path());
    assert!(other.contains("another deck or mesh"), "{other}");
    // The right deck, but a state of something else.
    checkpoint::save(&path, &head, &Kept { state: state(), ..kept }).unwrap();
    let unfit = restart(DECK, directory.path());
    assert!(unfit.contains("run.checkpoint"), "{unfit}");
    // What was refused leaves no results behind.
    let left = std::fs::read_dir(directory.path()).unwrap().count();
    assert_eq!(left, 1);
}
