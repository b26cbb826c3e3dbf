//! Every deck of the corpus, broken in every line: what is wrong is told with file and line, and nothing panics.

#[path = "../../asperity/tests/support/damage.rs"]
mod damage;

use damage::{Dice, damage};
use std::path::{Path, PathBuf};

fn decks() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/decks");
    let mut decks: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    decks.retain(|path| path.extension().is_some_and(|extension| extension == "inp"));
    decks.sort();
    decks
}

/// A folder with the files that decks include.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let decks = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/decks");
    std::fs::copy(decks.join("spelling.inc"), folder.path().join("spelling.inc")).unwrap();
    folder
}

/// The errors of a text, none if it can be translated.
fn errors(folder: &Path, text: &str) -> Vec<String> {
    let errors = inp::translate_text(&folder.join("deck.inp"), text, "mesh.inp").err().unwrap_or_default();
    for error in &errors {
        let rest = error.starts_with("and ") && error.ends_with(" more like these");
        assert!(rest || error.contains("deck.inp") || error.contains("spelling.inc"), "without a place: {error}");
        assert!(error.len() < 800 && !error.contains("unwrap"), "{error}");
    }
    errors
}

/// The lines of a text with one changed.
fn with(lines: &[&str], at: usize, line: &str) -> String {
    let mut lines = lines.to_vec();
    lines[at] = line;
    lines.join("\n") + "\n"
}

/// Keywords whose data nobody reads.
fn is_read(keyword: &str) -> bool {
    let name = keyword.trim_start_matches('*').split(',').next().unwrap_or("").trim().to_uppercase();
    let idle = ["HEADING", "SURFACE INTERACTION", "PART", "ASSEMBLY"];
    !idle.contains(&name.as_str())
        && inp::keywords::named(&name)
            .is_some_and(|keyword| !matches!(keyword.treated, inp::keywords::Treated::Left(_)))
}

#[test]
fn the_decks_are_sound() {
    let folder = folder();
    for deck in decks() {
        let found = errors(folder.path(), &std::fs::read_to_string(&deck).unwrap());
        assert!(found.is_empty(), "{}: {found:?}", deck.display());
    }
}

/// A field that is neither a number nor the name of anything is told at its line.
#[test]
fn a_wrong_field_is_told_at_its_line() {
    let (folder, mut told) = (folder(), 0);
    for deck in decks() {
        let text = std::fs::read_to_string(&deck).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        let mut keyword = "";
        for (at, line) in lines.iter().enumerate() {
            if line.starts_with('*') {
                keyword = if line.starts_with("**") { keyword } else { line };
                continue;
            }
            if line.contains('=') || line.trim() == "generate" || !is_read(keyword) {
                continue;
            }
            let fields: Vec<&str> = line.trim_end_matches(',').split(',').collect();
            for field in (0..fields.len()).filter(|&field| !fields[field].trim().is_empty()) {
                let mut fields = fields.clone();
                fields[field] = "?%&";
                let found = errors(folder.path(), &with(&lines, at, &fields.join(",")));
                let place = format!("deck.inp:{}: ", at + 1);
                let said = found.iter().any(|error| error.contains(&place) && error.contains("?%&"));
                // The name of a surface's own part is told where the surface is used.
                assert!(
                    said || !found.is_empty(),
                    "{}:{}: field {field} of '{line}': {found:?}",
                    deck.display(),
                    at + 1
                );
                told += usize::from(said);
            }
        }
    }
    assert!(told > 1500, "only {told} fields were told at their line");
}

/// A field more than a line has is told at its line, whether it would have a meaning or not.
#[test]
fn a_field_too_many_is_told_at_its_line() {
    let folder = folder();
    for deck in decks() {
        let text = std::fs::read_to_string(&deck).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        let mut keyword = "";
        for (at, line) in lines.iter().enumerate() {
            if line.starts_with('*') {
                keyword = if line.starts_with("**") { keyword } else { line };
                continue;
            }
            if line.contains('=') || line.trim() == "generate" || !is_read(keyword) || line.trim().is_empty() {
                continue;
            }
            let found = errors(folder.path(), &with(&lines, at, &format!("{},?%&", line.trim_end_matches(','))));
            let place = format!("deck.inp:{}: ", at + 1);
            let told = found.iter().any(|error| error.contains(&place));
            assert!(told, "{}:{}: '{line}': {found:?}", deck.display(), at + 1);
        }
    }
}

/// A keyword or a parameter of no known name is told, with the nearest one.
#[test]
fn a_wrong_keyword_is_told_at_its_line() {
    let folder = folder();
    for deck in decks() {
        let text = std::fs::read_to_string(&deck).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        for (at, line) in lines.iter().enumerate().filter(|(_, line)| line.starts_with('*') && !line.starts_with("**"))
        {
            let place = format!("deck.inp:{}: ", at + 1);
            let wrong = line.replacen('*', "*Q", 1);
            let found = errors(folder.path(), &with(&lines, at, &wrong));
            assert!(
                found.iter().any(|error| error.contains(&place) && error.contains("no keyword")),
                "{line}: {found:?}"
            );
            let left = inp::keywords::named(&line[1..].split(',').next().unwrap().to_uppercase())
                .is_none_or(|keyword| matches!(keyword.treated, inp::keywords::Treated::Left(_)));
            if !left && !line.trim_end().ends_with(',') {
                let found = errors(folder.path(), &with(&lines, at, &format!("{line}, BOGUS=1")));
                assert!(
                    found.iter().any(|error| error.contains(&place) && error.contains("BOGUS")),
                    "{line}: {found:?}"
                );
            }
        }
    }
}

/// A deck that ends too early is told so; one without a line, or with two lines swapped, is read or told.
#[test]
fn torn_decks_do_not_panic() {
    let folder = folder();
    for deck in decks() {
        let text = std::fs::read_to_string(&deck).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        let first = lines.iter().position(|line| !line.starts_with("**")).unwrap();
        for at in 0..lines.len() {
            let torn = lines[..at].join("\n");
            let found = errors(folder.path(), &torn);
            assert!(
                at <= first || !found.is_empty() || torn.to_uppercase().contains("*END STEP"),
                "{}:{at}",
                deck.display()
            );
            let mut rest = lines.clone();
            let removed = rest.remove(at);
            errors(folder.path(), &rest.join("\n"));
            rest.insert((at * 7 + 3) % lines.len(), removed);
            errors(folder.path(), &rest.join("\n"));
            if let Some(half) = lines[at].get(..lines[at].len() / 2) {
                errors(folder.path(), &with(&lines, at, half));
            }
        }
    }
}

/// Decks in UTF-16 and with the ends of lines of other machines say the same.
#[test]
fn encodings_and_ends_of_lines() {
    let folder = folder();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/decks/cload.inp");
    let text = std::fs::read_to_string(&path).unwrap();
    let deck = folder.path().join("cload.inp");
    let translated = |bytes: &[u8]| {
        std::fs::write(&deck, bytes).unwrap();
        inp::translate(&deck, "mesh.inp").unwrap().deck
    };
    let plain = translated(text.as_bytes());
    let wide = |of: fn(u16) -> [u8; 2]| format!("\u{feff}{text}").encode_utf16().flat_map(of).collect::<Vec<u8>>();
    assert_eq!(translated(&wide(u16::to_le_bytes)), plain);
    assert_eq!(translated(&wide(u16::to_be_bytes)), plain);
    assert_eq!(translated(text.replace('\n', "\r\n").as_bytes()), plain);
    assert_eq!(translated(text.replace('\n', "\r").as_bytes()), plain);
}

#[test]
fn files_that_are_no_decks_are_told() {
    let folder = folder();
    assert!(errors(folder.path(), "")[0].contains("no *STEP"));
    assert!(errors(folder.path(), "1, 2, 3\n")[0].contains("begins with a *KEYWORD"));
    assert!(errors(folder.path(), "\u{0}\u{1}*\n*,\n,,,\n*NODE\n")[0].contains("deck.inp:1"));
    assert!(errors(folder.path(), "*INCLUDE, INPUT=deck.inp\n")[0].contains("includes itself"));
    assert!(errors(folder.path(), "*INCLUDE, INPUT=gone.inc\n")[0].contains("cannot be read"));
    assert!(errors(folder.path(), "*INCLUDE, INPUT=.\n")[0].contains("no regular file"));
    let errors = inp::translate(&folder.path().join("gone.inp"), "mesh.inp").unwrap_err();
    assert!(errors[0].contains("gone.inp") && errors[0].contains("cannot be read"));
}

/// What once passed without a word.
#[test]
fn nothing_is_passed_over() {
    let folder = folder();
    let text =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/decks/held_loads.inp")).unwrap();
    let said = |from: &str, to: &str, what: &str| {
        assert!(text.contains(from), "{from}");
        let found = errors(folder.path(), &text.replace(from, to));
        assert!(found.iter().any(|error| error.contains(what)), "{to}: {found:?}");
    };
    said("1000, 0\n", "1000, 0, 20, 7\n", "*ELASTIC does not read field 4, '7'");
    said("1, P4, 3\n", "1, P4, 3, 5\n", "*DLOAD does not read field 4, '5'");
    said("*STATIC\n", "*STATIC\n.1, 1.\n.2, 1.\n", "*STATIC does not read this line");
    said("*MATERIAL", "*SURFACE, NAME=S\n1, -4\n*MATERIAL", "no face '-4'");
    said("*MATERIAL", "*SURFACE, NAME=S\n1, S+4\n*MATERIAL", "no face 'S+4'");
    // A keyword line that is wrong does not hide what is wrong below it.
    said("*CLOAD\nRIGHT, 1, 5\n", "*CLOAD, AMPLITUDE=A\nRIGHTT, 1, 5\n", "did you mean 'RIGHT'?");
    // Nor does an unknown type make errors of all that names its elements.
    let found = errors(folder.path(), &text.replace("TYPE=CPE4", "TYPE=CPE44"));
    assert!(found.len() == 1 && found[0].contains("elements of type CPE44"), "{found:?}");
    let tied = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/decks/tie.inp")).unwrap();
    let led = tied.replace("*STATIC\n", "*STATIC\n*BOUNDARY\n101, 3, 3, -0.01\n");
    let notes = inp::translate_text(&folder.path().join("deck.inp"), &led, "mesh.inp").unwrap().notes;
    assert!(
        notes.iter().any(|note| note.contains("1 of these nodes are of a surface that follows in a *TIE")),
        "{notes:?}"
    );
    let some = text.replace("1, 4\n", "1, 4\n*NSET, NSET=SOME, GENERATE\n3, 9\n");
    let made = inp::translate_text(&folder.path().join("deck.inp"), &some, "mesh.inp");
    let notes = made.map(|made| made.notes);
    assert!(
        notes.as_ref().is_ok_and(|notes| notes.iter().any(|note| note.contains("2 of the 7 numbers"))),
        "{notes:?}"
    );
}

/// All faults are told at once.
#[test]
fn all_faults_at_once() {
    let folder = folder();
    let text =
        "*NODE\n1, 0., x\n*ELEMENT, TYPE=B31\n*ELASTIC\n1., 0.\n*EMBEDDED ELEMENT\n*BOUNDERY\nA, 1\n*STEP\n*DYNAMIC\n";
    let found = errors(folder.path(), text);
    for (line, said) in [
        (2, "a coordinate is 'x'"),
        (3, "elements of type B31"),
        (4, "belongs to no material"),
        (6, "*EMBEDDED ELEMENT cannot be translated"),
        (7, "did you mean 'BOUNDARY'?"),
        (10, "only *STATIC steps"),
    ] {
        let place = format!("deck.inp:{line}: ");
        assert!(found.iter().any(|error| error.contains(&place) && error.contains(said)), "{said}: {found:#?}");
    }
}

const WORDS: &[&str] = &[
    "*",
    "**",
    ",",
    ",,",
    "=",
    "\n",
    "nan",
    "-inf",
    "1e999",
    "-1",
    "0",
    "99999999999",
    "1.D+5",
    "\u{0}",
    "\u{e9}",
    "\u{1f980}",
    "*STEP\n",
    "*END STEP\n",
    "*INCLUDE, INPUT=deck.inp\n",
    "*NODE\n",
    "*PART, NAME=A\n",
    "GENERATE",
    "*EQUATION\n2\n",
];

/// Decks with random damage are translated or refused, each message with its place, and nothing panics.
#[test]
fn damaged_decks_are_translated_or_refused() {
    let (folder, mut dice) = (folder(), Dice(0x9e37_79b9_7f4a_7c15));
    let decks: Vec<Vec<u8>> = decks().iter().map(|deck| std::fs::read(deck).unwrap()).collect();
    let (mut translated, mut refused) = (0, 0);
    for round in 0..10_000 {
        let mut bytes = decks[round % decks.len()].clone();
        for _ in 0..=dice.roll(3) {
            damage(&mut bytes, WORDS, &mut dice);
        }
        match errors(folder.path(), &String::from_utf8_lossy(&bytes)).is_empty() {
            true => translated += 1,
            false => refused += 1,
        }
    }
    assert!(translated > 500 && refused > 4000, "{translated} translated, {refused} refused");
}
