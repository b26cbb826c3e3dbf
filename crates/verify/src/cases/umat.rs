//! A law of a shared library beside the law of the program that it repeats.

use crate::bench::Bench;
use crate::{Case, Measured};
use asperity::{Error, deck};
use std::path::PathBuf;
use std::process::Command;

/// The case.
pub const CASE: Case = Case { name: "umat", measure };

const OWN: &str =
    "material.steel={ von_mises = { young = 200e3, poisson = 0.3, yield_stress = 300.0, hardening = 2e3 } }";

fn measure(bench: &Bench) -> Result<Measured, Error> {
    umat::provide();
    let folder = tempfile::tempdir().map_err(|error| Error::write("a temporary folder", error))?;
    let library = built(bench, folder.path().join("libj2.so"))?;
    let mut measured = vec![("point".into(), point(bench, &library)?)];
    let mut solutions = [0, 0];
    for name in ["bar", "beam"] {
        // What rounding makes of the last iterations stays below the tolerance.
        let solve = |law: String| bench.solve(&format!("{name}.toml"), &[law, "solver.tolerance=1e-13".into()]);
        let (own, other) = (solve(OWN.into())?, solve(set("steel", &library))?);
        let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |m: f64, x| m.max(x.abs()));
        let size = largest(&mut own.state.u.iter().copied());
        let apart = largest(&mut own.state.u.iter().zip(&other.state.u).map(|(a, b)| a - b));
        measured.push((name.into(), apart / size));
        for (sum, solved) in solutions.iter_mut().zip([own, other]) {
            *sum += solved.attempts.iter().map(|attempt| attempt.solutions()).sum::<usize>();
        }
    }
    measured.push(("iterations".into(), solutions[1] as f64 / solutions[0] as f64));
    Ok(measured)
}

fn set(material: &str, library: &str) -> String {
    format!("material.{material}.umat.library={library:?}")
}

/// The library of the law, which needs a C compiler, as the program itself does.
fn built(bench: &Bench, library: PathBuf) -> Result<String, Error> {
    let mut compiler = Command::new("cc");
    compiler.args(["-O2", "-shared", "-fPIC", "-o"]).arg(&library).arg(bench.folder().join("j2.c")).arg("-lm");
    let status = compiler.status().map_err(|error| Error::input(format!("cc, a C compiler, is needed: {error}")))?;
    if !status.success() {
        return Err(Error::input("cc does not compile cases/umat/j2.c"));
    }
    Ok(library.display().to_string())
}

/// Largest difference of the stresses of the point over the largest stress.
fn point(bench: &Bench, library: &str) -> Result<f64, Error> {
    let loaded = deck::load_point(&bench.folder().join("point.toml"), &[set("steel_umat", library)])?;
    let records = loaded.run()?;
    let (mut size, mut apart) = (0.0_f64, 0.0_f64);
    for (column, name) in records[0].columns.iter().enumerate().filter(|(_, name)| name.starts_with("stress_")) {
        let other = records[1].columns.iter().position(|known| known == name).unwrap_or(column);
        for (own, umat) in records[0].rows.iter().zip(&records[1].rows) {
            (size, apart) = (size.max(own[column].abs()), apart.max((own[column] - umat[other]).abs()));
        }
    }
    Ok(apart / size)
}
