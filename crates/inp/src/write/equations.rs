//! Equations.

use super::{Writer, quoted};

const AXES: [&str; 3] = ["x", "y", "z"];

impl Writer<'_> {
    /// One equation of the deck for each.
    pub(super) fn equations(&mut self) {
        let model = self.model;
        for equation in &model.equations {
            if model.rigid.iter().any(|rigid| equation.terms.iter().any(|term| term.0 == rigid.node)) {
                self.error(
                    equation.place,
                    "an equation names the reference node of a rigid body, which cannot be translated",
                );
                continue;
            }
            let said: Vec<_> = equation.terms.iter().filter(|term| term.1 < self.dimension()).collect();
            let mut text = format!("\n[[equation]]{}\nterms = [\n", self.from(equation.place));
            if said.len() < 2 {
                self.error(equation.place, "an equation with one term holds a node; write it as *BOUNDARY");
                continue;
            }
            for (node, axis, factor) in said {
                let group = self.groups.nodes(&model.nodes[*node].label.to_string(), vec![*node]);
                text += &format!(
                    "    {{ group = {}, axis = \"{}\", factor = {factor:?} }},\n",
                    quoted(&group),
                    AXES[*axis]
                );
            }
            self.text += &(text + "]\n");
        }
    }
}
