//! Hertz's point contact in space: a rigid ball pressed on an elastic block. `a^3 = 3 P R / (4 E*)`,
//! `p0 = 3 P / (2 pi a^2)`, `p(r) = p0 sqrt(1 - r^2/a^2)`.

use crate::bench::{Bench, both_forms, resultant};
use crate::{Case, Measured, fit};
use asperity::Error;

/// The case.
pub const CASE: Case = Case { name: "hertz-ball", measure };

fn measure(bench: &Bench) -> Result<Measured, Error> {
    both_forms(&["contact.foot.form=paper"], |form| pressed(bench, form))
}

fn pressed(bench: &Bench, form: &[String]) -> Result<Measured, Error> {
    let run = bench.solve("ball.toml", &[&bench.pick(vec![], finer()), form].concat())?;
    let points = run.points(0);
    let radius = |x: f64, y: f64| x.hypot(y);
    let pressures: Vec<_> = points.iter().map(|p| (radius(p.position[0], p.position[1]), p.pressure)).collect();
    let (_, p0) = fit::hertz(&pressures);
    let force = resultant(&points)[2];
    let thrust = |weight: &dyn Fn(f64) -> f64| -> f64 {
        points.iter().zip(&pressures).map(|(point, &(r, p))| point.area * p * weight(r)).sum()
    };
    // The mean square radius of Hertz's pressure; faces that the circle cuts do not disturb it.
    let a = (2.5 * thrust(&|r| r * r) / thrust(&|_| 1.0)).sqrt();
    Ok(vec![("a".into(), a), ("p0".into(), p0), ("force".into(), -force), ("iterations".into(), run.iterations())])
}

/// Cells at the contact of two thirds the size.
fn finer() -> Vec<String> {
    let part = "mesh.part.block.box";
    let wide = "[{ to = 0.42, cells = 9 }, { to = 4.0, cells = 6, smooth = true }]";
    let deep = "[{ to = -0.3, cells = 7, ratio = 0.05 }, { to = 0.0, cells = 5 }]";
    vec![format!("{part}.along_x={wide}"), format!("{part}.along_y={wide}"), format!("{part}.along_z={deep}")]
}
