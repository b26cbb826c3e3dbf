//! Contact of two bodies: tangents against central differences with Richardson's extrapolation, on edges of both
//! degrees, with one pass and with two, on edges that the target covers wholly and in part; balance of the forces of one
//! pass.

mod perturbed;

use asperity::contact::field::{FieldSurface, FieldTarget};
use asperity::contact::{ContactOptions, ContactParts, LoadedSides, PaperContact};
use asperity::interface::laws::Coulomb;
use asperity::mesh::generate::Rectangle;
use asperity::mesh::{Cell, Mesh, Space};
use asperity::system::{Attempt, Dofs, Local, Stencils, Term};
use perturbed::{Random, check, commit, instant, state};
use std::sync::Arc;

/// Largest difference of an entry over the largest entry.
const ALLOWED: f64 = 1e-7;

/// Which of the two blocks carries the points.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Carrier {
    /// The narrow one, on a wide target of three edges.
    Narrow,
    /// The wide one, which the narrow target covers in part.
    Wide,
}

/// A narrow block above a wide one.
fn mesh(cell: &str) -> Mesh {
    let cell = Cell::named(cell).unwrap();
    let mut mesh = Rectangle::new([0.5, -1.0], [2.9, 0.0], [3, 1], cell).mesh("wide").unwrap();
    mesh.append(Rectangle::new([1.35, 0.0], [2.05, 1.0], [1, 1], cell).mesh("narrow").unwrap()).unwrap();
    mesh
}

fn contact(cell: &str, carrier: Carrier, loads: LoadedSides, space: Space) -> (PaperContact, Dofs) {
    let mesh = Arc::new(mesh(cell));
    let dofs = Dofs::new(2, mesh.points.len(), 0);
    let sides = |group: &str| mesh.groups[group].sides.as_slice();
    let (own, other) = match carrier {
        Carrier::Narrow => ("narrow.bottom", "wide.top"),
        Carrier::Wide => ("wide.top", "narrow.bottom"),
    };
    let target = FieldTarget::faces(FieldSurface::whole(&mesh, sides(other), space, 0.8), &mesh);
    let parts = ContactParts {
        name: "c".into(),
        surface: FieldSurface::whole(&mesh, sides(own), space, 0.8),
        boundary: mesh.boundary(&mesh.groups[own.split('.').next().unwrap()].cells),
        target,
        law: Coulomb::new(0.4).into(),
        options: ContactOptions { thickness: 0.8, ..perturbed::options(loads) },
        space,
        dofs: dofs.clone(),
        mesh: mesh.clone(),
    };
    (PaperContact::new(parts, None), dofs)
}

/// Random motion: the narrow block by up to a tenth and downwards, all nodes by a little.
fn motion(mesh: &Mesh, dofs: &Dofs, random: &mut Random) -> Vec<f64> {
    let (right, down) = (0.08 * random.next(), -0.03 - 0.06 * random.next());
    let mut u = vec![0.0; dofs.count()];
    for node in 0..dofs.nodes() {
        let narrow = mesh.groups["narrow"].nodes.contains(&node);
        let [x, y] = if narrow { [right, down] } else { [0.0; 2] };
        u[dofs.node(node)] = x + 0.02 * random.next();
        u[dofs.node(node) + 1] = y + 0.02 * random.next();
    }
    u
}

/// Looks at random states, each after a random accepted one that itself follows another.
fn states(cell: &str, carrier: Carrier, loads: LoadedSides, space: Space, look: &mut dyn FnMut(&dyn Attempt, &[f64])) {
    let ((contact, dofs), mut random) = (contact(cell, carrier, loads, space), Random(11));
    let mesh = mesh(cell);
    let start = state(vec![0.0; dofs.count()], contact.initial());
    for _ in 0..600 {
        let first = commit(&contact, &start, motion(&mesh, &dofs, &mut random));
        // A point that came to lie deep where nothing was refuses the increment.
        let accepted = first.and_then(|first| commit(&contact, &first, motion(&mesh, &dofs, &mut random)));
        let Ok(accepted) = accepted else { continue };
        let attempt = contact.attempt(&accepted, &accepted.histories[0], instant()).unwrap();
        look(attempt.as_ref(), &motion(&mesh, &dofs, &mut random));
    }
}

#[test]
fn tangents_of_contact_between_bodies_are_exact() {
    for cell in ["quad4", "quad8"] {
        for carrier in [Carrier::Narrow, Carrier::Wide] {
            for (loads, space) in [(LoadedSides::Own, Space::PlaneStrain), (LoadedSides::Both, Space::Axisymmetric)] {
                let (mut met, mut skipped, mut worst) = ([0; 3], 0, 0.0_f64);
                states(cell, carrier, loads, space, &mut |attempt, u| {
                    for result in check(attempt, u).into_iter().flatten() {
                        met[usize::from(result.branch)] += 1;
                        skipped += usize::from(!result.smooth);
                        assert!(result.error.is_finite());
                        worst = if result.smooth { worst.max(result.error) } else { worst };
                    }
                });
                let name =
                    format!("{cell}, {carrier:?}, {loads:?}, {space:?}: {met:?} skipped {skipped} worst {worst:.1e}");
                println!("{name}");
                assert!(met.iter().all(|&met| met >= 60), "{name}");
                assert!(20 * skipped <= met.iter().sum::<usize>(), "{name}");
                assert!(worst < ALLOWED, "{name}");
            }
        }
    }
}

/// The forces of one pass on the two bodies are opposite. Their moments differ by the friction stress times the
/// penetration, since they act on either side of it.
#[test]
fn forces_of_one_pass_balance() {
    let mut closed = 0;
    for carrier in [Carrier::Narrow, Carrier::Wide] {
        states("quad8", carrier, LoadedSides::Both, Space::PlaneStrain, &mut |attempt, u| {
            let (mut stencils, mut local) = (Stencils::default(), Local::default());
            attempt.stencils(u, &mut stencils).unwrap();
            for (i, stencil) in stencils.list.iter().enumerate() {
                let dofs = stencils.dofs(stencil);
                local.u = dofs.iter().map(|&dof| u[dof]).collect();
                local.reset(stencil.len);
                if attempt.evaluate(i, stencil, &mut attempt.scratch(i), &mut local).is_err() {
                    continue;
                }
                let sum = |axis: usize| local.force.iter().skip(axis).step_by(2).sum::<f64>();
                let size = local.force.iter().fold(0.0_f64, |size, force| size.max(force.abs()));
                closed += usize::from(size > 0.0);
                assert!(sum(0).abs().max(sum(1).abs()) <= 1e-14 * size, "{:?} of {size}", [sum(0), sum(1)]);
            }
        });
    }
    assert!(closed > 500, "{closed}");
}
