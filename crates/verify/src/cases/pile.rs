//! A cone-tipped pile pushed into clay: the pressure on its cone tends to a plateau, in Tresca's clay that of Teh and
//! Houlsby.

use crate::bench::{Bench, points};
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

/// What is pushed: key and title, deck, travel over diameter, pressure at rest and the unit in which pressures are told.
type Pile = (&'static str, &'static str, &'static str, f64, [f64; 2]);

const PILES: [Pile; 2] = [
    ("clay", "Tresca, over su", "clay.toml", 10.9, [5.0, 1.0]),
    ("cam_clay", "Cam-clay, over p0", "cam_clay.toml", 10.9, [100.0, 100.0]),
];

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let mut measured = Measured::new();
    let mut chart = Chart::new("Pressure on the cone of a pile", "depth over diameter", "pressure over that at rest");
    for pile in &PILES[..bench.pick(1, 2)] {
        let (curve, normal) = push(bench, pile)?;
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
    bench.draw("pile", &chart)?;
    Ok(measured)
}

/// Axial force on the cone over the section, less the pressure at rest, by depth over diameter; and at the end the mean
/// normal pressure on the cone less that at rest. Both in the pile's unit.
fn push(bench: &Bench, &(_, _, deck, whole, [at_rest, unit]): &Pile) -> Result<(Vec<(f64, f64)>, f64), Error> {
    let way = bench.pick(QUICK, whole);
    let sets = [
        format!("step.push.motion.pile.y={:?}", -DIAMETER * way),
        format!("step.push.increments.largest={:?}", 0.05 / way),
    ];
    let section = 0.25 * std::f64::consts::PI * DIAMETER * DIAMETER;
    let (mut curve, mut normal) = (vec![(0.0, 0.0)], 0.0);
    bench.follow(deck, &sets, |model, state| {
        let cone: Vec<ContactRecord> = points(model, state, 0).into_iter().filter(on_cone).collect();
        let force: f64 = cone.iter().map(|p| -p.force()[1]).sum();
        let area: f64 = cone.iter().map(|p| p.area).sum();
        normal = (cone.iter().map(|p| p.pressure * p.area).sum::<f64>() / area - at_rest) / unit;
        curve.push((way * state.time, (force / section - at_rest) / unit));
    })?;
    Ok((curve, normal))
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
