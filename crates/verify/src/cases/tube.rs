//! The paper's own application: an elastic tube is pushed over a stepped rigid tool, with and without friction.

use crate::bench::{Bench, Solved, points, resultant};
use crate::{Case, Measured};
use asperity::Error;
use asperity::contact::ContactRecord;

/// The case.
pub const CASE: Case = Case { name: "tube", measure };

const TRAVEL: f64 = 100.0;
/// The steady range of travel begins here,
const BEGIN: f64 = 40.0;
/// and ends before this.
const END: f64 = 90.0;
/// Length of the coarsest cells. The ridge is as long, so that only finer ones see it.
const PITCH: f64 = 4.0;

/// An element of the tube, with a form of contact.
struct Element {
    name: &'static str,
    sets: [&'static str; 3],
    form: &'static str,
}

const QUAD8: [&str; 3] = ["cell=quad8", "formulation=standard", "integration=reduced"];
const QUAD4: [&str; 3] = ["cell=quad4", "formulation=f-bar", "integration=full"];
/// The paper's element, and the field that is the default.
const ELEMENTS: [Element; 4] = [
    Element { name: "quad8", sets: QUAD8, form: "paper" },
    Element { name: "quad4", sets: QUAD4, form: "paper" },
    Element { name: "quad8-field", sets: QUAD8, form: "field" },
    Element { name: "quad4-field", sets: QUAD4, form: "field" },
];

/// Travel and force along the axis after each increment.
type Curve = Vec<(f64, f64)>;

/// Cells of a length of `PITCH` over `n`, pushed so far in so many increments.
#[derive(Clone, Copy)]
struct Course {
    n: usize,
    travel: f64,
    increments: usize,
}

impl Course {
    /// The whole travel.
    fn whole(n: usize, increments: usize) -> Self {
        Self { n, travel: TRAVEL, increments }
    }

    /// Eight increments a pitch; the finest cells go no further than the coarsest pitch in the steady range.
    fn eighths(level: usize) -> Self {
        let n = 1 << level;
        let travel = if level < 3 { TRAVEL } else { BEGIN + PITCH };
        Self { n, travel, increments: (8.0 * travel / PITCH) as usize * n }
    }
}

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let mut measured = Measured::new();
    for element in &ELEMENTS {
        frictionless(bench, element, &mut measured)?;
        with_friction(bench, element, &mut measured)?;
    }
    newton(bench, &mut measured)?;
    Ok(measured)
}

/// At least four cells through the wall. A tube of 152 mm makes their number whole.
fn run(bench: &Bench, element: &Element, course: Course, more: &[&str]) -> Result<(Solved, Curve), Error> {
    let Course { n, travel, increments } = course;
    let part = "mesh.part.tube.rectangle";
    let [cell, formulation, integration] = element.sets;
    let mut sets = vec![
        format!("{part}.{cell}"),
        format!("{part}.to=[55.0, 152.0]"),
        format!("{part}.cells=[{}, {}]", (2 * n).max(4), 38 * n),
        format!("body.tube.{formulation}"),
        format!("body.tube.{integration}"),
        format!("contact.bore.form={}", element.form),
        format!("step.push.increments.count={increments}"),
        format!("step.push.displacement.\"tube.top\".y=-{travel:?}"),
    ];
    sets.extend(more.iter().map(|set| (*set).to_string()));
    let mut curve = Curve::new();
    let solved = bench.follow("tube.toml", &sets, |model, state| {
        curve.push((travel * state.time, resultant(&points(model, state, 0))[1]));
    })?;
    Ok((solved, curve))
}

/// Mean, and half the range, of the force over as many whole pitches as the steady range holds.
fn steady(curve: &Curve, course: Course) -> (f64, f64) {
    let pitch = PITCH / course.n as f64;
    let end = BEGIN + ((END.min(course.travel) - BEGIN) / pitch).floor() * pitch;
    let samples = 2000;
    let at = |i: usize| force_at(curve, BEGIN + (end - BEGIN) * (i as f64 + 0.5) / samples as f64);
    let forces: Vec<f64> = (0..samples).map(at).collect();
    let most = forces.iter().fold(f64::MIN, |a, &b| a.max(b));
    let least = forces.iter().fold(f64::MAX, |a, &b| a.min(b));
    (forces.iter().sum::<f64>() / samples as f64, 0.5 * (most - least))
}

/// The force at a travel, linear between increments.
fn force_at(curve: &Curve, travel: f64) -> f64 {
    let after = curve.partition_point(|point| point.0 < travel).clamp(1, curve.len() - 1);
    let ((t0, f0), (t1, f1)) = (curve[after - 1], curve[after]);
    f0 + (f1 - f0) * (travel - t0) / (t1 - t0)
}

/// The ripple on all meshes, the force on the finest, and the pressures of the finest that is pushed the whole way.
fn frictionless(bench: &Bench, element: &Element, measured: &mut Measured) -> Result<(), Error> {
    let mut add = |key: &str, value: f64| measured.push((format!("{}-{key}", element.name), value));
    let slides = ["contact.bore.law.coulomb.friction=0.0"];
    let mut ripples = Vec::new();
    for level in 0..bench.pick(1, 4) {
        let course = Course::eighths(level);
        let (solved, curve) = run(bench, element, course, &slides)?;
        let (mean, ripple) = steady(&curve, course);
        ripples.push(ripple / mean);
        if level == bench.pick(0, 3) {
            add("force", mean / 1e3);
        }
        if level == bench.pick(0, 2) {
            let (plateau, end) = pressures(&solved.points(0));
            add("plateau", plateau);
            add("end", end / plateau);
        }
    }
    add("ripple", ripples[ripples.len() - 1]);
    if let [coarsest, middle @ .., finest] = &ripples[..] {
        add("ripple-coarsest", *coarsest);
        add("ripple-most", middle.iter().fold(*coarsest, |a, &b| a.max(b)));
        add("ripple-ratio", finest / coarsest);
    }
    Ok(())
}

/// Mean pressure of the land away from its ends, and the largest at the leading end.
fn pressures(points: &[ContactRecord]) -> (f64, f64) {
    let lead = points.iter().map(|point| point.position[1]).fold(f64::MAX, f64::min);
    let behind = |point: &&ContactRecord, from: f64, to: f64| (from..to).contains(&(point.position[1] - lead));
    let middle: Vec<_> = points.iter().filter(|point| behind(point, 35.0, 65.0)).collect();
    let area: f64 = middle.iter().map(|point| point.area).sum();
    let plateau = middle.iter().map(|point| point.pressure * point.area).sum::<f64>() / area;
    let end = points.iter().filter(|point| behind(point, 0.0, 6.0)).map(|point| point.pressure).fold(0.0, f64::max);
    (plateau, end)
}

/// Growth of the force between two travels, and what half the increments change of its mean.
fn with_friction(bench: &Bench, element: &Element, measured: &mut Measured) -> Result<(), Error> {
    let mut add = |key: &str, value: f64| measured.push((format!("{}-{key}", element.name), value));
    let (n, increments) = bench.pick((1, 100), (2, 200));
    let (_, curve) = run(bench, element, Course::whole(n, increments), &[])?;
    let growth = (force_at(&curve, 79.8) - force_at(&curve, 39.8)) / 1e3;
    add("growth", growth);
    add("growth-small", growth);
    let (_, halved) = run(bench, element, Course::whole(n, 2 * increments), &[])?;
    let common: Vec<f64> = curve.iter().map(|point| point.0).filter(|&travel| travel >= BEGIN).collect();
    let mean = |curve: &Curve| common.iter().map(|&t| force_at(curve, t)).sum::<f64>() / common.len() as f64;
    add("halved", mean(&halved) / mean(&curve) - 1.0);
    Ok(())
}

/// Iterations an increment at 70 increments, of all four kinds of run the most; order of convergence at the increments of
/// the deck.
fn newton(bench: &Bench, measured: &mut Measured) -> Result<(), Error> {
    let (n, mut most, mut cuts) = (bench.pick(1, 2), 0.0_f64, 0);
    for (element, friction) in ELEMENTS.iter().flat_map(|element| [(element, 0.0), (element, 0.2)]) {
        let law = format!("contact.bore.law.coulomb.friction={friction}");
        let (solved, curve) = run(bench, element, Course::whole(n, 70), &[&law])?;
        most = most.max(solved.solutions() as f64 / curve.len() as f64);
        cuts += solved.attempts.len() - curve.len();
    }
    measured.push(("iterations".into(), most));
    measured.push(("cuts".into(), cuts as f64));
    let (solved, _) = run(bench, &ELEMENTS[0], Course::whole(n, 100), &[])?;
    let orders: Vec<f64> = solved.attempts.iter().filter_map(|attempt| attempt.residual_order()).collect();
    measured.push(("orders".into(), orders.len() as f64));
    let high = orders.iter().filter(|&&order| order > 1.8).count();
    measured.push(("quadratic".into(), high as f64 / orders.len().max(1) as f64));
    Ok(())
}
