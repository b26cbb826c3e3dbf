//! Two claws threaded through each other's mouth, pulled apart until they let go: contact of two strained bodies on spots that
//! wander over both, instabilities, free bodies at the end.

use crate::bench::{Bench, Solved, reaction};
use crate::{Case, Measured};
use asperity::Error;
use asperity::system::{Energies, State};

/// The case.
pub const CASE: Case = Case { name: "claw", measure };

const PLASTIC: &str =
    "material.steel={ von_mises = { young = 210e3, poisson = 0.3, yield_stress = 400.0, hardening = 500.0 } }";

/// What a pull shows.
struct Pull {
    run: Solved,
    /// Largest force along the pull.
    peak: f64,
    /// Largest energy missing until then, over the work done.
    missing: f64,
}

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let ring = bench.solve("half_ring.toml", &[])?;
    let end = ring.model.mesh.groups["end"].nodes[0];
    let mut measured = vec![("opening".into(), ring.state.u[ring.model.problem.dofs.node(end)])];
    if bench.pick(true, false) {
        let quick =
            ["step.pull.displacement.right_grip.x=16.0", "step.pull.increments={ first = 0.04, largest = 0.04 }"];
        report("elastic_00", &pull(bench, 0.0, &quick)?, &mut measured);
        return Ok(measured);
    }
    for (law, sets) in [("elastic", vec![]), ("plastic", vec![PLASTIC])] {
        for (name, friction) in [("00", 0.0), ("02", 0.2)] {
            let coarse = pull(bench, friction, &sets)?;
            report(&format!("{law}_{name}"), &coarse, &mut measured);
            let fine = pull(bench, friction, &[&sets[..], &["mesh.file=\"claw_fine.msh\""]].concat())?;
            measured.push((format!("{law}_{name}_fine"), fine.peak / coarse.peak));
        }
    }
    Ok(measured)
}

fn pull(bench: &Bench, friction: f64, more: &[&str]) -> Result<Pull, Error> {
    let law = format!("contact.lock.law.coulomb.friction={friction:?}");
    let sets: Vec<String> = more.iter().map(|set| (*set).to_owned()).chain([law]).collect();
    let (mut peak, mut missing, mut worst) = (0.0_f64, 0.0_f64, 0.0_f64);
    let run = bench.follow("claw.toml", &sets, |model, state| {
        worst = worst.max(lost(state).abs());
        let force = reaction(model, state, "right_grip")[0];
        if force > peak {
            (peak, missing) = (force, worst / state.external_work);
        }
    })?;
    Ok(Pull { run, peak, missing })
}

/// Work that nothing has taken up, nor was set free.
fn lost(state: &State) -> f64 {
    let kept: f64 = state.energies.iter().map(Energies::taken).sum();
    state.external_work - kept - state.released
}

fn report(name: &str, pull: &Pull, measured: &mut Measured) {
    let force = |contact: usize| pull.run.points(contact).iter().map(|point| point.pressure).fold(0.0, f64::max);
    let left = (0..pull.run.model.contacts.len()).map(force).fold(0.0, f64::max);
    let of = |what: &str, value: f64| (format!("{name}_{what}"), value);
    measured.extend([
        of("peak", pull.peak),
        of("left", left),
        of("missing", pull.missing),
        of("jumps", pull.run.state.jumps as f64),
        of("cuts", pull.run.cuts() as f64),
    ]);
}
