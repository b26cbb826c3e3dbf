//! Equations.

use super::{Writer, quoted};
use crate::elements::Family;
use crate::message::InputPlace;
use crate::model::{ActionKind, Condition};
use crate::read::along;

const AXES: [&str; 3] = ["x", "y", "z"];

impl Writer<'_> {
    /// One equation of the deck for each.
    pub(super) fn equations(&mut self) {
        let model = self.model;
        for equation in &model.equations {
            if self.tools.iter().any(|tool| equation.terms.iter().any(|term| term.0 == tool.node)) {
                self.error(
                    equation.place,
                    "an equation names the reference node of a rigid body, which cannot be translated",
                );
                continue;
            }
            // Along axes of a node's own a term is several.
            let mut said: Vec<(usize, usize, f64)> = Vec::new();
            for &(node, axis, factor) in &equation.terms {
                let parts = along(model.frames.get(&node), axis);
                for at in (0..self.dimension()).filter(|&at| parts[at] != 0.0) {
                    match said.iter_mut().find(|other| (other.0, other.1) == (node, at)) {
                        Some(other) => other.2 += factor * parts[at],
                        None => said.push((node, at, factor * parts[at])),
                    }
                }
            }
            let out_of_plane = said.is_empty() && equation.terms.iter().all(|term| term.1 >= self.dimension());
            if out_of_plane {
                continue;
            }
            if said.len() < 2 {
                self.error(equation.place, "an equation with one term holds a node; write it as *BOUNDARY");
                continue;
            }
            let terms: Vec<(String, usize, f64)> = said
                .into_iter()
                .map(|(node, axis, factor)| {
                    (self.groups.nodes(&model.nodes[node].label.to_string(), vec![node]), axis, factor)
                })
                .collect();
            self.equation(equation.place, &terms);
        }
    }

    /// Terms: group, axis and factor.
    fn equation(&mut self, place: InputPlace, terms: &[(String, usize, f64)]) {
        let mut text = format!("\n[[equation]]{}\nterms = [\n", self.from(place));
        for (group, axis, factor) in terms {
            text += &format!("    {{ group = {}, axis = \"{}\", factor = {factor:?} }},\n", quoted(group), AXES[*axis]);
        }
        self.text += &(text + "]\n");
    }

    /// A group whose nodes go with the node of a rigid body along some axes, without turning.
    pub(super) fn partial_group(&mut self, group: &str, number: usize) {
        let (model, rigid) = (self.model, &self.model.rigid[number]);
        let ring = self.family == Family::Axisymmetric;
        let turns: &[usize] = if self.dimension() == 2 { &[5] } else { &[3, 4, 5] };
        if !ring && !turns.iter().all(|&axis| self.never_turns(rigid.node, axis)) {
            let what = "nodes that go with a node along some axes only, and turn with it, cannot be translated; hold the node's rotations \
                        by *BOUNDARY, couple degrees of freedom 1 to 3, or say by *EQUATION what goes together";
            return self.error(rigid.place, what);
        }
        if model.frames.contains_key(&rigid.node) {
            return self.error(rigid.place, "the reference node has axes of its own, which cannot be translated");
        }
        let name = self.groups.nodes(&model.nodes[rigid.node].label.to_string(), vec![rigid.node]);
        for axis in (0..self.dimension()).filter(|&axis| rigid.axes[axis] && !(ring && axis == 0)) {
            self.equation(rigid.place, &[(group.to_owned(), axis, 1.0), (name.clone(), axis, -1.0)]);
        }
        // A ring that does not change its shape keeps its radius.
        if ring && rigid.axes[0] {
            self.rings.push((group.to_owned(), rigid.place));
        }
    }

    /// Whether a node is held against turning about an axis in all steps.
    fn never_turns(&self, node: usize, axis: usize) -> bool {
        let mut held = false;
        for step in 0..self.model.steps.len() {
            for action in self.model.actions(step) {
                match &action.kind {
                    ActionKind::Fresh(Condition::Boundary) => held = false,
                    ActionKind::Lead(target, led, value) if *led == axis && target.members.contains(&node) => {
                        held = *value == 0.0;
                    }
                    _ => {}
                }
            }
            if !held {
                return false;
            }
        }
        true
    }
}
