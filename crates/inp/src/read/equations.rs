//! `*EQUATION`: how many terms, then node, degree of freedom and factor of each. Where the first term names a set, there is one
//! equation for each of its nodes, in order, and sets of as many nodes go with them.

use super::Reader;
use super::names::Of;
use crate::model::Equation;
use crate::source::{DataLine, KeywordBlock};

impl Reader {
    /// `*EQUATION`.
    pub(crate) fn equation(&mut self, block: &KeywordBlock) {
        let mut lines = block.lines.iter();
        while let Some(line) = lines.next() {
            let field = line.field(0).to_string();
            let Some(count) = field.parse::<usize>().ok().filter(|count| (1..=100_000).contains(count)) else {
                let what = format!(
                    "an equation begins with the number of its terms, which '{}' is not",
                    super::shorten(&field)
                );
                return self.error(line.place, what);
            };
            let mut terms = Vec::new();
            while terms.len() < count {
                let Some(line) = lines.next() else {
                    let what = format!(
                        "the equation has {} of its {count} terms; give node, degree of freedom, factor of each",
                        terms.len()
                    );
                    return self.error(line.place, what);
                };
                for at in (0..line.fields().len()).step_by(3) {
                    let Some(term) = self.term(line, at) else { return };
                    terms.push(term);
                }
            }
            self.related(line, &terms[..count]);
        }
    }

    /// Nodes, axis and factor of a term.
    fn term(&mut self, line: &DataLine, at: usize) -> Option<(Vec<usize>, usize, f64)> {
        let name = line.field(at).to_string();
        let nodes = self.members(line.place, &name, Of::Nodes)?.members;
        Some((nodes, self.axis(line, at + 1)?, self.real(line, at + 2, "the factor")?))
    }

    /// One equation for each node of the first term.
    fn related(&mut self, line: &DataLine, terms: &[(Vec<usize>, usize, f64)]) {
        let count = terms.first().map_or(0, |term| term.0.len());
        if let Some((nodes, ..)) = terms.iter().find(|term| term.0.len() != 1 && term.0.len() != count) {
            let what = format!(
                "the sets of an equation hold {count} and {} nodes; they must hold as many, or one",
                nodes.len()
            );
            return self.error(line.place, what);
        }
        if terms.iter().any(|term| term.1 > 2) {
            return self.error(line.place, "rotations cannot stand in an equation; degrees of freedom 1 to 3 can");
        }
        for number in 0..count {
            let node = |nodes: &[usize]| nodes.get(if nodes.len() == 1 { 0 } else { number }).copied();
            let terms = terms.iter().filter_map(|(nodes, axis, factor)| Some((node(nodes)?, *axis, *factor))).collect();
            self.model.equations.push(Equation { place: line.place, terms });
        }
    }
}
