//! A belt on a drum: `T2 / T1 = exp(mu theta R / (R + t/2))`, as the friction `mu p` acts at the radius `R` of the drum
//! and the tension at the middle of the belt.

use crate::bench::Bench;
use crate::{Case, Measured};
use asperity::Error;

/// The case.
pub const CASE: Case = Case { name: "capstan", measure };

const TENSION: f64 = 10.0;
/// Wrap angles, and how far the end must be pulled until every point slips.
const WRAPS: [(usize, f64, f64); 3] = [(90, 90.0, 0.4), (180, 180.0, 1.0), (350, 350.0, 3.0)];

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let mut measured = Vec::new();
    for (name, angle, pull) in &WRAPS[..bench.pick(1, 3)] {
        for tenths in bench.pick(2..=2, 1..=3) {
            let ratio = ratio(bench, (*angle, *pull), &format!("contact.wrap.law.coulomb.friction=0.{tenths}"))?;
            measured.push((format!("wrap_{name}_mu_0{tenths}"), ratio));
        }
    }
    if bench.pick(false, true) {
        measured.push(("stiffer".into(), ratio(bench, (90.0, 0.4), "contact.wrap.penalty=4e5")?));
    }
    // The strip is 2 wide.
    let [x, _] = bench.solve("strip.toml", &[])?.reaction("end");
    measured.push(("strip".into(), -x / (2.0 * TENSION)));
    Ok(measured)
}

fn ratio(bench: &Bench, (angle, pull): (f64, f64), set: &str) -> Result<f64, Error> {
    let (sine, cosine) = angle.to_radians().sin_cos();
    let end = "displacement.\"belt.end\"";
    let along = format!("[{:?}, {cosine:?}]", -sine);
    let sets = [
        format!("mesh.part.belt.annulus.to=[51.0, {angle:?}]"),
        format!("mesh.part.belt.annulus.cells=[2, {}]", (0.5 * angle).round()),
        format!("step.1.{end}.along={along}"),
        format!("step.2.{end}.along={along}"),
        format!("step.2.{end}.value={pull:?}"),
        set.into(),
    ];
    let [x, y] = bench.solve("belt.toml", &sets)?.reaction("belt.end");
    Ok((y * cosine - x * sine) / TENSION)
}
