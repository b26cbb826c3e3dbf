//! VTK's order of nodes. Corners come in our order (for wedges too: the volume is then positive), the others follow
//! as the middles of edges, faces and the cell. A middle is found by its place in the reference cell, so that this
//! table does not depend on how a cell numbers its own middle nodes.
//! Source: the class documentation of vtkQuadraticHexahedron, vtkTriQuadraticHexahedron, vtkQuadraticWedge and so on,
//! checked against `vtkCell::GetParametricCoords` of VTK 9.7.

use asperity_core::mesh::Cell;
use asperity_core::mesh::cells::ALL;

/// Corners whose mean is the place of a node that is not a corner.
type Middle = &'static [usize];

const LINE: &[Middle] = &[&[0, 1]];
const TRIANGLE: &[Middle] = &[&[0, 1], &[1, 2], &[2, 0]];
const QUAD: &[Middle] = &[&[0, 1], &[1, 2], &[2, 3], &[3, 0], &[0, 1, 2, 3]];
const TETRA: &[Middle] = &[&[0, 1], &[1, 2], &[2, 0], &[0, 3], &[1, 3], &[2, 3]];
const WEDGE: &[Middle] = &[&[0, 1], &[1, 2], &[2, 0], &[3, 4], &[4, 5], &[5, 3], &[0, 3], &[1, 4], &[2, 5]];
const HEXA: &[Middle] = &[
    &[0, 1],
    &[1, 2],
    &[2, 3],
    &[3, 0],
    &[4, 5],
    &[5, 6],
    &[6, 7],
    &[7, 4],
    &[0, 4],
    &[1, 5],
    &[2, 6],
    &[3, 7],
    &[0, 3, 7, 4],
    &[1, 2, 6, 5],
    &[0, 1, 5, 4],
    &[3, 2, 6, 7],
    &[0, 1, 2, 3],
    &[4, 5, 6, 7],
    &[0, 1, 2, 3, 4, 5, 6, 7],
];

/// Number of corners and the middles in VTK's order, by VTK cell type.
fn layout(vtk: u8) -> Option<(usize, &'static [Middle])> {
    Some(match vtk {
        3 => (2, &[]),
        21 => (2, LINE),
        5 => (3, &[]),
        22 => (3, TRIANGLE),
        9 => (4, &[]),
        23 => (4, &QUAD[..4]),
        28 => (4, QUAD),
        10 => (4, &[]),
        24 => (4, TETRA),
        13 => (6, &[]),
        26 => (6, WEDGE),
        12 => (8, &[]),
        25 => (8, &HEXA[..12]),
        29 => (8, HEXA),
        _ => return None,
    })
}

/// For each place of a VTK cell, which of our nodes stands there; none for a cell that VTK does not know.
pub fn vtk_order(cell: &Cell) -> Option<Vec<usize>> {
    let (corners, middles) = layout(cell.vtk)?;
    if corners + middles.len() != cell.nodes.len() {
        return None;
    }
    let middle = |group: &&[usize]| find(cell, mean(cell, group));
    (0..corners).map(Some).chain(middles.iter().map(middle)).collect()
}

/// Our cell of a VTK type and its order of nodes.
pub fn from_vtk(vtk: u8) -> Option<(&'static Cell, Vec<usize>)> {
    let cell = ALL.iter().find(|cell| cell.vtk == vtk)?;
    Some((cell, vtk_order(cell)?))
}

fn mean(cell: &Cell, nodes: &[usize]) -> [f64; 3] {
    std::array::from_fn(|a| nodes.iter().map(|&i| cell.nodes[i][a]).sum::<f64>() / nodes.len() as f64)
}

fn find(cell: &Cell, place: [f64; 3]) -> Option<usize> {
    let near = |node: &[f64; 3]| (0..3).all(|a| (node[a] - place[a]).abs() < 1e-9);
    cell.nodes.iter().position(near)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cell_has_an_order_that_uses_each_node_once() {
        for cell in ALL {
            let mut order = vtk_order(cell).unwrap_or_else(|| panic!("{} has no VTK order", cell.name));
            order.sort_unstable();
            assert!(order.iter().copied().eq(0..cell.nodes.len()), "{}: {order:?}", cell.name);
            assert_eq!(from_vtk(cell.vtk).unwrap().0.name, cell.name);
        }
    }

    #[test]
    fn an_unknown_type_is_refused() {
        assert!(from_vtk(42).is_none());
    }
}
