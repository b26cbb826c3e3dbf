//! The command under what an unkind shell may hand to it: files that never end, full disks, names that steer terminals, two
//! runs in one place, numbers beyond reason.
#![cfg(unix)]

use std::path::Path;
use std::process::{Command, Output, Stdio};

const DECK: &str = r#"
version = 1
space = "plane-strain"
mesh.part.block.rectangle = { from = [0.0, 0.0], to = [4.0, 2.0], cells = [4, 2], cell = "quad4" }
material.steel.elastic = { young = 210e3, poisson = 0.3 }
body.block = { material = "steel" }
tool.plate.profile = [{ line = [[20.0, 0.0], [-20.0, 0.0]] }]
contact.sole = { surface = "block.bottom", target = "plate", law.coulomb = { friction = 0.2 } }

[[step]]
name = "press"
increments = { count = 20 }
displacement."block.top" = { x = 0.0, y = -0.01 }
"#;

fn asperity(directory: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_asperity")).args(arguments).current_dir(directory).output().unwrap()
}

/// The command at the end of a line of a shell, as `exec asperity ..`.
fn shell(directory: &Path, line: &str) -> Output {
    let line = line.replace("asperity", env!("CARGO_BIN_EXE_asperity"));
    Command::new("bash").args(["-c", &line]).current_dir(directory).output().unwrap()
}

fn code(output: &Output) -> i32 {
    output.status.code().unwrap_or_else(|| panic!("{output:?}"))
}

fn error(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn folder(deck: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("block.toml"), deck).unwrap();
    folder
}

fn summary(directory: &Path) -> serde_json::Value {
    serde_json::from_slice(&std::fs::read(directory.join("summary.json")).unwrap()).unwrap()
}

#[test]
fn what_never_ends_is_refused_as_deck_mesh_and_surface() {
    let folder = folder(DECK);
    assert!(Command::new("mkfifo").arg(folder.path().join("pipe.toml")).status().unwrap().success());
    std::os::unix::fs::symlink("/dev/zero", folder.path().join("zero.msh")).unwrap();
    std::fs::write(
        folder.path().join("mesh.toml"),
        DECK.replace("mesh.part.block", "mesh.file = \"zero.msh\"\nmesh.part.block"),
    )
    .unwrap();
    for (arguments, words) in [
        (["run", "pipe.toml"], "this is a pipe and no ordinary file"),
        (["check", "/dev/zero"], "this is a device and no ordinary file"),
        (["info", "zero.msh"], "this is a device and no ordinary file"),
        (["run", "mesh.toml"], "this is a device and no ordinary file"),
    ] {
        let refused = asperity(folder.path(), &arguments);
        assert!(code(&refused) == 2 && error(&refused).contains(words), "{arguments:?}: {}", error(&refused));
    }
}

/// No byte reaches the terminal that would steer it, nor is a name taken that would do so in tables.
#[test]
fn names_do_not_steer_the_terminal() {
    let deck = DECK
        .replace("\"press\"", "\"pr\\u001b]0;x\\u0007ess\"")
        .replace("version = 1", "version = 1\ntitle = \"\\u001b[31mred\"");
    let folder = folder(&deck);
    for verb in ["check", "run"] {
        let said = asperity(folder.path(), &[verb, "block.toml"]);
        assert_eq!(code(&said), 0, "{}", error(&said));
        assert!(![said.stdout, said.stderr].concat().contains(&0x1b), "{verb}");
    }
    let named = deck.replace("part.block.", "part.\"bl\\u001b[31mock\".").replace("\"press\"", "1");
    std::fs::write(folder.path().join("named.toml"), named).unwrap();
    let refused = asperity(folder.path(), &["check", "named.toml"]);
    assert_eq!(code(&refused), 2);
    assert!(error(&refused).contains("holds control characters") && !refused.stderr.contains(&0x1b));
    let mesh = "*NODE\n1,0,0\n2,1,0\n3,0,1\n*ELEMENT,TYPE=CPE3,ELSET=a\x1b[31mb\n1,1,2,3\n";
    std::fs::write(folder.path().join("m.inp"), mesh).unwrap();
    let refused = asperity(folder.path(), &["info", "m.inp"]);
    assert_eq!(code(&refused), 2, "{}", error(&refused));
    assert!(error(&refused).contains("control characters") && !refused.stderr.contains(&0x1b), "{}", error(&refused));
}

#[test]
fn penalties_and_increments_beyond_reason_are_told_at_their_lines() {
    let folder = folder(DECK);
    for (set, words) in [
        ("contact.sole.penalty=1e308", "times the computed one"),
        ("contact.sole.tangential_penalty=1e30", "times the computed one"),
        ("step.press.increments={smallest=1e-300}", "must be from 1e-12 to 1, not 1e-300"),
    ] {
        let refused = asperity(folder.path(), &["run", "block.toml", "--set", set]);
        assert!(code(&refused) == 2 && error(&refused).contains(words), "{set}: {}", error(&refused));
    }
}

/// A rotation, an hourglass motion and a translation are each called what they are.
#[test]
fn free_motions_are_named_for_what_they_are() {
    let held = "displacement.\"block.bottom_left\" = { x = 0.0, y = 0.0 }\nforce.\"block.top_right\" = { y = 1.0 }";
    let deck = DECK.replace("displacement.\"block.top\" = { x = 0.0, y = -0.01 }", held);
    let deck: String = deck
        .lines()
        .filter(|line| !line.starts_with("contact") && !line.starts_with("tool"))
        .map(|l| format!("{l}\n"))
        .collect();
    let hourglass = deck.replace("material = \"steel\" }", "material = \"steel\", integration = \"reduced\" }");
    let hourglass = format!("{hourglass}displacement.\"block.bottom_right\" = {{ y = 0.0 }}\n");
    let along = deck.replace("x = 0.0, y = 0.0", "x = 0.0").replace("bottom_left", "left");
    for (deck, words) in [
        (deck, "error: body 'block' is free to turn: "),
        (hourglass, "error: body 'block' deforms without resistance"),
        (along, "error: body 'block' is free along y: "),
    ] {
        let folder = folder(&deck);
        let run = asperity(folder.path(), &["run", "block.toml"]);
        assert!(code(&run) == 3 && error(&run).contains(words), "{words}: {}", error(&run));
    }
}

/// While one run writes, no other does; when it is killed, nothing is left that keeps the next one out.
#[test]
fn two_runs_do_not_mix_their_files() {
    let folder = folder(DECK);
    let slow = ["run", "block.toml", "--set", "step.press.increments={count=100000}"];
    let mut first = Command::new(env!("CARGO_BIN_EXE_asperity"));
    let mut first = first.args(slow).current_dir(folder.path()).stdout(Stdio::null()).spawn().unwrap();
    let begun = std::time::Instant::now();
    while !folder.path().join("block.results/summary.json").exists() {
        assert!(begun.elapsed().as_secs() < 60, "the run does not begin");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let second = asperity(folder.path(), &["run", "block.toml"]);
    assert!(code(&second) == 2 && error(&second).contains("another process is writing"), "{}", error(&second));
    first.kill().unwrap();
    first.wait().unwrap();
    let third = asperity(folder.path(), &["run", "block.toml"]);
    assert_eq!(code(&third), 0, "{}", error(&third));
}

#[test]
fn equally_named_decks_do_not_replace_each_others_results() {
    let folder = folder(DECK);
    std::fs::create_dir(folder.path().join("other")).unwrap();
    std::fs::write(folder.path().join("other/block.toml"), DECK).unwrap();
    assert_eq!(code(&asperity(folder.path(), &["run", "block.toml"])), 0);
    let refused = asperity(folder.path(), &["run", "other/block.toml"]);
    assert!(code(&refused) == 2 && error(&refused).contains("these are results of"), "{}", error(&refused));
    assert_eq!(summary(&folder.path().join("block.results"))["status"], "converged");
    for again in [&["run", "block.toml"][..], &["run", "other/block.toml", "--out", "block.results"]] {
        assert_eq!(code(&asperity(folder.path(), again)), 0, "{again:?}");
    }
}

/// A run that goes on from its own end says what it has said; one that goes on from its last checkpoint but one says the
/// whole.
#[test]
fn a_finished_run_stays_what_it_is() {
    let folder = folder(DECK);
    let results = folder.path().join("block.results");
    assert_eq!(code(&asperity(folder.path(), &["run", "block.toml"])), 0);
    let before = std::fs::read(results.join("summary.json")).unwrap();
    let again = asperity(folder.path(), &["restart", "block.toml"]);
    assert_eq!(code(&again), 0, "{}", error(&again));
    assert!(String::from_utf8_lossy(&again.stdout).contains("nothing was computed"));
    assert_eq!(std::fs::read(results.join("summary.json")).unwrap(), before);
    // As a run leaves it that is killed between its last checkpoint and its end.
    let cut = String::from_utf8(before).unwrap().replace("\"converged\"", "\"running\"");
    std::fs::write(results.join("summary.json"), cut).unwrap();
    assert_eq!(code(&asperity(folder.path(), &["restart", "block.toml"])), 0);
    let after = summary(&results);
    assert_eq!((after["status"].as_str(), after["increments"].as_u64()), (Some("converged"), Some(20)));
    assert!(after["time"] == 1.0 && after["reactions"]["block.top"]["y"].as_f64().unwrap() < 0.0, "{after}");
}

/// A limit of the size of files stands for the full disk: the run ends with 1, says why, and what is there is whole.
#[test]
fn a_full_disk_is_told_and_leaves_no_half_of_a_file() {
    let folder = folder(DECK);
    let run =
        shell(folder.path(), "ulimit -f 80; exec asperity run block.toml --set 'step.press.increments={count=4000}'");
    assert_eq!(code(&run), 1, "{}", error(&run));
    assert!(error(&run).contains("File too large"), "{}", error(&run));
    let results = folder.path().join("block.results");
    let summary = summary(&results);
    assert_eq!(summary["status"], "file-error");
    assert!(summary["reason"].as_str().unwrap().contains("File too large"), "{summary}");
    for table in ["history.csv", "increments.csv", "iterations.csv"] {
        assert!(std::fs::read(results.join(table)).unwrap().ends_with(b"\n"), "{table}");
    }
    let left = std::fs::read_dir(&results).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let half: Vec<_> = left.filter(|name| name.starts_with(".writing")).collect();
    assert!(half.is_empty(), "{half:?}");
}

/// A cube that needs some gigabytes.
const CUBE: &str = r#"
version = 1
space = "solid"
mesh.part.cube.box = { from = [0.0, 0.0, 0.0], to = [1.0, 1.0, 1.0], cells = [32, 32, 32], cell = "hex8" }
material.steel.elastic = { young = 210e3, poisson = 0.3 }
body.cube = { material = "steel" }
[[step]]
increments = { count = 1 }
displacement."cube.bottom" = { x = 0.0, y = 0.0, z = 0.0 }
displacement."cube.top" = { y = -0.01 }
"#;

/// A run that does not fit ends before it begins, with its need and with what would fit; `check` says so beforehand.
#[test]
fn what_does_not_fit_into_memory_is_told() {
    let folder = folder(CUBE);
    let results = folder.path().join("block.results");
    let refused = [
        ("ulimit -v 1000000; exec asperity run block.toml", "the limit of its address space"),
        ("exec asperity run block.toml --set solver.memory=0.9", "what `solver.memory` allows"),
    ];
    for (line, words) in refused {
        let run = shell(folder.path(), line);
        assert!(code(&run) == 2 && error(&run).contains(words), "{line}: {}", error(&run));
        let summary = summary(&results);
        assert_eq!(summary["status"], "input-error", "{line}");
        let reason = summary["reason"].as_str().unwrap();
        assert!(reason.contains("unknowns would fit") && reason.contains(words), "{reason}");
        std::fs::remove_dir_all(&results).unwrap();
    }
    let check = asperity(folder.path(), &["check", "block.toml", "--set", "solver.memory=0.9"]);
    assert_eq!(code(&check), 5);
    assert!(error(&check).contains("the run needs about"), "{}", error(&check));
    let said = String::from_utf8_lossy(&check.stdout).into_owned();
    assert!(said.contains("equations: ") && said.contains("memory: about "), "{said}");
    let tiny = shell(folder.path(), "ulimit -v 200000; exec asperity run block.toml --threads 1");
    assert!(code(&tiny) == 2 && error(&tiny).contains("before anything is solved"), "{}", error(&tiny));
}
