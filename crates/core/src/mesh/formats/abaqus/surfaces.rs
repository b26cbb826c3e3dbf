//! `*SURFACE`: faces of elements by their numbers, of element sets, or all that are exposed; or nodes.

use super::cells;
use super::lexer::{Keyword, fields};
use super::sets::Index;
use super::{Block, Place, Reader};
use crate::error::Error;

/// A surface as the file lists it.
pub(super) struct Surface {
    name: String,
    of_nodes: bool,
    /// An element, a node or a set, and the face of elements or nothing.
    lines: Vec<(String, String, Place)>,
}

impl Reader {
    pub(super) fn open_surface(&mut self, keyword: &Keyword, place: Place) -> Result<Block, Error> {
        let Some(name) = keyword.value("NAME") else {
            return Err(self.error(place, "*SURFACE has no name; write *SURFACE, NAME=..., TYPE=ELEMENT"));
        };
        let kind = keyword.value("TYPE").unwrap_or("ELEMENT").to_ascii_uppercase();
        if keyword.has("COMBINE") || keyword.has("CROP") {
            return Err(self.error(place, "surfaces made of other surfaces are not read; list the faces themselves"));
        }
        if kind != "ELEMENT" && kind != "NODE" {
            let text = format!("surface '{name}' of type {kind} is not used; draw rigid tools in the deck");
            self.note(place, text);
            return Ok(Block::Ignored);
        }
        self.note_parameters(keyword, &["NAME", "TYPE", "INTERNAL", "INPUT"], place);
        self.surfaces.push(Surface { name: name.to_string(), of_nodes: kind == "NODE", lines: vec![] });
        Ok(Block::Surface)
    }

    pub(super) fn surface_line(&mut self, data: &str, place: Place) -> Result<(), Error> {
        let mut fields = fields(data).map(|field| field.trim_matches('"').to_string());
        let (what, face) = (fields.next().unwrap_or_default(), fields.next().unwrap_or_default());
        if what.is_empty() {
            return Err(self.error(place, "a line of a surface names an element or a set; mend it"));
        }
        if let Some(surface) = self.surfaces.last_mut() {
            surface.lines.push((what, face, place));
        }
        Ok(())
    }

    pub(super) fn fill_surfaces(&mut self, elements: &Index) -> Result<(), Error> {
        let nodes = Index::of(self.draft.numbers());
        for surface in std::mem::take(&mut self.surfaces) {
            let name = self.group_name(&surface.name);
            self.draft.group(&name);
            for (what, face, place) in &surface.lines {
                match surface.of_nodes {
                    true => {
                        let members = self.members(&nodes, what, true, *place)?;
                        self.draft.group(&name).nodes.extend(members);
                    }
                    false => {
                        let members = self.members(elements, what, false, *place)?;
                        self.add_faces(&name, &members, face, *place)?;
                    }
                }
            }
        }
        Ok(())
    }

    /// The nodes or elements that a line names by a number or a set.
    fn members(&self, index: &Index, what: &str, of_nodes: bool, place: Place) -> Result<Vec<usize>, Error> {
        let noun = if of_nodes { "node" } else { "element" };
        if let Ok(number) = what.parse::<u64>() {
            let missing = || self.error(place, format!("there is no {noun} {number}; mend the surface"));
            return index.get(number).map(|place| vec![place]).ok_or_else(missing);
        }
        let sets = if of_nodes { &self.node_sets } else { &self.element_sets };
        let Some(set) = sets.get(what) else {
            let hint = match crate::declare::nearest(what, sets.iter().map(|set| set.name.as_str())) {
                Some(near) => format!("did you mean '{near}'?"),
                None => "define the set".into(),
            };
            return Err(self.error(place, format!("there is no set of {noun}s '{what}'; {hint}")));
        };
        let found = index
            .members(set)
            .map_err(|(number, _)| self.error(place, format!("there is no {noun} {number}; mend the set")))?;
        Ok(found.members)
    }

    /// Adds faces of elements to a group: those of one number, or without a number all that are exposed.
    fn add_faces(&mut self, name: &str, elements: &[usize], label: &str, place: Place) -> Result<(), Error> {
        if label.is_empty() {
            let dimension = self.draft.dimension();
            let (skins, bodies): (Vec<usize>, Vec<usize>) =
                elements.iter().partition(|&&element| self.draft.is_skin(element, dimension));
            let group = self.draft.group(name);
            group.elements.extend(skins);
            group.exposed.extend(bodies);
            return Ok(());
        }
        for &element in elements {
            let cell = self.draft.kind(element);
            let Some(face) = cells::face(cell, label) else {
                let number = self.draft.number(element);
                let (faces, shape) = (cell.faces.len(), cell.name);
                let what = format!("element {number} ({shape}) has no face '{label}'; its faces are S1 to S{faces}");
                return Err(self.error(place, what));
            };
            self.draft.group(name).faces.push((element, face));
        }
        Ok(())
    }
}
