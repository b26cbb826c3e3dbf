//! Runs that go on from a checkpoint with a deck that has changed in what lies ahead.

use asperity::output::{Kept, checkpoint};
use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Output};

/// A block is clamped by a plate, drawn under it, and led back.
const DECK: &str = r#"
version = 1
space = "plane-strain"
mesh.part.block.rectangle = { from = [0.0, 0.0], to = [4.0, 2.0], cells = [4, 2], cell = "quad4" }
material.soft.elastic = { young = 100.0, poisson = 0.3 }
body.block = { material = "soft", formulation = "f-bar" }
tool.plate.profile = [{ line = [[-20.0, 2.0], [20.0, 2.0]] }]
contact.top = { surface = "block.top", target = "plate", law.coulomb = { friction = 0.2 } }
output.checkpoints = "steps"
output.export = ["frd", "xdmf"]
output.print = [{ of.nodes = "block.top", quantities = ["displacement"] }]
probe.corner = { at.point = [4.0, 2.0], quantities = ["displacement"] }
[[step]]
name = "clamp"
increments = { count = 2 }
displacement."block.bottom" = { x = 0.0, y = 0.0 }
motion.plate = { y = -0.1 }
[[step]]
name = "draw"
increments = { count = 4 }
displacement."block.bottom" = { x = 0.5 }
"#;
const BACK: &str =
    "[[step]]\nname = \"back\"\nincrements = { count = 3 }\ndisplacement.\"block.bottom\" = { x = 0.0 }\n";
/// Another third step: the plate is removed, and a side is pressed.
const FREE: &str = r#"
[[step]]
name = "free"
increments = { count = 5 }
remove = ["plate"]
pressure."block.right" = { value = 1.0 }
[[step]]
name = "aside"
increments = { count = 2 }
displacement."block.top_left" = { x = 0.4 }
"#;

fn asperity(directory: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_asperity")).args(arguments).current_dir(directory).output().unwrap()
}

fn error(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn done(directory: &Path, arguments: &[&str]) {
    let output = asperity(directory, arguments);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{arguments:?}: {} {}",
        error(&output),
        String::from_utf8_lossy(&output.stdout)
    );
}

fn refused(directory: &Path, arguments: &[&str]) -> String {
    let output = asperity(directory, arguments);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", error(&output));
    error(&output)
}

fn folder(decks: &[(&str, String)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    decks.iter().for_each(|(name, text)| std::fs::write(folder.path().join(name), text).unwrap());
    folder
}

/// The last state of a run, with all digits.
fn state(directory: &Path) -> String {
    let (_, kept) = checkpoint::read::<Kept>(&directory.join("run.checkpoint")).unwrap();
    format!("{:?}", kept.state)
}

/// The rows of a table by column.
fn table(directory: &Path, name: &str) -> BTreeMap<String, Vec<String>> {
    let text = std::fs::read_to_string(directory.join(name)).unwrap();
    let mut rows = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    let header = rows.next().unwrap();
    let rows: Vec<_> = rows.collect();
    header.iter().enumerate().map(|(i, name)| (name.clone(), rows.iter().map(|row| row[i].clone()).collect())).collect()
}

/// A third step that was changed, from the end of the second: the same bits as a whole run with the changed step, in the
/// accepted state, in the rows of tables and in the last frame.
#[test]
fn a_branch_is_the_whole_run_with_the_changed_step() {
    let folder = folder(&[("a.toml", format!("{DECK}{BACK}")), ("b.toml", format!("{DECK}{FREE}"))]);
    let at = |name: &str| folder.path().join(name);
    done(folder.path(), &["run", "a.toml"]);
    done(folder.path(), &["run", "b.toml", "--out", "whole"]);
    let summary = std::fs::read(at("a.results/summary.json")).unwrap();
    done(folder.path(), &["restart", "b.toml", "--from", "draw", "--of", "a.results", "--out", "branch"]);
    assert_eq!(summary, std::fs::read(at("a.results/summary.json")).unwrap(), "what is branched of stays");
    assert!(state(&at("whole")) == state(&at("branch")));
    for file in ["bodies/bodies_000013.vtu", "results.frd", "results.xdmf", "results.dat", "probe.corner.csv"] {
        let [whole, branch] = ["whole", "branch"].map(|run| std::fs::read(at(run).join(file)).unwrap());
        assert!(whole == branch, "{file}");
    }
    for name in ["history.csv", "certificate.csv", "increments.csv"] {
        let [whole, branch] = ["whole", "branch"].map(|run| table(&at(run), name));
        assert_eq!(whole.keys().collect::<Vec<_>>(), branch.keys().collect::<Vec<_>>());
        for (column, values) in &whole {
            let same = |(a, b): (&String, &String)| a == b || (b.is_empty() && column.contains("block.top_left"));
            assert!(values.len() == branch[column].len(), "{name} {column}");
            assert!(values.iter().zip(&branch[column]).all(same), "{name} {column}: {values:?} {:?}", branch[column]);
        }
    }
    let told = refused(folder.path(), &["restart", "a.toml", "--from", "draw", "--out", "elsewhere"]);
    assert!(told.contains("--of") && told.contains("a.results"), "{told}");
    // In the same directory, from a number.
    done(folder.path(), &["restart", "b.toml", "--from", "2", "--out", "a.results"]);
    assert!(state(&at("whole")) == state(&at("a.results")));
    let summary = std::fs::read_to_string(at("a.results/summary.json")).unwrap();
    assert!(summary.contains("these parts have changed: step 3, step 3 increments, step 4"), "{summary}");
}

#[test]
fn what_lies_behind_may_not_change() {
    let deck = format!("{DECK}{BACK}");
    let folder = folder(&[("a.toml", deck.clone()), ("b.toml", deck.replace("y = -0.1", "y = -0.2"))]);
    done(folder.path(), &["run", "a.toml"]);
    let told = refused(folder.path(), &["restart", "b.toml", "--from", "draw", "--out", "a.results"]);
    assert!(told.contains("`step 1` is not") && told.contains("`step 3` and later"), "{told}");
    let set = ["--set", "material.soft.elastic.young=99", "--set", "body.block.formulation=standard"];
    let told = refused(folder.path(), &[&["restart", "a.toml", "--from", "draw"], &set[..]].concat());
    assert!(told.contains("`body.block`, `material.soft` are not"), "{told}");
    let told = refused(folder.path(), &["restart", "a.toml", "--from", "0.5"]);
    assert!(told.contains("kept are the end of step 1 (time 1)"), "{told}");
    let told = refused(folder.path(), &["restart", "a.toml", "--from", "drow"]);
    assert!(told.contains("clamp, draw, back"), "{told}");
}

/// Whatever the deck says of output and solver, a run that is finished stays as it is, until a step is added.
#[test]
fn a_finished_run_is_not_written_again() {
    let folder = folder(&[("a.toml", format!("{DECK}{BACK}")), ("b.toml", format!("{DECK}{BACK}{FREE}"))]);
    let results = folder.path().join("a.results");
    done(folder.path(), &["run", "a.toml"]);
    let files =
        || ["summary.json", "report.html", "deck.json", "history.csv"].map(|f| std::fs::read(results.join(f)).unwrap());
    let before = files();
    done(folder.path(), &["restart", "a.toml", "--set", "output.every=2", "--set", "solver.tolerance=1e-7"]);
    done(folder.path(), &["restart", "a.toml", "--from", "back"]);
    assert!(before == files());
    done(folder.path(), &["restart", "b.toml", "--out", "a.results"]);
    done(folder.path(), &["run", "b.toml", "--out", "whole"]);
    assert!(state(&results) == state(&folder.path().join("whole")));
    assert_eq!(table(&results, "history.csv")["time"].len(), 2 + 4 + 3 + 5 + 2);
}

/// A run that fails names the settings and the command that goes on; that command does.
#[test]
fn a_failed_run_goes_on_with_smaller_increments() {
    let deck = r#"
version = 1
space = "plane-strain"
mesh.part.pad.rectangle = { from = [0.0, 0.0], to = [2.0, 1.0], cells = [4, 2], cell = "quad4" }
material.rubber.neo_hookean = { shear = 1.0, bulk = 20.0 }
body.pad = { material = "rubber", formulation = "f-bar" }
solver = { iterations = 4, relax = false }
[[step]]
increments = { count = 2 }
displacement."pad.bottom" = { x = 0.0, y = 0.0 }
displacement."pad.top" = { x = 0.0, y = -0.1 }
[[step]]
increments = { first = 1.0, largest = 1.0, smallest = 0.6 }
displacement."pad.top" = { x = 0.2, y = -0.92 }
"#;
    let folder = folder(&[("pad.toml", deck.into())]);
    let run = asperity(folder.path(), &["run", "pad.toml"]);
    assert_eq!(run.status.code(), Some(3), "{}", error(&run));
    let text = String::from_utf8_lossy(&run.stdout).into_owned();
    let line = text.lines().find(|line| line.contains("--set 'step.2.increments={")).expect(&text);
    let set = line.split('\'').nth(1).unwrap();
    assert!(text.contains("or, with smaller increments"), "{text}");
    done(folder.path(), &["restart", "pad.toml", "--set", set]);
    done(folder.path(), &["run", "pad.toml", "--set", set, "--out", "whole"]);
    let [parted, whole] = ["pad.results", "whole"].map(|name| table(&folder.path().join(name), "history.csv"));
    assert!(parted == whole);
}
