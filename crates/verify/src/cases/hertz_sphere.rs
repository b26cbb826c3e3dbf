//! Hertz's point contact: an elastic sphere pressed on a rigid plane. `a^3 = 3 P R / (4 E*)`,
//! `p0 = 3 P / (2 pi a^2)`, `p(r) = p0 sqrt(1 - r^2/a^2)`.

use crate::bench::{Bench, points};
use crate::{Case, Measured, fit};
use asperity::Error;
use asperity::contact::PointRecord;
use std::f64::consts::PI;

/// The case.
pub const CASE: Case = Case { name: "hertz-sphere", measure };

const RADIUS: f64 = 10.0;
const MODULUS: f64 = 210e3 / (1.0 - 0.3 * 0.3);
const FORCE: f64 = 1000.0;

/// What one mesh gives.
struct Level {
    points: Vec<PointRecord>,
    error: f64,
}

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let levels = bench.pick(1, 3);
    let runs = (0..levels).map(|level| solve(bench, 1 << level)).collect::<Result<Vec<_>, _>>()?;
    let finest = &runs[levels - 1];
    let (a, p0) = fit::hertz(&finest.points.iter().map(|p| (p.position[0], p.pressure)).collect::<Vec<_>>());
    let mut measured = vec![
        ("a".into(), a),
        ("p0".into(), p0),
        ("pressure".into(), finest.error),
        ("force".into(), force(&finest.points)),
    ];
    if levels > 1 {
        measured.push(("order".into(), fit::order(&runs.iter().map(|run| run.error).collect::<Vec<_>>())));
    }
    Ok(measured)
}

/// Every cell of the deck cut into `n` by `n`; the error is the mean over the increments of the second half of the
/// load, as it depends on where within an edge the contact ends.
fn solve(bench: &Bench, n: usize) -> Result<Level, Error> {
    let mut errors = Vec::new();
    let run = bench.follow("sphere.toml", &refined(n), |model, state| {
        let points = points(model, state, 0);
        if force(&points) > 0.5 * FORCE {
            errors.push(pressure_error(&points));
        }
    })?;
    Ok(Level { points: run.points(0), error: errors.iter().sum::<f64>() / errors.len() as f64 })
}

fn refined(n: usize) -> Vec<String> {
    let part = "mesh.part.sphere.annulus";
    let radius = format!("[{{ to = 9.6, cells = {}, ratio = 0.02 }}, {{ to = 10.0, cells = {} }}]", 10 * n, 9 * n);
    let angle = format!("[{{ to = -87.4, cells = {} }}, {{ to = 0.0, cells = {}, smooth = true }}]", 9 * n, 12 * n);
    vec![format!("{part}.along_radius={radius}"), format!("{part}.along_angle={angle}")]
}

fn force(points: &[PointRecord]) -> f64 {
    points.iter().map(|point| point.force()[1]).sum()
}

/// `|p - p_Hertz| / |p_Hertz|` in L2 over the circle of contact, with Hertz's pressure for the force that it carries.
fn pressure_error(points: &[PointRecord]) -> f64 {
    let force = force(points);
    let a = (0.75 * force * RADIUS / MODULUS).cbrt();
    let p0 = 1.5 * force / (PI * a * a);
    let (mut error, mut norm) = (0.0, 0.0);
    for point in points {
        let exact = p0 * (1.0 - (point.position[0] / a).powi(2)).max(0.0).sqrt();
        error += point.area * (point.pressure - exact).powi(2);
        norm += point.area * exact * exact;
    }
    (error / norm).sqrt()
}
