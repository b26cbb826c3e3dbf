//! A law of a library and the law of the program that it repeats agree but for rounding: at a point and in structures, in the
//! plane and in space, with as many iterations.

mod support;

use asperity::deck::{self, LoadedPoint, load_point};
use asperity::solve::{AttemptRecord, Observer, RunOptions, Stop};
use asperity::system::State;
use std::path::Path;
use support::{examples, library, library_of};

const J2: &str = "{ young = 200e3, poisson = 0.3, yield_stress = 300.0, hardening = 2e3 }";
const ELASTIC: &str = "{ young = 200e3, poisson = 0.3 }";

fn umat(library: &Path, rest: &str) -> String {
    format!("{{ umat = {{ library = {:?}, {rest} }} }}", library.display().to_string())
}

fn j2(library: &Path) -> String {
    umat(library, "properties = [200e3, 0.3, 300.0, 2e3], states = 1, check_tangent = 200")
}

fn elastic(library: &Path) -> String {
    umat(library, "properties = [200e3, 0.3], thread_safe = true")
}

fn point(sets: &[String]) -> LoadedPoint {
    umat::provide();
    load_point(&examples().join("point.toml"), sets).unwrap_or_else(|error| panic!("{}", error.render(false)))
}

/// Largest difference of the stresses of two laws along the path of the point deck, over the largest stress.
fn apart(own: &str, other: &str, more: &[&str]) -> f64 {
    let sets = [format!("material={{ own = {own}, other = {other} }}")];
    let sets: Vec<String> = sets.into_iter().chain(more.iter().map(ToString::to_string)).collect();
    let records = point(&sets).run().unwrap();
    let [own, other] = [&records[0], &records[1]];
    let (mut size, mut apart) = (0.0_f64, 0.0_f64);
    for (a, b) in own.rows.iter().zip(&other.rows) {
        for (name, (a, b)) in own.columns.iter().zip(a.iter().zip(b)) {
            if name.starts_with("stress") {
                (size, apart) = (size.max(a.abs()), apart.max((a - b).abs()));
            }
        }
    }
    assert!(size > 100.0 && own.rows.len() == other.rows.len());
    apart / size
}

#[test]
fn a_point_follows_the_law_of_the_program() {
    let folder = tempfile::tempdir().unwrap();
    let Some(j2_library) = library(&examples().join("j2.c"), folder.path()) else { return };
    for rate in ["jaumann", "green-naghdi", "logarithmic"] {
        let apart = apart(&format!("{{ von_mises = {J2} }}"), &j2(&j2_library), &[&format!("rate='{rate}'")]);
        assert!(apart < 1e-12, "{rate}: {apart:e}");
    }
    let Some(library) = library(&examples().join("elastic.f90"), folder.path()) else { return };
    let apart = apart(&format!("{{ elastic = {ELASTIC} }}"), &elastic(&library), &[]);
    assert!(apart < 1e-12, "{apart:e}");
}

/// The tangent along the deformation, rotation and all, is the exact one.
#[test]
fn the_tangent_of_a_point_is_that_of_differences() {
    let folder = tempfile::tempdir().unwrap();
    let Some(library) = library(&examples().join("j2.c"), folder.path()) else { return };
    for rate in ["jaumann", "green-naghdi", "logarithmic"] {
        let sets = [format!("material={{ other = {} }}", j2(&library)), format!("rate='{rate}'")];
        for (name, check) in point(&sets).tangents() {
            assert!(check.worst < 1e-5 && check.columns > 500, "{rate}, {name}: {check:?}");
        }
    }
}

/// Counts the solutions of the first step of a run, and keeps its energies.
#[derive(Default)]
struct Account {
    solutions: Vec<usize>,
    energies: [f64; 2],
}

impl Observer for Account {
    fn accepted(&mut self, state: &State, attempt: &AttemptRecord) -> Result<(), asperity::Error> {
        if attempt.step == 0 {
            self.solutions.push(attempt.solutions());
        }
        let energies = &state.energies[0];
        self.energies = [energies.stored, energies.dissipated];
        Ok(())
    }
}

/// The last state of a deck and its account.
fn solved(deck: &str, sets: &[String]) -> (State, Account) {
    umat::provide();
    let made = deck::load(&examples().join(deck), sets).and_then(deck::build);
    let made = made.unwrap_or_else(|error| panic!("{}", error.render(false)));
    let mut run = made.model.run(made.model.problem.initial_state());
    let mut account = Account::default();
    assert_eq!(run.run(&RunOptions::default(), &mut account).unwrap(), Stop::Done);
    (run.state.clone(), account)
}

/// Two laws make one structure. Where a point lies on the yield surface when it is let go, rounding decides what the first
/// iteration takes it for: iterations are counted as long as the load grows, where the last of each increment are of
/// rounding alone, and the tolerance leaves no trace of them.
fn agree(deck: &str, own: &str, other: &str, more: &[&str]) {
    let sets = |law: &str| -> Vec<String> {
        [format!("material.steel={law}"), "solver.tolerance=1e-13".into()]
            .into_iter()
            .chain(more.iter().map(ToString::to_string))
            .collect()
    };
    let ((a, counted), (b, other)) = (solved(deck, &sets(own)), solved(deck, &sets(other)));
    let size = a.u.iter().fold(0.0, |m: f64, u| m.max(u.abs()));
    let apart = a.u.iter().zip(&b.u).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
    println!("{deck} {more:?}: {:e}, {:?}, {:?}", apart / size, counted.solutions, other.solutions);
    assert!(apart < 1e-12 * size, "{deck}, {more:?}: {:e} of {size}", apart / size);
    let [own, with_umat]: [usize; 2] = [&counted, &other].map(|account| account.solutions.iter().sum());
    assert!(10 * own.abs_diff(with_umat) <= own, "{deck}, {more:?}: {:?} and {:?}", counted.solutions, other.solutions);
    for (a, b) in counted.energies.iter().zip(other.energies) {
        assert!((a - b).abs() < 1e-10 * counted.energies[0], "{deck}, {more:?}: {a} and {b}");
    }
}

#[test]
fn structures_are_those_of_the_law_of_the_program() {
    let folder = tempfile::tempdir().unwrap();
    let Some(j2_library) = library(&examples().join("j2.c"), folder.path()) else { return };
    let own = format!("{{ von_mises = {J2} }}");
    let little = ["bend=-0.5", "back=-0.6"].map(|end| end.replace('=', ".displacement.\"bar.right\".y="));
    let little = little.map(|end| format!("step.{end}"));
    let [bend, back] = little.each_ref().map(String::as_str);
    let [from, to] = ["from=[5.0, 0.0]", "to=[15.0, 1.0]"].map(|end| format!("mesh.part.bar.rectangle.{end}"));
    for more in [
        &[][..],
        &["space='plane-stress'", bend, back],
        // In larger increments rounding decides whether the first one back converges, and so over which increments it goes back.
        &["space='axisymmetric'", &from, &to, "step.back.increments.count=10"],
        &["body.bar.strain='small'", bend, back],
        &["body.bar.formulation='f-bar'", "mesh.part.bar.rectangle.cell='quad4'", bend, back],
        &["body.bar.rate='logarithmic'", bend, back],
    ] {
        agree("bar.toml", &own, &j2(&j2_library), more);
    }
    agree("beam.toml", &own, &j2(&j2_library), &[]);
    let Some(library) = library(&examples().join("elastic.f90"), folder.path()) else { return };
    let own = format!("{{ elastic = {ELASTIC} }}");
    agree("bar.toml", &own, &elastic(&library), &[]);
    agree("beam.toml", &own, &elastic(&library), &[]);
}

/// The J2 of the example, which keeps `TEMP` and `DTEMP` as states, in a body that is heated to 80 in four increments.
#[test]
fn a_law_is_told_of_the_temperature() {
    let folder = tempfile::tempdir().unwrap();
    let source = std::fs::read_to_string(examples().join("j2.c")).unwrap();
    let heading = source.find("umat_(").unwrap();
    let body = heading + source[heading..].find('{').unwrap() + 1;
    let told = format!("{}\n statev[1] = *temp; statev[2] = *dtemp;\n{}", &source[..body], &source[body..]);
    let Some(library) = library_of(&told, "told.c", folder.path()) else { return };
    let deck = format!(
        "version = 1
        space = \"plane-strain\"
        mesh.part.block.rectangle = {{ from = [0.0, 0.0], to = [1.0, 1.0], cells = [1, 1], cell = \"quad8\" }}
        material.m = {}
        body.block = {{ material = \"m\", expansion = 1e-6 }}
        [[step]]
        increments.count = 4
        symmetry = [\"block.left\", \"block.bottom\"]
        displacement.\"block.right\" = {{ x = 0.01 }}
        temperature.block.value = 80.0",
        umat(&library, "properties = [200e3, 0.3, 300.0, 2e3], states = 3")
    );
    let path = folder.path().join("heated.toml");
    std::fs::write(&path, deck).unwrap();
    let (state, _) = solved(path.to_str().unwrap(), &[]);
    let told = &state.histories[0].slot(0)[7..9];
    assert_eq!(told, [60.0, 20.0]);
}
