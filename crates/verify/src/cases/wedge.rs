//! A sharp wedge pressed into rubber, its tip anywhere over an edge: force against that of a finer mesh.

use crate::bench::{Bench, points, resultant};
use crate::{Case, Measured};
use asperity::Error;

/// The case.
pub const CASE: Case = Case { name: "wedge", measure };

/// Length of an edge and height of the wedge.
const EDGE: f64 = 0.1;
const HEIGHT: f64 = 5.0;
/// Depths at which forces are compared.
const DEPTHS: [f64; 2] = [5.0 * EDGE, 10.0 * EDGE];
/// Cells of the three parts along x and of the two along y.
const ALONG_X: [usize; 3] = [11, 30, 11];
const ALONG_Y: [usize; 2] = [11, 15];

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let mut measured = Measured::new();
    for angle in bench.pick(&[60.0][..], &[30.0, 60.0, 90.0]) {
        let fine = forces(bench, &[tip(*angle, 0.0, 0.0), finer(bench.pick(2, 4))])?;
        let places = [("node", 0.0, 0.0), ("third", 0.33, 0.0), ("middle", 0.5, 0.0), ("rounded", 0.3, 0.2)];
        for (name, part, radius) in places {
            let coarse = forces(bench, &[tip(*angle, part * EDGE, radius * EDGE)])?;
            let deviation = |k: usize| coarse[k] / fine[k] - 1.0;
            measured.push((format!("{name}_{angle}_at_5"), deviation(0)));
            measured.push((format!("{name}_{angle}_at_10"), deviation(1)));
        }
    }
    Ok(measured)
}

/// The wedge with its tip at `x`, rounded by a radius.
fn tip(angle: f64, x: f64, radius: f64) -> String {
    let (sine, cosine) = (0.5 * angle).to_radians().sin_cos();
    let side = |sign: f64, [across, up]: [f64; 2]| format!("[{}, {up}]", x + sign * across);
    // Where the rounding meets the flank, and the upper end of that.
    let touch = [radius * cosine, radius * (1.0 - sine)];
    let end = [touch[0] + (HEIGHT - touch[1]) * sine / cosine, HEIGHT];
    let line = |from: String, to: String| format!("{{ line = [{from}, {to}] }}");
    let arc = format!("{{ arc = [{}, [{x}, 0.0], {}] }},", side(-1.0, touch), side(1.0, touch));
    let profile = [line(side(-1.0, end), side(-1.0, touch)), line(side(1.0, touch), side(1.0, end))];
    format!("tool.wedge.profile=[{}, {} {}]", profile[0], if radius > 0.0 { arc } else { String::new() }, profile[1])
}

/// The mesh with every cell cut into so many along each side.
fn finer(times: usize) -> String {
    let [a, b, c] = ALONG_X.map(|cells| times * cells);
    let [d, e] = ALONG_Y.map(|cells| times * cells);
    format!(
        "mesh.part.block.rectangle={{ from = [-4.0, -4.0], cell = \"quad4\", along_x = [{{ to = -1.5, cells = {a}, ratio = 0.2472 }}, \
         {{ to = 1.5, cells = {b} }}, {{ to = 4.0, cells = {c}, smooth = true }}], along_y = [{{ to = -1.5, cells = {d}, ratio = 0.2472 }}, \
         {{ to = 0.0, cells = {e} }}] }}"
    )
}

/// Forces of the wedge at the two depths.
fn forces(bench: &Bench, sets: &[String]) -> Result<[f64; 2], Error> {
    let mut curve = vec![(0.0, 0.0)];
    bench.follow("wedge.toml", sets, |model, state| {
        curve.push((state.time, -resultant(&points(model, state, 0))[1]));
    })?;
    Ok(DEPTHS.map(|depth| {
        let after = curve.partition_point(|(time, _)| *time < depth).clamp(1, curve.len() - 1);
        let ((t0, f0), (t1, f1)) = (curve[after - 1], curve[after]);
        f0 + (f1 - f0) * (depth - t0) / (t1 - t0)
    }))
}
