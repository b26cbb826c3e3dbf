//! The guides of the book do what they say: their decks are written into an empty folder and their commands run there.
//!
//! A fence of a deck names its file (` ```toml,name=press.toml `); each line of a ` ```sh ` fence is run and ends with 0, or with what
//! `# exit N` behind it says. What is expected of the results stands in comments:
//!
//! ```text
//! <!-- expect press.results converged -->
//! <!-- expect press.results COLUMN = VALUE within ERROR -->             the last row of history.csv
//! <!-- expect press.results probe.NAME COLUMN = VALUE within ERROR -->  that of a probe
//! ```
//!
//! Notes, warnings and causes that a page quotes are among what was printed, up to `...`.
#![cfg(unix)]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

fn guides() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../book/src/guide");
    let mut pages: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    pages.sort();
    pages
}

/// Fences of a page: what stands behind the backticks, and the lines.
fn fences(page: &str) -> Vec<(&str, Vec<&str>)> {
    let (mut found, mut open): (Vec<(&str, Vec<&str>)>, bool) = (Vec::new(), false);
    for line in page.lines() {
        match line.strip_prefix("```") {
            Some(_) if open => open = false,
            Some(info) => {
                open = true;
                found.push((info, Vec::new()));
            }
            None if open => found.last_mut().unwrap().1.push(line),
            None => {}
        }
    }
    found
}

/// Runs a line, and returns what it printed.
fn run(folder: &Path, line: &str) -> String {
    let (command, code) = line.split_once(" # exit ").unwrap_or((line, "0"));
    let rest = command.strip_prefix("asperity ").unwrap_or_else(|| panic!("'{line}' is no command of ours"));
    let command = format!("\"$ASPERITY\" {rest}");
    let mut shell = Command::new("bash");
    shell.args(["-c", &command]).current_dir(folder).env("ASPERITY", env!("CARGO_BIN_EXE_asperity"));
    let output = shell.output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code.trim().parse().unwrap()), "{line}\n{said}");
    said
}

/// The last row of a table by its columns.
fn last_row(path: &Path) -> BTreeMap<String, f64> {
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let (head, last) = (text.lines().next().unwrap(), text.lines().last().unwrap());
    let number = |field: &str| field.parse().unwrap_or(f64::NAN);
    head.split(',').map(String::from).zip(last.split(',').map(number)).collect()
}

/// Holds one expectation against the results.
fn meet(folder: &Path, expected: &str) {
    let words: Vec<&str> = expected.split_whitespace().collect();
    let directory = folder.join(words[0]);
    let (table, column, value, error) = match words[1..] {
        ["converged"] => {
            let summary = std::fs::read_to_string(directory.join("summary.json")).unwrap();
            return assert!(summary.contains("\"status\": \"converged\""), "{expected}: {summary}");
        }
        [column, "=", value, "within", error] => ("history", column, value, error),
        [probe, column, "=", value, "within", error] => (probe, column, value, error),
        _ => panic!("'{expected}' is no expectation"),
    };
    let row = last_row(&directory.join(format!("{table}.csv")));
    let found = *row.get(column).unwrap_or_else(|| panic!("{expected}: no column; there are {:?}", row.keys()));
    let [value, error]: [f64; 2] = [value, error].map(|number| number.parse().unwrap());
    assert!((found - value).abs() <= error, "{expected}: it is {found}");
}

#[test]
fn the_guides_do_what_they_say() {
    let pages = guides();
    assert!(pages.len() >= 8, "{pages:?}");
    for path in pages {
        let page = std::fs::read_to_string(&path).unwrap();
        let (folder, fences) = (tempfile::tempdir().unwrap(), fences(&page));
        for (info, lines) in &fences {
            if let Some((_, name)) = info.split_once("name=") {
                std::fs::write(folder.path().join(name), lines.join("\n") + "\n").unwrap();
            }
        }
        let commands = fences.iter().filter(|(info, _)| *info == "sh").flat_map(|(_, lines)| lines);
        let said: Vec<String> = commands.map(|line| run(folder.path(), line)).collect();
        assert!(!said.is_empty(), "{} runs nothing", path.display());
        let quoted = fences.iter().filter(|(info, _)| *info == "text").flat_map(|(_, lines)| lines);
        for line in quoted {
            let line = line.split("...").next().unwrap().trim();
            let told = ["note:", "warning:", "most likely:", "seen:", "try:"].iter().any(|word| line.starts_with(word));
            assert!(!told || said.iter().any(|said| said.contains(line)), "{}: '{line}'\n{said:#?}", path.display());
        }
        let expected = page.lines().filter_map(|line| line.strip_prefix("<!-- expect ")?.strip_suffix(" -->"));
        let count = expected.map(|expected| meet(folder.path(), expected)).count();
        assert!(count > 0, "{} expects nothing", path.display());
    }
}
