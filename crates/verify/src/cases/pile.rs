//! A cone-tipped pile pushed into clay: the pressure on its cone tends to a plateau, in Tresca's clay that of Teh and
//! Houlsby.

use crate::bench::{Bench, both_forms, points};
use crate::{Case, Measured};
use asperity::Error;
use asperity::contact::ContactRecord;
use asperity::output::figure::Chart;

/// The case.
pub const CASE: Case = Case { name: "pile", measure };

const DIAMETER: f64 = 40.0;
/// Depth over diameter from which on the plateau is taken.
const PLATEAU: f64 = 2.0;
/// Travel over diameter in a test.
const QUICK: f64 = 0.5;

/// What is pushed: key and title, deck, travel over diameter, pressure at rest and the unit in which pressures are told, and
/// the penalty of the paper's form.
type Pile = (&'static str, &'static str, &'static str, f64, [f64; 2], f64);

const PILES: [Pile; 2] = [
    ("clay", "Tresca, over su", "clay.toml", 10.9, [5.0, 1.0], 1e3),
    ("cam_clay", "Cam-clay, over p0", "cam_clay.toml", 10.9, [100.0, 100.0], 2e4),
];

/// The paper's form as it runs here: with its own penalty and tolerance, one point after the other.
const PAPER: [&str; 4] =
    ["contact.skin.form=paper", "contact.skin.gauss=3", "solver.tolerance=1e-5", "solver.piecewise=false"];

fn measure(bench: &Bench) -> Result<Measured, Error> {
    both_forms(&PAPER, |form| pushed(bench, form))
}

fn pushed(bench: &Bench, form: &[String]) -> Result<Measured, Error> {
    let mut measured = Measured::new();
    let mut chart = Chart::new("Pressure on the cone of a pile", "depth over diameter", "pressure over that at rest");
    for pile in &PILES[..bench.pick(1, 2)] {
        let Pushed { curve, normal, iterations } = push(bench, pile, form)?;
        measured.push((format!("{}_iterations", pile.0), iterations as f64));
        if pile.0 == "clay" {
            measured.push(("normal".into(), normal));
        }
        chart.line(pile.1, curve.iter().map(|&(x, y)| [x, y]).collect());
        if bench.pick(false, true) {
            let [mean, range] = plateau(&curve);
            measured.push((pile.0.into(), mean));
            measured.push((format!("{}_range", pile.0), range));
        }
    }
    if form.is_empty() {
        bench.draw("pile", &chart)?;
    }
    Ok(measured)
}

/// What a pile finds, pressures in its unit.
struct Pushed {
    /// Axial force on the cone over the section, less the pressure at rest, by depth over diameter.
    curve: Vec<(f64, f64)>,
    /// Mean normal pressure on the cone at the end, less that at rest.
    normal: f64,
    iterations: usize,
}

fn push(
    bench: &Bench,
    &(_, _, deck, whole, [at_rest, unit], penalty): &Pile,
    form: &[String],
) -> Result<Pushed, Error> {
    let way = bench.pick(QUICK, whole);
    let mut sets = vec![
        format!("step.push.motion.pile.y={:?}", -DIAMETER * way),
        format!("step.push.increments.largest={:?}", 0.05 / way),
    ];
    sets.extend_from_slice(form);
    if !form.is_empty() {
        sets.push(format!("contact.skin.penalty={penalty:?}"));
    }
    let section = 0.25 * std::f64::consts::PI * DIAMETER * DIAMETER;
    let (mut curve, mut normal) = (vec![(0.0, 0.0)], 0.0);
    let run = bench.follow(deck, &sets, |model, state| {
        let cone: Vec<ContactRecord> = points(model, state, 0).into_iter().filter(on_cone).collect();
        let force: f64 = cone.iter().map(|p| -p.force()[1]).sum();
        let area: f64 = cone.iter().map(|p| p.area).sum();
        normal = (cone.iter().map(|p| p.pressure * p.area).sum::<f64>() / area - at_rest) / unit;
        curve.push((way * state.time, (force / section - at_rest) / unit));
    })?;
    Ok(Pushed { curve, normal, iterations: run.solutions() })
}

/// Whether a closed point lies on the cone, whose normal dips by 30 degrees, or on the rounding of its ends.
fn on_cone(point: &ContactRecord) -> bool {
    point.pressure > 0.0 && point.inward[1] < -0.1
}

/// Mean and range of what lies deeper than [`PLATEAU`].
fn plateau(curve: &[(f64, f64)]) -> [f64; 2] {
    let deep: Vec<_> = curve.windows(2).filter(|two| two[0].0 >= PLATEAU).collect();
    let area: f64 = deep.iter().map(|two| (two[1].0 - two[0].0) * 0.5 * (two[0].1 + two[1].1)).sum();
    let way: f64 = deep.iter().map(|two| two[1].0 - two[0].0).sum();
    let ends = deep.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), two| (l.min(two[1].1), h.max(two[1].1)));
    [area / way, ends.1 - ends.0]
}
