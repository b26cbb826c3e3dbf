//! Contact points in space: their tangents against differences on faces of every kind over targets of every kind, and
//! their indifference to a rotation of everything.

mod cubes;
mod perturbed;
mod support;

use asperity::contact::PaperContact;
use asperity::deck::{build, read};
use asperity::interface::laws::Coulomb;
use asperity::solve::{RunOptions, Silent, Stop};
use asperity::system::{Dofs, Local, State, Stencils, Term};
use asperity::tensor::Vec3;
use asperity::tool::Pose;
use cubes::{at, motion};
use perturbed::{Random, check, commit, instant, state};
use std::path::Path;

/// Largest difference of an entry over the largest entry.
const ALLOWED: f64 = 1e-7;

/// A contact of a single cell with Coulomb friction.
fn contact(cell: &str, kind: &str) -> (PaperContact, Dofs) {
    with_friction(cell, kind, 0.4)
}

fn with_friction(cell: &str, kind: &str, friction: f64) -> (PaperContact, Dofs) {
    cubes::contact((cell, 1), kind, Coulomb::new(friction))
}

/// A pressure of some steps of the differences, times the penalty.
const LITTLE: f64 = 1e-2;

fn pressures(contact: &PaperContact, state: &State) -> Vec<f64> {
    contact.records(&state.u, &state.histories[0]).iter().map(|record| record.pressure).collect()
}

#[test]
fn tangents_are_exact_on_every_face_and_target() {
    for cell in ["tet4", "tet10", "hex8", "hex20", "hex27", "wedge15"] {
        for kind in ["triangle", "quad", "sphere", "cone", "torus", "parabola", "arc"] {
            let (mut met, mut skipped, mut worst) = ([0; 3], 0, 0.0_f64);
            let ((contact, dofs), mut random) = (contact(cell, kind), Random(7));
            let start = state(vec![0.0; dofs.count()], contact.initial());
            for _ in 0..60 {
                let accepted = commit(&contact, &start, motion(&dofs, &mut random)).unwrap();
                let attempt = contact.attempt(&accepted, &accepted.histories[0], instant()).unwrap();
                let trial = motion(&dofs, &mut random);
                let pressures = pressures(&contact, &commit(&contact, &accepted, trial.clone()).unwrap());
                for (result, pressure) in check(attempt.as_ref(), &trial).unwrap().into_iter().zip(pressures) {
                    met[usize::from(result.branch)] += 1;
                    // Where hardly anything is left of the pressure, the steps of the differences are not small.
                    let smooth = result.smooth && (pressure == 0.0 || pressure > LITTLE);
                    skipped += usize::from(!smooth);
                    assert!(result.error.is_finite());
                    worst = if smooth { worst.max(result.error) } else { worst };
                }
            }
            let name = format!("{cell}, {kind}: {met:?} skipped {skipped} worst {worst:.1e}");
            assert!(met.iter().all(|&met| met >= 4), "{name}");
            assert!(10 * skipped <= met.iter().sum::<usize>(), "{name}");
            assert!(worst < ALLOWED, "{name}");
        }
    }
}

/// Pressed and sheared, then turned by 63 degrees in one increment: nothing slips and no stress changes.
#[test]
fn a_loaded_pair_turns_without_slip() {
    for cell in ["tet4", "tet10", "hex8", "hex20", "hex27"] {
        let ((contact, dofs), mut random) = (contact(cell, "sphere"), Random(3));
        let start = state(vec![0.0; dofs.count()], contact.initial());
        let mut steps = (0..2).map(|_| {
            let mut u = motion(&dofs, &mut random);
            (0..dofs.nodes()).for_each(|node| u[dofs.node(node) + 2] -= 0.1);
            // Turned from a tool that is only moved, so that the rotation vector is that of the turn.
            u[dofs.tool(0) + 3..].fill(0.0);
            u
        });
        let pressed = commit(&contact, &start, steps.next().unwrap()).unwrap();
        let loaded = commit(&contact, &pressed, steps.next().unwrap()).unwrap();
        let axis = at(0.48, -0.6, 0.64) * 63.0_f64.to_radians();
        let turn = Pose::new(&[0.0, 0.0, 0.0, axis[0], axis[1], axis[2]]);
        let rest = dofs.nodes();
        let mut u = loaded.u.clone();
        let mut carry = |x: Vec3, first: usize| {
            let now = turn.rotate(x + at(loaded.u[first], loaded.u[first + 1], loaded.u[first + 2])) - x;
            (0..3).for_each(|axis| u[first + axis] = now[axis]);
        };
        (0..rest).for_each(|node| carry(contact.mesh().points[node], dofs.node(node)));
        carry(contact.pole(&vec![0.0; dofs.count()]), dofs.tool(0));
        (0..3).for_each(|i| u[dofs.tool(0) + 3 + i] = axis[i]);
        let turned = commit(&contact, &loaded, u).unwrap();
        let before = contact.records(&loaded.u, &loaded.histories[0]);
        let after = contact.records(&turned.u, &turned.histories[0]);
        let closed = before.iter().filter(|record| record.pressure > 0.0 && record.shear > 0.0).count();
        assert!(closed > before.len() / 2, "{cell}: {closed} closed");
        for (a, b) in before.iter().zip(&after) {
            assert!((a.slip - b.slip).abs() < 1e-12 && (a.slipped - b.slipped).abs() < 1e-12, "{cell} {a:?} {b:?}");
            assert!((a.pressure - b.pressure).abs() < 1e-12 && (a.shear - b.shear).abs() < 1e-12, "{cell}");
            assert!((turn.rotate(a.traction()) - b.traction()).norm() < 1e-12, "{cell}");
        }
    }
}

/// Without friction what the nodes bear and what the tool bears balance, forces and moments, however the tool is turned.
#[test]
fn forces_and_moments_of_the_two_sides_balance() {
    let ((contact, dofs), mut random) = (with_friction("hex20", "cone", 0.0), Random(5));
    let start = state(vec![0.0; dofs.count()], contact.initial());
    let mut pressed = 0;
    for _ in 0..40 {
        let u = motion(&dofs, &mut random);
        let attempt = contact.attempt(&start, &start.histories[0], instant()).unwrap();
        let (mut stencils, mut sum) = (Stencils::default(), vec![0.0; dofs.count()]);
        attempt.stencils(&u, &mut stencils).unwrap();
        for (i, stencil) in stencils.list.iter().enumerate() {
            let mut local = Local { u: stencils.dofs(stencil).iter().map(|&dof| u[dof]).collect(), ..Local::default() };
            local.reset(stencil.len);
            attempt.evaluate(i, stencil, &mut attempt.scratch(i), &mut local).unwrap();
            stencils.dofs(stencil).iter().zip(&local.force).for_each(|(&dof, force)| sum[dof] += force);
        }
        let at = |values: &[f64], first: usize| Vec3([values[first], values[first + 1], values[first + 2]]);
        let (mut force, mut moment, mut size) = (Vec3::zero(), Vec3::zero(), 0.0);
        for node in 0..dofs.nodes() {
            let (x, f) = (contact.mesh().points[node] + at(&u, dofs.node(node)), at(&sum, dofs.node(node)));
            (force, moment, size) = (force + f, moment + x.cross(f), size + f.norm());
        }
        let (tool, pole) = (dofs.tool(0), contact.pole(&u));
        let f = at(&sum, tool);
        (force, moment) =
            (force + f, moment + pole.cross(f) + Pose::new(&u[tool..tool + 6]).moment(at(&sum, tool + 3)));
        assert!(force.norm() <= 1e-13 * size && moment.norm() <= 1e-13 * size, "{force:?} {moment:?}");
        pressed += usize::from(size > 1e-3);
    }
    assert!(pressed >= 10, "{pressed}");
}

/// A ball that is free to turn rolls along a slab: past half a turn, by its travel over its radius.
#[test]
fn a_free_ball_rolls_past_half_a_turn() {
    const DECK: &str = r#"
version = 1
space = "solid"
mesh.part.slab.box = { from = [-0.5, -0.5, -0.5], to = [2.5, 0.5, 0.0], cells = [24, 8, 2], cell = "hex8" }
material.rubber.elastic = { young = 10.0, poisson = 0.3 }
body.slab.material = "rubber"
tool.ball = { sphere = { center = [0.0, 0.0, 0.5], radius = 0.5 }, reference = [0.0, 0.0, 0.5] }
contact.track = { surface = "slab.front", target = "ball", law.coulomb = { friction = 0.8 } }
[[step]]
displacement."slab.back" = { x = 0.0, y = 0.0, z = 0.0 }
motion.ball = { z = -0.05 }
increments.count = 2
[[step]]
motion.ball = { x = 1.8 }
load.ball = { torque_y = 0.0 }
increments.count = 30
"#;
    let made =
        read(DECK, "ball.toml", Path::new(""), &[]).and_then(build).unwrap_or_else(|d| panic!("{}", d.render(false)));
    let mut run = made.model.run(made.model.problem.initial_state());
    assert_eq!(run.run(&RunOptions::default(), &mut Silent).unwrap(), Stop::Done);
    let angle = run.state.u[made.model.problem.dofs.tool(0) + 4];
    // The radius at which it rolls lies between that of the ball and that to the sunken face.
    assert!((1.8 / 0.5..1.8 / 0.45).contains(&angle) && angle > 3.5, "{angle}");
    let directory = tempfile::tempdir().unwrap();
    support::write_results(&made, directory.path());
    let text = |path: &str| String::from_utf8_lossy(&std::fs::read(directory.path().join(path)).unwrap()).into_owned();
    let header = text("history.csv").lines().next().unwrap().to_owned();
    for column in ["contact.track.force.z", "contact.track.moment.x", "tool.ball.rotation.y", "tool.ball.moment.z"] {
        assert!(header.split(',').any(|name| name == column), "{column}: {header}");
    }
    let tools = text("tools/tools_000032.vtu");
    let cells = tools.split("NumberOfCells=\"").nth(1).and_then(|rest| rest.split('"').next()).unwrap();
    assert!(cells.parse::<usize>().unwrap() > 100, "the ball is drawn as a surface: {cells}");
}

/// A slab and the ball that is dragged along it, turned with all they are given by so many thirds of a turn about the
/// space diagonal: forces on the ball and the largest pressure, in the axes of the slab.
fn dragged(thirds: usize) -> [f64; 4] {
    let turn = |v: [f64; 3]| -> [f64; 3] { std::array::from_fn(|axis| v[(axis + 3 - thirds) % 3]) };
    let side = |axis: usize, end: usize| {
        format!("slab.{}", [["left", "right"], ["bottom", "top"], ["back", "front"]][(axis + thirds) % 3][end])
    };
    let [from, to, center] = [[-1.0, 0.0, -1.0], [2.0, 1.0, 0.0], [0.1, 0.0, 1.0]].map(turn);
    let (cells, [x, y, z]) = (turn([9.0, 3.0, 2.0]).map(|n| n as usize), turn([0.6, 0.1, -0.15]));
    let (held, mirror, top) = (side(2, 0), side(1, 0), side(2, 1));
    let deck = format!(
        r#"
version = 1
space = "solid"
mesh.part.slab.box = {{ from = {from:?}, to = {to:?}, cells = {cells:?}, cell = "hex20" }}
material.rubber.elastic = {{ young = 10.0, poisson = 0.3 }}
body.slab = {{ material = "rubber", integration = "reduced" }}
tool.ball.sphere = {{ center = {center:?}, radius = 1.0 }}
contact.track = {{ surface = "{top}", target = "ball", law.coulomb = {{ friction = 0.3 }} }}
solver.tolerance = 1e-11
[[step]]
symmetry = ["{mirror}"]
displacement."{held}" = {{ x = 0.0, y = 0.0, z = 0.0 }}
motion.ball = {{ x = {x}, y = {y}, z = {z} }}
increments.count = 6
"#
    );
    let made = read(&deck, "turned.toml", Path::new(""), &[])
        .and_then(build)
        .unwrap_or_else(|d| panic!("{}", d.render(false)));
    let mut run = made.model.run(made.model.problem.initial_state());
    assert_eq!(run.run(&RunOptions::default(), &mut Silent).unwrap(), Stop::Done);
    let history = &run.state.histories[made.model.first_contact()];
    let records = made.model.field_contacts[0].records(&run.state.u, history);
    assert!(records.iter().any(|record| record.slipped > 0.0));
    let force = records.iter().fold(Vec3::zero(), |sum, record| sum + record.force());
    let back: [f64; 3] = std::array::from_fn(|axis| force[(axis + thirds) % 3]);
    let pressure = records.iter().map(|record| record.pressure).fold(0.0, f64::max);
    [back[0], back[1], back[2], pressure]
}

/// The lattice of the slab numbers its nodes, and with them the axes of its faces, in another order each time.
#[test]
fn a_turned_model_gives_the_turned_answer() {
    let straight = dragged(0);
    for thirds in [1, 2] {
        let turned = dragged(thirds);
        let error = straight.iter().zip(&turned).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(error < 1e-8 * straight[3], "{straight:?} {turned:?}");
    }
}
