//! Nodes that go with others: `*MPC`, `*KINEMATIC COUPLING`.

use super::Reader;
use super::names::Of;
use crate::elements::{Dialect, Family};
use crate::model::{Equation, Rigid, RigidPart};
use crate::source::{DataLine, KeywordBlock};

impl Reader {
    /// `*MPC` of types PIN and TIE, which let nodes move as one, and BEAM, which makes them rigid with another.
    pub(crate) fn mpc(&mut self, block: &KeywordBlock) {
        if self.first_line(block, "a type and nodes").is_none() {
            return;
        }
        for line in &block.lines {
            let fields: Vec<String> = line.fields().iter().map(|field| field.to_ascii_uppercase()).collect();
            let kind = fields.first().map_or("", String::as_str);
            let beam = kind == "BEAM" && self.model.dialect == Dialect::Abaqus;
            if !beam && !matches!(kind, "PIN" | "TIE") {
                let what = format!(
                    "*MPC of type '{}' cannot be translated; PIN and TIE can, BEAM in decks of Abaqus; or write *EQUATION",
                    super::shorten(kind)
                );
                self.error(line.place, what);
                continue;
            }
            let [_, first, second] = fields.as_slice() else {
                self.error(
                    line.place,
                    format!("*MPC of type {kind} has two nodes or sets: what follows, and what is followed"),
                );
                continue;
            };
            match beam {
                true => self.beam(line, first, second),
                false => self.pinned(line, first, second),
            }
        }
    }

    /// Nodes that move as one.
    fn pinned(&mut self, line: &DataLine, first: &str, second: &str) {
        let (follow, lead) = (self.members(line.place, first, Of::Nodes), self.members(line.place, second, Of::Nodes));
        let (Some(follow), Some(lead)) = (follow, lead) else { return };
        if lead.members.len() != 1 && lead.members.len() != follow.members.len() {
            let what = format!(
                "the sets hold {} and {} nodes; the second must hold as many as the first, or one",
                follow.members.len(),
                lead.members.len()
            );
            return self.error(line.place, what);
        }
        for (at, &node) in follow.members.iter().enumerate() {
            let other = lead.members[if lead.members.len() == 1 { 0 } else { at }];
            for axis in 0..3 {
                let terms = vec![(node, axis, 1.0), (other, axis, -1.0)];
                self.model.equations.push(Equation { place: line.place, terms });
            }
        }
    }

    /// Nodes that are rigid with a node of no body.
    fn beam(&mut self, line: &DataLine, first: &str, second: &str) {
        let (Some(follow), Some(node)) =
            (self.members(line.place, first, Of::Nodes), self.one_node(line.place, second))
        else {
            return;
        };
        if self.model.elements.iter().any(|element| element.kind.is_cell() && element.nodes.contains(&node)) {
            let what = format!(
                "*MPC of type BEAM: '{second}' is a node of a body, which does not turn; follow a node of none"
            );
            return self.error(line.place, what);
        }
        let same = self.model.rigid.iter_mut().find(|rigid| rigid.node == node);
        if let Some(Rigid { what: RigidPart::Nodes(nodes, _), .. }) = same {
            nodes.extend(follow.members);
            nodes.sort_unstable();
            nodes.dedup();
            return;
        }
        self.model.rigid.push(Rigid::new(line.place, node, RigidPart::Nodes(follow.members, follow.name)));
    }

    /// `*KINEMATIC COUPLING`: nodes that go with a node, along the axes that are named.
    pub(crate) fn kinematic_coupling(&mut self, block: &KeywordBlock) {
        let Some(node) = self.required(block, "REF NODE").map(str::to_string) else { return };
        let Some(node) = self.one_node(block.place, &node) else { return };
        if self.first_line(block, "nodes and degrees of freedom").is_none() {
            return;
        }
        for line in &block.lines {
            let name = line.field(0).to_string();
            let Some(target) = self.members(line.place, &name, Of::Nodes) else { continue };
            let Some(axes) = self.held_axes(line, 1) else { continue };
            let what = RigidPart::Nodes(target.members, target.name);
            self.model.rigid.push(Rigid { axes, ..Rigid::new(line.place, node, what) });
        }
    }

    /// The axes from one degree of freedom to another, all where none is named.
    pub(super) fn held_axes(&mut self, line: &DataLine, at: usize) -> Option<[bool; 3]> {
        let given = |at: usize| !line.field(at).is_empty();
        if !given(at) {
            return Some([true; 3]);
        }
        let first = self.axis(line, at)?;
        let last = if given(at + 1) { self.axis(line, at + 1)? } else { first };
        Some(std::array::from_fn(|axis| (first..=last).contains(&axis)))
    }

    /// Couplings along all axes that the model has, whatever they say of the third in the plane.
    pub(super) fn end_couplings(&mut self) {
        if self.model.elements.iter().all(|element| element.kind.family != Family::Solid) {
            self.model.rigid.iter_mut().for_each(|rigid| rigid.axes[2] = rigid.axes[0] && rigid.axes[1]);
        }
    }
}
