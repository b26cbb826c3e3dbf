//! Good decks with random damage: a deck is read or refused with messages, never a panic, and every message can be
//! drawn. The damage is the same in every run.

#[path = "support/damage.rs"]
mod damage;

use damage::{Dice, damage};
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/decks")
}

fn decks() -> Vec<Vec<u8>> {
    let mut paths: Vec<_> = std::fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    paths.sort();
    paths.iter().map(|path| std::fs::read(path).unwrap()).collect()
}

const WORDS: &[&str] = &[
    "nan",
    "-inf",
    "1e999",
    "-1",
    "0",
    "\"\"",
    "[]",
    "{}",
    "[[",
    "]]",
    "=",
    "\n",
    ".",
    "\"",
    "'''",
    "#",
    "\u{0}",
    "\u{7f}",
    "true",
    "0x7fffffffffffffff",
    "1979-05-27",
    "\u{e9}",
    "\u{1f980}",
    "[step]",
    "[[step]]",
    "a.b.c = 1",
    "version = 1",
];

/// Damage may ask for a huge mesh, which is allowed but not what is tried here.
fn modest(text: &str) -> bool {
    let small = |word: &str| word.len() <= 2 || word.bytes().any(|byte| byte.is_ascii_alphabetic() && byte != b'x');
    let words = |line: &str| line.split(|c: char| !c.is_ascii_alphanumeric()).all(small);
    text.lines().filter(|line| line.contains("cells")).all(words)
}

#[test]
fn damaged_decks_are_read_or_refused() {
    let (decks, mut dice) = (decks(), Dice(0x9e37_79b9_7f4a_7c15));
    let (mut read, mut refused) = (0, 0);
    for round in 0..12_000 {
        let mut bytes = decks[round % decks.len()].clone();
        for _ in 0..=dice.roll(3) {
            damage(&mut bytes, WORDS, &mut dice);
        }
        let text = String::from_utf8_lossy(&bytes);
        if !modest(&text) {
            continue;
        }
        match asperity::deck::read(&text, "damaged.toml", &folder(), &[]) {
            Ok(_) => read += 1,
            Err(diagnostics) => {
                assert!(diagnostics.has_errors() && !diagnostics.render(true).is_empty());
                refused += 1;
            }
        }
    }
    assert!(refused > 6000 && read > 300, "{refused} refused, {read} read");
}

#[test]
fn damaged_overrides_are_applied_or_refused() {
    let (text, mut dice) = (String::from_utf8(decks().swap_remove(0)).unwrap(), Dice(7));
    for _ in 0..2000 {
        let mut set = b"step.1.increments.first=0.25".to_vec();
        damage(&mut set, WORDS, &mut dice);
        let set = String::from_utf8_lossy(&set).into_owned();
        if let Err(diagnostics) = asperity::deck::read(&text, "deck.toml", &folder(), std::slice::from_ref(&set)) {
            assert!(diagnostics.render(false).contains("error"), "{set}");
        }
    }
}
