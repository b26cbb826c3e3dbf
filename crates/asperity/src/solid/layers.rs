//! How many cells lie behind one another through a body.

use crate::mesh::Mesh;
use crate::mesh::cells::Cell;
use std::collections::VecDeque;

/// Steps from node to node over cells within which every node of a body, not counting those of edges' middles, reaches its
/// surface: none with one cell through it, one with two or three, two with four or five.
pub(super) fn depth(mesh: &Mesh, cells: &[usize]) -> usize {
    let corners = |cell: usize| {
        let view = mesh.cell(cell);
        &view.nodes[..view.kind.linear.nodes.len()]
    };
    let (mut starts, mut steps) = (vec![0; mesh.points.len() + 1], vec![usize::MAX; mesh.points.len()]);
    cells.iter().flat_map(|&cell| corners(cell)).for_each(|&node| starts[node + 1] += 1);
    (1..starts.len()).for_each(|node| starts[node] += starts[node - 1]);
    let (mut around, mut next) = (vec![0; starts[mesh.points.len()]], starts.clone());
    for &cell in cells {
        for &node in corners(cell) {
            around[next[node]] = cell;
            next[node] += 1;
        }
    }
    let mut front = VecDeque::new();
    for side in mesh.boundary(cells) {
        for node in mesh.side(side).1.filter(|&node| starts[node] < starts[node + 1]) {
            if steps[node] > 0 {
                steps[node] = 0;
                front.push_back(node);
            }
        }
    }
    let mut deepest = 0;
    while let Some(node) = front.pop_front() {
        deepest = deepest.max(steps[node]);
        for &other in around[starts[node]..starts[node + 1]].iter().flat_map(|&cell| corners(cell)) {
            if steps[other] == usize::MAX {
                steps[other] = steps[node] + 1;
                front.push_back(other);
            }
        }
    }
    deepest
}

/// Depth up to which a cell of first degree without incompatible modes is more than a tenth too stiff in bending: three layers of
/// quadrilaterals and bricks (13 % with two, 6 % with three), five of others (48 % with two, 19 % with four).
pub(super) fn stiff_in_bending(kind: &Cell) -> Option<usize> {
    match (kind.degree, kind.nodes.len(), kind.dimension) {
        (1, 4, 2) | (1, 8, 3) => Some(1),
        (1, ..) => Some(2),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::generate::{Block, Rectangle};

    #[test]
    fn layers_are_counted_from_the_surface() {
        for (through, wanted) in [(1, 0), (2, 1), (3, 1), (4, 2), (5, 2)] {
            for name in ["tri3", "quad8"] {
                let mesh = Rectangle::new([0.0; 2], [9.0, 1.0], [12, through], Cell::named(name).unwrap()).mesh("b");
                let mesh = mesh.unwrap();
                assert_eq!(depth(&mesh, &(0..mesh.cell_count()).collect::<Vec<_>>()), wanted, "{name} {through}");
            }
            let mesh = Block::new([0.0; 3], [9.0, 9.0, 1.0], [8, 8, through], Cell::named("tet4").unwrap()).mesh("b");
            let mesh = mesh.unwrap();
            assert_eq!(depth(&mesh, &(0..mesh.cell_count()).collect::<Vec<_>>()), wanted, "tet4 {through}");
        }
    }
}
