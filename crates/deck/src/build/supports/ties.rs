//! Ties as equations: what the nodes that follow have to be in a step, given what else holds them.
//!
//! A node that something else holds or leads cannot follow as well. What it would have followed goes to its neighbours in equal
//! parts, as at the ends of an interface (Wohlmuth 2000): the sum of all conditions, by which a uniform stress passes, stays.

use super::equations::{Equation, Fixed, Relations};
use crate::build::ties::Glued;
use asperity_core::system::Dofs;
use std::collections::{BTreeMap, BTreeSet};

impl Relations {
    /// Adds the conditions of a tie along an axis; `fixed` are the prescribed unknowns.
    pub fn tie(&mut self, glued: &Glued, (dofs, axis): (&Dofs, usize), fixed: &Fixed) {
        let (conditions, dof) = (&glued.tie.conditions, |node: usize| dofs.node(node) + axis);
        let taken = |node: usize| fixed.contains_key(&dof(node)) || self.list.contains_key(&dof(node));
        let able = conditions.iter().filter(|condition| condition.follows && !taken(condition.node));
        let able: BTreeSet<usize> = able.map(|condition| condition.node).collect();
        let mut rows: BTreeMap<usize, Vec<(usize, f64)>> = BTreeMap::new();
        let mut alone = Vec::new();
        for condition in conditions {
            let node = condition.node;
            let to: Vec<usize> = match able.contains(&node) {
                true => vec![node],
                false => condition.neighbours.iter().copied().filter(|other| able.contains(other)).collect(),
            };
            let part = (to.len().max(1) as f64).recip();
            let terms = || condition.terms.iter().map(|&(other, c)| (dof(other), part * c));
            for &node in &to {
                // The node's own term comes first: it is the one that follows.
                rows.entry(node).or_insert_with(|| vec![(dof(node), 0.0)]).extend(terms());
            }
            if to.is_empty() && condition.follows {
                alone.push(terms().collect());
            }
        }
        for terms in rows.into_values().chain(alone) {
            self.hold(&Equation { terms, place: glued.place, by: "tie" }, fixed);
        }
    }
}
