//! The mesh itself: points, cells of any kinds, named groups.

use super::{Cell, Group, Side, Space};
use crate::error::Error;
use crate::tensor::{BoundingBox, Vec3};
use std::collections::BTreeMap;

/// Distance from the origin of the coordinates over the extent of a mesh beyond which it has an origin of its own: its gaps would lose
/// two digits and more.
const FAR: f64 = 100.0;

/// Points, cells and groups. Plane meshes have z = 0; axisymmetric ones are drawn in (r, z) = (x, y).
#[derive(Debug, Clone)]
pub struct Mesh {
    /// Positions of the nodes, undeformed, from the origin of the mesh.
    pub points: Vec<Vec3>,
    /// Where that lies in the coordinates of the deck and of the mesh's file: zero but for a mesh that is far from theirs.
    pub origin: Vec3,
    /// Kind of each cell; cells of lower dimension than the space (lines drawn for a group) do not stand here.
    pub kinds: Vec<&'static Cell>,
    /// Nodes of cell `c` are `nodes[starts[c]..starts[c + 1]]`; one entry more than cells.
    pub starts: Vec<usize>,
    /// Nodes of all cells, one after another.
    pub nodes: Vec<usize>,
    /// Groups by the name that the mesh or the deck gave them.
    pub groups: BTreeMap<String, Group>,
    /// The numbers by which the mesh's file knows its nodes and cells.
    pub numbers: Numbers,
    /// How many of its nodes, the first ones, it had before cells were raised; none where none were.
    pub before_raised: Option<usize>,
}

/// The numbers of nodes and cells in the file they come from; empty if the mesh was generated.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Numbers {
    /// One for each node, or none at all.
    pub nodes: Vec<u64>,
    /// One for each cell, or none at all.
    pub cells: Vec<u64>,
}

/// One cell of a mesh.
#[derive(Debug, Clone, Copy)]
pub struct CellView<'a> {
    /// Its reference cell.
    pub kind: &'static Cell,
    /// Its nodes.
    pub nodes: &'a [usize],
}

impl Default for Mesh {
    fn default() -> Self {
        Self::new()
    }
}

impl Mesh {
    /// An empty mesh.
    pub fn new() -> Self {
        Self {
            points: vec![],
            origin: Vec3::zero(),
            kinds: vec![],
            starts: vec![0],
            nodes: vec![],
            groups: BTreeMap::new(),
            numbers: Numbers::default(),
            before_raised: None,
        }
    }
    /// Where a node lies in the coordinates of the deck and of the mesh's file.
    pub fn place(&self, node: usize) -> Vec3 {
        self.points[node] + self.origin
    }
    /// The same of all nodes.
    pub fn places(&self) -> impl Iterator<Item = Vec3> + '_ {
        self.points.iter().map(|&point| point + self.origin)
    }
    /// Puts the origin of the mesh near its nodes, where they lie farther than a hundred times their extent from that of the
    /// coordinates, as in coordinates of a land survey: a position that is the sum of such a number and a displacement has lost the
    /// digits that a gap is made of. Radii stay what they are.
    ///
    /// The origin is a multiple of a power of two beyond the extent, so that positions lose nothing by it.
    pub fn recentre(&mut self, space: Space) {
        let bounds = BoundingBox::of(self.points.iter().copied());
        let (extent, middle) = ((bounds.max - bounds.min).0.into_iter().fold(0.0, f64::max), bounds.centre());
        let unit = extent.log2().ceil().exp2();
        let origin = |axis: usize| {
            let middle = middle[axis];
            let is_far = extent > 0.0 && middle.abs() > FAR * extent && !(space == Space::Axisymmetric && axis == 0);
            if is_far { (middle / unit).round() * unit } else { 0.0 }
        };
        self.origin = Vec3(std::array::from_fn(origin));
        self.points.iter_mut().for_each(|point| *point -= self.origin);
    }
    /// Number of cells.
    pub fn cell_count(&self) -> usize {
        self.kinds.len()
    }
    /// Adds a cell and returns its number.
    pub fn push_cell(&mut self, kind: &'static Cell, nodes: &[usize]) -> usize {
        self.kinds.push(kind);
        self.nodes.extend_from_slice(nodes);
        self.starts.push(self.nodes.len());
        self.kinds.len() - 1
    }
    /// Adds another part. Nodes are not merged: parts touch only by contact.
    ///
    /// # Errors
    /// [`Error::Input`] if both parts have a group of the same name; the mesh is then unchanged.
    pub fn append(&mut self, part: Mesh) -> Result<(), Error> {
        if let Some(name) = part.groups.keys().find(|name| self.groups.contains_key(*name)) {
            return Err(Error::input(format!("two parts of the mesh have a group '{name}'; rename one of them")));
        }
        append_numbers(&mut self.numbers.nodes, self.points.len(), &part.numbers.nodes, part.points.len());
        append_numbers(&mut self.numbers.cells, self.kinds.len(), &part.numbers.cells, part.kinds.len());
        let (nodes, cells, entries) = (self.points.len(), self.cell_count(), self.nodes.len());
        self.points.extend(part.points);
        self.kinds.extend(part.kinds);
        self.starts.extend(part.starts.iter().skip(1).map(|start| start + entries));
        self.nodes.extend(part.nodes.iter().map(|node| node + nodes));
        self.groups.extend(part.groups.into_iter().map(|(name, group)| (name, group.shifted(nodes, cells))));
        Ok(())
    }
    /// The number by which the user knows a node: that of the file, or its place counted from 1.
    pub fn node_number(&self, node: usize) -> u64 {
        number(&self.numbers.nodes, node)
    }
    /// The number by which the user knows a cell: that of the file, or its place counted from 1.
    pub fn cell_number(&self, cell: usize) -> u64 {
        number(&self.numbers.cells, cell)
    }
    /// One cell.
    pub fn cell(&self, cell: usize) -> CellView<'_> {
        CellView { kind: self.kinds[cell], nodes: &self.nodes[self.starts[cell]..self.starts[cell + 1]] }
    }
    /// The reference cell of a side and its nodes, in the order of that reference cell.
    pub fn side(&self, side: Side) -> (&'static Cell, impl Iterator<Item = usize> + '_) {
        let cell = self.cell(side.cell);
        let face = &cell.kind.faces[side.face];
        (face.cell, face.nodes.iter().map(move |&local| cell.nodes[local]))
    }
}

fn number(numbers: &[u64], place: usize) -> u64 {
    numbers.get(place).copied().unwrap_or(place as u64 + 1)
}

/// Appends the numbers of a part; a part without numbers counts its own from 1.
fn append_numbers(all: &mut Vec<u64>, before: usize, part: &[u64], count: usize) {
    if all.is_empty() && part.is_empty() {
        return;
    }
    all.extend((all.len()..before).map(|place| place as u64 + 1));
    all.extend((0..count).map(|place| number(part, place)));
}
