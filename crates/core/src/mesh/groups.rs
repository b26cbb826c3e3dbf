//! Named parts of a mesh, by which the deck speaks of it.

use super::Mesh;

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
    /// Edges or faces of a file that have a cell on either side. They are not among `sides`: which of the two is meant
    /// is open, and no contact or load can act on them; their nodes are among `nodes`.
    pub inner: Vec<[Side; 2]>,
}

/// An edge or face, named by the cell it belongs to and its place in that cell's list of faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Side {
    /// The cell behind it.
    pub cell: usize,
    /// Which of the cell's faces.
    pub face: usize,
}

impl Group {
    /// A group of cells, sides and single nodes, in any order and with any repeats; the nodes of the cells and sides
    /// are added.
    pub fn new(mesh: &Mesh, cells: Vec<usize>, sides: Vec<Side>, nodes: Vec<usize>) -> Self {
        let mut group = Self { cells, sides, nodes, inner: vec![] };
        for &cell in &group.cells {
            group.nodes.extend_from_slice(mesh.cell(cell).nodes);
        }
        for &side in &group.sides {
            group.nodes.extend(mesh.side(side).1);
        }
        group.tidy();
        group
    }

    /// Sorts the lists and drops repeats.
    pub(super) fn tidy(&mut self) {
        self.cells.sort_unstable();
        self.cells.dedup();
        self.sides.sort_unstable();
        self.sides.dedup();
        self.nodes.sort_unstable();
        self.nodes.dedup();
        self.inner.sort_unstable();
        self.inner.dedup();
    }

    pub(super) fn shifted(mut self, nodes: usize, cells: usize) -> Self {
        self.nodes.iter_mut().for_each(|node| *node += nodes);
        self.cells.iter_mut().for_each(|cell| *cell += cells);
        self.sides.iter_mut().for_each(|side| side.cell += cells);
        self.inner.iter_mut().flatten().for_each(|side| side.cell += cells);
        self
    }
}
