//! What a contact must hold where a deck says nothing of how: forces that are exact, and answers that depend neither on the size of
//! increments nor on which side carries the stress nor on groups.

use crate::bench::{Bench, Solved, resultant};
use crate::{Case, Measured};
use asperity::Error;
use asperity::contact::ContactRecord;

/// The case.
pub const CASE: Case = Case { name: "contact-default", measure };

/// Radius of the roller, and its friction.
const RADIUS: f64 = 1.5;
const FRICTION: f64 = 0.4;
/// Pressures on the floor and on the wall of the corner.
const PRESSURES: [f64; 2] = [10.0, 3.0];

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let sizes = bench.pick(&[1, 60][..], &[1, 2, 5, 20, 60]);
    let [few, many] = roles(bench)?;
    Ok(vec![
        ("torque".into(), torque(bench)?),
        ("corner".into(), corner(bench)?),
        ("one_group".into(), one_group(bench)?),
        ("ripple_quad4".into(), ripple(bench, "quad4")?),
        ("ripple_quad8".into(), ripple(bench, "quad8")?),
        ("roles_few".into(), few),
        ("roles_many".into(), many),
        ("ball".into(), spread(bench, ("ball.toml", &["mesh.part.slab.rectangle.cells=[80, 8]"]), sizes)?),
        ("strips".into(), spread(bench, ("strips.toml", &[]), sizes)?),
    ])
}

/// Error of the torque on the roller against `mu R int p dA`, relative.
fn torque(bench: &Bench) -> Result<f64, Error> {
    let run = bench.solve("roller.toml", &[])?;
    let torque = run.state.internal[run.model.problem.dofs.tool(0) + 2];
    Ok((torque.abs() / (FRICTION * RADIUS * thrust(&run)) - 1.0).abs())
}

/// Integral of the pressure over the surface of the first contact.
fn thrust(run: &Solved) -> f64 {
    run.points(0).iter().map(|point| point.pressure * point.area).sum()
}

/// Size of the vertical force that points carry.
fn lift(points: &[ContactRecord]) -> f64 {
    resultant(points)[1].abs()
}

/// Largest error of a pressure on floor and wall of the corner, relative.
fn corner(bench: &Bench) -> Result<f64, Error> {
    let mut worst = 0.0_f64;
    for cell in ["quad4", "quad8", "tri6"] {
        let run = bench.solve("corner.toml", &[format!("mesh.part.block.rectangle.cell={cell}")])?;
        for (wall, pressure) in PRESSURES.iter().enumerate() {
            let points = run.points(wall);
            let closed = points.iter().filter(|point| point.pressure > 0.0);
            worst = closed.map(|point| (point.pressure / pressure - 1.0).abs()).fold(worst, f64::max);
        }
    }
    Ok(worst)
}

/// Difference of the forces of a press fit with both rings in one body from those with a body each, relative.
fn one_group(bench: &Bench) -> Result<f64, Error> {
    let [apart, together] = ["rings.toml", "one_group.toml"].map(|deck| bench.solve(deck, &[]).map(|run| thrust(&run)));
    Ok((together? / apart? - 1.0).abs())
}

/// Half the range of the normal force over its mean while the block slides, the largest of three coefficients of friction.
fn ripple(bench: &Bench, cell: &str) -> Result<f64, Error> {
    let cells = ["column", "block"].map(|part| format!("mesh.part.{part}.rectangle.cell={cell}"));
    let mut worst = 0.0_f64;
    for friction in [0.0, 0.2, 0.4] {
        let sets = [&cells[..], &[format!("contact.joint.law.coulomb.friction={friction}")]].concat();
        let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
        bench.follow("column.toml", &sets, |model, state| {
            // The block slides with all of its nodes from here on.
            if state.time > 1.3 {
                let force = lift(&crate::bench::points(model, state, 0));
                (least, most) = (least.min(force), most.max(force));
            }
        })?;
        worst = worst.max((most - least) / (most + least));
    }
    Ok(worst)
}

/// Largest difference of the force with either side carrying the stress, relative: on a block of fewer than four faces, and of more.
fn roles(bench: &Bench) -> Result<[f64; 2], Error> {
    let force = |sets: &[String]| bench.solve("roles.toml", sets).map(|run| lift(&run.points(0)));
    let mut worst = [0.0_f64; 2];
    for cell in ["quad4", "quad8"] {
        for faces in [1, 2, 3, 4, 8] {
            let sets = [
                format!("mesh.part.block.rectangle.cells=[{faces}, {}]", faces.max(2)),
                format!("mesh.part.block.rectangle.cell={cell}"),
                format!("mesh.part.ground.rectangle.cell={cell}"),
            ];
            let other = ["contact.joint.surface=ground.top".to_owned(), "contact.joint.target=block.bottom".to_owned()];
            let apart = (force(&sets)? / force(&[&sets[..], &other].concat())? - 1.0).abs();
            let class = usize::from(faces >= 4);
            worst[class] = worst[class].max(apart);
        }
    }
    Ok(worst)
}

/// Largest difference of the force at the end from that on a finer mesh (of the same where none is given) in 20 increments,
/// relative, over numbers of increments.
fn spread(bench: &Bench, (deck, finer): (&str, &[&str]), increments: &[usize]) -> Result<f64, Error> {
    let force = |count: usize, finer: &[&str]| {
        let mut sets = vec![format!("step.1.increments.count={count}")];
        sets.extend(finer.iter().map(|&set| set.to_owned()));
        bench.solve(deck, &sets).map(|run| lift(&run.points(0)))
    };
    let reference = force(20, finer)?;
    increments.iter().try_fold(0.0_f64, |worst, &count| Ok(worst.max((force(count, &[])? / reference - 1.0).abs())))
}
