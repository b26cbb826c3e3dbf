//! Hertz's line contact: an elastic roller pressed on a rigid plane. `p(x) = p0 sqrt(1 - x^2/a^2)` with
//! `a^2 = 4 P R / (pi E*)` and `p0 = 2 P / (pi a)`.

use crate::bench::{Bench, Solved};
use crate::{Case, Measured, fit};
use asperity::Error;

/// The case.
pub const CASE: Case = Case { name: "hertz-cylinder", measure };

const A: f64 = 0.525232;
const P0: f64 = 1212.07;

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let levels = bench.pick(1, 3);
    let runs = (0..levels).map(|level| bench.solve("roller.toml", &refined(1 << level)));
    let runs = runs.collect::<Result<Vec<_>, _>>()?;
    let errors: Vec<f64> = runs.iter().map(pressure_error).collect();
    let finest = &runs[levels - 1];
    let (a, p0) = fit::hertz(&profile(finest));
    let force = finest.points(0).iter().map(|point| point.force()[1]).sum();
    let mut measured = vec![
        ("a".into(), a),
        ("p0".into(), p0),
        ("pressure".into(), errors[levels - 1]),
        ("force".into(), force),
    ];
    if levels > 1 {
        let order = (errors[0] / errors[levels - 1]).ln() / f64::from(1 << (levels - 1)).ln();
        measured.push(("order".into(), order));
    }
    Ok(measured)
}

/// Every cell of the deck cut into `n` by `n`.
fn refined(n: usize) -> Vec<String> {
    let part = "mesh.part.roller.annulus";
    vec![
        format!(
            "{part}.along_radius=[{{ to = 49.0, cells = {}, ratio = 0.01 }}, {{ to = 50.0, cells = {} }}]",
            10 * n,
            9 * n
        ),
        format!(
            "{part}.along_angle=[{{ to = -89.0, cells = {} }}, {{ to = 0.0, cells = {}, smooth = true }}]",
            9 * n,
            12 * n
        ),
    ]
}

fn profile(run: &Solved) -> Vec<(f64, f64)> {
    run.points(0).iter().map(|point| (point.position[0], point.pressure)).collect()
}

/// `|p - p_Hertz| / |p_Hertz|` in L2 over the contact points.
fn pressure_error(run: &Solved) -> f64 {
    let hertz = |x: f64| P0 * (1.0 - (x / A).powi(2)).max(0.0).sqrt();
    let (mut error, mut norm) = (0.0, 0.0);
    for point in run.points(0) {
        let exact = hertz(point.position[0]);
        error += point.area * (point.pressure - exact).powi(2);
        norm += point.area * exact * exact;
    }
    (error / norm).sqrt()
}
