//! Gmsh's element types and the order of their nodes.

use crate::mesh::Cell;
use crate::mesh::cells::{
    HEX8, HEX20, HEX27, LINE2, LINE3, QUAD4, QUAD8, QUAD9, TET4, TET10, TRI3, TRI6, WEDGE6, WEDGE15,
};

/// The type of a single point, which is no cell.
pub(super) const POINT: i64 = 15;

/// One element type.
pub(super) struct Type {
    /// Gmsh's number of it.
    pub number: i64,
    pub cell: &'static Cell,
    /// Node `i` of the cell is node `order[i]` of Gmsh's element; empty where the orders agree.
    pub order: &'static [usize],
}

const fn same(number: i64, cell: &'static Cell) -> Type {
    Type { number, cell, order: &[] }
}

/// The types that can be read.
pub(super) static TYPES: &[Type] = &[
    same(1, &LINE2),
    same(2, &TRI3),
    same(3, &QUAD4),
    same(4, &TET4),
    same(5, &HEX8),
    same(6, &WEDGE6),
    same(8, &LINE3),
    same(9, &TRI6),
    same(10, &QUAD9),
    Type { number: 11, cell: &TET10, order: &[0, 1, 2, 3, 4, 5, 6, 7, 9, 8] },
    Type {
        number: 12,
        cell: &HEX27,
        order: &[0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15, 22, 23, 21, 24, 20, 25, 26],
    },
    same(16, &QUAD8),
    Type { number: 17, cell: &HEX20, order: &[0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15] },
    Type { number: 18, cell: &WEDGE15, order: &[0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11] },
];

/// Types that Gmsh writes and this program does not compute on, and what to do.
const UNREADABLE: &[(i64, &str)] = &[
    (7, "a pyramid; mesh without pyramids (tetrahedra or hexahedra only)"),
    (13, "a wedge of 18 nodes; set Mesh.SecondOrderIncomplete = 1 to get wedges of 15"),
    (14, "a pyramid; mesh without pyramids (tetrahedra or hexahedra only)"),
    (19, "a pyramid; mesh without pyramids (tetrahedra or hexahedra only)"),
];

/// The type of a number.
///
/// # Errors
/// A sentence without its place if there is none.
pub(super) fn named(number: i64) -> Result<&'static Type, String> {
    TYPES.iter().find(|found| found.number == number).ok_or_else(|| {
        let what = UNREADABLE
            .iter()
            .find(|entry| entry.0 == number)
            .map_or("not a cell of first or second degree; set Mesh.ElementOrder to 1 or 2", |entry| entry.1);
        format!("element type {number} is {what}")
    })
}

impl Type {
    /// Puts nodes listed in Gmsh's order into the order of the cell.
    pub(super) fn reorder(&self, nodes: &[usize]) -> Vec<usize> {
        match self.order {
            [] => nodes.to_vec(),
            order => order.iter().map(|&place| nodes[place]).collect(),
        }
    }
}
