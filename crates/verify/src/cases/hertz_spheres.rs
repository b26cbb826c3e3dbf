//! Two equal elastic spheres under a force: `a^3 = 3 F R' / (4 E')` with `R' = R/2`, `E' = E / (2 (1 - nu^2))`, and
//! `p0 = 3 F / (2 pi a^2)`.

use crate::bench::{Bench, both_forms, points, reaction, resultant, sides};
use crate::{Case, Measured, fit};
use asperity::Error;
use asperity::model::Model;
use asperity::system::State;
use std::f64::consts::PI;

/// The case.
pub const CASE: Case = Case { name: "hertz-spheres", measure };

const RADIUS: f64 = 50.0;
const MODULUS: f64 = 20e3 / (2.0 * (1.0 - 0.3 * 0.3));
const FORCE: f64 = 586_080.6;

/// Radii and pressures of contact points.
type Pressures = Vec<(f64, f64)>;

/// Force, and radius of contact and largest pressure over those of Hertz for it.
type Moment = (f64, [f64; 2]);

fn measure(bench: &Bench) -> Result<Measured, Error> {
    // The contact ends within edges.
    both_forms(&["contact.touch.form=paper", "contact.touch.gauss=3"], |form| pressed(bench, form))
}

fn pressed(bench: &Bench, form: &[String]) -> Result<Measured, Error> {
    let n = bench.pick(1, 2);
    let mut moments: Vec<Moment> = Vec::new();
    let finite = bench.follow("spheres.toml", &[&refined(n), form].concat(), |model, state| {
        let force = reaction(model, state, "lower.start")[1];
        moments.push((force, over_hertz(force, &present(model, state))));
    })?;
    let near = |force: f64| {
        let distance = |moment: &&Moment| (moment.0 / force).ln().abs();
        moments.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).copied().unwrap_or_default()
    };
    let small = ["lower", "upper"].map(|body| format!("body.{body}.strain=small"));
    let small = bench.solve("spheres.toml", &[&refined(n)[..], &small, form].concat())?;
    let carried = sides(&finite.model, &finite.state).map(|side| resultant(&side)[1].abs());
    let (whole, eighth) = (near(FORCE), near(0.125 * FORCE));
    let figures = [
        (["a", "p0"], whole.1),
        (["a_eighth", "p0_eighth"], eighth.1),
        (["a_undeformed", "p0_undeformed"], over_hertz(FORCE, &undeformed(&finite.model, &finite.state))),
        (["a_small", "p0_small"], over_hertz(FORCE, &undeformed(&small.model, &small.state))),
        (["a_small_present", "p0_small_present"], over_hertz(FORCE, &present(&small.model, &small.state))),
    ];
    let mut measured: Measured =
        figures.iter().flat_map(|(names, values)| names.map(String::from).into_iter().zip(*values)).collect();
    measured.extend([
        ("force".into(), whole.0),
        ("force_small".into(), small.reaction("lower.start")[1]),
        ("balance".into(), carried[0] / carried[1] - 1.0),
    ]);
    Ok(measured)
}

/// Radius of contact and largest pressure over those of Hertz for a force.
fn over_hertz(force: f64, pressures: &Pressures) -> [f64; 2] {
    let a = (0.75 * force * 0.5 * RADIUS / MODULUS).cbrt();
    let (width, largest) = fit::hertz(pressures);
    [width / a, largest / (1.5 * force / (PI * a * a))]
}

/// Pressures over present areas at present radii.
fn present(model: &Model, state: &State) -> Pressures {
    points(model, state, 0).iter().map(|point| (point.position[0], point.pressure)).collect()
}

/// Axial forces over the areas that the undeformed surface has on the plane of contact, at undeformed radii.
fn undeformed(model: &Model, state: &State) -> Pressures {
    // Areas of a field are those of its history.
    let start = model.problem.initial_state();
    let both = points(model, state, 0).into_iter().zip(points(model, &start, 0));
    both.filter(|(_, start)| start.area > 0.0)
        .map(|(now, start)| (start.position[0], (now.force()[1] / (start.area * start.inward[1])).abs()))
        .collect()
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
