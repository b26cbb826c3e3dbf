//! Bearing capacity of a strip footing on weightless ground: Prandtl's `Nc = (Nq - 1) cot phi` and Reissner's
//! `Nq = exp(pi tan phi) tan^2(45 + phi/2)`.

use crate::bench::{Bench, reaction};
use crate::{Case, Measured};
use asperity::Error;

/// The case.
pub const CASE: Case = Case { name: "strip-footing", measure };

/// Settlement at which the load has come to rest, for an angle of friction in degrees.
fn settlement(friction: usize) -> f64 {
    2e-4 * (1.0 + friction as f64 / 10.0)
}

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let mut measured = Measured::new();
    for &friction in bench.pick(&[0, 20][..], &[0, 10, 20, 30]) {
        measured.push((format!("nc_{friction}"), load(bench, "footing.toml", friction)?));
        if friction > 0 {
            measured.push((format!("nq_{friction}"), load(bench, "surcharge.toml", friction)?));
        }
    }
    if bench.pick(false, true) {
        for friction in [20, 30] {
            let (even, bands) = (even(bench, friction)?, bands(bench, friction)?);
            let of_even = [("", even[0]), ("_davis", even[0]), ("_range", even[1])];
            for (what, value) in of_even.into_iter().chain([("_bands", bands[0]), ("_bands_range", bands[1])]) {
                measured.push((format!("nc_{friction}_psi_0{what}"), value));
            }
        }
    }
    Ok(measured)
}

/// Cells, angles and settlement.
fn sets(n: usize, [friction, dilatancy]: [usize; 2], settlement: f64) -> Vec<String> {
    let (part, soil) = ("mesh.part.ground.rectangle", "material.soil.drucker_prager_plane_strain");
    let (x, rest, y) = (6 * n, 24 * n, 18 * n);
    vec![
        format!("{part}.along_x=[{{ to = 1.0, cells = {x} }}, {{ to = 14.0, cells = {rest}, smooth = true }}]"),
        format!("{part}.along_y=[{{ to = 0.0, cells = {y}, ratio = 0.2 }}]"),
        format!("{soil}.friction={friction}"),
        format!("{soil}.dilatancy={dilatancy}"),
        format!("step.load.displacement.face={{ y = -{settlement:?} }}"),
    ]
}

/// Mean pressure under the half of the footing, of width 1, with associated flow.
fn load(bench: &Bench, deck: &str, friction: usize) -> Result<f64, Error> {
    let sets = sets(bench.pick(1, 2), [friction; 2], settlement(friction));
    Ok(-bench.solve(deck, &sets)?.reaction("face")[1])
}

/// Without dilatancy, on the mesh of the deck.
fn even(bench: &Bench, friction: usize) -> Result<[f64; 2], Error> {
    let mut sets = sets(1, [friction, 0], 5e-4);
    sets.push("step.load.increments={ first = 0.01, largest = 0.02 }".into());
    sets.push("solver={ tolerance = 1e-3, iterations = 40 }".into());
    plateau(bench, "footing.toml", &sets)
}

/// Without dilatancy, on the mesh along the slip lines.
fn bands(bench: &Bench, friction: usize) -> Result<[f64; 2], Error> {
    let soil = "material.soil.drucker_prager_plane_strain";
    let sets = [format!("mesh.file='bands_{friction}.inp'"), format!("{soil}.friction={friction}")];
    plateau(bench, "bands.toml", &sets)
}

/// Mean over the second half of the settlement, and the range over it, of a load that never comes to rest.
fn plateau(bench: &Bench, deck: &str, sets: &[String]) -> Result<[f64; 2], Error> {
    let mut curve = Vec::new();
    bench.follow(deck, sets, |model, state| curve.push((state.time, -reaction(model, state, "face")[1])))?;
    let late: Vec<_> = curve.windows(2).filter(|two| two[1].0 > 0.5).collect();
    let area: f64 = late.iter().map(|two| (two[1].0 - two[0].0) * two[1].1).sum();
    let (low, high) = late.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), two| (l.min(two[1].1), h.max(two[1].1)));
    Ok([area / (1.0 - late.first().map_or(0.0, |two| two[0].0)), high - low])
}
