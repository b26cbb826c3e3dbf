//! Every deck of the corpus, broken in every line: what is wrong is told with file and line, and nothing panics.

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
