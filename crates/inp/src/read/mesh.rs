//! Nodes, elements, their sets and surfaces.

use super::Reader;
use super::names::Of;
use crate::elements::{self, Type};
use crate::message::InputPlace;
use crate::model::{Element, Node, Set, Surface, SurfaceKind};
use crate::source::{DataLine, KeywordBlock};

/// More members than this of all sets together are taken for sets that copy one another without end.
const MOST_MEMBERS: usize = 100_000_000;

/// The largest number of a node or element.
const MOST_NUMBER: u64 = 1_000_000_000_000;

impl Reader {
    /// `*NODE`.
    pub(crate) fn nodes(&mut self, block: &KeywordBlock) {
        let first = self.model.nodes.len();
        for line in &block.lines {
            self.node(line);
        }
        if let Some(name) = block.value("NSET") {
            self.extend(name, Of::Nodes, (first..self.model.nodes.len()).collect(), false);
        }
    }

    fn node(&mut self, line: &DataLine) -> Option<()> {
        let label = self.whole(line, 0, "the number of a node")?;
        let mut x = [0.0; 3];
        for (axis, value) in x.iter_mut().enumerate() {
            *value = self.real_or(line, axis + 1, "a coordinate", 0.0)?;
        }
        for at in 4..7 {
            self.real_or(line, at, "a component of the normal", 0.0)?;
        }
        let (x, scope) = (self.placed(x), self.scope);
        let index = self.model.nodes.len();
        if self.model.scopes.get_mut(scope)?.nodes.insert(label, index).is_some() {
            self.error(line.place, format!("node {label} is there twice; give each a number of its own"));
        }
        self.model.nodes.push(Node { label, scope, x });
        Some(())
    }

    fn whole(&mut self, line: &DataLine, at: usize, what: &str) -> Option<u64> {
        let field = line.field(at);
        let number = field.parse::<u64>().ok().filter(|number| (1..=MOST_NUMBER).contains(number));
        if number.is_none() {
            self.error(
                line.place,
                format!("{what} is '{}', which is not a whole number from 1 to {MOST_NUMBER}", super::shorten(field)),
            );
        }
        number
    }

    /// `*ELEMENT`.
    pub(crate) fn elements(&mut self, block: &KeywordBlock) {
        let Some(name) = self.required(block, "TYPE") else { return };
        let Some((kind, variant)) = elements::named(name) else {
            let known: Vec<&str> = elements::TYPES.iter().filter(|kind| kind.is_cell()).map(|kind| kind.name).collect();
            let what =
                format!("elements of type {name} cannot be solved; {} can, with their variants", known.join(", "));
            self.error(block.place, what);
            return self.unknown_elements(block);
        };
        let (mut open, first): (Option<Element>, usize) = (None, self.model.elements.len());
        for line in &block.lines {
            let mut fields = line.fields().into_iter();
            if open.is_none() {
                let Some(label) = self.whole(line, 0, "the number of an element") else { continue };
                fields.next();
                let (scope, variant) = (self.scope, variant.clone());
                open = Some(Element { label, scope, kind, variant, nodes: vec![], place: line.place });
            }
            let Some(element) = open.as_mut() else { continue };
            let mut sound = true;
            for field in fields.filter(|field| !field.is_empty()) {
                let found = field
                    .parse()
                    .ok()
                    .and_then(|label: u64| self.model.scopes.get(self.scope)?.nodes.get(&label).copied());
                match found {
                    Some(node) => element.nodes.push(node),
                    None => {
                        sound = false;
                        let what = format!("element {}: there is no node '{}'", element.label, super::shorten(field));
                        self.messages.error(line.place, what);
                    }
                }
            }
            if !sound {
                open = None;
            } else if element.nodes.len() >= kind.nodes {
                self.push(open.take(), kind);
            }
        }
        if let Some(element) = open {
            let (has, needs) = (element.nodes.len(), kind.nodes);
            self.error(
                element.place,
                format!("element {} has {has} nodes but {} needs {needs}", element.label, kind.name),
            );
        }
        if let Some(name) = block.value("ELSET") {
            self.extend(name, Of::Elements, (first..self.model.elements.len()).collect(), false);
        }
    }

    /// What names elements of an unknown type is not told as well.
    fn unknown_elements(&mut self, block: &KeywordBlock) {
        let labels = block.lines.iter().filter_map(|line| line.field(0).parse::<u64>().ok());
        if let Some(scope) = self.model.scopes.get_mut(self.scope) {
            scope.unknown.extend(labels);
        }
        if let Some(name) = block.value("ELSET") {
            self.extend(name, Of::Elements, vec![], false);
        }
    }

    fn push(&mut self, element: Option<Element>, kind: &'static Type) {
        let Some(element) = element else { return };
        if element.nodes.len() > kind.nodes {
            let (has, needs) = (element.nodes.len(), kind.nodes);
            return self.error(
                element.place,
                format!("element {} has {has} nodes but {} has {needs}", element.label, kind.name),
            );
        }
        let index = self.model.elements.len();
        if let Some(scope) = self.model.scopes.get_mut(self.scope)
            && scope.elements.insert(element.label, index).is_some()
        {
            self.error(
                element.place,
                format!("element {} is there twice; give each a number of its own", element.label),
            );
        }
        self.model.elements.push(element);
    }

    /// Adds members to a set, new if there is none of that name.
    fn extend(&mut self, name: &str, of: Of, members: Vec<usize>, internal: bool) {
        let full = self.full_name(name);
        let Some(scope) = self.model.scopes.get_mut(self.scope) else { return };
        let sets = if of == Of::Nodes { &mut scope.node_sets } else { &mut scope.element_sets };
        let set =
            sets.entry(name.to_ascii_uppercase()).or_insert_with(|| Set { name: full, members: vec![], internal });
        set.members.extend(members);
        set.members.sort_unstable();
        set.members.dedup();
    }

    /// `*NSET`.
    pub(crate) fn node_set(&mut self, block: &KeywordBlock) {
        self.set(block, Of::Nodes);
    }

    /// `*ELSET`.
    pub(crate) fn element_set(&mut self, block: &KeywordBlock) {
        self.set(block, Of::Elements);
    }

    fn set(&mut self, block: &KeywordBlock, of: Of) {
        let Some(name) = self.required(block, &block.name) else { return };
        let Some(scope) = self.instance(block.place, block.value("INSTANCE")) else { return };
        let mut members = Vec::new();
        if let (Of::Nodes, Some(elements)) = (of, block.value("ELSET")) {
            let found = self.members_in(block.place, scope, elements, Of::Elements).unwrap_or_default();
            members.extend(found.iter().flat_map(|&element| self.model.elements[element].nodes.clone()));
        }
        for line in &block.lines {
            match block.has("GENERATE") {
                true => members.extend(self.range(line, scope, of)),
                false => members.extend(self.listed(line, scope, of)),
            }
            if members.len() > MOST_MEMBERS {
                return self
                    .error(line.place, "the sets hold too many members; define them without copying one another");
            }
        }
        self.extend(name, of, members, block.has("INTERNAL"));
    }

    fn listed(&mut self, line: &DataLine, scope: usize, of: Of) -> Vec<usize> {
        let fields: Vec<String> = line.fields().iter().filter(|f| !f.is_empty()).map(|f| (*f).to_string()).collect();
        let member = |name: &String| match self.split(name) {
            (own, rest) if own == self.scope => (scope, rest.to_string()),
            (other, rest) => (other, rest.to_string()),
        };
        let named: Vec<(usize, String)> = fields.iter().map(member).collect();
        named.iter().filter_map(|(scope, name)| self.members_in(line.place, *scope, name, of)).flatten().collect()
    }

    /// The members of a range that exist.
    fn range(&mut self, line: &DataLine, scope: usize, of: Of) -> Vec<usize> {
        let numbers: Result<Vec<u64>, _> = line.fields().iter().map(|field| field.parse::<u64>()).collect();
        let (first, last, step) = match numbers.as_deref() {
            Ok(&[first, last]) if first <= last => (first, last, 1),
            Ok(&[first, last, step]) if first <= last && step > 0 => (first, last, step),
            _ => {
                self.error(line.place, "a line under GENERATE holds first, last and step, increasing; mend it");
                return vec![];
            }
        };
        let Some(scope) = self.model.scopes.get(scope) else { return vec![] };
        let numbers = if of == Of::Nodes { &scope.nodes } else { &scope.elements };
        let found: Vec<usize> =
            numbers.range(first..=last).filter(|(n, _)| (*n - first).is_multiple_of(step)).map(|(_, &i)| i).collect();
        let wanted = (last - first) / step + 1;
        if of == Of::Elements && !scope.unknown.is_empty() {
            return found;
        }
        if found.is_empty() {
            self.error(line.place, format!("nothing has a number from {first} to {last} by {step}"));
        } else if (found.len() as u64) < wanted {
            let what = format!("{} of the {wanted} numbers from {first} to {last} are there", found.len());
            self.note(line.place, what);
        }
        found
    }

    /// `*SURFACE`.
    pub(crate) fn surface(&mut self, block: &KeywordBlock) {
        let Some(name) = self.required(block, "NAME") else { return };
        let kind = match block.word("TYPE").as_deref() {
            None | Some("ELEMENT") => {
                SurfaceKind::Faces(block.lines.iter().flat_map(|line| self.faces(line)).collect())
            }
            Some("NODE") => {
                let named: Vec<(InputPlace, String)> = block
                    .lines
                    .iter()
                    .map(|line| {
                        self.real_or(line, 1, "the area of a node", 0.0);
                        (line.place, line.field(0).to_string())
                    })
                    .collect();
                let found = named.iter().filter_map(|(place, name)| self.members(*place, name, Of::Nodes));
                SurfaceKind::Nodes(found.flat_map(|target| target.members).collect())
            }
            Some(kind) => match self.profile(block, kind) {
                Some(profile) => SurfaceKind::Analytical(profile),
                None => return,
            },
        };
        if block.lines.is_empty() {
            self.error(block.place, format!("surface '{name}' is empty; list its faces below"));
        }
        let surface = Surface { name: self.full_name(name), place: block.place, kind };
        if let Some(scope) = self.model.scopes.get_mut(self.scope) {
            let key = name.to_ascii_uppercase();
            // One name may be that of nodes and of the faces between them: the faces say more.
            let of_nodes = matches!(surface.kind, SurfaceKind::Nodes(_));
            let known = scope.surfaces.get(&key).is_some_and(|known| matches!(known.kind, SurfaceKind::Faces(_)));
            if of_nodes && known {
                return self.note(block.place, format!("'{name}' is a surface of faces too, which holds"));
            }
            scope.surfaces.insert(key, surface);
        }
    }

    /// The faces that a line of a surface names.
    fn faces(&mut self, line: &DataLine) -> Vec<(usize, Option<usize>, bool)> {
        let (name, label) = (line.field(0).to_string(), line.field(1));
        if name.is_empty() {
            self.error(line.place, "a line of a surface names an element or a set; mend it");
            return vec![];
        }
        let label = label.to_ascii_uppercase();
        let Some(target) = self.members(line.place, &name, Of::Elements) else { return vec![] };
        let mut faces = Vec::new();
        for element in target.members {
            match self.face(line.place, element, &label) {
                Some((face, negative)) => faces.push((element, face, negative)),
                None => break,
            }
        }
        faces
    }

    /// The number of a face of an element, and whether its negative side is meant.
    pub(super) fn face(&mut self, place: InputPlace, element: usize, label: &str) -> Option<(Option<usize>, bool)> {
        let found = self.model.elements.get(element)?;
        let count = found.kind.faces.len();
        let rigid = found.kind.family == elements::Family::Rigid;
        match label {
            "" => return Some((None, false)),
            "SPOS" if rigid => return Some((Some(1), false)),
            "SNEG" if rigid => return Some((Some(1), true)),
            _ => {}
        }
        let digits = label.strip_prefix('S').filter(|digits| digits.chars().all(|c| c.is_ascii_digit()));
        let number = digits.and_then(|digits| digits.parse::<usize>().ok());
        match number.filter(|number| (1..=count).contains(number)) {
            Some(number) => Some((Some(number), false)),
            None => {
                let what = format!(
                    "element {} ({}) has no face '{}'; its faces are S1 to S{count}",
                    found.label,
                    found.kind.name,
                    super::shorten(label)
                );
                self.error(place, what);
                None
            }
        }
    }
}
