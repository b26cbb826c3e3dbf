//! Two equal elastic spheres under a force: `a^3 = 3 F R' / (4 E')` with `R' = R/2`, `E' = E / (2 (1 - nu^2))`, and
//! `p0 = 3 F / (2 pi a^2)`.

use crate::bench::{Bench, points, reaction};
use crate::{Case, Measured, fit};
use asperity::Error;
use std::f64::consts::PI;

/// The case.
pub const CASE: Case = Case { name: "hertz-spheres", measure };

const RADIUS: f64 = 50.0;
const MODULUS: f64 = 20e3 / (2.0 * (1.0 - 0.3 * 0.3));
const FORCE: f64 = 586_080.6;

/// Force, and radius of contact and largest pressure over those of Hertz for it.
type Moment = (f64, f64, f64);

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let n = bench.pick(1, 2);
    let mut moments: Vec<Moment> = Vec::new();
    let run = bench.follow("spheres.toml", &refined(n), |model, state| {
        let force = reaction(model, state, "lower.start")[1];
        let a = (0.75 * force * 0.5 * RADIUS / MODULUS).cbrt();
        let pressures: Vec<_> = points(model, state, 0).iter().map(|p| (p.position[0], p.pressure)).collect();
        let (width, largest) = fit::hertz(&pressures);
        moments.push((force, width / a, largest / (1.5 * force / (PI * a * a))));
    })?;
    let near = |force: f64| {
        let distance = |moment: &&Moment| (moment.0 / force).ln().abs();
        moments.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).copied().unwrap_or_default()
    };
    let (whole, eighth) = (near(FORCE), near(0.125 * FORCE));
    let carried = |contact: usize| run.points(contact).iter().map(|point| point.force()[1]).sum::<f64>().abs();
    Ok(vec![
        ("a".into(), whole.1),
        ("p0".into(), whole.2),
        ("a_eighth".into(), eighth.1),
        ("p0_eighth".into(), eighth.2),
        ("force".into(), whole.0),
        ("balance".into(), carried(0) / carried(1) - 1.0),
    ])
}

fn refined(n: usize) -> Vec<String> {
    let rings = format!("[{{ to = 47.5, cells = {}, ratio = 0.1 }}, {{ to = 50.0, cells = {} }}]", 10 * n, 4 * n);
    let (near, far) = (20 * n, 12 * n);
    let lower = format!("[{{ to = 74.0, cells = {far}, ratio = 0.15 }}, {{ to = 90.0, cells = {near} }}]");
    let upper = format!("[{{ to = -74.0, cells = {near} }}, {{ to = 0.0, cells = {far}, ratio = 6.7 }}]");
    let part = |name: &str, angles: String| {
        let key = format!("mesh.part.{name}.annulus");
        [format!("{key}.along_radius={rings}"), format!("{key}.along_angle={angles}")]
    };
    [part("lower", lower), part("upper", upper)].concat()
}
