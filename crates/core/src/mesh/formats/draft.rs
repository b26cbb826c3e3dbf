//! What all readers fill: nodes and elements as a file lists them, whatever their dimension, and the members of its
//! groups. [`Draft::finish`] makes the mesh of it.

use super::Note;
use super::numbering::Numbering;
use crate::error::Error;
use crate::mesh::{Behind, Cell, Faces, Group, Mesh, Numbers, Side};
use crate::tensor::Vec3;
use std::collections::BTreeMap;

/// Nodes, elements and groups of a file.
pub(super) struct Draft {
    file: String,
    points: Vec<Vec3>,
    numbers: Vec<u64>,
    index: Numbering,
    elements: Vec<Element>,
    nodes: Vec<usize>,
    groups: BTreeMap<String, Members>,
    pub notes: Vec<Note>,
}

/// An element of any dimension.
struct Element {
    number: u64,
    kind: &'static Cell,
    start: usize,
    /// Whether it can only mark a side: a truss, a shell, a membrane.
    skin: bool,
}

/// Members of a group, by index into the draft.
#[derive(Default)]
pub(super) struct Members {
    pub elements: Vec<usize>,
    /// Faces of elements.
    pub faces: Vec<(usize, usize)>,
    /// Elements of which those faces belong to the group that no other element shares.
    pub exposed: Vec<usize>,
    pub nodes: Vec<usize>,
}

impl Draft {
    pub(super) fn new(file: String) -> Self {
        let (points, numbers, elements, nodes, notes) = (vec![], vec![], vec![], vec![], vec![]);
        Self { file, points, numbers, index: Numbering::default(), elements, nodes, groups: BTreeMap::new(), notes }
    }

    /// A remark about the file, at a line where there is one.
    pub(super) fn note(&mut self, line: Option<usize>, text: impl Into<String>) {
        self.notes.push(Note { file: self.file.clone(), line, text: text.into() });
    }

    /// Adds a node under its own number.
    ///
    /// # Errors
    /// What is wrong, without its place: the number is taken, or a coordinate is not finite.
    pub(super) fn add_node(&mut self, number: u64, point: Vec3) -> Result<(), String> {
        if !point.is_finite() {
            return Err(format!("node {number} has a coordinate that is not a finite number; mend the mesh there"));
        }
        if !self.index.insert(number, self.points.len()) {
            return Err(format!("node {number} is there twice; give every node a number of its own"));
        }
        self.points.push(point);
        self.numbers.push(number);
        Ok(())
    }

    /// The node of a number.
    ///
    /// # Errors
    /// A sentence without its place if there is none.
    pub(super) fn node(&self, number: u64) -> Result<usize, String> {
        let missing = || format!("there is no node {number}; add it or correct the number");
        self.index.get(number).ok_or_else(missing)
    }

    /// The numbers of all nodes, in the order in which they came.
    pub(super) fn numbers(&self) -> impl Iterator<Item = u64> + '_ {
        self.numbers.iter().copied()
    }

    pub(super) fn node_count(&self) -> usize {
        self.points.len()
    }

    /// Adds an element, its nodes already in the order of the reference cell; returns its index.
    pub(super) fn add_element(&mut self, number: u64, kind: &'static Cell, skin: bool, nodes: &[usize]) -> usize {
        self.elements.push(Element { number, kind, start: self.nodes.len(), skin });
        self.nodes.extend_from_slice(nodes);
        self.elements.len() - 1
    }

    pub(super) fn kind(&self, element: usize) -> &'static Cell {
        self.elements[element].kind
    }

    pub(super) fn number(&self, element: usize) -> u64 {
        self.elements[element].number
    }

    /// Whether an element can only mark a side, `dimension` being that of the cells.
    pub(super) fn is_skin(&self, element: usize, dimension: usize) -> bool {
        self.elements[element].skin || self.kind(element).dimension < dimension
    }

    /// The highest dimension of any element.
    pub(super) fn dimension(&self) -> usize {
        self.elements.iter().map(|element| element.kind.dimension).max().unwrap_or(0)
    }

    pub(super) fn group_names(&self) -> impl Iterator<Item = &str> {
        self.groups.keys().map(String::as_str)
    }

    pub(super) fn nodes_of(&self, element: usize) -> &[usize] {
        let Element { start, kind, .. } = self.elements[element];
        &self.nodes[start..start + kind.nodes.len()]
    }

    /// The members of a group, new if there is none of that name.
    pub(super) fn group(&mut self, name: &str) -> &mut Members {
        if !self.groups.contains_key(name) {
            self.groups.insert(name.to_string(), Members::default());
        }
        self.groups.entry(name.to_string()).or_default()
    }

    /// The mesh: the elements of the highest dimension are its cells.
    ///
    /// # Errors
    /// [`Error::Input`] if there are no plane or solid elements.
    pub(super) fn finish(mut self) -> Result<(Mesh, Vec<Note>), Error> {
        let dimension = self.dimension();
        let is_cell = |element: &Element| element.kind.dimension == dimension && !element.skin;
        if dimension < 2 || !self.elements.iter().any(is_cell) {
            let what = if dimension < 2 { "plane or solid elements" } else { "elements that can be part of a body" };
            return Err(Error::input(format!("{}: the file has no {what}; save the cells of the bodies", self.file)));
        }
        let mut mesh = Mesh { points: std::mem::take(&mut self.points), ..Mesh::new() };
        let mut cells = vec![None; self.elements.len()];
        for (place, element) in self.elements.iter().enumerate().filter(|(_, element)| is_cell(element)) {
            cells[place] = Some(mesh.push_cell(element.kind, self.nodes_of(place)));
        }
        let numbers = self.elements.iter().filter(|element| is_cell(element)).map(|element| element.number).collect();
        mesh.numbers = Numbers { nodes: std::mem::take(&mut self.numbers), cells: numbers };
        self.fill_groups(&mut mesh, &cells);
        Ok((mesh, self.notes))
    }

    fn fill_groups(&mut self, mesh: &mut Mesh, cells: &[Option<usize>]) {
        let (faces, dimension) = (Faces::of(mesh, 0..mesh.cell_count()), mesh.dimension());
        let mut grouped = vec![false; self.elements.len()];
        for (name, members) in std::mem::take(&mut self.groups) {
            members
                .elements
                .iter()
                .chain(members.faces.iter().map(|(element, _)| element))
                .chain(&members.exposed)
                .for_each(|&element| {
                    grouped[element] = true;
                });
            let group = Sorter { draft: self, mesh, faces: &faces, cells, dimension }.sort(&name, members);
            mesh.groups.insert(name, group);
        }
        let loose = (0..cells.len()).filter(|&element| cells[element].is_none() && !grouped[element]).count();
        if loose > 0 {
            let text = format!("{loose} elements of lower dimension belong to no group and are left out");
            self.note(None, text);
        }
        if mesh.groups.is_empty() {
            self.note(None, "the file has no groups, so that no part of the mesh can be named");
        }
    }
}

/// Sorts the members of a group into cells, sides, inner faces and nodes.
struct Sorter<'a> {
    draft: &'a mut Draft,
    mesh: &'a Mesh,
    faces: &'a Faces,
    /// The cell of each element that is one.
    cells: &'a [Option<usize>],
    /// Dimension of the cells.
    dimension: usize,
}

impl Sorter<'_> {
    fn sort(self, name: &str, members: Members) -> Group {
        let mut group = Group { nodes: members.nodes, ..Group::default() };
        let mut loose = 0;
        for element in members.elements {
            let nodes = self.draft.nodes_of(element);
            let kind = self.draft.kind(element);
            group.nodes.extend_from_slice(nodes);
            match self.cells[element] {
                Some(cell) => group.cells.push(cell),
                None if kind.dimension + 1 < self.dimension => {}
                None => loose += usize::from(!put(&mut group, self.faces.behind(&nodes[..kind.linear.nodes.len()]))),
            }
        }
        for (element, face) in members.faces {
            let Some(cell) = self.cells[element] else { continue };
            let nodes: Vec<usize> = self.mesh.side(Side { cell, face }).1.collect();
            let corners = self.mesh.kinds[cell].faces[face].cell.linear.nodes.len();
            put(&mut group, self.faces.behind(&nodes[..corners]));
            group.nodes.extend(nodes);
        }
        for cell in members.exposed.into_iter().filter_map(|element| self.cells[element]) {
            for (face, reference) in self.mesh.kinds[cell].faces.iter().enumerate() {
                let nodes: Vec<usize> = self.mesh.side(Side { cell, face }).1.collect();
                if let Behind::One(side) = self.faces.behind(&nodes[..reference.cell.linear.nodes.len()]) {
                    group.sides.push(side);
                    group.nodes.extend(nodes);
                }
            }
        }
        if loose > 0 {
            let text = format!("{loose} elements of group '{name}' lie on no cell; only their nodes are kept");
            self.draft.note(None, text);
        }
        group.tidy();
        group
    }
}

/// Puts what was found behind a face into a group; false if that is no cell.
fn put(group: &mut Group, behind: Behind) -> bool {
    match behind {
        Behind::One(side) => group.sides.push(side),
        Behind::Two(pair) => group.inner.push(pair),
        Behind::Nothing => return false,
        Behind::Many(_) => {}
    }
    true
}
