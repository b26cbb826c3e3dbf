//! Seeded failures: decks that are wrong on purpose, each in one way that its first line names. None of them ends well, and the
//! cause that the run names first is the one that was seeded.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What is to be found of a deck: its name, the causes that are right, and where it lies.
struct Seed {
    name: String,
    causes: Vec<String>,
    path: PathBuf,
}

fn seeds() -> Vec<Seed> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/failures");
    let mut paths = Vec::new();
    // Those in `blind` were written by the list of causes in the manual, before their answers were seen.
    for folder in [root.clone(), root.join("more"), root.join("blind")] {
        let Ok(entries) = std::fs::read_dir(folder) else { continue };
        paths.extend(
            entries.map(|entry| entry.unwrap().path()).filter(|path| path.extension().is_some_and(|e| e == "toml")),
        );
    }
    paths.sort();
    let seed = |path: PathBuf| {
        let text = std::fs::read_to_string(&path).unwrap();
        let line = text.lines().find_map(|line| line.strip_prefix("# cause: ")).expect("a first line with its cause");
        let causes = line.split(" or ").map(|cause| cause.trim().to_owned()).collect();
        Seed { name: path.file_stem().unwrap().to_str().unwrap().into(), causes, path }
    };
    paths.into_iter().map(seed).collect()
}

/// What the run says first, or what went otherwise than a failed run should.
fn first(seed: &Seed) -> Result<String, String> {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("results");
    let mut command = Command::new(env!("CARGO_BIN_EXE_asperity"));
    command.arg("run").arg(&seed.path).args(["--threads", "1", "--no-report", "--out"]).arg(&out);
    let ended = command.current_dir(folder.path()).output().unwrap();
    let code = ended.status.code();
    let said = String::from_utf8_lossy(&ended.stdout).into_owned();
    if !matches!(code, Some(3 | 6)) {
        return Err(format!("ended with {code:?}: {}", String::from_utf8_lossy(&ended.stderr)));
    }
    let summary = std::fs::read(out.join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap();
    let found = summary["diagnosis"][0]["cause"].as_str().ok_or("no cause is named")?.to_owned();
    let told = summary["diagnosis"][0]["what"].as_str().unwrap_or_default();
    if !said.contains(told) || summary["diagnosis"][0]["advice"][0].is_null() {
        return Err("the cause is not told on the screen, or without advice".into());
    }
    Ok(found)
}

#[test]
fn seeded_failures_are_named_rightly() {
    let seeds = seeds();
    let (next, wrong) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(2, usize::from) {
            scope.spawn(|| {
                while let Some(seed) = seeds.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let found = first(seed);
                    if !found.as_ref().is_ok_and(|cause| seed.causes.contains(cause)) {
                        wrong.lock().unwrap().push(format!(
                            "{}: {found:?} in place of {}",
                            seed.name,
                            seed.causes.join(" or ")
                        ));
                    }
                }
            });
        }
    });
    let wrong = wrong.into_inner().unwrap();
    assert!(seeds.len() >= 75, "only {} seeds were found", seeds.len());
    assert!(wrong.is_empty(), "{} of {} are named wrongly:\n{}", wrong.len(), seeds.len(), wrong.join("\n"));
}
