//! Runs on several ranks as users start them: the same iterations and results on any number of them, as close to the library's
//! own linear solver as the tolerance says; checkpoints that know no ranks; troubles that end all at once.
#![cfg(feature = "cluster")]

use asperity::deck::{self, Made};
use asperity::output::{CHECKPOINT, resumed};
use asperity::solve::{RunOptions, Silent};
use asperity::system::State;
use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// What several ranks may differ by from one, and from `frontal`, over the largest displacement.
const SAME: f64 = 1e-10;
const TOLERANCE: f64 = 1e-5;

/// One run at a time: idle ranks are busy ones.
static ONE: Mutex<()> = Mutex::new(());

const BALL: &str = r#"
version = 1
space = "solid"
mesh.part.slab.box = { from = [-1.0, 0.0, -1.0], to = [1.0, 1.0, 0.0], cells = [8, 4, 4], cell = "hex8" }
material.rubber.neo_hookean = { shear = 0.385, bulk = 0.833 }
body.slab.material = "rubber"
tool.ball.sphere = { center = [0.0, 0.0, 1.0], radius = 1.0 }
contact.track = { surface = "slab.front", target = "ball", law.coulomb = { friction = 0.3 } }
output.checkpoints = "steps"
[[step]]
name = "press"
symmetry = ["slab.bottom"]
displacement."slab.back" = { x = 0.0, y = 0.0, z = 0.0 }
motion.ball = { z = -0.2 }
increments.count = 2
[[step]]
name = "drag"
motion.ball = { x = 0.2 }
increments.count = 3
"#;

fn cases() -> Vec<(&'static str, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let case = |path: &str| std::fs::read_to_string(folder.join(path)).unwrap();
    let pushed = BALL.replace("motion.ball = { x = 0.2 }", "motion.ball = { x = 0.2 }\nload.ball = { z = -0.05 }");
    let ring = case("crushed-ring/ring.toml")
        .replace("y = -18.25", "y = -18.05")
        .replace("0.02, largest = 0.02", "0.05, largest = 0.05");
    vec![
        ("friction", BALL.to_owned()),
        ("plasticity", case("strip-punch/punch.toml")),
        ("two bodies", case("contact-field/drag.toml")),
        ("self-contact", ring),
        ("tool held by force", pushed),
    ]
}

/// A result directory and the deck beside it.
struct Trial {
    folder: tempfile::TempDir,
}

impl Trial {
    fn new(deck: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("deck.toml"), deck).unwrap();
        Self { folder }
    }
    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }
    fn made(&self) -> Made {
        deck::load(&self.path("deck.toml"), &[]).and_then(deck::build).unwrap_or_else(|d| panic!("{}", d.render(false)))
    }
    fn command(&self, ranks: usize, words: &[&str]) -> Command {
        self.command_of(ranks, &[], words)
    }
    /// The same by programs that start the one they are told.
    fn command_of(&self, ranks: usize, by: &[&str], words: &[&str]) -> Command {
        let mut command = Command::new("mpirun");
        command.args(["--oversubscribe", "--mca", "mpi_yield_when_idle", "1", "-n", &ranks.to_string()]).args(by);
        command.arg(env!("CARGO_BIN_EXE_asperity")).args(words).args(["--threads", "1", "--no-report"]);
        command.envs([("OMPI_ALLOW_RUN_AS_ROOT", "1"), ("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")]);
        command.current_dir(self.folder.path());
        command
    }
    fn asperity(&self, ranks: usize, words: &[&str]) -> Output {
        let _one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
        self.command(ranks, words).output().unwrap()
    }
    /// The state at the end of a run into a directory.
    fn run(&self, ranks: usize, verb: &[&str], out: &str) -> State {
        let output = self.asperity(ranks, &[verb, &["deck.toml", "--out", out]].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        self.state(&format!("{out}/{CHECKPOINT}"))
    }
    fn state(&self, checkpoint: &str) -> State {
        let made = self.made();
        resumed(&self.path(checkpoint), &made.model.problem, &made.parts).unwrap().0
    }
    /// The state at the end by the library's own solver.
    fn alone(&self, from: Option<State>) -> State {
        let made = self.made();
        let mut run = made.model.run(from.unwrap_or_else(|| made.model.problem.initial_state()));
        run.run(&RunOptions::default(), &mut Silent).unwrap();
        run.state
    }
}

fn apart(a: &State, b: &State) -> f64 {
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0_f64, |most, x| most.max(x.abs()));
    largest(&mut a.u.iter().zip(&b.u).map(|(a, b)| a - b)) / largest(&mut b.u.iter().copied())
}

#[test]
fn any_number_of_ranks_comes_to_the_same() {
    for (name, deck) in cases() {
        let trial = Trial::new(&deck);
        let (own, one) = (trial.alone(None), trial.run(1, &["run"], "one"));
        assert!(apart(&one, &own) < TOLERANCE, "{name}: {:.1e} from frontal", apart(&one, &own));
        for ranks in [2, 3] {
            let several = trial.run(ranks, &["run"], &ranks.to_string());
            assert_eq!(
                (several.increment, several.iterations),
                (one.increment, one.iterations),
                "{name}, {ranks} ranks"
            );
            assert!(apart(&several, &one) < SAME, "{name}, {ranks} ranks: {:.1e}", apart(&several, &one));
            eprintln!("{name}, {ranks} ranks: {} iterations, {:.1e}", one.iterations, apart(&several, &one));
        }
    }
}

#[test]
fn a_checkpoint_knows_no_ranks() {
    let trial = Trial::new(BALL);
    let whole = trial.run(2, &["run"], "whole");
    let branch = trial.run(3, &["restart", "--from", "press", "--of", "whole"], "branch");
    assert_eq!(branch.iterations, whole.iterations);
    assert!(apart(&branch, &whole) < SAME, "{:.1e}", apart(&branch, &whole));
    let press = std::fs::read_dir(trial.path("whole/checkpoints")).unwrap().map(|entry| entry.unwrap().path());
    let press = press.min().expect("the checkpoint of the first step");
    let made = trial.made();
    let alone = trial.alone(Some(resumed(&press, &made.model.problem, &made.parts).unwrap().0));
    assert!(apart(&alone, &whole) < TOLERANCE, "{:.1e}", apart(&alone, &whole));
}

/// What a run ends with: its code and its errors in words.
fn end(output: &Output) -> (Option<i32>, Vec<String>) {
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code(), text.lines().filter(|line| line.starts_with("error")).map(str::to_owned).collect())
}

#[test]
fn what_all_ranks_meet_is_told_once() {
    let trial = Trial::new(BALL);
    let run = ["run", "deck.toml", "--set"];
    let (code, errors) = end(&trial.asperity(
        2,
        &[&run[..], &["solver.iterations=2", "--set", "solver.relax=false", "--set", "step.1.increments.smallest=0.4"]]
            .concat(),
    ));
    assert_eq!((code, errors.len()), (Some(3), 1), "{errors:?}");
    let (code, errors) = end(&trial.asperity(2, &[&run[..], &["material.rubber.neo_hookean.shear=-1"]].concat()));
    assert_eq!((code, errors.len()), (Some(2), 1), "{errors:?}");
    for wrong in ["-pc_type hyper", "-ksp_tpye cg"] {
        let set = format!("solver.petsc='-ksp_type fgmres -pc_type asm {wrong}'");
        let (code, errors) = end(&trial.asperity(2, &[&run[..], &[set.as_str()]].concat()));
        assert_eq!((code, errors.len()), (Some(2), 1), "{errors:?}");
        assert!(errors[0].contains(if wrong.contains("hyper") { "hyper" } else { "-ksp_tpye" }), "{errors:?}");
    }
}

#[test]
fn an_iterative_engine_is_told_in_the_deck() {
    let trial = Trial::new(BALL);
    let own = trial.alone(None);
    let output = trial
        .asperity(2, &["run", "deck.toml", "--out", "out", "--set", "solver.petsc='-ksp_type fgmres -pc_type hypre'"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let state = trial.state(&format!("out/{CHECKPOINT}"));
    assert!(apart(&state, &own) < TOLERANCE, "{:.1e}", apart(&state, &own));
}

#[test]
fn processes_that_the_launcher_left_alone_say_so() {
    let trial = Trial::new(BALL);
    let mut command = Command::new(env!("CARGO_BIN_EXE_asperity"));
    command
        .args(["run", "deck.toml"])
        .current_dir(trial.folder.path())
        .envs([("SLURM_NTASKS", "4"), ("SLURM_PROCID", "0")]);
    let (code, errors) = end(&command.output().unwrap());
    assert_eq!((code, errors.len()), (Some(2), 1), "{errors:?}");
    assert!(errors[0].contains("mpirun -n 4"), "{errors:?}");
}

/// An elastic law that gives up on one rank alone, on the way: the others learn of it.
const MOODY: &str = r#"
#include <stdlib.h>
void xit_(void);
void umat_(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd, double *rpl,
           double *ddsddt, double *drplde, double *drpldt, const double *stran, const double *dstran,
           const double *time, const double *dtime, const double *temp, const double *dtemp, const double *predef,
           const double *dpred, const char *cmname, const int *ndi, const int *nshr, const int *ntens,
           const int *nstatv, const double *props)
{
    const char *rank = getenv("OMPI_COMM_WORLD_RANK");
    int n = *ntens;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            ddsdde[i + n * j] = i == j ? props[0] * (i < 3 ? 1.0 : 0.5) : 0.0;
    for (int i = 0; i < n; i++)
        stress[i] += ddsdde[i + n * i] * dstran[i];
    if (time[1] > 0.2 && rank && atoi(rank) == 1)
        xit_();
}
"#;

const BLOCK: &str = r#"
version = 1
output.checkpoint_every = 1
space = "plane-strain"
mesh.part.block.rectangle = { from = [0.0, 0.0], to = [1.0, 1.0], cells = [2, 2], cell = "quad4" }
body.block.material = "sand"
material.sand.umat = { library = "libmoody.so", properties = [100.0], states = 1 }
[[step]]
increments = { count = 4 }
displacement."block.left" = { x = 0.0, y = 0.0 }
displacement."block.right" = { x = 0.01, y = 0.0 }
"#;

#[test]
fn a_law_that_fails_on_one_rank_ends_all() {
    let trial = Trial::new(BLOCK);
    std::fs::write(trial.path("moody.c"), MOODY).unwrap();
    let mut cc = Command::new("cc");
    cc.args(["-O1", "-shared", "-fPIC", "-o", "libmoody.so", "moody.c"]).current_dir(trial.folder.path());
    assert!(cc.status().is_ok_and(|status| status.success()), "a C compiler");
    let _one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
    let begun = Instant::now();
    let (code, errors) = end(&trial.command(2, &["run", "deck.toml", "--out", "out"]).output().unwrap());
    assert_eq!((code, errors.len()), (Some(3), 1), "{errors:?}");
    assert!(errors[0].contains("rank 1 of 2") && errors[0].contains("XIT"), "{errors:?}");
    assert!(begun.elapsed() < Duration::from_secs(60));
    assert!(Path::new(&trial.path("out").join(CHECKPOINT)).exists());
}

/// The processes that `mpirun` started.
fn children(parent: u32) -> Vec<u32> {
    let list = std::fs::read_to_string(format!("/proc/{parent}/task/{parent}/children")).unwrap_or_default();
    list.split_whitespace().filter_map(|pid| pid.parse().ok()).collect()
}

fn wait_for(checkpoint: &Path) {
    let begun = Instant::now();
    while !checkpoint.exists() {
        assert!(begun.elapsed() < Duration::from_secs(120), "no checkpoint came");
        std::thread::sleep(Duration::from_millis(50));
    }
}

#[test]
fn a_rank_that_is_killed_ends_all() {
    let _one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
    let trial = Trial::new(
        &BALL.replace("checkpoints = \"steps\"", "checkpoint_every = 1").replace("count = 3", "count = 400"),
    );
    let mut command = trial.command(2, &["run", "deck.toml", "--out", "out"]);
    let mut mpirun = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let checkpoint = format!("out/{CHECKPOINT}");
    wait_for(&trial.path(&checkpoint));
    let last = *children(mpirun.id()).last().expect("ranks");
    assert!(Command::new("kill").args(["-9", &last.to_string()]).status().unwrap().success());
    let killed = Instant::now();
    let status = mpirun.wait().unwrap();
    assert!(!status.success() && killed.elapsed() < Duration::from_secs(60), "{status} after {:?}", killed.elapsed());
    assert!(trial.state(&checkpoint).increment > 0);
}

/// A cube whose factors are a good part of what a rank holds.
const CUBE: &str = r#"
version = 1
space = "solid"
mesh.part.cube.box = { from = [0.0, 0.0, 0.0], to = [1.0, 1.0, 1.0], cells = [20, 20, 20], cell = "hex8" }
material.rubber.neo_hookean = { shear = 0.385, bulk = 0.833 }
body.cube.material = "rubber"
output.checkpoint_every = 1
[[step]]
displacement."cube.bottom" = { x = 0.0, y = 0.0, z = 0.0 }
displacement."cube.top" = { x = 1.0, y = -0.1, z = 0.0 }
increments.count = 10
"#;

/// Limits the address space of the second of two ranks and leaves the first alone.
const LIMITED: &str = r#"#!/bin/sh
[ "$OMPI_COMM_WORLD_RANK" = 1 ] && ulimit -v "$LIMIT"
exec "$@"
"#;

/// What the status of a process says of its memory, in kilobytes, as long as it lives.
fn memory(pid: u32, key: &str) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{pid}/status")).ok()?;
    status.lines().find_map(|line| line.strip_prefix(key))?.split_whitespace().next()?.parse().ok()
}

#[test]
fn ranks_take_the_memory_that_is_predicted() {
    let _one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
    let deck =
        CUBE.replace("[20, 20, 20]", "[16, 16, 16]").replace("x = 1.0", "x = 0.1").replace("count = 10", "count = 1");
    let trial = Trial::new(&deck);
    let problem = &trial.made().model.problem;
    let said = problem.demand(&problem.initial_state()).unwrap().of_ranks(NonZeroUsize::new(2).unwrap());
    let multigrid = "solver.petsc=\"-ksp_type fgmres -pc_type hypre -pc_hypre_boomeramg_strong_threshold 0.5\"";
    for (set, said, range) in [("solver.iterations=20", said.direct, 0.85..1.15), (multigrid, said.multigrid, 0.9..1.6)]
    {
        let mut command = trial.command(2, &["run", "deck.toml", "--out", "out", "--set", set]);
        let mut mpirun = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        let mut most: BTreeMap<u32, u64> = BTreeMap::new();
        while mpirun.try_wait().unwrap().is_none() {
            let held = children(mpirun.id()).into_iter().filter_map(|pid| Some((pid, memory(pid, "VmHWM:")?)));
            most.extend(held);
            std::thread::sleep(Duration::from_millis(5));
        }
        assert!(mpirun.wait().unwrap().success() && most.len() == 2, "{most:?}");
        let parts: Vec<f64> = most.values().zip(said).map(|(held, said)| said as f64 / (held * 1024) as f64).collect();
        eprintln!("{set}: {most:?} kB, predicted {said:?} bytes: {parts:.2?} times as much");
        assert!(parts.iter().all(|part| range.contains(part)), "{parts:?}");
    }
}

#[test]
fn a_rank_without_memory_ends_all() {
    let _one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
    let (trial, checkpoint) = (Trial::new(CUBE), format!("out/{CHECKPOINT}"));
    let mut command = trial.command(2, &["run", "deck.toml", "--out", "out"]);
    let mut mpirun = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    wait_for(&trial.path(&checkpoint));
    let last = *children(mpirun.id()).last().expect("ranks");
    let size = memory(last, "VmSize:").expect("a size");
    assert!(Command::new("kill").args(["-9", &last.to_string()]).status().unwrap().success());
    assert!(!mpirun.wait().unwrap().success());

    let script = trial.path("limited");
    std::fs::write(&script, LIMITED).unwrap();
    std::fs::set_permissions(&script, std::fs::Permissions::from_mode(0o755)).unwrap();
    let mut command = trial.command_of(2, &[script.to_str().unwrap()], &["restart", "deck.toml", "--out", "out"]);
    let begun = Instant::now();
    let output = command.env("LIMIT", (size / 4 * 3).to_string()).output().unwrap();
    let (code, errors) = end(&output);
    assert_eq!((code, errors.len()), (Some(2), 1), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(errors[0].contains("memory"), "{errors:?}");
    assert!(begun.elapsed() < Duration::from_secs(60), "{:?}", begun.elapsed());
    assert!(trial.state(&checkpoint).increment > 0);
    eprintln!("{size} kB of addresses, {:?}: {}", begun.elapsed(), errors[0]);
}

/// What a bound on memory refuses, MUMPS is not begun with.
#[test]
fn a_bound_on_memory_is_kept() {
    let _one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
    let trial = Trial::new(CUBE);
    for ranks in [1, 2] {
        let output = trial
            .command(ranks, &["run", "deck.toml", "--out", "out", "--set", "solver.memory=0.02"])
            .output()
            .unwrap();
        let (code, errors) = end(&output);
        assert_eq!((code, errors.len()), (Some(2), 1), "{}", String::from_utf8_lossy(&output.stderr));
        assert!(errors[0].contains("what `solver.memory` allows"), "{errors:?}");
    }
}

/// A slender column beyond its Euler load, straight.
const COLUMN: &str = r#"
version = 1
space = "plane-strain"
[mesh.part.column.rectangle]
from = [0.0, 0.0]
to = [0.5, 10.0]
cells = [2, 20]
cell = "quad8"
[material.rubber.neo_hookean]
shear = 100.0
bulk = 1000.0
[body.column]
material = "rubber"
[[step]]
name = "squeeze"
displacement."column.bottom" = { x = 0.0, y = 0.0 }
displacement."column.top" = { x = 0.0, y = -0.12 }
increments = { count = 6 }
"#;

/// MUMPS tells the sign of the determinant, an engine that iterates nothing, and then a note says so.
#[test]
fn stability_is_watched_by_determinants() {
    let trial = Trial::new(COLUMN);
    let notes = |ranks: usize, words: &[&str]| {
        let output = trial.asperity(ranks, &[&["run", "deck.toml", "--out", "out"], words].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        std::fs::read_to_string(trial.path("out/summary.json")).unwrap()
    };
    for ranks in [1, 2] {
        let summary = notes(ranks, &[]);
        assert!(summary.contains("the determinant of the stiffness changes its sign"), "{ranks}: {summary}");
        assert!(!summary.contains("stability was not watched"), "{ranks}: {summary}");
    }
    let summary = notes(1, &["--set", "solver.petsc=-ksp_type gmres -pc_type lu"]);
    assert!(summary.contains("stability was not watched"), "{summary}");
}

/// What solves in this program is foreseen, and not the library's own solver.
#[test]
fn a_look_beforehand_foresees_the_engine_of_the_program() {
    let trial = Trial::new(COLUMN);
    let mut command = Command::new(env!("CARGO_BIN_EXE_asperity"));
    let output = command.args(["check", "deck.toml"]).current_dir(trial.folder.path()).output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(text.contains("memory of a rank, 1 in all") && !text.contains("memory: about"), "{text}");
}
