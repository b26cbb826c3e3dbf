//! Contact stress as a field of nodal values: Coulomb's limit, the weight of stacked blocks, and Lame's pressure between
//! rings of facets that do not match.

use crate::bench::{Bench, Solved, points, resultant};
use crate::{Case, Measured};
use asperity::Error;

/// The case.
pub const CASE: Case = Case { name: "contact-field", measure };

/// Pressure between the rings: `p (1 - a^2 / r^2) / (1 - a^2 / c^2)`.
const LAME: f64 = 1e6 * (1.0 - 0.04 / 0.36) / (1.0 - 0.04);
/// Weight of one block.
const WEIGHT: f64 = 4.0;

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let mut measured = vec![("friction".into(), friction(bench)?), ("weight".into(), weight(bench, "stack.toml", 2)?)];
    measured.push(("weight_four".into(), weight(bench, "four.toml", 4)?));
    let mut open = 0;
    for (name, inner, outer) in [("rings_24", 24, 31), ("rings_48", 48, 62)] {
        let mut rings = |more: &[&str]| {
            let cells = [("inner", inner), ("outer", outer)]
                .map(|(part, around)| format!("mesh.part.{part}.annulus.cells=[10, {around}]"));
            let sets: Vec<String> = cells.into_iter().chain(more.iter().map(|set| (*set).to_owned())).collect();
            let run = bench.solve("rings.toml", &sets)?;
            open += run.points(0).iter().filter(|point| point.pressure == 0.0).count();
            Ok::<_, Error>(ring_error(&run))
        };
        let swapped = ["contact.joint.surface=outer.inner", "contact.joint.target=inner.outer"];
        let other = [&swapped[..], &["contact.joint.roles=given"]].concat();
        measured.push((name.into(), rings(&swapped)?));
        measured.push((format!("{name}_other"), rings(&other)?));
        measured.push((format!("{name}_fit"), rings(&["contact.joint.overlap=fit"])?));
    }
    measured.push(("open".into(), open as f64));
    Ok(measured)
}

fn friction(bench: &Bench) -> Result<f64, Error> {
    let mut worst = 0.0_f64;
    for cell in ["quad4", "quad8", "tri6"] {
        for friction in [0.1, 0.5, 1.2] {
            let sets = [
                format!("mesh.part.block.rectangle.cell={cell}"),
                format!("contact.sole.law.coulomb.friction={friction}"),
            ];
            let [along, across] = force(&bench.solve("drag.toml", &sets)?, 0);
            worst = worst.max((along.abs() / across / friction - 1.0).abs());
        }
    }
    Ok(worst)
}

/// Largest error of what the contacts of so many stacked blocks carry in any increment, from the ground up, over the weight above.
fn weight(bench: &Bench, deck: &str, blocks: usize) -> Result<f64, Error> {
    let mut worst = 0.0_f64;
    bench.follow(deck, &[], |model, state| {
        let carried = |contact: usize| resultant(&points(model, state, contact))[1];
        let above = |contact: usize| (blocks - contact) as f64 * WEIGHT * state.time;
        worst = (0..blocks).map(|contact| (carried(contact) / above(contact) - 1.0).abs()).fold(worst, f64::max);
    })?;
    Ok(worst)
}

/// Force on the surface of a contact.
fn force(run: &Solved, contact: usize) -> [f64; 2] {
    let force = resultant(&run.points(contact));
    [force[0], force[1]]
}

/// Error of the pressure, root mean square over the area.
fn ring_error(run: &Solved) -> f64 {
    let sum = run.points(0).iter().fold([0.0; 2], |[area, sum], point| {
        [area + point.area, sum + point.area * (point.pressure / LAME - 1.0).powi(2)]
    });
    (sum[1] / sum[0]).sqrt()
}
