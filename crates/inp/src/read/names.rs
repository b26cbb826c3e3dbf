//! Names of sets and surfaces, and what they stand for: `TOP`, `PLATE-1.TOP`, `17`, `PLATE-1.17`.

use super::Reader;
use crate::message::{InputPlace, suggestion};
use crate::model::{Scope, Set, Target};

/// What a name is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Of {
    /// Nodes.
    Nodes,
    /// Elements.
    Elements,
}

impl Of {
    fn noun(self) -> &'static str {
        if self == Self::Nodes { "node" } else { "element" }
    }

    fn set(self, scope: &Scope, name: &str) -> Option<Set> {
        let sets = if self == Self::Nodes { &scope.node_sets } else { &scope.element_sets };
        sets.get(&name.to_ascii_uppercase()).cloned()
    }

    fn number(self, scope: &Scope, number: u64) -> Option<usize> {
        let numbers = if self == Self::Nodes { &scope.nodes } else { &scope.elements };
        numbers.get(&number).copied()
    }
}

impl Reader {
    /// The instance that a name begins with, and the rest of it.
    pub(super) fn split<'n>(&self, name: &'n str) -> (usize, &'n str) {
        let instance = |(at, _): (usize, char)| {
            let found = self
                .model
                .scopes
                .iter()
                .position(|scope| !scope.name.is_empty() && scope.name.eq_ignore_ascii_case(&name[..at]))?;
            Some((found, &name[at + 1..]))
        };
        name.char_indices().filter(|(_, c)| *c == '.').find_map(instance).unwrap_or((self.scope, name))
    }

    /// The scope of an `INSTANCE` parameter.
    pub(super) fn instance(&mut self, place: InputPlace, name: Option<&str>) -> Option<usize> {
        let Some(name) = name else { return Some(self.scope) };
        let found = self.model.scopes.iter().position(|scope| scope.name.eq_ignore_ascii_case(name));
        if found.is_none() {
            let near = suggestion(name, self.model.scopes.iter().skip(1).map(|scope| scope.name.as_str()));
            self.error(place, format!("there is no instance '{name}'{near}"));
        }
        found
    }

    /// The members that a number or the name of a set stands for.
    pub(super) fn members(&mut self, place: InputPlace, name: &str, of: Of) -> Option<Target> {
        let (scope, rest) = self.split(name);
        self.members_in(place, scope, rest, of).map(|members| Target { name: name.to_string(), members })
    }

    /// The same within one scope.
    pub(super) fn members_in(&mut self, place: InputPlace, scope: usize, name: &str, of: Of) -> Option<Vec<usize>> {
        let found = self.model.scopes.get(scope)?;
        if let Ok(number) = name.parse::<u64>() {
            let member = of.number(found, number);
            if member.is_none() && !(of == Of::Elements && found.unknown.contains(&number)) {
                self.error(place, format!("there is no {} {number}; mend the number", of.noun()));
            }
            return member.map(|member| vec![member]);
        }
        if let Some(set) = of.set(found, name) {
            return Some(set.members);
        }
        let sets =
            |scope: &'_ Scope| if of == Of::Nodes { scope.node_sets.clone() } else { scope.element_sets.clone() };
        let key = name.to_ascii_uppercase();
        let others: Vec<Set> = self.model.scopes.iter().filter_map(|scope| of.set(scope, &key)).collect();
        let near = owned(others.iter().map(|set| &set.name)).unwrap_or_else(|| {
            let full = format!("{}.{name}", found.name);
            nearest((&full, name), sets(found).values().map(|set| set.name.as_str()))
        });
        let (other, kind) = if of == Of::Nodes { (Of::Elements, "elements") } else { (Of::Nodes, "nodes") };
        let near = match other.set(found, &key) {
            Some(_) => format!("; a set of {kind} has this name"),
            None => near,
        };
        let near = if near.is_empty() { "; a set must be defined before it is used".into() } else { near };
        self.error(place, format!("there is no set of {}s '{}'{near}", of.noun(), super::shorten(name)));
        None
    }

    /// The only node that a number or the name of a set stands for.
    pub(super) fn one_node(&mut self, place: InputPlace, name: &str) -> Option<usize> {
        let target = self.members(place, name, Of::Nodes)?;
        match target.members.as_slice() {
            &[node] => Some(node),
            members => {
                self.error(place, format!("'{name}' holds {} nodes; one is needed", members.len()));
                None
            }
        }
    }

    /// A surface by its name: its scope and its name in capitals.
    pub(super) fn named_surface(&mut self, place: InputPlace, name: &str) -> Option<(usize, String)> {
        let (scope, rest) = self.split(name);
        let key = rest.to_ascii_uppercase();
        let surfaces = &self.model.scopes.get(scope)?.surfaces;
        if surfaces.contains_key(&key) {
            return Some((scope, key));
        }
        // A part's surface is found without its instance where only one instance has it.
        let mut owners =
            (0..self.model.scopes.len()).filter(|&scope| self.model.scopes[scope].surfaces.contains_key(&key));
        if let (Some(only), None) = (owners.next(), owners.next()) {
            return Some((only, key));
        }
        let near =
            match owned(self.model.scopes.iter().filter_map(|scope| scope.surfaces.get(&key)).map(|one| &one.name)) {
                None => nearest((name, rest), surfaces.values().map(|surface| surface.name.as_str())),
                Some(which) => which,
            };
        self.error(place, format!("there is no surface '{name}'{near}"));
        None
    }

    /// A name as it is known outside its instance.
    pub(super) fn full_name(&self, name: &str) -> String {
        match self.model.scopes.get(self.scope) {
            Some(scope) if !scope.name.is_empty() => format!("{}.{name}", scope.name),
            _ => name.to_string(),
        }
    }
}

/// The nearest of some full names, by the whole of it or by what stands behind the instance.
fn nearest<'a>((full, name): (&str, &str), known: impl Iterator<Item = &'a str> + Clone) -> String {
    let whole = suggestion(full, known.clone());
    match whole.is_empty() {
        true => suggestion(name, known.map(|known| known.rsplit('.').next().unwrap_or(known))),
        false => whole,
    }
}

/// The full names of what instances have by this name, of which one is to be said.
fn owned<'a>(names: impl Iterator<Item = &'a String>) -> Option<String> {
    let names: Vec<String> = names.map(|name| format!("'{name}'")).collect();
    (!names.is_empty()).then(|| format!("; say which: {}", names.join(", ")))
}
