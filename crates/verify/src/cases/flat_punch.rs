//! A rigid flat punch. On a half plane `p = P / (pi sqrt(a^2 - x^2))`; the cylinder on a half space takes
//! `F = 2 a E* d`, `p = F / (2 pi a sqrt(a^2 - r^2))`.

use crate::bench::{Bench, Solved, resultant};
use crate::{Case, Measured, fit};
use asperity::Error;
use std::f64::consts::PI;

/// The case.
pub const CASE: Case = Case { name: "flat-punch", measure };

const A: f64 = 10.0;

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let strip = bench.solve("strip.toml", &refined(bench, STRIP))?;
    let disc = bench.solve("disc.toml", &refined(bench, DISC))?;
    let ([p, f], force) = (pressures(&strip), force(&strip));
    let ([q, g], total) = (pressures(&disc), self::force(&disc));
    let mut measured: Measured = vec![
        // The model is half of the strip.
        ("strip_centre".into(), p * PI * A / (2.0 * force)),
        ("strip_edge".into(), f * PI * A / (2.0 * force)),
        ("disc_force".into(), total),
        ("disc_centre".into(), q * 2.0 * PI * A * A / total),
        ("disc_edge".into(), g * 2.0 * PI * A * A / total),
    ];
    let mut iterations = 0.0_f64;
    for (cell, cells) in bench.pick(&RIMS[..3], &RIMS[..]) {
        let part = "mesh.part.block";
        let run =
            bench.solve("rim.toml", &[format!("{part}.box.cells={cells:?}"), format!("{part}.box.cell=\"{cell}\"")])?;
        iterations = iterations.max(run.iterations());
        measured.push((format!("rim_{cell}_{}", cells[0]), self::force(&run)));
    }
    measured.push(("rim_iterations".into(), iterations));
    Ok(measured)
}

/// Meshes of the block under a rim.
const RIMS: [(&str, [usize; 3]); 5] =
    [("hex8", [5, 2, 5]), ("tet10", [4, 2, 4]), ("tet10", [5, 2, 5]), ("hex8", [10, 2, 10]), ("hex20", [5, 2, 5])];

/// Far end along x, number of cells to it, depth, number of cells along it, size of the last over that of the first.
type Extent = (f64, usize, usize, f64);
const STRIP: Extent = (1000.0, 12, 30, 0.0002);
const DISC: Extent = (4000.0, 14, 32, 5e-5);

/// The deck's mesh; in full every cell cut into two by two.
fn refined(bench: &Bench, (far, out, deep, ratio): Extent) -> Vec<String> {
    let (n, part) = (bench.pick(1, 2), "mesh.part.ground.rectangle");
    // Half as long cells throughout: the ratio of a run from end to end stays.
    let near = format!(
        "{{ to = 10.0, cells = {}, ratio = 0.02 }}, {{ to = 20.0, cells = {}, smooth = true }}",
        16 * n,
        12 * n
    );
    let x = format!("[{near}, {{ to = {far:?}, cells = {}, smooth = true }}]", out * n);
    let y = format!("[{{ to = 0.0, cells = {}, ratio = {ratio:?} }}]", deep * n);
    vec![format!("{part}.along_x={x}"), format!("{part}.along_y={y}")]
}

fn force(run: &Solved) -> f64 {
    -resultant(&run.points(0))[1]
}

/// Pressure at the centre and at `0.9 a`: `1/p^2` is a straight line over `x^2`, fitted around both.
fn pressures(run: &Solved) -> [f64; 2] {
    let points = run.points(0);
    let at = |from: f64, to: f64, x: f64| {
        let closed = points.iter().filter(|point| point.pressure > 0.0);
        let near = closed.filter(|point| (from * A..to * A).contains(&point.position[0]));
        let line =
            fit::line(&near.map(|point| (point.position[0].powi(2), point.pressure.powi(-2))).collect::<Vec<_>>());
        (line.0 + line.1 * (x * A).powi(2)).powf(-0.5)
    };
    [at(0.0, 0.4, 0.0), at(0.85, 0.95, 0.9)]
}
