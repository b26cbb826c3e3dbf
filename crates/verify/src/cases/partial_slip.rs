//! Cattaneo and Mindlin: two cylinders pressed together and moved across slip at the edges of their contact and stick
//! within `|x| < c = a sqrt(1 - Q / (mu P))`, where `mu p - q = mu p0 (c / a) sqrt(1 - x^2 / c^2)`.

use crate::bench::{Bench, Solved, both_forms};
use crate::{Case, Measured, fit};
use asperity::Error;
use asperity::contact::PointStatus;
use std::f64::consts::PI;

/// The case.
pub const CASE: Case = Case { name: "partial-slip", measure };

const FRICTION: f64 = 0.2;
const RADIUS: f64 = 8.0;
const MODULUS: f64 = 200.0 / (1.0 - 0.3 * 0.3);

fn measure(bench: &Bench) -> Result<Measured, Error> {
    both_forms(&["contact.line.form=paper"], |form| pressed(bench, form))
}

fn pressed(bench: &Bench, form: &[String]) -> Result<Measured, Error> {
    let run = bench.solve("cylinders.toml", &[&bench.pick(vec![], refined()), form].concat())?;
    let reaction = run.reaction("lower.inner");
    let [tangential, normal] = reaction.map(f64::abs);
    let side = Side::new(&run, 0);
    let ratio = (1.0 - tangential / (FRICTION * normal)).sqrt();
    let mut measured = vec![
        ("load".into(), tangential / (FRICTION * normal)),
        ("a".into(), side.a / (4.0 * normal * (0.5 * RADIUS) / (PI * 0.5 * MODULUS)).sqrt()),
        ("c".into(), side.c / side.a / ratio),
        ("sticking".into(), side.sticking / side.a / ratio),
        ("order".into(), run.order()),
        ("iterations".into(), run.iterations()),
    ];
    if !run.model.contacts.is_empty() {
        let second = Side::new(&run, 1);
        measured.push(("c_target".into(), second.c / second.a / ratio));
    }
    Ok(measured)
}

/// Twice as fine where they touch, and moved twice as far: fewer points stick.
fn refined() -> Vec<String> {
    let part = |name: &str, [start, end]: [f64; 2], fine: usize| {
        let (from, to) = (0.5 * (start + end) - 7.0, 0.5 * (start + end) + 7.0);
        let angle = format!(
            "[{{ to = {from:?}, cells = 14, ratio = 0.02 }}, {{ to = {to:?}, cells = {fine} }}, {{ to = {end:?}, cells = 14, \
             smooth = true }}]"
        );
        let radius = "[{ to = 7.0, cells = 8, ratio = 0.05 }, { to = 8.0, cells = 12, ratio = 0.3 }]";
        let part = format!("mesh.part.{name}.annulus");
        [format!("{part}.along_angle={angle}"), format!("{part}.along_radius={radius}")]
    };
    let meshes = [part("upper", [180.0, 360.0], 61), part("lower", [0.0, 180.0], 70)];
    meshes.into_iter().flatten().chain(["step.2.displacement.\"upper.inner\".x=0.04".into()]).collect()
}

/// What one side shows.
struct Side {
    /// Half width of the contact.
    a: f64,
    /// Half width of the zone without slip, from the stress that friction leaves unused there.
    c: f64,
    /// The same from the points that stick.
    sticking: f64,
}

impl Side {
    fn new(run: &Solved, contact: usize) -> Self {
        let points = run.points(contact);
        let [thrust, moment] = points.iter().fold([0.0; 2], |[f, m], p| {
            let force = p.pressure * p.area;
            [f + force, m + force * p.position[0]]
        });
        let centre = moment / thrust;
        let over = |value: &dyn Fn(f64, f64) -> f64| {
            points.iter().map(|p| (p.position[0] - centre, value(p.pressure, p.shear.abs()))).collect::<Vec<_>>()
        };
        let stick = points.iter().filter(|p| p.status == PointStatus::Stick);
        let (low, high) = stick.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
            (low.min(p.position[0]), high.max(p.position[0]))
        });
        Self {
            a: fit::hertz(&over(&|p, _| p)).0,
            c: fit::hertz(&over(&|p, q| FRICTION * p - q)).0,
            sticking: 0.5 * (high - low),
        }
    }
}
