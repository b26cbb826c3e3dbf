//! Every input deck of `crates/inp/tests/decks` and `benches/input_decks/decks`, translated and run, against what its own
//! comments expect, closed forms there and the answers of CalculiX here:
//!
//! ```text
//! ** expect u NODE AXIS = VALUE within ERROR             a displacement at the end
//! ** expect COLUMN [at TIME] = VALUE within ERROR        a column of history.csv
//! ** expect ratio COLUMN COLUMN = VALUE within ERROR     one over the other, at the end
//! ```

use asperity::deck;
use asperity::output::{Job, RunStatus, Start, simulate};
use asperity::solve::{RunOptions, Silent};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

struct Expected {
    what: Vec<String>,
    value: f64,
    within: f64,
}

fn decks() -> Vec<PathBuf> {
    let folders = ["../inp/tests/decks", "../../benches/input_decks/decks"];
    let folders = folders.map(|folder| Path::new(env!("CARGO_MANIFEST_DIR")).join(folder));
    let files = folders.iter().flat_map(|folder| std::fs::read_dir(folder).unwrap());
    let mut decks: Vec<PathBuf> = files.map(|entry| entry.unwrap().path()).collect();
    decks.retain(|path| path.extension().is_some_and(|extension| extension == "inp"));
    // It needs a library, which the tests of such compile.
    decks.retain(|path| path.file_stem().is_some_and(|name| name != "user_material"));
    decks.sort();
    decks
}

fn expected(text: &str) -> Vec<Expected> {
    let lines = text.lines().filter_map(|line| line.strip_prefix("** expect "));
    lines
        .map(|line| {
            let (what, rest) = line.split_once(" = ").unwrap();
            let (value, within) = rest.split_once(" within ").unwrap();
            let what = what.split_whitespace().map(str::to_owned).collect();
            Expected { what, value: value.trim().parse().unwrap(), within: within.trim().parse().unwrap() }
        })
        .collect()
}

/// The columns of `history.csv`.
fn history(directory: &Path) -> BTreeMap<String, Vec<f64>> {
    let text = std::fs::read_to_string(directory.join("history.csv")).unwrap();
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    let column = |at: usize| rows.iter().map(|row| row[at].parse().unwrap_or(f64::NAN)).collect();
    names.iter().enumerate().map(|(at, name)| ((*name).to_owned(), column(at))).collect()
}

/// What differs from what a deck expects, one line each.
fn differences(path: &Path) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let told = |what: &dyn std::fmt::Display| vec![format!("{}: {what}", path.file_name().unwrap().display())];
    let translation = match inp::translate(path, "mesh.inp") {
        Ok(translation) => translation,
        Err(errors) => return told(&errors.join("\n")),
    };
    std::fs::write(folder.path().join("mesh.inp"), &translation.mesh).unwrap();
    let made = match deck::read(&translation.deck, "deck", folder.path(), &[]).and_then(deck::build) {
        Ok(made) => made,
        Err(diagnostics) => return told(&diagnostics.render(false)),
    };
    let expected = expected(&std::fs::read_to_string(path).unwrap());
    assert!(!expected.is_empty(), "{} expects nothing", path.display());
    let mut run = made.model.run(made.model.problem.initial_state());
    if let Err(error) = run.run(&RunOptions::default(), &mut Silent) {
        return told(&error);
    }
    let mesh = &made.model.mesh;
    let mut columns = BTreeMap::new();
    if expected.iter().any(|expected| expected.what[0] != "u") {
        let (options, limits) = (made.results.clone(), &made.deck.limits.limits);
        let directory = folder.path();
        let job = Job {
            directory,
            options,
            input: made.input,
            parts: &made.parts,
            asked: None,
            start: Start::Beginning,
            limits,
            notes: &[],
            facts: &Default::default(),
        };
        let (summary, _) = simulate(&made.model, &job, &mut Silent).unwrap();
        if !matches!(summary.status, RunStatus::Converged | RunStatus::Doubtful) {
            return told(&format!("{:?}", summary.status));
        }
        columns = history(directory);
    }
    let column = |name: &str| {
        columns.get(name).unwrap_or_else(|| panic!("{}: no column {name}: {:?}", path.display(), columns.keys()))
    };
    let found = |what: &[&str]| match what {
        ["u", node, axis] => {
            let number: u64 = node.parse().unwrap();
            let node = (0..mesh.points.len()).find(|&node| mesh.node_number(node) == number).unwrap();
            // The unknowns of the nodes come first.
            run.state.u[node * mesh.dimension() + axis.parse::<usize>().unwrap() - 1]
        }
        ["ratio", one, other] => column(one).last().unwrap() / column(other).last().unwrap(),
        [name, "at", time] => {
            let time: f64 = time.parse().unwrap();
            let row = column("time").iter().position(|t| (t - time).abs() < 1e-9).unwrap();
            column(name)[row]
        }
        [name] => *column(name).last().unwrap(),
        _ => panic!("{}: {what:?} is no expectation", path.display()),
    };
    let wrong = expected.iter().filter_map(|expected| {
        let what: Vec<&str> = expected.what.iter().map(String::as_str).collect();
        let found = found(&what);
        let off = (found - expected.value).abs();
        let line = || format!("{}: {} is {found}, not {}", path.display(), what.join(" "), expected.value);
        (off.is_nan() || off > expected.within).then(line)
    });
    wrong.collect()
}

#[test]
fn every_input_deck_gives_what_it_expects() {
    let decks = decks();
    assert!(decks.len() > 40, "only {} decks found", decks.len());
    let wrong: Vec<String> = decks.par_iter().flat_map(|path| differences(path)).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Runs the command in a folder.
fn asperity(folder: &Path, arguments: &[&str]) -> (i32, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_asperity")).args(arguments).current_dir(folder).output().unwrap();
    let told = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    (output.status.code().unwrap(), told)
}

#[test]
fn the_command_takes_input_decks_as_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let deck = Path::new(env!("CARGO_MANIFEST_DIR")).join("../inp/tests/decks/friction_block.inp");
    std::fs::copy(&deck, folder.path().join("block.inp")).unwrap();
    for verb in ["check", "info"] {
        let (code, told) = asperity(folder.path(), &[verb, "block.inp"]);
        assert_eq!(code, 0, "{told}");
        assert!(told.contains("SOLE") && told.contains("block.inp:"), "{told}");
    }
    let (code, told) = asperity(folder.path(), &["run", "block.inp"]);
    assert_eq!(code, 0, "{told}");
    let kept = folder.path().join("block.results/block.toml");
    assert!(std::fs::read_to_string(&kept).unwrap().starts_with("# Translated from block.inp"));
    let (code, told) = asperity(folder.path(), &["check", "block.results/block.toml"]);
    assert_eq!(code, 0, "the kept deck stands for itself: {told}");

    let (code, told) = asperity(folder.path(), &["translate", "block.inp"]);
    assert!(code == 0 && told.contains("block.toml\nblock.mesh.inp\n"), "{told}");
    assert_eq!(
        asperity(folder.path(), &["translate", "block.inp", "--out", "block.toml"]).0,
        0,
        "a translation is replaced"
    );
    std::fs::write(folder.path().join("mine.toml"), "version = 1\n").unwrap();
    let (code, told) = asperity(folder.path(), &["translate", "block.inp", "--out", "mine.toml"]);
    assert!(code == 2 && told.contains("was not translated"), "{told}");
}

/// Files and tables that an input deck asks for: the totals of `*NODE PRINT` are the closed form of the deck.
#[test]
fn what_an_input_deck_asks_for_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let deck = Path::new(env!("CARGO_MANIFEST_DIR")).join("../inp/tests/decks/outputs.inp");
    std::fs::copy(&deck, folder.path().join("block.inp")).unwrap();
    let (code, told) = asperity(folder.path(), &["run", "block.inp", "--no-report"]);
    assert_eq!(code, 0, "{told}");
    let read = |name: &str| std::fs::read_to_string(folder.path().join("block.results").join(name)).unwrap();
    let (frd, dat) = (read("results.frd"), read("results.dat"));
    assert!(frd.contains(" -4  CONTACT     6    1\n") && frd.ends_with(" -3\n 9999\n"));
    let at = dat.find(" total force (fx,fy,fz) for set TOP and time  0.1000000E+01\n").expect("a total");
    let row = dat[at..].lines().nth(2).unwrap();
    let force: f64 = row.split_whitespace().nth(1).unwrap().parse().unwrap();
    assert!((force + 39.60396).abs() < 1e-3, "{row}");
    // The elements keep their numbers.
    assert!(dat.contains("\n       101   1") && !dat.contains("\n         1   1"));
    assert!(dat.contains(" contact pressure (point,value) for contact DRY and time"));
}

#[test]
fn the_command_tells_all_that_is_wrong_in_an_input_deck() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("bad.inp"),
        "*NODE\n1, 0., x\n*EMBEDDED ELEMENT\n*BOUNDERY\n*STEP\n*STATIC\n*END STEP\n",
    )
    .unwrap();
    let (code, told) = asperity(folder.path(), &["run", "bad.inp"]);
    assert_eq!(code, 2);
    for said in [
        "bad.inp:2: a coordinate is 'x'",
        "bad.inp:3: *EMBEDDED ELEMENT cannot be translated",
        "bad.inp:4: there is no keyword *BOUNDERY",
    ] {
        assert!(told.contains(said), "{told}");
    }
    assert!(!folder.path().join("bad.results").exists());
}
