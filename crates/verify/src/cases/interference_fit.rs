//! A ring pressed into another: Lame's pressure on both sides of the joint.

use crate::bench::{Bench, Solved, reaction};
use crate::{Case, Measured};
use asperity::Error;

/// The case.
pub const CASE: Case = Case { name: "interference-fit", measure };

const YOUNG: f64 = 210e3;
const BORE: f64 = 20.0;
const RIM: f64 = 50.0;

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let (n, penalty) = bench.pick(([12, 17], 2e5), ([24, 31], 1e6));
    let solve = |sets: &[String]| bench.solve("fit.toml", sets);
    let meshed = |cell: &str, [shaft, hub]: [usize; 2], more: &[&str]| {
        let mut sets = vec![
            format!("contact.seat.penalty={penalty:?}"),
            format!("mesh.part.shaft.annulus.cells=[4, {shaft}]"),
            format!("mesh.part.hub.annulus.cells=[6, {hub}]"),
            format!("mesh.part.shaft.annulus.cell={cell}"),
            format!("mesh.part.hub.annulus.cell={cell}"),
        ];
        if cell == "quad4" {
            sets.extend(["shaft", "hub"].map(|body| format!("body.{body}.integration=full")));
        }
        sets.extend(more.iter().map(|set| (*set).to_owned()));
        sets
    };
    // Three points integrate the distance of a parabola from its circle.
    let paper = |cell: &str, n: [usize; 2], more: &[&str]| {
        let gauss = if cell == "quad4" { "contact.seat.gauss=2" } else { "contact.seat.gauss=3" };
        meshed(cell, n, &[&["contact.seat.form=paper", gauss], more].concat())
    };
    let linear = [2 * n[0], 2 * n[1]];
    let [smooth, facets] = [solve(&meshed("quad8", n, &[]))?, solve(&meshed("quad4", linear, &[]))?];
    let two = solve(&paper("quad8", n, &[]))?;
    let one = solve(&paper("quad8", n, &["contact.seat.passes=one"]))?;
    let auto = solve(&paper("quad4", linear, &[]))?;
    // Without coupling the increment is given up at once, not cut again and again.
    let uncoupled = |penalty: &str| {
        let bare = ["solver.relax=false", "solver.line_search=false"];
        let more = ["contact.seat.coupling=false", "step.1.increments.smallest=0.6", bare[0], bare[1], penalty];
        bench.exhaust("fit.toml", &paper("quad8", [12, 17], &more)).map(|run| rate(&run))
    };
    Ok(vec![
        ("field_iterations".into(), smooth.iterations()),
        ("field_pressure".into(), pressure(&smooth, 0)),
        ("field_ripple".into(), ripple(&smooth)),
        ("field_bore_hoop".into(), hoop(&smooth, "shaft.inner", BORE)),
        ("field_rim_hoop".into(), hoop(&smooth, "hub.outer", RIM)),
        ("field_linear_pressure".into(), pressure(&facets, 0)),
        ("field_linear_ripple".into(), ripple(&facets)),
        ("iterations".into(), two.iterations()),
        ("uncoupled_soft".into(), uncoupled("contact.seat.penalty=2e4")?),
        ("uncoupled".into(), uncoupled("contact.seat.penalty=2e5")?),
        ("uncoupled_stiff".into(), uncoupled("contact.seat.penalty=1e6")?),
        ("shaft_pressure".into(), pressure(&two, 0)),
        ("hub_pressure".into(), pressure(&two, 1)),
        ("ripple".into(), ripple(&two)),
        ("bore_hoop".into(), hoop(&two, "shaft.inner", BORE)),
        ("rim_hoop".into(), hoop(&two, "hub.outer", RIM)),
        ("one_pass".into(), pressure(&one, 0)),
        ("linear_contacts".into(), auto.model.contacts.len() as f64),
        ("linear_one_pass".into(), pressure(&auto, 0)),
        ("extraction".into(), extraction(bench)?),
    ])
}

/// Largest force that draws the shaft out of the hub.
fn extraction(bench: &Bench) -> Result<f64, Error> {
    let sets = ["shaft", "hub"].map(|part| {
        let (across, along) = if part == "shaft" { (4, 20) } else { (6, 23) };
        let n = bench.pick(1, 2);
        format!("mesh.part.{part}.rectangle.cells=[{}, {}]", n * across, n * along)
    });
    let mut largest = 0.0_f64;
    bench.follow("extraction.toml", &sets, |model, state| {
        largest = largest.max(reaction(model, state, "shaft.top")[1]);
    })?;
    Ok(largest)
}

/// What one iteration leaves of the residual, over the last ten.
fn rate(run: &Solved) -> f64 {
    let residuals: Vec<f64> = run.attempts[0].iterations.iter().map(|iteration| iteration.residual).collect();
    let [.., last] = residuals[..] else { return f64::NAN };
    (last / residuals[residuals.len().saturating_sub(11)]).powf(0.1)
}

/// Force over area of one side.
fn pressure(run: &Solved, contact: usize) -> f64 {
    let points = run.points(contact);
    let [force, area] = points.iter().fold([0.0; 2], |[f, a], p| [f + p.pressure * p.area, a + p.area]);
    force / area
}

/// Root mean square of the deviation from the mean, over the mean.
fn ripple(run: &Solved) -> f64 {
    let (mean, points) = (pressure(run, 0), run.points(0));
    let [sum, area] = points.iter().fold([0.0; 2], |[s, a], p| [s + (p.pressure - mean).powi(2) * p.area, a + p.area]);
    (sum / area).sqrt() / mean
}

/// Hoop stress at a free circle, `E u / r`: the mean over its nodes.
fn hoop(run: &Solved, group: &str, radius: f64) -> f64 {
    let (mesh, dofs) = (&run.model.mesh, &run.model.problem.dofs);
    let nodes = &mesh.groups[group].nodes;
    let moved = |node: usize| {
        let (x, u) = (mesh.points[node], &run.state.u[dofs.node(node)..]);
        (x[0] * u[0] + x[1] * u[1]) / radius
    };
    YOUNG * nodes.iter().map(|&node| moved(node)).sum::<f64>() / (nodes.len() as f64 * radius)
}
