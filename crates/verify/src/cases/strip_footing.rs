//! Bearing capacity of a strip footing on weightless ground: Prandtl's `Nc = (Nq - 1) cot phi` and Reissner's
//! `Nq = exp(pi tan phi) tan^2(45 + phi/2)`.

use crate::bench::{Bench, reaction};
use crate::{Case, Measured};
use asperity::Error;

/// Associated flow.
pub const CASE: Case = Case { name: "strip-footing", measure };
/// Less dilatancy than friction, on the same deck.
pub const DILATANCY: Case = Case { name: "strip-footing-dilatancy", measure: with_less_dilatancy };
/// No dilatancy, on meshes along the slip lines.
pub const BANDS: Case = Case { name: "strip-footing-bands", measure: along_slip_lines };

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
    for &friction in bench.pick(&[20][..], &[0, 10, 20, 25, 30, 35]) {
        for (cell, n) in [("quad4", bench.pick(2, 6)), ("quad8", bench.pick(1, 3))] {
            measured.extend(by_default(bench, (cell, n), [friction; 2], settlement(friction))?);
        }
    }
    Ok(measured)
}

fn with_less_dilatancy(bench: &Bench) -> Result<Measured, Error> {
    let mut measured = Measured::new();
    for &friction in bench.pick(&[10][..], &[10, 20, 30, 35]) {
        for (cell, n) in [("quad4", 2), ("quad8", 1)] {
            for dilatancy in [friction / 2, 0] {
                measured.extend(by_default(bench, (cell, n), [friction, dilatancy], SETTLED)?);
            }
        }
    }
    Ok(measured)
}

fn along_slip_lines(bench: &Bench) -> Result<Measured, Error> {
    let mut measured = Measured::new();
    for &friction in bench.pick(&[20][..], &[20, 30]) {
        let [mean, range] = bands(bench, friction)?;
        measured.push((format!("nc_{friction}_psi_0_bands"), mean));
        measured.push((format!("nc_{friction}_psi_0_bands_range"), range));
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

/// Settlement of runs whose flow is not associated.
const SETTLED: f64 = 1e-3;

/// With cells, formulation and solver as they come: the load over the cohesion, with other than associated flow its mean over the
/// second half of the settlement; its range over the last third, and increments.
fn by_default(
    bench: &Bench,
    (cell, n): (&str, usize),
    [friction, dilatancy]: [usize; 2],
    settlement: f64,
) -> Result<Vec<(String, f64)>, Error> {
    let mut sets = sets(n, [friction, dilatancy], settlement);
    sets.push(format!("mesh.part.ground.rectangle.cell='{cell}'"));
    let (name, mut curve) = (format!("{cell}_{friction}_psi_{dilatancy}"), Vec::new());
    let name = if dilatancy == friction { format!("{cell}_{friction}") } else { name };
    bench.follow("../strip-footing/default.toml", &sets, |model, state| {
        curve.push((state.time, -reaction(model, state, "face")[1]))
    })?;
    let load = if dilatancy == friction { curve.last().map_or(f64::NAN, |last| last.1) } else { late(&curve, 0.5)[0] };
    let range = late(&curve, 2.0 / 3.0)[1] / load;
    let found = [("", load), ("_range", range), ("_increments", curve.len() as f64 - 1.0)];
    Ok(found.map(|(what, value)| (format!("{name}{what}"), value)).to_vec())
}

/// Without dilatancy, on the mesh along the slip lines: mean over the second half of the settlement, and the range over it, of a load that
/// never comes to rest.
fn bands(bench: &Bench, friction: usize) -> Result<[f64; 2], Error> {
    let soil = "material.soil.drucker_prager_plane_strain";
    let coarse = bench.pick("_coarse", "");
    let sets = [format!("mesh.file='bands_{friction}{coarse}.inp'"), format!("{soil}.friction={friction}")];
    let mut curve = Vec::new();
    bench.follow("bands.toml", &sets, |model, state| curve.push((state.time, -reaction(model, state, "face")[1])))?;
    Ok(late(&curve, 0.5))
}

/// Mean of a curve and its range from a time on.
fn late(curve: &[(f64, f64)], from: f64) -> [f64; 2] {
    let late: Vec<_> = curve.windows(2).filter(|two| two[1].0 > from).collect();
    let area: f64 = late.iter().map(|two| (two[1].0 - two[0].0) * two[1].1).sum();
    let (low, high) = late.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), two| (l.min(two[1].1), h.max(two[1].1)));
    [area / (1.0 - late.first().map_or(0.0, |two| two[0].0)), high - low]
}
