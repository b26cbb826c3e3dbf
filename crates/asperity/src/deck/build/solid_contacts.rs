//! Contacts of a model in space.

use super::Builder;
use super::contacts::{Opposite, backings, boundary_behind, following, is_double};
use crate::contact::space::{Contact, Faces, Parts, Surface, Target};
use crate::contact::{Backing, second_name};
use crate::deck::keys;
use crate::deck::reader::Name;
use crate::mesh::Side;
use crate::solid::Body;
use crate::tool::space::Tool;
use std::sync::Arc;

impl Builder<'_> {
    /// The contacts in space, those of the second of two passes right behind those of the first.
    pub(super) fn solid_contacts(&mut self, tools: &[Arc<Tool>], bodies: &[(Body, usize)]) -> Option<Vec<Contact>> {
        let backings = backings(&self.site.mesh, bodies.iter().map(|(body, _)| body));
        let deck = self.deck;
        self.check_doubles();
        let of_points: Vec<_> = deck.contact.iter().filter(|(_, keys)| !self.is_field(keys)).collect();
        let contacts: Vec<_> =
            of_points.into_iter().map(|(name, keys)| self.solid_contact(name, keys, tools, &backings)).collect();
        Some(contacts.into_iter().collect::<Option<Vec<_>>>()?.into_iter().flatten().collect())
    }

    fn solid_contact(
        &mut self,
        name: &Name,
        keys: &keys::Contact,
        tools: &[Arc<Tool>],
        backings: &[Backing],
    ) -> Option<Vec<Contact>> {
        let law = self.interface(name, keys)?;
        let (mesh, dofs) = (self.site.mesh.clone(), self.site.dofs.clone());
        let sides = mesh.groups.get(&keys.surface.text)?.sides.as_slice();
        let opposite = self.opposite(keys, &mesh)?;
        if !self.check_passes(name, keys, (sides, opposite)) {
            return None;
        }
        if let Some(parts) = keys.parts {
            self.refuse("`parts` divides edges, which carry contact in the plane and in axial symmetry", parts.place);
            return None;
        }
        let options = self.options(keys, (sides, opposite), backings);
        self.check_penalties(name, keys, self.computed_penalty(keys, (sides, opposite), backings));
        self.check_elastic_slip(keys, &options);
        let build = |name: &str, sides: &[Side], target: Target, options| {
            Contact::new(Parts {
                name: name.into(),
                dofs: dofs.clone(),
                surface: Surface::new(&mesh, sides, keys.gauss.map(|gauss| gauss.value)),
                boundary: boundary_behind(&mesh, sides, &self.deck.body),
                target,
                law: law.clone(),
                options,
                mesh: mesh.clone(),
            })
        };
        let faces = |sides: &[Side]| Target::Faces(Faces::new(mesh.clone(), dofs.clone(), sides));
        Some(match opposite {
            Opposite::Tool(number) => {
                vec![build(&name.text, sides, Target::tool(tools[number].clone(), number, &dofs), options)]
            }
            Opposite::Sides(others) => {
                let second = is_double(&options, sides, others)
                    .then(|| build(&second_name(&name.text), others, faces(sides), following(options)));
                std::iter::once(build(&name.text, sides, faces(others), options)).chain(second).collect()
            }
        })
    }
}
