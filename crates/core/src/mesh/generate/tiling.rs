//! How one brick of the lattice is tiled by cells. Corners are lattice points of the brick, 0 or 2 along each
//! direction, so that half steps are whole numbers; the order gives every cell a positive Jacobian, and neighbouring
//! bricks meet in the same diagonals.

use crate::mesh::Cell;

type Corner = [u8; 3];

const QUAD: &[&[Corner]] = &[&[[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]]];
const TRIANGLES: &[&[Corner]] = &[&[[0, 0, 0], [2, 0, 0], [2, 2, 0]], &[[0, 0, 0], [2, 2, 0], [0, 2, 0]]];
const HEX: &[&[Corner]] = &[&[[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [0, 0, 2], [2, 0, 2], [2, 2, 2], [0, 2, 2]]];
const WEDGES: &[&[Corner]] = &[
    &[[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 0, 2], [2, 0, 2], [2, 2, 2]],
    &[[0, 0, 0], [2, 2, 0], [0, 2, 0], [0, 0, 2], [2, 2, 2], [0, 2, 2]],
];
/// Six tetrahedra about the space diagonal, one for each order in which the three directions can be walked (Kuhn).
const TETRAHEDRA: &[&[Corner]] = &[
    &[[0, 0, 0], [2, 0, 0], [2, 2, 0], [2, 2, 2]],
    &[[0, 0, 0], [2, 2, 0], [0, 2, 0], [2, 2, 2]],
    &[[0, 0, 0], [0, 2, 0], [0, 2, 2], [2, 2, 2]],
    &[[0, 0, 0], [0, 2, 2], [0, 0, 2], [2, 2, 2]],
    &[[0, 0, 0], [0, 0, 2], [2, 0, 2], [2, 2, 2]],
    &[[0, 0, 0], [2, 0, 2], [2, 0, 0], [2, 2, 2]],
];

/// The cells that tile a brick, each as the lattice points of all its nodes; none for cells that tile no brick.
pub(super) fn tiling(cell: &Cell) -> Vec<Vec<[usize; 3]>> {
    let tiles: &[&[Corner]] = match cell.linear.name {
        "quad4" => QUAD,
        "tri3" => TRIANGLES,
        "hex8" => HEX,
        "wedge6" => WEDGES,
        "tet4" => TETRAHEDRA,
        _ => &[],
    };
    tiles.iter().map(|corners| cell.nodes.iter().map(|&xi| image(cell.linear, corners, xi)).collect()).collect()
}

/// The lattice point of a node: the corners weighted by the first degree shape functions, a whole number exactly.
fn image(linear: &Cell, corners: &[Corner], xi: [f64; 3]) -> [usize; 3] {
    let (mut n, mut dn) = ([0.0; crate::mesh::cells::MAX_NODES], [[0.0; 3]; crate::mesh::cells::MAX_NODES]);
    (linear.shape)(xi, &mut n, &mut dn);
    std::array::from_fn(|a| {
        corners.iter().zip(n).map(|(corner, weight)| f64::from(corner[a]) * weight).sum::<f64>().round() as usize
    })
}
