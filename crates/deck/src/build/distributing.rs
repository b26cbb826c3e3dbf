//! Points whose loads a group carries.

use super::Builder;
use crate::diagnose::Diagnostic;
use crate::keys::{DistributingKeys, Weights};
use crate::reader::Name;
use asperity_core::amplitude::Timeline;
use asperity_core::load::{DistributedLoad, areas};
use asperity_core::mesh::Space;
use asperity_core::system::Term;
use asperity_core::tensor::Vec3;

impl Builder<'_> {
    /// The point of a name.
    pub(super) fn distributing(&self, name: &Name) -> Option<&'_ DistributingKeys> {
        self.deck.distributing.iter().find(|(other, _)| other.text == name.text).map(|(_, keys)| keys)
    }

    /// What loads a point, as a load on its nodes.
    pub(super) fn distributed(&mut self, title: &str, name: &Name, values: Vec<Timeline>) -> Option<Box<dyn Term>> {
        let (place, dimension) = (name.place, self.site.space.dimension());
        if self.site.space == Space::Axisymmetric {
            let what =
                format!("`distributing.{name}`: a body of revolution has no moment, and forces along its axis only");
            let help = "lay the force on the group by `force`, or a pressure on its sides";
            self.found.push(Diagnostic::error(what).at(place).help(help));
            return None;
        }
        if self.leader(&name.text).is_some() {
            self.refuse(format!("`{name}` is both a tool or rigid group and a point of loads"), place);
            return None;
        }
        let keys = self.distributing(name)?.clone();
        let weights: Vec<(usize, f64)> = match keys.weights {
            Weights::Equal => self.nodes(&keys.group.text).iter().map(|&node| (node, 1.0)).collect(),
            Weights::Area => {
                let areas = areas(title, &self.site, &self.sides(&keys.group));
                self.keep(areas, keys.group.place)?
            }
        };
        if weights.is_empty() {
            self.refuse(
                format!("`distributing.{name}.group` has no sides, whose area could be weights"),
                keys.group.place,
            );
            return None;
        }
        let reference = match &keys.reference {
            Some(reference) if reference.len() != dimension => {
                let count = reference.len();
                let what = format!(
                    "`distributing.{name}.reference` must have {dimension} coordinates in this space; it has {count}"
                );
                self.refuse(what, reference.place);
                return None;
            }
            Some(reference) => self.point(reference),
            None => {
                let sum = |of: &dyn Fn(usize) -> Vec3| {
                    weights.iter().fold(Vec3::zero(), |sum, &(node, w)| sum + of(node) * w)
                };
                let all: f64 = weights.iter().map(|(_, weight)| weight).sum();
                sum(&|node| self.site.mesh.points[node]) * all.recip()
            }
        };
        let load = DistributedLoad::new(title, self.site.clone(), &weights, reference, values);
        Some(Box::new(self.keep(load, place)?))
    }
}
