//! What the contacts of a model claim, for the audit: which pairs they are about and how deep their points lie.

use crate::audit::Claim;
use crate::contact::field::{FieldContact, FieldTarget, Surface, Tie};
use crate::contact::{self, Contact};
use std::sync::Arc;

/// The claims of all contacts, whose terms follow the bodies.
pub(super) fn claims(
    bodies: usize,
    (plane, space): (&[Arc<Contact>], &[Arc<contact::space::Contact>]),
    fields: &[Arc<FieldContact>],
    ties: &[([String; 2], Tie)],
) -> Vec<Claim> {
    let flat = plane.iter().enumerate().map(|(i, contact)| in_plane(contact, bodies + i));
    let solid = space.iter().enumerate().map(|(i, contact)| in_space(contact, bodies + plane.len() + i));
    let first = bodies + plane.len() + space.len();
    let field = fields.iter().enumerate().map(|(i, contact)| of_field(contact, first + i));
    flat.chain(solid).chain(field).chain(ties.iter().map(|(_, tie)| of_tie(tie))).collect()
}

fn in_plane(contact: &Arc<Contact>, term: usize) -> Claim {
    let nodes = |edges: &[contact::Edge]| edges.iter().flat_map(|edge| edge.nodes.iter().copied()).collect();
    let target = match contact.target() {
        contact::Target::Tool(tool) => Err(tool.number()),
        contact::Target::Faces(faces) => Ok(nodes(faces.edges())),
    };
    let (surface, contact) = (nodes(&contact.surface().edges), contact.clone());
    Claim { surface, target, term, penetration: Box::new(move |history| contact.largest_penetration(history)) }
}

fn in_space(contact: &Arc<contact::space::Contact>, term: usize) -> Claim {
    let nodes = |faces: &[contact::space::Face]| faces.iter().flat_map(|face| face.nodes.iter().copied()).collect();
    let target = match contact.target() {
        contact::space::Target::Tool(tool) => Err(tool.number()),
        contact::space::Target::Faces(faces) => Ok(nodes(faces.list())),
    };
    let (surface, contact) = (nodes(&contact.surface().faces), contact.clone());
    Claim { surface, target, term, penetration: Box::new(move |history| contact.largest_penetration(history)) }
}

fn of_field(contact: &Arc<FieldContact>, term: usize) -> Claim {
    let nodes = |surface: &Surface| surface.faces.iter().flat_map(|face| face.nodes.iter().copied()).collect();
    let target = match contact.target() {
        FieldTarget::Tool(tool) => Err(tool.number()),
        FieldTarget::Faces(faces) => Ok(nodes(&faces.surface)),
    };
    let (surface, contact) = (nodes(contact.surface()), contact.clone());
    Claim { surface, target, term, penetration: Box::new(move |history| contact.largest_penetration(history)) }
}

/// Meshes that do not match lie in each other a little where they are glued, and report nothing of it.
fn of_tie(tie: &Tie) -> Claim {
    let [surface, target] = tie.nodes.clone();
    Claim { surface, target: Ok(target), term: NO_TERM, penetration: Box::new(|_| 0.0) }
}

/// The number of no term.
const NO_TERM: usize = usize::MAX;
