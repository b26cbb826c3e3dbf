//! Rigid groups of nodes.

use super::Builder;
use crate::diagnose::Diagnostic;
use crate::keys::RigidKeys;
use crate::reader::Name;
use asperity_core::mesh::Space;
use asperity_core::model::RigidGroup;
use asperity_core::tensor::Vec3;
use std::collections::BTreeMap;

impl Builder<'_> {
    /// The number of a tool or rigid group among the unknowns.
    pub(super) fn leader(&self, name: &str) -> Option<usize> {
        self.leaders().position(|leader| leader.text == name)
    }

    /// Names of the tools and then of the rigid groups.
    pub(super) fn leaders(&self) -> impl Iterator<Item = &Name> {
        self.deck.tool.iter().map(|(name, _)| name).chain(self.deck.rigid.iter().map(|(name, _)| name))
    }

    /// The rigid groups. What is wrong with them is reported.
    pub(super) fn rigid(&mut self) -> Vec<RigidGroup> {
        let (deck, mut of) = (self.deck, BTreeMap::new());
        let mut groups = Vec::new();
        for (name, keys) in &deck.rigid {
            groups.extend(self.rigid_group(name, keys));
            if deck.tool.iter().any(|(tool, _)| tool.text == name.text) {
                self.refuse(format!("`{name}` is both a tool and a rigid group"), name.place);
            }
            for &node in self.site.mesh.groups.get(&keys.group.text).map_or(&[][..], |group| &group.nodes) {
                let Some(other) = of.insert(node, &name.text) else { continue };
                let number = self.site.mesh.node_number(node);
                let what = format!("node {number} belongs to two rigid groups, `{other}` and `{name}`");
                self.found.push(Diagnostic::error(what).at(keys.group.place).help("make one group of them"));
                break;
            }
        }
        for (contact, keys) in &deck.contact {
            if deck.rigid.iter().any(|(name, _)| name.text == keys.target.text) {
                let what = format!("`{}`, the target of contact `{contact}`, is a group of nodes", keys.target);
                let help = "name the group of sides of the body that it belongs to";
                self.found.push(Diagnostic::error(what).at(keys.target.place).help(help));
            }
        }
        groups
    }

    fn rigid_group(&mut self, name: &Name, keys: &RigidKeys) -> Option<RigidGroup> {
        let (mesh, dimension) = (self.site.mesh.clone(), self.site.space.dimension());
        if self.site.space == Space::Axisymmetric {
            let what = format!("`rigid.{name}`: a body of revolution can move along its axis only");
            let help = "lead the group by `displacement`, or let its nodes follow one of them by [[equation]]";
            self.found.push(Diagnostic::error(what).at(name.place).help(help));
            return None;
        }
        let nodes = mesh.groups.get(&keys.group.text)?.nodes.clone();
        let reference = match &keys.reference {
            Some(reference) if reference.len() != dimension => {
                let what = format!(
                    "`rigid.{name}.reference` must have {dimension} coordinates in this space; it has {}",
                    reference.len()
                );
                self.refuse(what, reference.place);
                return None;
            }
            Some(reference) => self.point(reference),
            None => {
                let sum = nodes.iter().fold(Vec3::zero(), |sum, &node| sum + mesh.points[node]);
                sum * (nodes.len().max(1) as f64).recip()
            }
        };
        Some(RigidGroup { name: name.text.clone(), reference, nodes })
    }
}
