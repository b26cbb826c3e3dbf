//! The mesh itself: points, cells of any kinds, named groups.

use super::Cell;
use crate::tensor::Vec3;
use std::collections::BTreeMap;

/// Points, cells and groups. Plane meshes have z = 0; axisymmetric ones are drawn in (r, z) = (x, y).
#[derive(Debug, Clone, Default)]
pub struct Mesh {
    /// Positions of the nodes, undeformed.
    pub points: Vec<Vec3>,
    /// Kind of each cell; cells of lower dimension than the space (lines drawn for a group) do not stand here.
    pub kinds: Vec<&'static Cell>,
    /// Nodes of cell `c` are `nodes[starts[c]..starts[c + 1]]`; one entry more than cells.
    pub starts: Vec<usize>,
    /// Nodes of all cells, one after another.
    pub nodes: Vec<usize>,
    /// Groups by the name that the mesh or the deck gave them.
    pub groups: BTreeMap<String, Group>,
}

/// A named part of the mesh: cells for a body, sides for a contact or a load, nodes for a support. `nodes` always
/// holds the nodes of the cells and sides too; all three are sorted and without repeats.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Group {
    /// Cells.
    pub cells: Vec<usize>,
    /// Edges or faces, each by the cell behind it.
    pub sides: Vec<Side>,
    /// Nodes.
    pub nodes: Vec<usize>,
}

/// An edge or face, named by the cell it belongs to and its place in that cell's list of faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Side {
    /// The cell behind it.
    pub cell: usize,
    /// Which of the cell's faces.
    pub face: usize,
}

/// One cell of a mesh.
#[derive(Debug, Clone, Copy)]
pub struct CellView<'a> {
    /// Its reference cell.
    pub kind: &'static Cell,
    /// Its nodes.
    pub nodes: &'a [usize],
}

impl Mesh {
    /// An empty mesh.
    pub fn new() -> Self {
        Self { starts: vec![0], ..Self::default() }
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
