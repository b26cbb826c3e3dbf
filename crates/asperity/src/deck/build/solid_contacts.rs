//! Contacts of a model in space.

use super::Builder;
use super::contacts::{Opposite, boundary_behind, moduli};
use crate::contact::space::{Contact, Parts, Surface};
use crate::contact::{ContactOptions, Guard, Loads, default_penalty};
use crate::deck::keys;
use crate::deck::reader::Name;
use crate::mesh::Side;
use crate::solid::Body;
use crate::tool::space::Tool;
use std::sync::Arc;

impl Builder<'_> {
    /// The contacts with tools in space.
    pub(super) fn solid_contacts(&mut self, tools: &[Arc<Tool>], bodies: &[(Body, usize)]) -> Option<Vec<Contact>> {
        let moduli = moduli(&self.site.mesh, bodies);
        let deck = self.deck;
        self.check_doubles();
        let contact = |(name, keys): &(Name, keys::Contact)| self.solid_contact(name, keys, tools, &moduli);
        let contacts: Vec<_> = deck.contact.iter().map(contact).collect();
        contacts.into_iter().collect()
    }

    fn solid_contact(
        &mut self,
        name: &Name,
        keys: &keys::Contact,
        tools: &[Arc<Tool>],
        moduli: &[f64],
    ) -> Option<Contact> {
        let number = self.deck.tool.iter().position(|(tool, _)| tool.text == keys.target.text);
        let Some(number) = number else {
            self.refuse("two bodies touch in the plane spaces and the axisymmetric one only", keys.target.place);
            return None;
        };
        let law = self.interface(keys)?;
        let mesh = self.site.mesh.clone();
        let sides = mesh.groups.get(&keys.surface.text)?.sides.as_slice();
        if !self.check_passes(name, keys, (sides, Opposite::Tool(number))) {
            return None;
        }
        Some(Contact::new(Parts {
            name: name.text.clone(),
            dofs: self.site.dofs.clone(),
            surface: Surface::new(&mesh, sides, keys.gauss.map(|gauss| gauss.value)),
            boundary: boundary_behind(&mesh, sides, &self.deck.body),
            tool: (tools[number].clone(), number),
            law,
            options: self.solid_options(keys, sides, moduli),
            mesh: mesh.clone(),
        }))
    }

    fn solid_options(&self, keys: &keys::Contact, sides: &[Side], moduli: &[f64]) -> ContactOptions {
        let computed = || default_penalty(&self.site.mesh, sides, |cell| moduli[cell]);
        let penalty = keys.penalty.unwrap_or_else(computed);
        ContactOptions {
            penalty,
            tangential_penalty: keys.tangential_penalty.unwrap_or(penalty),
            thickness: 1.0,
            modulus: sides.iter().map(|side| moduli[side.cell]).fold(f64::INFINITY, f64::min),
            loads: Loads::Both,
            coupling: true,
            guard: Guard::Refuse,
        }
    }
}
