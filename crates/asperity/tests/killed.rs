//! A writer is killed at random instants, again and again: the checkpoint that stands always loads, the list of frames
//! names only whole frames, the table has only whole rows.

use asperity::output::checkpoint::{self, Head, InputHash, Stamp};
use asperity::output::vtk::{Cells, Encoding, Grid, PvdSeries, read_grid, read_series};
use asperity::output::{Columns, Table, file};
use asperity::system::State;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const KILLS: u32 = 40;
const SIZE: usize = 40_000;
/// Tells the child where to write.
const DIRECTORY: &str = "ASPERITY_TEST_KILLED";

fn input() -> InputHash {
    InputHash::of(&[b"deck", b"mesh"])
}

fn state(increment: usize) -> State {
    State { increment, u: vec![increment as f64; SIZE], ..State::default() }
}

fn checkpoint_path(directory: &Path) -> PathBuf {
    directory.join("run.checkpoint")
}

/// Writes until it is killed.
#[test]
#[ignore = "the child of the other test"]
fn child() {
    let Some(directory) = std::env::var_os(DIRECTORY).map(PathBuf::from) else { return };
    let before = checkpoint::read::<State>(&checkpoint_path(&directory));
    let first = before.map_or(0, |(_, state)| state.increment) + 1;
    let mut series = PvdSeries::create(&directory, "frames", Encoding::default()).unwrap();
    let mut table = Table::create(&directory.join("rows.csv"), &["increment", "text"]).unwrap();
    for increment in first.. {
        let stamp = Stamp { step: 0, increment: increment as u64, time: 0.0 };
        checkpoint::save(&checkpoint_path(&directory), &Head { input: input(), stamp }, &state(increment)).unwrap();
        let points = vec![[increment as f64, 0.0, 0.0]; 200];
        series.push(&Grid { time: increment as f64, cells: Cells::vertices(200), points, ..Grid::default() }).unwrap();
        table.push(&[increment.into(), "some words, \"quoted\"".into()]).unwrap();
    }
}

fn spawn(directory: &Path) -> std::process::Child {
    Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "child", "--ignored", "--nocapture"])
        .env(DIRECTORY, directory)
        .stdout(Stdio::null())
        .spawn()
        .unwrap()
}

/// Waits for the child's first row, so that a kill meets it at work.
fn wait_for_work(directory: &Path) {
    let rows = directory.join("rows.csv");
    let start = Instant::now();
    while Columns::read(&rows).map_or(true, |columns| columns.rows.is_empty()) {
        assert!(start.elapsed() < Duration::from_secs(60), "the child does nothing");
        std::thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn what_stands_after_a_kill_is_whole() {
    let directory = tempfile::tempdir().unwrap();
    let directory = directory.path();
    let mut last = 0;
    for kill in 0..KILLS {
        let _ = std::fs::remove_file(directory.join("rows.csv"));
        let mut child = spawn(directory);
        wait_for_work(directory);
        // Spread over the time that a few rounds of writing take.
        std::thread::sleep(Duration::from_micros(u64::from(kill.wrapping_mul(2_654_435_761) % 20_000)));
        child.kill().unwrap();
        child.wait().unwrap();
        let (head, found) = checkpoint::read::<State>(&checkpoint_path(directory)).unwrap();
        assert!(found.increment > last && head.stamp.increment == found.increment as u64);
        assert_eq!(found, state(found.increment));
        last = found.increment;
        let frames = read_series(&directory.join("frames.pvd")).unwrap();
        assert!(frames.iter().all(|(time, name)| read_grid(&directory.join(name)).unwrap().time == *time));
        assert!(Columns::read(&directory.join("rows.csv")).unwrap().rows.iter().all(|row| row.len() == 2));
    }
    file::sweep(directory).unwrap();
    let left = std::fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().file_name());
    assert!(left.into_iter().all(|name| !name.to_string_lossy().starts_with('.')), "no temporary file is left");
}
