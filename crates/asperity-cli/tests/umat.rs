//! Laws of shared libraries as users meet them: what stops a law stops the increment, what crashes it is told, and what cannot be
//! loaded is refused in one message.

use std::path::Path;
use std::process::{Command, Output};

/// An elastic law that does something else, as its second number says, where the increment of a strain is long.
const MOODY: &str = r#"
#include <math.h>
#include <stdlib.h>
void xit_(void);
void stdb_abqerr_(const int *, const char *, const int *, const double *, const char *, size_t, size_t);
void umat_(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd, double *rpl,
           double *ddsddt, double *drplde, double *drpldt, const double *stran, const double *dstran,
           const double *time, const double *dtime, const double *temp, const double *dtemp, const double *predef,
           const double *dpred, const char *cmname, const int *ndi, const int *nshr, const int *ntens,
           const int *nstatv, const double *props, const int *nprops, const double *coords, const double *drot,
           double *pnewdt)
{
    volatile int none = 0, three = 3;
    const int stop = -3, state = 3;
    int n = *ntens, mood = dstran[0] > 1e-3 ? (int)props[1] : 0;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            ddsdde[i + n * j] = i == j ? props[0] * (i < 3 ? 1.0 : 0.5) : 0.0;
    for (int i = 0; i < n; i++)
        stress[i] += ddsdde[i + n * i] * dstran[i];
    if (mood == 1) xit_();
    if (mood == 2) *pnewdt = 0.25;
    if (mood == 3) stress[1] = NAN;
    if (mood == 4) stdb_abqerr_(&stop, "%S: state %I is %R", &state, &props[0], "SAND    ", 18, 8);
    if (mood == 5) *(volatile int *)8 = 1;
    if (mood == 6) statev[0] = three / none;
    if (mood == 7) exit(0);
    if (mood == 8) abort();
    if (mood == 9) ddsdde[1 + n] *= 0.5;
    if (mood == 10) pnewdt[0] = 3.0;
    if (props[1] == 11.0) statev[5] = 1.0;
}
"#;

const POINT: &str = "version = 1\n[material.sand.umat]\nlibrary = \"libmoody.so\"\nproperties = [100.0, 0.0]\nstates = 1\n\
                     [[step]]\nincrements = 4\nstrain = { xx = 0.01, yy = 0.0, zz = 0.0, xy = 0.0, yz = 0.0, xz = 0.0 }\n";

const BLOCK: &str = "version = 1\nspace = \"plane-strain\"\n\
                     mesh.part.block.rectangle = { from = [0.0, 0.0], to = [1.0, 1.0], cells = [2, 2], cell = \"quad4\" }\n\
                     body.block = { material = \"sand\" }\n\
                     [material.sand.umat]\nlibrary = \"libmoody.so\"\nproperties = [100.0, 0.0]\nstates = 1\n\
                     [[step]]\nincrements = { count = 2 }\ndisplacement.\"block.left\" = { x = 0.0, y = 0.0 }\n\
                     displacement.\"block.right\" = { x = 0.01, y = 0.0 }\n";

fn asperity(directory: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_asperity")).args(arguments).current_dir(directory).output().unwrap()
}

fn error(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A shared library of a text; nothing without a compiler.
fn library(folder: &Path, name: &str, text: &str) -> Option<()> {
    let source = folder.join(name).with_extension("c");
    std::fs::write(&source, text).unwrap();
    let built = folder.join(name).with_extension("so");
    let output = Command::new("cc").args(["-shared", "-fPIC", "-o"]).arg(built).arg(source).arg("-lm").output();
    let Ok(output) = output else {
        eprintln!("skipped: there is no cc");
        return None;
    };
    assert!(output.status.success(), "{}", error(&output));
    Some(())
}

/// A folder with the law and both decks.
fn folder() -> Option<tempfile::TempDir> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("point.toml"), POINT).unwrap();
    std::fs::write(folder.path().join("block.toml"), BLOCK).unwrap();
    library(folder.path(), "libmoody", MOODY).map(|()| folder)
}

fn mood(folder: &Path, verb: &[&str], mood: u32) -> Output {
    let set = format!("material.sand.umat.properties=[100.0, {mood}.0]");
    asperity(folder, &[verb, &["--set", &set]].concat())
}

/// XIT, PNEWDT, NaN and an error that stops cut the increment; shorter ones go on.
#[test]
fn a_law_that_gives_up_cuts_the_increment() {
    let Some(folder) = folder() else { return };
    let words = [
        (1, "it gives up: it calls XIT"),
        (2, "it asks for a smaller increment (PNEWDT = 0.25)"),
        (3, "stress, states, tangent or energies are not finite"),
        (4, "it gives up: SAND: state 3 is 100"),
    ];
    for (number, words) in words {
        let run = mood(folder.path(), &["run", "block.toml"], number);
        assert_eq!(run.status.code(), Some(0), "{}", error(&run));
        let log = std::fs::read_to_string(folder.path().join("block.results/increments.csv")).unwrap();
        assert!(log.contains(words) && log.contains("libmoody.so"), "{words}\n{log}");
        std::fs::remove_dir_all(folder.path().join("block.results")).unwrap();
        assert_eq!(mood(folder.path(), &["point", "point.toml"], number).status.code(), Some(0));
    }
    assert_eq!(mood(folder.path(), &["run", "block.toml"], 10).status.code(), Some(0));
}

/// One line names the library and its crash; a crash is no success.
#[test]
#[cfg(target_os = "linux")]
fn a_crash_names_the_library() {
    use std::os::unix::process::ExitStatusExt;
    let Some(folder) = folder() else { return };
    let mut crashes = vec![(5, "crashed: a forbidden address", Some(11)), (8, "crashed: its own abort", Some(6))];
    if cfg!(target_arch = "x86_64") {
        crashes.push((6, "crashed: a forbidden operation of arithmetic", Some(8)));
    }
    crashes.push((7, "it ended the program (STOP or exit)", None));
    for (number, words, signal) in crashes {
        for verb in [["point", "point.toml"], ["run", "block.toml"]] {
            let run = mood(folder.path(), &verb, number);
            let told = error(&run);
            let line = told.lines().find(|line| line.contains(words)).unwrap_or_else(|| panic!("{words}: {told}"));
            assert!(line.contains("libmoody.so"), "{line}");
            assert_eq!(run.status.signal(), signal, "{told}");
            assert!(signal.is_some() || run.status.code() == Some(1), "{told}");
        }
    }
}

#[test]
fn a_law_with_more_states_than_are_said_is_told() {
    let Some(folder) = folder() else { return };
    let run = mood(folder.path(), &["point", "point.toml"], 11);
    assert!(!run.status.success() && error(&run).contains("it writes more than 1 states"), "{}", error(&run));
}

#[test]
fn a_wrong_tangent_is_told_where_it_is_asked_for() {
    let Some(folder) = folder() else { return };
    let check = ["run", "block.toml", "--set", "material.sand.umat.check_tangent=100000"];
    let run = mood(folder.path(), &check, 0);
    assert_eq!(run.status.code(), Some(0), "{}", error(&run));
    std::fs::remove_dir_all(folder.path().join("block.results")).unwrap();
    let run = mood(folder.path(), &check, 9);
    let words = "DDSDDE(2,2) is 5.000000e1, and differences give 1.0000";
    assert!(run.status.code() == Some(3) && error(&run).contains(words), "{}", error(&run));
}

#[test]
fn a_library_that_cannot_be_used_is_refused_in_one_message() {
    let Some(folder) = folder() else { return };
    let path = folder.path();
    std::fs::write(path.join("text.so"), "no library at all").unwrap();
    let lost = "void missing_(void); void umat_(void) { missing_(); }";
    library(path, "lost", lost).and_then(|()| library(path, "empty", "int nothing;")).unwrap();
    for (name, words) in [
        ("none.so", "none.so: "),
        ("text.so", "cannot be loaded as a shared library"),
        ("lost.so", "undefined symbol: missing_"),
        ("empty.so", "has no function `umat_` or `umat`"),
    ] {
        for verb in [["check", "block.toml"], ["point", "point.toml"]] {
            let set = format!("material.sand.umat.library={name:?}");
            let refused = asperity(path, &[&verb[..], &["--set", &set]].concat());
            let told = error(&refused);
            assert_eq!(refused.status.code(), Some(2), "{told}");
            assert!(told.contains(words) && told.matches("error:").count() == 1, "{name}: {told}");
        }
    }
}

#[test]
fn calls_are_said_to_be_serial_unless_the_law_is_safe() {
    let Some(folder) = folder() else { return };
    let serial = asperity(folder.path(), &["check", "block.toml"]);
    let page = String::from_utf8_lossy(&serial.stdout).into_owned();
    assert!(page.contains("the calls of the library are made one at a time"), "{page}\n{}", error(&serial));
    let safe = asperity(folder.path(), &["check", "block.toml", "--set", "material.sand.umat.thread_safe=true"]);
    assert!(!String::from_utf8_lossy(&safe.stdout).contains("one at a time"));
}

/// A restart finds out that the library is another one.
#[test]
fn a_restart_knows_the_library() {
    let Some(folder) = folder() else { return };
    let two = format!("{BLOCK}[[step]]\nname = \"more\"\ndisplacement.\"block.right\" = {{ x = 0.02 }}\n");
    let two = two.replace("[[step]]\nincrements", "[output]\ncheckpoints = \"steps\"\n[[step]]\nincrements");
    std::fs::write(folder.path().join("block.toml"), two).unwrap();
    let run = asperity(folder.path(), &["run", "block.toml"]);
    assert_eq!(run.status.code(), Some(0), "{}", error(&run));
    let restart = || asperity(folder.path(), &["restart", "block.toml", "--from", "1"]);
    library(folder.path(), "libmoody", &MOODY.replace("1.0 : 0.5", "1.0 : 0.4")).unwrap();
    let other = restart();
    assert!(other.status.code() == Some(2) && error(&other).contains("`files`"), "{}", error(&other));
    library(folder.path(), "libmoody", MOODY).unwrap();
    let same = restart();
    assert_eq!(same.status.code(), Some(0), "{}", error(&same));
}

/// What laws may call is exported by the program.
#[test]
fn the_program_exports_the_utilities() {
    let build = include_str!("../build.rs");
    umat::SYMBOLS.iter().for_each(|symbol| assert!(build.contains(&format!("{symbol:?}")), "{symbol}"));
}

/// Hooke's law by Young's modulus and Poisson's ratio.
const HOOKE: &str = r#"
#include <stddef.h>
void umat_(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd, double *rpl,
           double *ddsddt, double *drplde, double *drpldt, const double *stran, const double *dstran,
           const double *time, const double *dtime, const double *temp, const double *dtemp, const double *predef,
           const double *dpred, const char *cmname, const int *ndi, const int *nshr, const int *ntens,
           const int *nstatv, const double *props, const int *nprops, const double *coords, const double *drot,
           double *pnewdt)
{
    double shear = 0.5 * props[0] / (1.0 + props[1]), lambda = 2.0 * shear * props[1] / (1.0 - 2.0 * props[1]);
    int n = *ntens;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            ddsdde[i + n * j] = (i < 3 && j < 3 ? lambda : 0.0) + (i != j ? 0.0 : i < 3 ? 2.0 * shear : shear);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            stress[i] += ddsdde[i + n * j] * dstran[j];
    statev[0] += 1.0;
}
"#;

/// `*USER MATERIAL` of an input deck is the law of the library beside it: what the comments of the deck expect.
#[test]
fn a_law_of_an_input_deck_is_that_of_the_library_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    let deck = Path::new(env!("CARGO_MANIFEST_DIR")).join("../inp/tests/decks/user_material.inp");
    std::fs::copy(deck, folder.path().join("cube.inp")).unwrap();
    let missing = asperity(folder.path(), &["run", "cube.inp"]);
    assert_eq!(missing.status.code(), Some(2));
    assert!(error(&missing).contains("umat.so"), "{}", error(&missing));
    if library(folder.path(), "umat", HOOKE).is_none() {
        return;
    }
    let output = asperity(folder.path(), &["run", "cube.inp", "--no-report", "--set", "output.export=[\"frd\"]"]);
    assert_eq!(output.status.code(), Some(0), "{}", error(&output));
    let frd = std::fs::read_to_string(folder.path().join("cube.results/results.frd")).unwrap();
    let last = &frd[frd.rfind(" -4  DISP").unwrap()..];
    let row = last.lines().find(|line| line.starts_with(" -1         8")).unwrap();
    let found: Vec<f64> = [13..25, 25..37, 37..49].map(|columns| row[columns].trim().parse().unwrap()).to_vec();
    assert!((found[0] - 0.01).abs() < 1e-7 && (found[2] + 0.003).abs() < 1e-7, "{row}");
}
