//! Hertz's line contact: an elastic roller pressed on a rigid plane. `p(x) = p0 sqrt(1 - x^2/a^2)` with
//! `a^2 = 4 P R / (pi E*)` and `p0 = 2 P / (pi a)`.

use crate::bench::{Bench, penalty};
use crate::hertz::Study;
use crate::{Case, Measured};
use asperity::Error;
use asperity::output::study::{extrapolate, forces};
use asperity::solve::Silent;
use std::f64::consts::PI;

/// The case.
pub const CASE: Case = Case { name: "hertz-cylinder", measure };

const RADIUS: f64 = 50.0;
const MODULUS: f64 = 210e3 / (1.0 - 0.3 * 0.3);
const STUDY: Study = Study { deck: "roller.toml", refined, share: 2.0, force: 1000.0, theory };

fn theory(force: f64) -> (f64, f64) {
    let a = (4.0 * force * RADIUS / (PI * MODULUS)).sqrt();
    (a, 2.0 * force / (PI * a))
}

fn measure(bench: &Bench) -> Result<Measured, Error> {
    Ok([STUDY.measure(bench)?, augmented(bench)?, study(bench)?].concat())
}

/// With multipliers: the largest penetration of a node in any increment over the edge's length, and the most augmentations that took.
fn augmented(bench: &Bench) -> Result<Measured, Error> {
    let augmentation = "contact.foot.augmentation={ penetration = 1e-6, loops = 6 }".to_owned();
    let mut nodal = 0.0_f64;
    let run = bench.follow("roller.toml", &[augmentation], |model, state| {
        let (contact, history) = (&model.field_contacts[0], &state.histories[model.first_contact()]);
        nodal = nodal.max(contact.nodal_penetration(history).unwrap_or(f64::NAN));
    })?;
    let loops = run.attempts.iter().map(|attempt| attempt.augmentations()).max().unwrap_or(0);
    Ok(vec![("nodal_penetration".into(), nodal), ("augmentations".into(), loops as f64)])
}

/// The penalty study of the deck with its computed penalty: how far the approach that it extrapolates is from that with
/// sixteen times the penalty, over the error that it states, and that error over the approach.
fn study(bench: &Bench) -> Result<Measured, Error> {
    let model = bench.model("roller.toml", &[])?;
    let computed = penalty(&model);
    let ends = |times: f64| {
        let penalty = format!("contact.foot.penalty={:e}", times * computed);
        forces(&bench.model("roller.toml", &[penalty])?, &mut Silent)
    };
    let lines = extrapolate(&ends(0.25)?, &ends(1.0)?, 4.0, model.problem.newton.tolerance);
    let nearly_rigid = ends(16.0)?;
    let approach = |name: &str| name == "tool.plane.translation.y";
    let line = lines.iter().rfind(|line| approach(&line.name));
    let last = nearly_rigid.steps.last().and_then(|(_, columns)| columns.iter().find(|(name, _)| approach(name)));
    let (Some(line), Some((_, value))) = (line, last) else {
        return Err(Error::input("the study does not list the approach of the plane"));
    };
    let (off, size) = ((line.extrapolated - value).abs(), line.values[1].abs());
    Ok(vec![("study".into(), off / line.error), ("study_error".into(), line.error / size)])
}

fn refined(n: usize) -> Vec<String> {
    let part = "mesh.part.roller.annulus";
    let radius = format!("[{{ to = 49.0, cells = {}, ratio = 0.01 }}, {{ to = 50.0, cells = {} }}]", 10 * n, 9 * n);
    let angle = format!("[{{ to = -89.0, cells = {} }}, {{ to = 0.0, cells = {}, smooth = true }}]", 9 * n, 12 * n);
    vec![format!("{part}.along_radius={radius}"), format!("{part}.along_angle={angle}")]
}
