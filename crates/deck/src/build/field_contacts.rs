//! Contacts whose stress is a field of nodal values.

use super::Builder;
use super::contacts::{Opposite, Tools, backings, boundary_behind};
use crate::keys::{self, ContactForm, Roles};
use crate::reader::Name;
use crate::source::Place;
use asperity_core::contact::field::{FieldContact, FieldRoles, FieldSurface, HeldNodes};
use asperity_core::contact::{Backing, ContactParts};
use asperity_core::model::FieldSides;
use asperity_core::solid::Body;

impl Builder<'_> {
    /// Whether a contact is a field.
    pub(super) fn is_field(&self, keys: &keys::Contact) -> bool {
        match keys.form {
            Some(form) => form.value == ContactForm::Field,
            None => said_of_points(keys).is_empty(),
        }
    }

    /// The contacts that are fields.
    pub(super) fn field_contacts(
        &mut self,
        tools: Option<Tools>,
        bodies: Option<&[(Body, usize)]>,
    ) -> Option<Vec<FieldContact>> {
        let deck = self.deck;
        let fields: Vec<&(Name, keys::Contact)> = deck.contact.iter().filter(|(_, keys)| self.is_field(keys)).collect();
        if fields.is_empty() {
            return Some(Vec::new());
        }
        let backings = backings(&self.site.mesh, deck, bodies?.iter().map(|(body, _)| body));
        let tools = tools?;
        let contacts: Vec<_> =
            fields.into_iter().map(|(name, keys)| self.field_contact(name, keys, tools, &backings)).collect();
        contacts.into_iter().collect()
    }

    fn field_contact(
        &mut self,
        name: &Name,
        keys: &keys::Contact,
        tools: Tools,
        backings: &[Backing],
    ) -> Option<FieldContact> {
        let law = self.interface(name, keys)?;
        if !self.check_field(keys) {
            return None;
        }
        let (mesh, dofs, space) = (self.site.mesh.clone(), self.site.dofs.clone(), self.site.space);
        let surface = mesh.groups.get(&keys.surface.text)?.sides.as_slice();
        let opposite = self.opposite(keys, &mesh)?;
        let computed = self.computed_penalty(keys, (surface, opposite), backings);
        let options = self.options(keys, (surface, opposite), computed);
        self.check_elastic_slip(keys, &options);
        self.check_penalties(name, keys, computed.value);
        if !self.check_passes(name, keys, (surface, opposite)) {
            return None;
        }
        let FieldSides { carrier: sides, target, itself, swapped } = match opposite {
            Opposite::Tool(number) => {
                let target = tools.target(number, &dofs)?;
                FieldSides { carrier: surface, target, itself: false, swapped: false }
            }
            Opposite::Sides(others) => {
                // What wears is the side that the deck names.
                let may_swap = keys.roles == Roles::Auto && keys.wear.is_none();
                FieldSides::new([surface, others], may_swap, (&mesh, space, self.site.thickness), backings)
            }
        };
        let held = self.planes(&mesh).into_iter().map(|plane| HeldNodes {
            nodes: plane.nodes.into_iter().collect(),
            normal: Some(plane.normal).filter(|_| plane.stays),
        });
        let held: Vec<HeldNodes> = held.collect();
        let carrier = FieldSurface::held(&mesh, sides, (space, self.site.thickness), &held);
        let pieces = target.as_tool().map_or(1, |rigid| rigid.pieces());
        if carrier.nodes.len().saturating_mul(pieces) > MOST {
            let what = format!(
                "{} nodes of the surface against {pieces} smooth pieces of the target are too many for a field; form = \"paper\", \
                 or a tool whose facets meet at smaller angles",
                carrier.nodes.len()
            );
            self.refuse(what, keys.law.place);
            return None;
        }
        let parts = ContactParts {
            name: name.text.clone(),
            surface: carrier,
            boundary: boundary_behind(&mesh, sides, &self.deck.body),
            target,
            law,
            options,
            space,
            dofs,
            mesh: mesh.clone(),
        };
        Some(FieldContact::new(parts, FieldRoles { itself, swapped }))
    }

    /// What is said of contact points says nothing of a field.
    fn check_field(&mut self, keys: &keys::Contact) -> bool {
        let said = said_of_points(keys);
        for (what, place) in &said {
            self.refuse(format!("{what} for stresses at points: form = \"paper\""), *place);
        }
        said.is_empty()
    }
}

/// What a deck says that only stresses at points have, and where.
fn said_of_points(keys: &keys::Contact) -> Vec<(&'static str, Place)> {
    let mean = !keys.law.build().is_ok_and(|law| law.radius() == 0.0);
    let said = [
        keys.gauss.map(|spot| ("`gauss` is", spot.place)),
        keys.passes.map(|spot| ("`passes` is", spot.place)),
        keys.coupling.map(|spot| ("`coupling` is", spot.place)),
        mean.then_some(("a mean of the pressure is", keys.law.place)),
    ];
    said.into_iter().flatten().collect()
}

/// Most pairs of a node of the field and a smooth piece of its target; each has a history.
const MOST: usize = 1_000_000;
