//! The drawing of a cup: complete by default on two meshes, whose forces agree, and what the way costs.

use crate::bench::{Bench, points, resultant};
use crate::{Case, Measured};
use asperity::Error;
use asperity::model::Model;
use asperity::system::State;

/// The case.
pub const CASE: Case = Case { name: "cup", measure };

/// The punch is the first contact of the deck.
const PUNCH: usize = 0;
/// Strokes, and the first travel over which forces are compared, and how often.
const STROKES: [f64; 2] = [20.0, 40.0];
const FIRST: f64 = 1.0;
const SAMPLES: usize = 96;

/// Travel of the punch and its force.
type Curve = Vec<(f64, f64)>;

fn measure(bench: &Bench) -> Result<Measured, Error> {
    if bench.pick(true, false) {
        return draw(bench, "quad8", &["step.2.motion.punch.y=-1.0".into()]).map(|(_, measured)| measured);
    }
    let mut measured = Measured::new();
    for (stroke, suffix) in STROKES.into_iter().zip(["", "_40"]) {
        let far = [format!("step.2.duration={stroke:?}"), format!("step.2.motion.punch.y={:?}", -stroke)];
        let linear = ["mesh.part.blank.rectangle.cells=[100, 3]", "mesh.part.blank.rectangle.cell=quad4"];
        let body = ["body.blank.formulation=f-bar", "body.blank.integration=full"];
        let other = [&far[..], &[linear, body].concat().iter().map(|&set| set.to_owned()).collect::<Vec<_>>()].concat();
        let (quad8, one) = draw(bench, &format!("quad8{suffix}"), &far)?;
        let (quad4, more) = draw(bench, &format!("quad4{suffix}"), &other)?;
        measured.extend(one.into_iter().chain(more));
        measured.push((format!("apart{suffix}"), apart(&quad8, &quad4, stroke)));
    }
    Ok(measured)
}

fn draw(bench: &Bench, name: &str, sets: &[String]) -> Result<(Curve, Measured), Error> {
    let mut curve = Curve::new();
    let run = bench.follow("cup.toml", sets, |model, state| {
        if state.step == 1 {
            curve.push((state.step_time, punch(model, state)));
        }
    })?;
    let peak = curve.iter().map(|(_, force)| *force).fold(0.0, f64::max);
    let measured = [("peak", peak), ("iterations", run.solutions() as f64), ("cuts", run.cuts() as f64)];
    Ok((curve, measured.map(|(key, value)| (format!("{name}_{key}"), value)).into()))
}

/// Force of the punch on the blank, downwards.
fn punch(model: &Model, state: &State) -> f64 {
    -resultant(&points(model, state, PUNCH))[1]
}

/// Root mean square of the difference of two curves over the peak of the first.
fn apart(one: &Curve, other: &Curve, stroke: f64) -> f64 {
    let places = (0..SAMPLES).map(|i| FIRST + (stroke - FIRST) * i as f64 / SAMPLES as f64);
    let square: f64 = places.map(|x| (at(one, x) - at(other, x)).powi(2)).sum();
    let peak = one.iter().map(|(_, force)| *force).fold(0.0, f64::max);
    (square / SAMPLES as f64).sqrt() / peak
}

/// The force at a travel, between the points of the curve.
fn at(curve: &Curve, x: f64) -> f64 {
    let after = curve.partition_point(|(travel, _)| *travel < x).clamp(1, curve.len() - 1);
    let ((x0, f0), (x1, f1)) = (curve[after - 1], curve[after]);
    f0 + (f1 - f0) * (x - x0) / (x1 - x0)
}
