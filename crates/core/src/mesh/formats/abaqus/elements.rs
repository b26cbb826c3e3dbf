//! `*NODE`, `*ELEMENT`, `*NSET` and `*ELSET`: their parameters and lines, and how they fill the draft.

use super::cells::{self, Type};
use super::lexer::{FLAGS, Keyword, fields};
use super::sets::{Index, Sets};
use super::{Block, Of, Place, Reader};
use crate::error::Error;
use crate::tensor::Vec3;

/// Elements as the file lists them; their nodes may come later.
#[derive(Default)]
pub(super) struct Elements {
    list: Vec<Element>,
    /// Nodes of all elements, by their numbers; the last element may still be incomplete.
    nodes: Vec<u64>,
    /// Types whose letters ask for something that the deck decides.
    variants: Vec<String>,
}

struct Element {
    number: u64,
    found: &'static Type,
    start: usize,
    place: Place,
}

impl Elements {
    /// The last element, if nodes of it are still to come, and how many.
    fn wanting(&self) -> Option<(&Element, usize)> {
        let last = self.list.last()?;
        let wanting = last.start + last.found.cell.nodes.len() - self.nodes.len();
        (wanting > 0).then_some((last, wanting))
    }

    /// What is wrong if the last element is incomplete.
    pub(super) fn unfinished(&self) -> Option<(Place, String)> {
        let (last, wanting) = self.wanting()?;
        let (needs, name) = (last.found.cell.nodes.len(), last.found.name);
        let has = needs - wanting;
        Some((last.place, format!("element {} has {has} nodes but {name} needs {needs}; list them all", last.number)))
    }
}

impl Reader {
    pub(super) fn open_nodes(&mut self, keyword: &Keyword, place: Place) -> Result<Block, Error> {
        if keyword.value("SYSTEM").is_some_and(|system| !system.eq_ignore_ascii_case("R")) {
            return Err(self.error(place, "only rectangular coordinates are read; convert those of the nodes"));
        }
        self.note_parameters(keyword, &["NSET", "SYSTEM", "INPUT"], place);
        let set = keyword.value("NSET").map(str::to_string);
        if let Some(name) = &set {
            self.node_sets.open(name);
        }
        Ok(Block::Nodes { set })
    }

    /// A node: its number and up to three coordinates; missing ones are zero.
    pub(super) fn node(&mut self, data: &str, set: Option<&str>, place: Place) -> Result<(), Error> {
        let mut fields = fields(data);
        let number = self.number(fields.next().unwrap_or(""), "a node", place)?;
        let mut point = Vec3::zero();
        for (a, field) in fields.by_ref().take(3).enumerate() {
            point[a] = self.real(field, place)?;
        }
        if fields.count() > 3 {
            let what = format!("node {number} has too many fields; one line holds a number and three coordinates");
            return Err(self.error(place, what));
        }
        self.draft.add_node(number, point).map_err(|what| self.error(place, what))?;
        match set {
            Some(set) => self.node_sets.add_known(set, number, place).map_err(|what| self.error(place, what)),
            None => Ok(()),
        }
    }

    /// A number of a node or an element.
    pub(super) fn number(&self, field: &str, of: &str, place: Place) -> Result<u64, Error> {
        field.parse().map_err(|_| {
            self.error(place, format!("'{}' is not the number of {of}; write a whole number", shorten(field)))
        })
    }

    /// A coordinate, with the exponents of Fortran too; an empty field is zero.
    fn real(&self, field: &str, place: Place) -> Result<f64, Error> {
        if field.is_empty() {
            return Ok(0.0);
        }
        let number = field.parse().or_else(|_| field.replace(['d', 'D'], "e").parse());
        number.map_err(|_| self.error(place, format!("'{}' is not a coordinate; write a number", shorten(field))))
    }

    pub(super) fn open_elements(&mut self, keyword: &Keyword, place: Place) -> Result<Block, Error> {
        let Some(name) = keyword.value("TYPE") else {
            return Err(self.error(place, "*ELEMENT names no type; write *ELEMENT, TYPE=C3D8 or the like"));
        };
        let (found, variant) = cells::named(name).map_err(|what| self.error(place, what))?;
        if !variant.is_empty() && !self.elements.variants.iter().any(|known| known.eq_ignore_ascii_case(name)) {
            self.elements.variants.push(name.to_ascii_uppercase());
        }
        self.note_parameters(keyword, &["TYPE", "ELSET", "INPUT"], place);
        let set = keyword.value("ELSET").map(str::to_string);
        if let Some(name) = &set {
            self.element_sets.open(name);
        }
        Ok(Block::Elements { found, set })
    }

    /// A line of an element: its number and nodes, or more nodes of the element before.
    pub(super) fn element(
        &mut self,
        data: &str,
        found: &'static Type,
        set: Option<&str>,
        place: Place,
    ) -> Result<(), Error> {
        let mut fields = fields(data);
        if self.elements.wanting().is_none() {
            let number = self.number(fields.next().unwrap_or(""), "an element", place)?;
            self.elements.list.push(Element { number, found, start: self.elements.nodes.len(), place });
            if let Some(set) = set {
                self.element_sets.add_known(set, number, place).map_err(|what| self.error(place, what))?;
            }
        }
        for field in fields {
            let node = self.number(field, "a node", place)?;
            if self.elements.wanting().is_none() {
                let last = self.elements.list.last().map_or(0, |element| element.number);
                let needs = found.cell.nodes.len();
                let what = format!("element {last} has more than the {needs} nodes of {}; mend the line", found.name);
                return Err(self.error(place, what));
            }
            self.elements.nodes.push(node);
        }
        Ok(())
    }

    pub(super) fn open_set(&mut self, keyword: &Keyword, of: Of, place: Place) -> Result<Block, Error> {
        let parameter = keyword.name.clone();
        let Some(name) = keyword.value(&parameter) else {
            return Err(self.error(place, format!("*{parameter} has no name; write *{parameter}, {parameter}=NAME")));
        };
        if keyword.has("INSTANCE") || (of == Of::Nodes && keyword.has("ELSET")) {
            return Err(self.error(place, "only sets that list their members are read; write the members out"));
        }
        let known: Vec<&str> = FLAGS.into_iter().chain([parameter.as_str(), "INPUT"]).collect();
        self.note_parameters(keyword, &known, place);
        self.sets(of).open(name);
        Ok(Block::Set { of, name: name.to_string(), generate: keyword.has("GENERATE") })
    }

    fn sets(&mut self, of: Of) -> &mut Sets {
        match of {
            Of::Nodes => &mut self.node_sets,
            Of::Elements => &mut self.element_sets,
        }
    }

    /// A line of a set: numbers and names of sets, or one range.
    pub(super) fn set_line(&mut self, data: &str, set: (Of, &str, bool), place: Place) -> Result<(), Error> {
        let (of, name, generate) = set;
        if generate {
            let range = self.range(data, place)?;
            return self.sets(of).add(name, range, place).map_err(|what| self.error(place, what));
        }
        for field in fields(data).filter(|field| !field.is_empty()) {
            let added = match field.parse::<u64>() {
                Ok(number) => self.sets(of).add(name, [number, number, 1], place),
                Err(_) => self.sets(of).include(name, field.trim_matches('"')),
            };
            added.map_err(|what| self.error(place, what))?;
        }
        Ok(())
    }

    /// First, last and step of a range; the step is one unless it is given.
    fn range(&self, data: &str, place: Place) -> Result<[u64; 3], Error> {
        let numbers: Result<Vec<u64>, _> = fields(data).map(str::parse).collect();
        match numbers.as_deref() {
            Ok(&[first, last]) if first <= last => Ok([first, last, 1]),
            Ok(&[first, last, step]) if first <= last && step > 0 => Ok([first, last, step]),
            _ => Err(self.error(place, "a line under GENERATE holds first, last and step, increasing; mend it")),
        }
    }

    /// Fills the draft with elements, sets and surfaces.
    pub(super) fn fill_draft(&mut self) -> Result<(), Error> {
        let elements = std::mem::take(&mut self.elements);
        let index = Index::of(elements.list.iter().map(|element| element.number));
        if let Some((number, places)) = index.repeated() {
            let place = elements.list[places[0].max(places[1])].place;
            return Err(self.error(place, format!("element {number} is there twice; give each a number of its own")));
        }
        for element in &elements.list {
            self.fill_element(element, &elements.nodes)?;
        }
        self.note_types(&elements);
        self.fill_sets(&index)?;
        self.fill_surfaces(&index)
    }

    fn fill_element(&mut self, element: &Element, nodes: &[u64]) -> Result<(), Error> {
        let found = element.found;
        let numbers = &nodes[element.start..element.start + found.cell.nodes.len()];
        let places: Result<Vec<usize>, String> = numbers.iter().map(|&number| self.draft.node(number)).collect();
        let places = places.map_err(|what| self.error(element.place, format!("element {}: {what}", element.number)))?;
        let ordered: Vec<usize> = match found.order {
            [] => places,
            order => order.iter().map(|&place| places[place]).collect(),
        };
        self.draft.add_element(element.number, found.cell, found.skin, &ordered);
        Ok(())
    }

    fn note_types(&mut self, elements: &Elements) {
        if !elements.variants.is_empty() {
            let names = elements.variants.join(", ");
            self.draft.note(None, format!("only the shape of {names} is read; the deck chooses the integration"));
        }
        let mut skins: Vec<&str> = elements.list.iter().filter(|e| e.found.skin).map(|e| e.found.name).collect();
        skins.sort_unstable();
        skins.dedup();
        if !skins.is_empty() {
            let names = skins.join(", ");
            self.draft.note(None, format!("elements of type {names} are no part of a body; they only mark its sides"));
        }
    }

    fn fill_sets(&mut self, elements: &Index) -> Result<(), Error> {
        let nodes = Index::of(self.draft.numbers());
        for (of, sets) in
            [(Of::Nodes, std::mem::take(&mut self.node_sets)), (Of::Elements, std::mem::take(&mut self.element_sets))]
        {
            for set in sets.iter() {
                let (index, noun) = if of == Of::Nodes { (&nodes, "node") } else { (elements, "element") };
                let found = index.members(set).map_err(|(number, place)| {
                    self.error(place, format!("set '{}': there is no {noun} {number}; mend the set", set.name))
                })?;
                if found.missing > 0 {
                    let text = format!("set '{}': {} numbers of its ranges do not exist", set.name, found.missing);
                    self.draft.note(None, text);
                }
                let name = self.group_name(&set.name);
                let group = self.draft.group(&name);
                let members = if of == Of::Nodes { &mut group.nodes } else { &mut group.elements };
                members.extend(found.members);
            }
            *self.sets(of) = sets;
        }
        Ok(())
    }

    /// The name under which a group is kept: as first written, whatever the case.
    pub(super) fn group_name(&self, name: &str) -> String {
        let known = self.draft.group_names().find(|known| known.eq_ignore_ascii_case(name));
        known.unwrap_or(name).to_string()
    }
}

/// A field short enough for a message.
fn shorten(field: &str) -> String {
    match field.char_indices().nth(24) {
        Some((end, _)) => format!("{}...", &field[..end]),
        None => field.to_string(),
    }
}
