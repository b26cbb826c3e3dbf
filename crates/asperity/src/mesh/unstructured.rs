//! The mesh itself: points, cells of any kinds, named groups.

use super::{Cell, Group, Side};
use crate::error::Error;
use crate::tensor::Vec3;
use std::collections::BTreeMap;

/// Points, cells and groups. Plane meshes have z = 0; axisymmetric ones are drawn in (r, z) = (x, y).
#[derive(Debug, Clone)]
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
        Self { points: vec![], kinds: vec![], starts: vec![0], nodes: vec![], groups: BTreeMap::new() }
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
        let (nodes, cells, entries) = (self.points.len(), self.cell_count(), self.nodes.len());
        self.points.extend(part.points);
        self.kinds.extend(part.kinds);
        self.starts.extend(part.starts.iter().skip(1).map(|start| start + entries));
        self.nodes.extend(part.nodes.iter().map(|node| node + nodes));
        self.groups.extend(part.groups.into_iter().map(|(name, group)| (name, group.shifted(nodes, cells))));
        Ok(())
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
