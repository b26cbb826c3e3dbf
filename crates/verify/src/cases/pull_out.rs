//! A rigid pile drawn through elastic soil that holds its dilatant skin: `p = p0 + k_e psi0 s_c (1 - exp(-s / s_c))`.

use crate::bench::{Bench, penalty, points};
use crate::{Case, Measured};
use asperity::Error;
use asperity::contact::{ContactRecord, PointStatus};

/// The case.
pub const CASE: Case = Case { name: "pull-out", measure };

/// Radii, and Lamé's shear modulus and Poisson's ratio of the soil.
const RADII: [f64; 2] = [500.0, 5000.0];
const POISSON: f64 = 0.3;
const SHEAR: f64 = 50.0 / (2.0 * (1.0 + POISSON));
/// Friction, cohesion, dilatancy and its slip.
const SKIN: [f64; 4] = [0.6, 0.01, 0.3, 1.0];

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let increments = format!("step.2.increments={{ first = 0.005, largest = {} }}", bench.pick(0.02, 0.005));
    let [mut before, mut slipped] = [0.0; 2];
    let run = bench.follow("pile.toml", std::slice::from_ref(&increments), |model, state| {
        if state.step <= 1 && state.time <= 1.0 + 1e-9 {
            (before, slipped) = mean(&points(model, state, 0), |point| (point.pressure, point.slipped));
        }
    })?;
    let end = run.points(0);
    let (pressure, slip) = mean(&end, |point| (point.pressure, point.slipped));
    let (shear, _) = mean(&end, |point| (point.shear.abs(), 0.0));
    let dilated = risen(penalty(&run.model), [slipped, slip]);
    let wedge = bench.solve("wedge.toml", std::slice::from_ref(&increments))?.points(0);
    let (in_space, shear_in_space) = mean(&wedge, |point| (point.pressure, point.shear.abs()));
    let skin = bench.solve("skin.toml", std::slice::from_ref(&increments))?;
    let (critical, last) = mean(&skin.points(0), |point| (point.pressure, point.shear.abs()));
    let like_skin = [
        "contact.skin.law={ cam_clay = { critical_slope = 0.6, preconsolidation = 0.3 } }",
        "step.draw.motion.pile.z=60.0",
    ];
    let sets: Vec<String> = like_skin.map(String::from).into_iter().chain([increments]).collect();
    let (skin_in_space, _) = mean(&bench.solve("wedge.toml", &sets)?.points(0), |point| (point.pressure, 0.0));
    Ok(vec![
        ("pressure".into(), pressure / (before + dilated)),
        ("shear".into(), shear / (SKIN[0] * pressure + SKIN[1])),
        ("dilated".into(), (pressure - before) / dilated),
        ("wedge_pressure".into(), in_space / pressure),
        ("wedge_shear".into(), shear_in_space / shear),
        ("wedge_critical".into(), skin_in_space / critical),
        ("critical_pressure".into(), 2.0 * critical / 0.3),
        ("critical_shear".into(), last / (0.6 * critical)),
    ])
}

/// Rise of the pressure between two slips.
fn risen(penalty: f64, [from, to]: [f64; 2]) -> f64 {
    let rho = (RADII[1] / RADII[0]).powi(2);
    let ring = 2.0 * SHEAR / RADII[0] * (rho + 1.0 / (1.0 - 2.0 * POISSON)) / (rho - 1.0);
    let stiffness = 1.0 / (1.0 / ring + 1.0 / penalty);
    let dilation = |slip: f64| SKIN[2] * SKIN[3] * (1.0 - (-slip / SKIN[3]).exp());
    stiffness * (dilation(to) - dilation(from))
}

fn mean(points: &[ContactRecord], of: impl Fn(&ContactRecord) -> (f64, f64)) -> (f64, f64) {
    let closed = || points.iter().filter(|point| point.status != PointStatus::Open);
    let n = closed().count() as f64;
    let sum = closed().map(of).fold((0.0, 0.0), |sum, value| (sum.0 + value.0, sum.1 + value.1));
    (sum.0 / n, sum.1 / n)
}
