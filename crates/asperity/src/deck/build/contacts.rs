//! Contacts: surface, target, law, penalties.

use super::Builder;
use crate::contact::{Contact, ContactOptions, Loads, Surface, Target, default_penalty};
use crate::deck::diagnose::Diagnostic;
use crate::deck::keys;
use crate::deck::reader::Name;
use crate::interface::Interface;
use crate::mesh::{Mesh, Side};
use crate::solid::Body;
use crate::tool::Tool;
use std::sync::Arc;

impl Builder<'_> {
    /// The contacts.
    pub(super) fn contacts(&mut self, tools: &[Arc<Tool>], bodies: &[(Body, usize)]) -> Option<Vec<Contact>> {
        let moduli = moduli(&self.site.mesh, bodies);
        let deck = self.deck;
        self.check_doubles();
        let contacts: Vec<_> =
            deck.contact.iter().map(|(name, keys)| self.contact(name, keys, tools, &moduli)).collect();
        contacts.into_iter().collect()
    }

    /// No side may touch the same tool by two contacts: it would do so twice as hard.
    fn check_doubles(&mut self) {
        let mesh = self.site.mesh.clone();
        let sides = |keys: &keys::Contact| mesh.groups.get(&keys.surface.text).map_or(&[][..], |group| &group.sides);
        let mut found = Vec::new();
        for (i, (name, keys)) in self.deck.contact.iter().enumerate() {
            let earlier = self.deck.contact[..i].iter().filter(|(_, other)| other.target.text == keys.target.text);
            let shares = |other: &keys::Contact| sides(keys).iter().any(|side| sides(other).contains(side));
            for (other, _) in earlier.filter(|(_, other)| shares(other)) {
                let what = format!("the contacts `{other}` and `{name}` let the same sides touch `{}`", keys.target);
                found.push(Diagnostic::error(what).at(keys.surface.place).help("keep one of the two"));
            }
        }
        self.found.append(&mut found);
    }

    fn contact(&mut self, name: &Name, keys: &keys::Contact, tools: &[Arc<Tool>], moduli: &[f64]) -> Option<Contact> {
        let number = self.deck.tool.iter().position(|(tool, _)| tool.text == keys.target.text)?;
        let law = keys.law.build().map_err(crate::Error::input);
        let law: Arc<dyn Interface> = Arc::from(self.keep(law, keys.law.place)?);
        let mesh = self.site.mesh.clone();
        let sides = mesh.groups.get(&keys.surface.text)?.sides.as_slice();
        let modulus = sides.iter().map(|side| moduli[side.cell]).fold(f64::INFINITY, f64::min);
        let computed = || default_penalty(&mesh, sides, |cell| moduli[cell]);
        let penalty = keys.penalty.unwrap_or_else(computed);
        let options = ContactOptions {
            penalty,
            tangential_penalty: keys.tangential_penalty.unwrap_or(penalty),
            thickness: self.site.thickness,
            modulus,
            loads: Loads::Both,
            coupling: true,
        };
        let surface = Surface::new(&mesh, sides, keys.gauss.map(|gauss| gauss.value));
        let boundary = boundary_behind(&mesh, sides, &self.deck.body);
        let target = Target::tool(tools[number].clone(), number, &self.site.dofs);
        let site = (mesh.clone(), self.site.dofs.clone(), self.site.space);
        Some(Contact::new(&name.text, site, (surface, boundary), target, (law, options)))
    }
}

/// Confined modulus of the material of each cell.
fn moduli(mesh: &Mesh, bodies: &[(Body, usize)]) -> Vec<f64> {
    let mut moduli = vec![0.0; mesh.cell_count()];
    for (body, _) in bodies {
        let modulus = body.material().confined_modulus();
        body.cells().iter().for_each(|&cell| moduli[cell] = modulus);
    }
    moduli
}

/// The whole outer boundary of the bodies whose cells lie behind the sides.
fn boundary_behind(mesh: &Mesh, sides: &[Side], bodies: &[(Name, keys::Body)]) -> Vec<Side> {
    let groups = bodies.iter().filter_map(|(name, _)| mesh.groups.get(&name.text));
    let behind = groups.filter(|group| sides.iter().any(|side| group.cells.binary_search(&side.cell).is_ok()));
    let mut cells: Vec<usize> = behind.flat_map(|group| group.cells.iter().copied()).collect();
    cells.sort_unstable();
    cells.dedup();
    mesh.boundary(&cells)
}
