//! Groups of the mesh: each content once, each name once, whatever sets and surfaces of the input deck are called.

use crate::model::Model;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// Members of a group.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
enum Content {
    Nodes(Vec<usize>),
    Cells(Vec<usize>),
    /// Faces of elements, or without a number all exposed faces.
    Sides(Vec<(usize, Option<usize>)>),
}

/// Which nodes are used, and new places of some.
pub type Nodes<'n> = (&'n [bool], &'n BTreeMap<usize, [f64; 3]>);

/// All groups that the deck uses.
#[derive(Debug, Default)]
pub struct Groups {
    by_content: BTreeMap<Content, String>,
    list: Vec<(String, Content)>,
    /// Names in capitals.
    taken: BTreeSet<String>,
}

impl Groups {
    /// The group of these nodes; a new one is called `name` if that is free.
    pub fn nodes(&mut self, name: &str, nodes: Vec<usize>) -> String {
        self.group(name, "nodes", Content::Nodes(nodes))
    }

    /// The group of these elements.
    pub fn cells(&mut self, name: &str, cells: Vec<usize>) -> String {
        self.group(name, "cells", Content::Cells(cells))
    }

    /// The group of these faces.
    pub fn sides(&mut self, name: &str, mut sides: Vec<(usize, Option<usize>)>) -> String {
        sides.sort_unstable();
        sides.dedup();
        self.group(name, "sides", Content::Sides(sides))
    }

    fn group(&mut self, name: &str, kind: &str, content: Content) -> String {
        if let Some(known) = self.by_content.get(&content) {
            return known.clone();
        }
        let name = self.free(name, kind);
        self.by_content.insert(content.clone(), name.clone());
        self.list.push((name.clone(), content));
        name
    }

    /// A second group with the content of the first.
    pub fn again(&mut self, name: &str, suffix: &str) -> String {
        let Some((_, content)) = self.list.iter().find(|(known, _)| known == name).cloned() else {
            return name.to_string();
        };
        let name = self.free(&format!("{name}.{suffix}"), "again");
        self.list.push((name.clone(), content));
        name
    }

    /// A name like this one that no group has.
    fn free(&mut self, name: &str, kind: &str) -> String {
        let clean: String = name.chars().filter(|c| !c.is_control() && !matches!(c, ',' | '"' | '=')).collect();
        let base = if clean.chars().all(|c| c.is_ascii_digit()) { format!("node_{clean}") } else { clean };
        let candidates = std::iter::once(base.clone())
            .chain(std::iter::once(format!("{base}.{kind}")))
            .chain((2..).map(|number| format!("{base}.{kind}.{number}")));
        for candidate in candidates {
            if self.taken.insert(candidate.to_ascii_uppercase()) {
                return candidate;
            }
        }
        base
    }

    /// Nodes, elements and groups as an input deck; elements without a section and nodes that are not used are left out.
    pub fn mesh(&self, model: &Model, section: &[Option<usize>], (used, moved): Nodes) -> String {
        let kept = |element: usize| section.get(element).copied().flatten().is_some();
        let (nodes, elements) = (shifts(model, |scope| &scope.nodes), shifts(model, |scope| &scope.elements));
        let node = |at: usize| model.nodes[at].label + nodes[model.nodes[at].scope];
        let element = |at: usize| model.elements[at].label + elements[model.elements[at].scope];
        let mut text = String::from("*NODE\n");
        for (at, found) in model.nodes.iter().enumerate().filter(|(at, _)| used[*at]) {
            let [x, y, z] = moved.get(&at).copied().unwrap_or(found.x);
            let _ = writeln!(text, "{}, {x:?}, {y:?}, {z:?}", node(at));
        }
        let mut kind = "";
        for (at, found) in model.elements.iter().enumerate().filter(|(at, _)| kept(*at)) {
            if found.kind.name != kind {
                kind = found.kind.name;
                let _ = writeln!(text, "*ELEMENT, TYPE={kind}");
            }
            let numbers: Vec<String> = std::iter::once(element(at).to_string())
                .chain(found.nodes.iter().map(|&at| node(at).to_string()))
                .collect();
            let rows: Vec<String> = numbers.chunks(14).map(|row| row.join(", ")).collect();
            let _ = writeln!(text, "{}", rows.join(",\n"));
        }
        for (name, content) in &self.list {
            match content {
                Content::Nodes(members) => {
                    let numbers = members.iter().filter(|&&at| used[at]).map(|&at| node(at));
                    write_set(&mut text, &format!("*NSET, NSET=\"{name}\""), numbers);
                }
                Content::Cells(members) => {
                    let numbers = members.iter().filter(|&&at| kept(at)).map(|&at| element(at));
                    write_set(&mut text, &format!("*ELSET, ELSET=\"{name}\""), numbers);
                }
                Content::Sides(sides) => {
                    let _ = writeln!(text, "*SURFACE, TYPE=ELEMENT, NAME=\"{name}\"");
                    for (at, face) in sides.iter().filter(|(at, _)| kept(*at)) {
                        let face = face.map_or(String::new(), |face| format!("S{face}"));
                        let _ = writeln!(text, "{}, {face}", element(*at));
                    }
                }
            }
        }
        text
    }
}

/// What is added to the numbers of each scope, so that all differ.
pub fn shifts(model: &Model, of: impl Fn(&crate::model::Scope) -> &BTreeMap<u64, usize>) -> Vec<u64> {
    let mut next = 0;
    let shift = |scope: &crate::model::Scope| {
        let own = next;
        next += of(scope).last_key_value().map_or(0, |(&label, _)| label);
        own
    };
    model.scopes.iter().map(shift).collect()
}

fn write_set(text: &mut String, head: &str, numbers: impl Iterator<Item = u64>) {
    let numbers: Vec<String> = numbers.map(|number| number.to_string()).collect();
    if numbers.is_empty() {
        return;
    }
    let _ = writeln!(text, "{head}");
    for row in numbers.chunks(12) {
        let _ = writeln!(text, "{}", row.join(", "));
    }
}
