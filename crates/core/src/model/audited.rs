//! What the contacts of a model claim, for the audit: which pairs they are about and how deep their points lie.

use crate::audit::Claim;
use crate::contact::PaperContact;
use crate::contact::field::{FieldContact, FieldSurface, FieldTarget, TiedSurfaces};
use crate::system::History;
use std::sync::Arc;

/// The claims of all contacts, whose terms follow the bodies.
pub(super) fn claims(
    bodies: usize,
    contacts: &[Arc<PaperContact>],
    fields: &[Arc<FieldContact>],
    ties: &[([String; 2], TiedSurfaces)],
) -> Vec<Claim> {
    let points = contacts.iter().enumerate().map(|(i, contact)| of_points(contact, bodies + i));
    let first = bodies + contacts.len();
    let field = fields.iter().enumerate().map(|(i, contact)| of_field(contact, first + i));
    points.chain(field).chain(ties.iter().map(|(_, tie)| of_tie(tie))).collect()
}

fn of_points(contact: &Arc<PaperContact>, term: usize) -> Claim {
    let own = contact.clone();
    claim((contact.surface(), contact.target(), term), move |history| own.largest_penetration(history))
}

fn of_field(contact: &Arc<FieldContact>, term: usize) -> Claim {
    let own = contact.clone();
    claim((contact.surface(), contact.target(), term), move |history| own.largest_penetration(history))
}

fn claim(
    (surface, target, term): (&FieldSurface, &FieldTarget, usize),
    penetration: impl Fn(&History) -> f64 + Send + Sync + 'static,
) -> Claim {
    let nodes = |surface: &FieldSurface| surface.faces.iter().flat_map(|face| face.nodes.iter().copied()).collect();
    let target = match target {
        FieldTarget::Tool(tool) => Err(tool.number()),
        FieldTarget::Faces(faces) => Ok(nodes(&faces.surface)),
    };
    Claim { surface: nodes(surface), target, term, penetration: Box::new(penetration) }
}

/// Meshes that do not match lie in each other a little where they are glued, and report nothing of it.
fn of_tie(tie: &TiedSurfaces) -> Claim {
    let [surface, target] = tie.nodes.clone();
    Claim { surface, target: Ok(target), term: NO_TERM, penetration: Box::new(|_| 0.0) }
}

/// The number of no term.
const NO_TERM: usize = usize::MAX;
