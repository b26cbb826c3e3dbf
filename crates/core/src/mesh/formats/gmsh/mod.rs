//! Gmsh's mesh files, versions 2.2 and 4.1, as text or binary of either byte order.
//!
//! The format is described in the Gmsh reference manual, "MSH file format". Physical groups become groups of the mesh
//! under their names; one without a name becomes `curve_7` or the like, by its dimension and number. Elements without
//! a physical group are kept if they are cells.

mod cells;
mod cursor;
mod v2;
mod v4;

use super::Note;
use super::draft::Draft;
use crate::error::Error;
use crate::mesh::Mesh;
use cursor::Cursor;
use std::collections::BTreeMap;
use std::path::Path;

/// Names of the physical groups by dimension and number.
type Names = BTreeMap<(i64, i64), String>;

/// A file that is being read.
struct Reader<'a> {
    cursor: Cursor<'a>,
    draft: Draft,
    names: Names,
    /// Physical groups of each geometric entity, by dimension and number; version 4 only.
    entities: BTreeMap<(i64, i64), Vec<i64>>,
    /// Sections read so far.
    seen: Vec<String>,
}

/// Reads a file's content.
pub(super) fn read(path: &Path, bytes: &[u8]) -> Result<(Mesh, Vec<Note>), Error> {
    let file = path.display().to_string();
    let (cursor, draft) = (Cursor::new(file.clone(), bytes), Draft::new(file));
    let mut reader = Reader { cursor, draft, names: Names::new(), entities: BTreeMap::new(), seen: vec![] };
    let version = reader.header()?;
    while let Some(section) = reader.cursor.next_section()? {
        reader.section(&section, version)?;
        reader.seen.push(section);
    }
    for needed in ["Nodes", "Elements"] {
        if !reader.seen.iter().any(|section| section == needed) {
            return Err(reader
                .cursor
                .error(format!("the file ends without '${needed}'; write it again, it is cut off")));
        }
    }
    reader.draft.finish()
}

#[derive(Clone, Copy, PartialEq)]
enum Version {
    V2,
    V4,
}

impl Reader<'_> {
    fn header(&mut self) -> Result<Version, Error> {
        let cursor = &mut self.cursor;
        if cursor.next_section()?.as_deref() != Some("MeshFormat") {
            return Err(cursor.section_error("the file does not begin with '$MeshFormat'; save it from Gmsh as .msh"));
        }
        let version = match cursor.word()? {
            "2.2" | "2.1" | "2" => Version::V2,
            "4.1" => Version::V4,
            other => {
                let advice = "save it with -format msh41 or -format msh22";
                return Err(cursor.error(format!("Gmsh's format {other} is not read; {advice}")));
            }
        };
        let binary = cursor.int("the file type")?;
        if !(binary == 0 || binary == 1) {
            return Err(cursor
                .error(format!("the file type is 0 for text or 1 for binary, not {binary}; the header is damaged")));
        }
        if cursor.int("the size of a number")? != 8 {
            return Err(cursor.error("numbers must have 8 bytes; save the file on a machine of today"));
        }
        cursor.rest_of_line()?;
        if binary == 1 {
            self.byte_order()?;
        }
        self.cursor.end_section()?;
        Ok(version)
    }

    /// The header of a binary file holds the number one.
    fn byte_order(&mut self) -> Result<(), Error> {
        self.cursor.binary = true;
        match self.cursor.int("one")? {
            1 => Ok(()),
            0x0100_0000 => {
                self.cursor.big_endian = true;
                Ok(())
            }
            other => Err(self.cursor.error(format!("the header should hold the number 1, not {other}; it is damaged"))),
        }
    }

    fn section(&mut self, section: &str, version: Version) -> Result<(), Error> {
        let twice = self.seen.iter().any(|seen| seen == section);
        match (section, version) {
            ("Nodes" | "Elements" | "Entities", _) if twice => {
                return Err(self.cursor.section_error(format!("'${section}' is there twice; one file holds one mesh")));
            }
            ("PhysicalNames", _) => self.physical_names()?,
            ("Nodes", Version::V2) => self.nodes_v2()?,
            ("Elements", Version::V2) => self.elements_v2()?,
            ("Entities", Version::V4) => self.entities_v4()?,
            ("Nodes", Version::V4) => self.nodes_v4()?,
            ("Elements", Version::V4) => self.elements_v4()?,
            ("PartitionedEntities", _) => {
                return Err(self.cursor.section_error("the mesh is cut into partitions; save it without them"));
            }
            ("ParametricNodes", _) => {
                return Err(self.cursor.section_error("parametric nodes are not read; set Mesh.SaveParametric = 0"));
            }
            _ => return self.ignored(section),
        }
        self.cursor.end_section()
    }

    fn ignored(&mut self, section: &str) -> Result<(), Error> {
        let line = self.cursor.line_number();
        self.cursor.skip_section()?;
        if section != "Comments" {
            self.draft.note(line, format!("'${section}' is not used"));
        }
        Ok(())
    }

    fn physical_names(&mut self) -> Result<(), Error> {
        // Names are text in binary files too.
        let binary = std::mem::replace(&mut self.cursor.binary, false);
        let count = self.cursor.count(3, "physical names")?;
        for _ in 0..count {
            let dimension = self.cursor.int("the dimension of a physical group")?;
            let number = self.cursor.int("the number of a physical group")?;
            let name = self.cursor.rest_of_line()?.trim_matches('"').to_string();
            if name.is_empty() {
                return Err(self.cursor.error(format!("physical group {number} has an empty name; name it")));
            }
            self.name_group((dimension, number), name);
        }
        self.cursor.binary = binary;
        Ok(())
    }

    /// Notes a name that groups of several dimensions share: they become one group.
    fn name_group(&mut self, group: (i64, i64), name: String) {
        if self.names.iter().any(|(known, other)| *other == name && *known != group) {
            self.draft.note(None, format!("several physical groups are called '{name}'; they become one"));
        }
        self.names.insert(group, name);
    }

    /// The name of a physical group; one without a name is noted once.
    fn group_name(&mut self, dimension: i64, number: i64) -> String {
        if let Some(name) = self.names.get(&(dimension, number)) {
            return name.clone();
        }
        let noun = ["point", "curve", "surface", "volume"][dimension.clamp(0, 3) as usize];
        let name = format!("{noun}_{number}");
        self.draft.note(None, format!("physical {noun} {number} has no name; it is called '{name}'"));
        self.names.insert((dimension, number), name.clone());
        name
    }

    /// Adds an element of a type to its physical groups; a point only brings its node. The index, if it is no point.
    fn add(&mut self, element: Listed<'_>, physical: &[i64]) -> Result<Option<usize>, Error> {
        let nodes: Result<Vec<usize>, String> = element.nodes.iter().map(|&node| self.draft.node(node)).collect();
        let nodes = nodes.map_err(|what| self.cursor.error(format!("element {}: {what}", element.number)))?;
        let index = element.found.map(|found| {
            let nodes = found.reorder(&nodes);
            self.draft.add_element(element.number, found.cell, false, &nodes)
        });
        let dimension = element.found.map_or(0, |found| found.cell.dimension as i64);
        for &number in physical {
            let name = self.group_name(dimension, number);
            let group = self.draft.group(&name);
            match index {
                Some(index) => group.elements.push(index),
                None => group.nodes.extend_from_slice(&nodes),
            }
        }
        Ok(index)
    }
}

/// An element as the file lists it; without a type it is a point.
struct Listed<'a> {
    number: u64,
    found: Option<&'static cells::Type>,
    nodes: &'a [u64],
}

/// The type of a number, none for a point, and how many nodes it has.
fn element_type(cursor: &Cursor<'_>, number: i64) -> Result<(Option<&'static cells::Type>, usize), Error> {
    if number == cells::POINT {
        return Ok((None, 1));
    }
    let found = cells::named(number).map_err(|what| cursor.error(what))?;
    Ok((Some(found), found.cell.nodes.len()))
}
