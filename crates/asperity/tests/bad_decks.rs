//! Broken decks and meshes, each beside the message that it must give.
//!
//! `tests/bad_decks/NAME.toml` is refused with exactly the text of `NAME.txt`. `ASPERITY_BLESS=1` writes these texts
//! anew, to be read by a person before they are committed.

use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad_decks")
}

/// In place of a message: there is none.
const TAKEN: &str = "taken for good";

/// What a user reads, with paths as seen from the folder of the decks.
fn message(path: &Path) -> String {
    let built = asperity::deck::load(path, &[]).and_then(asperity::deck::build);
    let Err(diagnostics) = built else { return TAKEN.to_owned() };
    assert!(diagnostics.has_errors());
    let text = diagnostics.render(false);
    text.replace(&format!("{}/", folder().display()), "") + "\n"
}

fn decks() -> Vec<PathBuf> {
    let mut paths: Vec<_> = std::fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    paths.sort();
    paths
}

#[test]
fn each_broken_deck_gives_its_message() {
    let decks = decks();
    assert!(decks.len() >= 200, "{}", decks.len());
    let bless = std::env::var_os("ASPERITY_BLESS").is_some();
    let mut different = Vec::new();
    for path in &decks {
        let (golden, found) = (path.with_extension("txt"), message(path));
        if bless {
            std::fs::write(&golden, &found).unwrap();
        }
        let wanted = std::fs::read_to_string(&golden).unwrap_or_default();
        if wanted != found || found == TAKEN {
            different.push(format!("{}\nwanted:\n{wanted}\nfound:\n{found}", path.display()));
        }
    }
    assert!(different.is_empty(), "{}", different.join("\n\n"));
}

/// The first `FILE:LINE:` of a message.
fn place(message: &str) -> Option<(String, usize)> {
    let (file, rest) = message.split_once("--> ")?.1.split_once(':')?;
    Some((file.to_owned(), rest.split(':').next()?.parse().ok()?))
}

#[test]
fn each_message_names_a_file_and_a_line_of_it() {
    for path in decks() {
        let text = message(&path);
        let name = path.file_name().unwrap().to_string_lossy();
        let Some((file, line)) = place(&text) else {
            assert!(text.contains(&format!("{name}: line 2 is not UTF-8")), "{name}: {text}");
            continue;
        };
        let lines = std::fs::read(folder().join(file)).unwrap().split(|&byte| byte == b'\n').count();
        assert!((1..=lines).contains(&line), "{name}: {text}");
    }
}
