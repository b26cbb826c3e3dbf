//! Upsetting without friction, where a billet stays a cylinder: `F = sigma pi R^2 H/h`, `r = R sqrt(H/h)`; and between
//! plates that stick, onto which its side folds.

use crate::bench::{Bench, both_forms, points, resultant};
use crate::{Case, Measured, fit};
use asperity::Error;
use asperity::model::Model;
use asperity::system::State;

/// The case.
pub const CASE: Case = Case { name: "billet", measure };

/// Reductions in per cent at which the source gives forces.
const REDUCTIONS: [f64; 4] = [10.0, 30.0, 50.0, 60.0];
const RADIUS: f64 = 10.0;

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let mut measured = Measured::new();
    let (n, increments) = bench.pick((1, 60), (3, 240));
    let cells = format!("mesh.part.billet.rectangle.cells=[{}, {}]", 4 * n, 6 * n);
    let fine = [cells.clone(), format!("step.upset.increments.count={increments}")];
    let billet = bench.follow("billet.toml", &fine, |model, state| {
        let reduction = 60.0 * state.time / 9.0;
        for at in REDUCTIONS.iter().filter(|at| (reduction - **at).abs() < 1e-6) {
            let [force, radius] = force_and_radius(model, state);
            measured.push((format!("force_{at}"), force / 1e3));
            measured.push((format!("radius_{at}"), radius));
        }
    })?;
    measured.push(("iterations".into(), billet.iterations()));
    // Increments long enough to need iterations.
    let tight = bench.solve("billet.toml", &[cells, "solver.tolerance=1e-11".into()])?;
    measured.push(("order".into(), tight.order()));
    let viscous = bench.solve("viscous.toml", &fine[1..])?;
    measured.push(("viscous".into(), force_and_radius(&viscous.model, &viscous.state)[0] / 1e3));
    measured.extend(both_forms(&PAPER, |form| sticking(bench, form))?);
    Ok(measured)
}

/// The paper's element, with a point more than an edge has nodes: fewer leave the wave of the nodes between them free, which
/// grows where metal flows.
const PAPER: [&str; 4] =
    ["contact.end.form=paper", "contact.end.gauss=3", "contact.side.form=paper", "contact.side.gauss=3"];

/// Force on plates that stick, and the part of it at the end that those cells carry that were on the side.
fn sticking(bench: &Bench, form: &[String]) -> Result<Measured, Error> {
    let set = format!("step.upset.increments.count={}", bench.pick(60, 240));
    let (mut curve, mut measured) = (Vec::new(), Measured::new());
    let run = bench.follow("sticking.toml", &[&[set], form].concat(), |model, state| {
        let [end, side] = [0, 1].map(|contact| thrust(model, state, contact) / 1e3);
        curve.push((60.0 * state.time / 9.0, end + side));
    })?;
    for at in [30.0, 50.0, 60.0] {
        measured.push((format!("sticking_{at}"), fit::at(&curve, at)));
    }
    let [end, side] = [0, 1].map(|contact| thrust(&run.model, &run.state, contact));
    measured.push(("folded".into(), side / (end + side)));
    measured.push(("sticking_cuts".into(), run.cuts() as f64));
    Ok(measured)
}

/// Axial force of a contact.
fn thrust(model: &Model, state: &State, contact: usize) -> f64 {
    -resultant(&points(model, state, contact))[1]
}

/// Force on the plate, and the mean radius of the side.
fn force_and_radius(model: &Model, state: &State) -> [f64; 2] {
    let force = thrust(model, state, 0);
    let side = &model.mesh.groups["billet.right"].nodes;
    let moved = side.iter().map(|&node| state.u[model.problem.dofs.node(node)]).sum::<f64>() / side.len() as f64;
    [force, RADIUS + moved]
}
