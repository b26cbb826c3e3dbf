//! Abaqus' and CalculiX' element types, the order of their nodes and the numbers of their faces.

use crate::mesh::Cell;
use crate::mesh::cells::{
    HEX8, HEX20, HEX27, LINE2, LINE3, QUAD4, QUAD8, QUAD9, TET4, TET10, TRI3, TRI6, WEDGE6, WEDGE15,
};

/// An element type, without the letters that tell its formulation.
pub(super) struct Type {
    pub name: &'static str,
    pub cell: &'static Cell,
    /// Whether it is no part of a body but can mark a side: trusses, shells, membranes, rigid facets.
    pub skin: bool,
    /// Node `i` of the cell is node `order[i]` of the element; empty where the orders agree.
    pub order: &'static [usize],
}

const fn solid(name: &'static str, cell: &'static Cell) -> Type {
    Type { name, cell, skin: false, order: &[] }
}

const fn skin(name: &'static str, cell: &'static Cell) -> Type {
    Type { name, cell, skin: true, order: &[] }
}

/// A truss of three nodes: its middle comes between its ends.
const fn middle_second(name: &'static str) -> Type {
    Type { name, cell: &LINE3, skin: true, order: &[0, 2, 1] }
}

/// The types that can be read.
pub(super) static TYPES: &[Type] = &[
    solid("CPS3", &TRI3),
    solid("CPS4", &QUAD4),
    solid("CPS6", &TRI6),
    solid("CPS8", &QUAD8),
    solid("CPE3", &TRI3),
    solid("CPE4", &QUAD4),
    solid("CPE6", &TRI6),
    solid("CPE8", &QUAD8),
    solid("CAX3", &TRI3),
    solid("CAX4", &QUAD4),
    solid("CAX6", &TRI6),
    solid("CAX8", &QUAD8),
    solid("C3D4", &TET4),
    solid("C3D10", &TET10),
    solid("C3D6", &WEDGE6),
    solid("C3D15", &WEDGE15),
    solid("C3D8", &HEX8),
    solid("C3D20", &HEX20),
    Type {
        name: "C3D27",
        cell: &HEX27,
        skin: false,
        // The centre comes first of the inner nodes, then the middles of the faces S1 to S6.
        order: &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 26, 24, 23, 25, 21, 22, 20],
    },
    skin("T2D2", &LINE2),
    middle_second("T2D3"),
    skin("T3D2", &LINE2),
    middle_second("T3D3"),
    skin("R2D2", &LINE2),
    skin("RAX2", &LINE2),
    skin("S3", &TRI3),
    skin("S4", &QUAD4),
    skin("S6", &TRI6),
    skin("S8", &QUAD8),
    skin("S9", &QUAD9),
    skin("M3D3", &TRI3),
    skin("M3D4", &QUAD4),
    skin("M3D6", &TRI6),
    skin("M3D8", &QUAD8),
    skin("M3D9", &QUAD9),
    skin("SFM3D3", &TRI3),
    skin("SFM3D4", &QUAD4),
    skin("SFM3D6", &TRI6),
    skin("SFM3D8", &QUAD8),
    skin("R3D3", &TRI3),
    skin("R3D4", &QUAD4),
];

/// Letters behind the name that choose integration or formulation, not the shape.
const VARIANTS: &str = "RHIMSTPE5";

/// Corners of the faces S1, S2, ... of each shape.
static FACES: &[(&Cell, &[&[usize]])] = &[
    (&TRI3, &[&[0, 1], &[1, 2], &[2, 0]]),
    (&QUAD4, &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]]),
    (&TET4, &[&[0, 1, 2], &[0, 3, 1], &[1, 3, 2], &[2, 3, 0]]),
    (&WEDGE6, &[&[0, 1, 2], &[3, 5, 4], &[0, 3, 4, 1], &[1, 4, 5, 2], &[2, 5, 3, 0]]),
    (&HEX8, &[&[0, 1, 2, 3], &[4, 7, 6, 5], &[0, 4, 5, 1], &[1, 5, 6, 2], &[2, 6, 7, 3], &[3, 7, 4, 0]]),
];

/// The type of a name and the letters of its variant.
///
/// # Errors
/// A sentence without its place if there is none.
pub(super) fn named(name: &str) -> Result<(&'static Type, String), String> {
    let name = name.to_ascii_uppercase();
    let variant = |found: &Type| {
        let rest = name.strip_prefix(found.name)?;
        rest.chars().all(|letter| VARIANTS.contains(letter)).then(|| rest.to_string())
    };
    TYPES.iter().find_map(|found| Some((found, variant(found)?))).ok_or_else(|| {
        format!(
            "elements of type '{name}' are not read; the readable ones are {}, each with its variants",
            TYPES.iter().filter(|found| !found.skin).map(|found| found.name).collect::<Vec<_>>().join(", ")
        )
    })
}

/// The place in the cell's list of its face `S1`, `S2`, ...; none if the cell has no such face.
pub(super) fn face(cell: &Cell, label: &str) -> Option<usize> {
    let number: usize = label.strip_prefix(['S', 's'])?.parse().ok()?;
    let faces = FACES.iter().find(|entry| entry.0 == cell.linear)?.1;
    let corners = faces.get(number.checked_sub(1)?)?;
    let holds = |nodes: &[usize]| nodes.iter().take(corners.len()).all(|node| corners.contains(node));
    cell.faces.iter().position(|face| face.cell.linear.nodes.len() == corners.len() && holds(face.nodes))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::cells::ALL;

    #[test]
    fn every_face_of_every_cell_has_one_number() {
        for cell in ALL.iter().filter(|cell| cell.dimension > 1) {
            let mut faces: Vec<usize> = (1..9).filter_map(|number| face(cell, &format!("S{number}"))).collect();
            faces.sort_unstable();
            assert!(faces.iter().copied().eq(0..cell.faces.len()), "{cell:?}: {faces:?}");
        }
        assert_eq!(face(&HEX8, "S1").map(|face| HEX8.faces[face].nodes), Some(&[0, 3, 2, 1][..]));
        assert_eq!([face(&HEX8, "S0"), face(&HEX8, "S7"), face(&HEX8, "SPOS"), face(&HEX8, "3")], [None; 4]);
    }

    #[test]
    fn variants_are_the_shape_without_their_letters() {
        for (name, cell, variant) in
            [("C3D20R", "hex20", "R"), ("cax8", "quad8", ""), ("C3D10MH", "tet10", "MH"), ("S8R5", "quad8", "R5")]
        {
            let (found, letters) = named(name).unwrap();
            assert_eq!((found.cell.name, letters.as_str()), (cell, variant));
        }
        for name in ["B31", "C3D5", "C3D15V", "C3D", "DC3D8"] {
            assert!(named(name).is_err_and(|text| text.contains(name)), "{name}");
        }
    }

    /// The inner nodes of a cell of 27: the centre, then the faces in the order of their numbers.
    #[test]
    fn the_inner_nodes_of_a_brick_follow_its_faces() {
        let order = named("C3D27").unwrap().0.order;
        let place = |abaqus: usize| HEX27.nodes[order.iter().position(|&node| node == abaqus).unwrap()];
        assert_eq!(place(20), [0.0; 3]);
        for number in 1..=6 {
            let nodes = HEX27.faces[face(&HEX27, &format!("S{number}")).unwrap()].nodes;
            assert_eq!(place(20 + number), HEX27.nodes[nodes[8]], "S{number}");
        }
    }
}
