//! A small block in space, `upper`, that touches a larger one, `lower`, from above, and random motions of both.

use super::perturbed::Random;
use asperity::contact::field::{FieldSurface, FieldTarget};
use asperity::contact::{ContactOptions, ContactParts, PaperContact};
use asperity::interface::laws::Coulomb;
use asperity::mesh::{Mesh, Space};
use asperity::system::Dofs;
use std::sync::Arc;

/// Which of the two blocks carries the points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Carrier {
    /// The small one, which the large one covers.
    Small,
    /// The large one, whose faces the small one covers in part.
    Large,
}

/// The contact between them.
pub fn pair(mesh: Mesh, carrier: Carrier, friction: f64, options: ContactOptions) -> (PaperContact, Dofs) {
    let mesh = Arc::new(mesh);
    let (own, other) = match carrier {
        Carrier::Small => ("upper.back", "lower.front"),
        Carrier::Large => ("lower.front", "upper.back"),
    };
    let dofs = Dofs::new(3, mesh.points.len(), 0);
    let sides = |group: &str| mesh.groups[group].sides.as_slice();
    let parts = ContactParts {
        name: "c".into(),
        surface: FieldSurface::whole(&mesh, sides(own), Space::Solid, 1.0),
        space: Space::Solid,
        boundary: mesh.boundary(&mesh.groups[own.split('.').next().unwrap()].cells),
        target: FieldTarget::faces(FieldSurface::whole(&mesh, sides(other), Space::Solid, 1.0), &mesh),
        law: Coulomb::new(friction).into(),
        options,
        dofs: dofs.clone(),
        mesh: mesh.clone(),
    };
    (PaperContact::new(parts, None), dofs)
}

/// Random motion: the small block by up to a tenth and down by `down`, `less` more or less, all nodes by a little.
pub fn motion((contact, dofs): (&PaperContact, &Dofs), [down, less]: [f64; 2], random: &mut Random) -> Vec<f64> {
    let by = [0.08 * random.next(), 0.08 * random.next(), -down - less * random.next()];
    let mut u = vec![0.0; dofs.count()];
    for node in 0..dofs.nodes() {
        let upper = contact.mesh().groups["upper"].nodes.contains(&node);
        for (axis, by) in by.into_iter().enumerate() {
            u[dofs.node(node) + axis] = if upper { by } else { 0.0 } + 0.012 * random.next();
        }
    }
    u
}
