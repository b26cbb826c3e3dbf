//! A pressed and sheared pair turned by 63 degrees in one increment: nothing slips, no pressure changes, and the
//! reaction turns.

use crate::bench::{Bench, Solved, points, reaction};
use crate::{Case, Measured};
use asperity::Error;
use asperity::contact::{PointRecord, PointStatus};

/// The case.
pub const CASE: Case = Case { name: "rotated-pair", measure };

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let mut before = (Vec::new(), [0.0; 2]);
    let run = bench.follow("pair.toml", &[], |model, state| {
        if state.step == 1 {
            before = (points(model, state, 0), reaction(model, state, "block.top"));
        }
    })?;
    let (loaded, force) = before;
    let turned = run.points(0);
    let stick = |points: &[PointRecord]| points.iter().filter(|point| point.status == PointStatus::Stick).count();
    Ok(vec![
        ("sticking".into(), (stick(&loaded).min(stick(&turned)) as f64) / loaded.len() as f64),
        ("sheared".into(), largest(&loaded, |point| point.shear.abs()) / largest(&loaded, |point| point.pressure)),
        ("slip".into(), change(&loaded, &turned, |point| point.slip)),
        ("pressure".into(), change(&loaded, &turned, |point| point.pressure) / largest(&loaded, |p| p.pressure)),
        ("shear".into(), change(&loaded, &turned, |point| point.shear) / largest(&loaded, |p| p.shear.abs())),
        ("reaction".into(), turning_error(force, &run)),
    ])
}

fn largest(points: &[PointRecord], value: impl Fn(&PointRecord) -> f64) -> f64 {
    points.iter().map(value).fold(0.0, f64::max)
}

fn change(before: &[PointRecord], after: &[PointRecord], value: impl Fn(&PointRecord) -> f64) -> f64 {
    before.iter().zip(after).map(|(before, after)| (value(after) - value(before)).abs()).fold(0.0, f64::max)
}

/// Difference of the reaction on the turned block and the turned reaction, over its size.
fn turning_error([x, y]: [f64; 2], run: &Solved) -> f64 {
    let ((s, c), now) = (63_f64.to_radians().sin_cos(), run.reaction("block.top"));
    (now[0] - (c * x - s * y)).hypot(now[1] - (s * x + c * y)) / x.hypot(y)
}
