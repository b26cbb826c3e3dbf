//! Contact of two bodies in space: tangents against central differences with Richardson's extrapolation on faces of every
//! kind against faces of every kind, with one pass and with two; balance of the forces of one pass; a loaded pair that
//! turns without slip.

mod pairs;
mod perturbed;

use asperity::contact::field::{FieldSurface, FieldTarget};
use asperity::contact::{ContactParts, LoadedSides, PaperContact};
use asperity::interface::laws::Coulomb;
use asperity::mesh::generate::Block;
use asperity::mesh::{Cell, Mesh, Space};
use asperity::system::{Attempt, Dofs, Local, State, Stencils, Term};
use asperity::tensor::Vec3;
use asperity::tool::Pose;
use pairs::Carrier;
use perturbed::{Random, check, commit, instant, options, state};
use std::sync::Arc;

/// Largest difference of an entry over the largest entry.
const ALLOWED: f64 = 1e-7;
/// A pressure of some steps of the differences, times the penalty.
const LITTLE: f64 = 5e-3;
/// A small part of the smallest face.
const SLIVER: f64 = 0.02;

/// Cells of the upper and of the lower block: all kinds of faces against each other.
const PAIRS: [[&str; 2]; 7] = [
    ["hex8", "hex8"],
    ["tet4", "hex20"],
    ["tet10", "tet4"],
    ["hex20", "hex27"],
    ["hex27", "tet10"],
    ["hex20", "hex20"],
    ["wedge15", "hex8"],
];

fn at(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3::new(x, y, z)
}

/// A small block above a large one, both with slightly bent faces.
fn mesh([upper, lower]: [&str; 2]) -> Mesh {
    let block = |from, to, cells, cell: &str, name: &str| {
        Block::new(from, to, cells, Cell::named(cell).unwrap()).mesh(name).unwrap()
    };
    let mut mesh = block([-1.0, -1.0, -1.0], [2.0, 2.0, 0.0], [3, 2, 1], lower, "lower");
    mesh.append(block([0.1, 0.05, 0.0], [0.9, 0.9, 1.0], [1, 1, 1], upper, "upper")).unwrap();
    for x in &mut mesh.points {
        let [a, b, c] = x.0;
        *x += at(0.06 * a * b, 0.05 * b * a * a, 0.02 * (a * (1.0 - b) + 0.4 * a * a) * (1.0 - c.abs()));
    }
    mesh
}

fn contact(cells: [&str; 2], carrier: Carrier, loads: LoadedSides, friction: f64) -> (PaperContact, Dofs) {
    pairs::pair(mesh(cells), carrier, friction, options(loads))
}

fn motion(contact: &PaperContact, dofs: &Dofs, random: &mut Random) -> Vec<f64> {
    pairs::motion((contact, dofs), [0.03, 0.06], random)
}

/// What looks at an accepted state, the attempt that follows it and the unknowns tried in it.
type Look<'a> = dyn FnMut(&State, &dyn Attempt, &[f64]) + 'a;

/// Looks at random states, each after a random accepted one that itself follows another.
fn states((contact, dofs): &(PaperContact, Dofs), count: usize, look: &mut Look) {
    let mut random = Random(11);
    let start = state(vec![0.0; dofs.count()], contact.initial());
    for _ in 0..count {
        let first = commit(contact, &start, motion(contact, dofs, &mut random));
        // A point that came to lie deep where nothing was refuses the increment.
        let accepted = first.and_then(|first| commit(contact, &first, motion(contact, dofs, &mut random)));
        let Ok(accepted) = accepted else { continue };
        let attempt = contact.attempt(&accepted, &accepted.histories[0], instant()).unwrap();
        look(&accepted, attempt.as_ref(), &motion(contact, dofs, &mut random));
    }
}

#[test]
fn tangents_of_contact_between_bodies_are_exact() {
    let carriers =
        [(Carrier::Small, LoadedSides::Own), (Carrier::Small, LoadedSides::Both), (Carrier::Large, LoadedSides::Both)];
    let (mut good, mut found) = (true, Vec::new());
    for cells in PAIRS {
        for (carrier, loads) in carriers {
            let (mut met, mut skipped, mut worst) = ([0; 3], 0, 0.0_f64);
            let pair = contact(cells, carrier, loads, 0.4);
            // As many points of each pair, whatever their number on a face.
            let points = pair.0.points().len();
            let count = if carrier == Carrier::Large { 900 / points } else { 60 + 120 / points };
            states(&pair, count, &mut |accepted, attempt, u| {
                let Ok(end) = commit(&pair.0, accepted, u.to_vec()) else { return };
                let records = pair.0.records(u, &end.histories[0]);
                for (result, record) in check(attempt, u).unwrap().into_iter().zip(records) {
                    met[usize::from(result.branch)] += 1;
                    // Where hardly anything is left of the pressure or of the face, the steps of the differences are
                    // not small.
                    let little = (record.pressure > 0.0 && record.pressure < LITTLE) || record.area < SLIVER;
                    let smooth = result.smooth && !little;
                    skipped += usize::from(!smooth);
                    assert!(result.error.is_finite());
                    worst = if smooth { worst.max(result.error) } else { worst };
                }
            });
            let name = format!("{cells:?}, {carrier:?}, {loads:?}: {met:?} skipped {skipped} worst {worst:.1e}");
            // The one point of a large face of first degree never lies over the small block.
            good &= (carrier == Carrier::Large || met.iter().all(|&met| met >= 4))
                && 5 * skipped <= met.iter().sum::<usize>()
                && worst < ALLOWED;
            found.push(name);
        }
    }
    assert!(good, "{}", found.join("\n"));
}

/// The forces of one pass on the two bodies are opposite, and without friction so are their moments.
#[test]
fn forces_of_one_pass_balance() {
    for (cells, friction) in [(["hex20", "tet10"], 0.0), (["hex27", "hex8"], 0.0), (["tet10", "hex20"], 0.4)] {
        let (contact, dofs) = contact(cells, Carrier::Small, LoadedSides::Both, friction);
        let mut closed = 0;
        states(&(contact, dofs), 60, &mut |_, attempt, u| {
            let (mut stencils, mut local) = (Stencils::default(), Local::default());
            attempt.stencils(u, &mut stencils).unwrap();
            for (i, stencil) in stencils.list.iter().enumerate() {
                local.u = stencils.dofs(stencil).iter().map(|&dof| u[dof]).collect();
                local.reset(stencil.len);
                if attempt.evaluate(i, stencil, &mut attempt.scratch(i), &mut local).is_err() {
                    continue;
                }
                let sum = |axis: usize| local.force.iter().skip(axis).step_by(3).sum::<f64>();
                let size = local.force.iter().fold(0.0_f64, |size, force| size.max(force.abs()));
                closed += usize::from(size > 0.0);
                assert!((0..3).all(|axis| sum(axis).abs() <= 1e-13 * size), "{cells:?}");
            }
        });
        assert!(closed > 100, "{closed}");
    }
}

/// Pressed and sheared, then turned by 63 degrees in one increment with both bodies: nothing slips, no stress changes.
#[test]
fn a_loaded_pair_turns_without_slip() {
    for cells in PAIRS {
        let ((contact, dofs), mut random) = (contact(cells, Carrier::Small, LoadedSides::Own, 0.4), Random(3));
        let start = state(vec![0.0; dofs.count()], contact.initial());
        let mut push = || {
            let mut u = motion(&contact, &dofs, &mut random);
            let upper = |node: &usize| contact.mesh().groups["upper"].nodes.contains(node);
            (0..dofs.nodes()).filter(upper).for_each(|node| u[dofs.node(node) + 2] -= 0.06);
            u
        };
        let pressed = commit(&contact, &start, push()).unwrap();
        let loaded = commit(&contact, &pressed, push()).unwrap();
        let axis = at(0.48, -0.6, 0.64) * 63.0_f64.to_radians();
        let turn = Pose::new(&[0.0, 0.0, 0.0, axis[0], axis[1], axis[2]]);
        let mut u = loaded.u.clone();
        for node in 0..dofs.nodes() {
            let (first, x) = (dofs.node(node), contact.mesh().points[node]);
            let now = turn.rotate(x + at(loaded.u[first], loaded.u[first + 1], loaded.u[first + 2])) - x;
            (0..3).for_each(|axis| u[first + axis] = now[axis]);
        }
        let turned = commit(&contact, &loaded, u).unwrap();
        let before = contact.records(&loaded.u, &loaded.histories[0]);
        let after = contact.records(&turned.u, &turned.histories[0]);
        let closed = before.iter().filter(|record| record.pressure > 0.0 && record.shear > 0.0).count();
        assert!(2 * closed > before.len(), "{cells:?}: {closed} closed of {}", before.len());
        for (a, b) in before.iter().zip(&after) {
            assert!((a.slip - b.slip).abs() < 1e-12 && (a.slipped - b.slipped).abs() < 1e-12, "{cells:?} {a:?} {b:?}");
            assert!((a.pressure - b.pressure).abs() < 1e-12 && (a.shear - b.shear).abs() < 1e-12, "{cells:?}");
            assert!((turn.rotate(a.traction()) - b.traction()).norm() < 1e-12, "{cells:?}");
        }
    }
}

/// A ring with a slit whose faces are one group, surface and target: closed a little too far, they press on each other
/// alike.
#[test]
fn a_ring_that_closes_touches_itself() {
    for cell in ["hex8", "hex20", "tet10"] {
        let mut mesh = Block::new([0.0; 3], [1.0; 3], [16, 1, 1], Cell::named(cell).unwrap()).mesh("ring").unwrap();
        let bent = |x: Vec3, part: f64| {
            let (sin, cos) = (std::f64::consts::TAU * part * x[0]).sin_cos();
            at((2.0 - x[1]) * cos, (2.0 - x[1]) * sin, x[2])
        };
        let straight = mesh.points.clone();
        mesh.points.iter_mut().for_each(|x| *x = bent(*x, 0.97));
        let dofs = Dofs::new(3, mesh.points.len(), 0);
        let mut sides = mesh.groups["ring.left"].sides.clone();
        sides.extend_from_slice(&mesh.groups["ring.right"].sides);
        let mesh = Arc::new(mesh);
        let options = options(LoadedSides::Own);
        let parts = ContactParts {
            name: "slit".into(),
            surface: FieldSurface::whole(&mesh, &sides, Space::Solid, 1.0),
            space: Space::Solid,
            boundary: mesh.boundary(&mesh.groups["ring"].cells),
            target: FieldTarget::faces(FieldSurface::whole(&mesh, &sides, Space::Solid, 1.0), &mesh),
            law: Coulomb::new(0.4).into(),
            options,
            dofs: dofs.clone(),
            mesh: mesh.clone(),
        };
        let contact = PaperContact::new(parts, None);
        let mut u = vec![0.0; dofs.count()];
        for (node, x) in straight.iter().enumerate() {
            let moved = bent(*x, 1.003) - mesh.points[node];
            (0..3).for_each(|axis| u[dofs.node(node) + axis] = moved[axis]);
        }
        let start = state(vec![0.0; dofs.count()], contact.initial());
        let closed = commit(&contact, &start, u).unwrap();
        let records = contact.records(&closed.u, &closed.histories[0]);
        let sum = |size: &dyn Fn(Vec3) -> f64| records.iter().map(|record| size(record.force())).sum::<f64>();
        assert!(records.iter().all(|record| record.pressure > 0.01), "{cell}");
        let (one, all) = (sum(&|force| force[1]), sum(&|force| force.norm()));
        assert!(one.abs() < 1e-3 * all && all > 0.01, "{cell}: {one} of {all}");
    }
}
