//! Periodic pairs as equations: `u_s - u_t = u_lead - u_lead'` for opposite nodes.

use super::equations::Equation;
use crate::build::Builder;
use crate::diagnose::Diagnostic;
use crate::keys::Periodic;
use asperity_core::tensor::Vec3;

/// Opposite nodes may be off their places by this part of the size of the mesh.
const OFF: f64 = 1e-6;

impl Builder<'_> {
    /// The equations of all periodic pairs.
    pub(super) fn periodic(&mut self) -> Vec<Equation> {
        let deck = self.deck;
        deck.periodic.iter().flat_map(|keys| self.pairs(keys).unwrap_or_default()).collect()
    }

    fn pairs(&mut self, keys: &Periodic) -> Option<Vec<Equation>> {
        let mesh = self.site.mesh.clone();
        let [surface, target, lead] =
            [&keys.surface, &keys.target, &keys.lead].map(|name| self.nodes(&name.text).to_vec());
        let &[lead] = lead.as_slice() else {
            let what = format!("`{}` holds {} nodes; one leads a periodic pair", keys.lead, lead.len());
            self.found.push(Diagnostic::error(what).at(keys.lead.place).help("choose one by [group.NAME]"));
            return None;
        };
        let mean = |nodes: &[usize]| {
            let sum = nodes.iter().fold(Vec3::zero(), |sum, &node| sum + mesh.points[node]);
            sum * (nodes.len().max(1) as f64).recip()
        };
        let shift = mean(&target) - mean(&surface);
        let opposite = |node: usize| {
            let to = mesh.points[node] + shift;
            let distance = |other: usize| (mesh.points[other] - to).norm();
            let nearest = target.iter().copied().min_by(|&a, &b| distance(a).total_cmp(&distance(b)))?;
            Some((nearest, distance(nearest)))
        };
        if surface.len() != target.len() {
            let what = format!(
                "`{}` has {} nodes and `{}` has {}: a periodic cell has as many on opposite sides",
                keys.surface,
                surface.len(),
                keys.target,
                target.len()
            );
            self.refuse(what, keys.place);
            return None;
        }
        let (mut pairs, farthest) = (Vec::new(), OFF * mesh.size());
        for &node in &surface {
            let (other, distance) = opposite(node)?;
            if distance > farthest {
                let number = mesh.node_number(node);
                let what = format!(
                    "node {number} of `{}` has no node of `{}` opposite: the nearest is {distance:.3e} off",
                    keys.surface, keys.target
                );
                let help = "give opposite sides nodes in the same places";
                self.found.push(Diagnostic::error(what).at(keys.surface.place).help(help));
                return None;
            }
            pairs.push([node, other]);
        }
        let Some(&first) = pairs.iter().find(|[node, _]| *node == lead) else {
            let what = format!("`{}` is no node of `{}`", keys.lead, keys.surface);
            self.found.push(Diagnostic::error(what).at(keys.lead.place).help("choose one of its corners"));
            return None;
        };
        let dofs = &self.site.dofs;
        let equation = |[node, other]: [usize; 2], axis: usize| {
            let terms = [(node, 1.0), (other, -1.0), (first[0], -1.0), (first[1], 1.0)];
            let terms = terms.map(|(node, factor)| (dofs.node(node) + axis, factor)).to_vec();
            Equation { terms, place: keys.place, by: "periodic" }
        };
        let others = pairs.iter().filter(|pair| **pair != first);
        Some(others.flat_map(|&pair| (0..dofs.per_node()).map(move |axis| equation(pair, axis))).collect())
    }
}
