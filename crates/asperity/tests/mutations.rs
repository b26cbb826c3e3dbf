//! Good decks with random damage: a deck is read or refused with messages, never a panic, and every message can be
//! drawn. The damage is the same in every run.

use std::path::{Path, PathBuf};

/// A small generator of random numbers (xorshift64*), so that a failure can be repeated.
struct Dice(u64);

impl Dice {
    fn roll(&mut self, below: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) as usize % below.max(1)
    }
}

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

/// One piece of damage.
fn damage(text: &mut Vec<u8>, dice: &mut Dice) {
    let at = dice.roll(text.len() + 1);
    let lines: Vec<&[u8]> = text.split(|&byte| byte == b'\n').collect();
    let (i, j) = (dice.roll(lines.len()), dice.roll(lines.len()));
    match dice.roll(8) {
        0 => text.truncate(at),
        1 => drop(text.drain(at..(at + dice.roll(12)).min(text.len()))),
        2 => text.insert(at, dice.roll(256) as u8),
        3 if at < text.len() => text[at] = dice.roll(256) as u8,
        4 => *text = [&lines[..i], &lines[lines.len().min(i + 1)..]].concat().join(&b'\n'),
        5 => *text = [&lines[..i], &[lines[j]], &lines[i..]].concat().join(&b'\n'),
        6 => drop(text.splice(at..at, WORDS[dice.roll(WORDS.len())].bytes())),
        _ => {
            // A whole value for another.
            if let Some(equal) = text[at.min(text.len())..].iter().position(|&byte| byte == b'=') {
                let start = at + equal + 1;
                let end = text[start..].iter().position(|&byte| byte == b'\n').map_or(text.len(), |n| start + n);
                text.splice(start..end, WORDS[dice.roll(WORDS.len())].bytes());
            }
        }
    }
}

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
            damage(&mut bytes, &mut dice);
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
        damage(&mut set, &mut dice);
        let set = String::from_utf8_lossy(&set).into_owned();
        if let Err(diagnostics) = asperity::deck::read(&text, "deck.toml", &folder(), std::slice::from_ref(&set)) {
            assert!(diagnostics.render(false).contains("error"), "{set}");
        }
    }
}
