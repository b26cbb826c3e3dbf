//! Cells that hang together.

use super::{Mesh, Side};
use crate::tensor::DisjointSets;
use std::collections::BTreeSet;

impl Mesh {
    /// For each cell the number of the connected whole that it belongs to: cells that share a node, whatever groups they
    /// are in, have the same. Wholes are numbered by their first cells.
    pub fn wholes(&self) -> Vec<usize> {
        self.wholes_of(&(0..self.cell_count()).collect::<Vec<_>>())
    }

    /// The same for each of some cells, among themselves.
    pub fn wholes_of(&self, cells: &[usize]) -> Vec<usize> {
        let mut sets = DisjointSets::new(self.points.len());
        for &cell in cells {
            let nodes = self.cell(cell).nodes;
            nodes.iter().for_each(|&node| sets.join(nodes[0], node));
        }
        let (mut number, mut count) = (vec![usize::MAX; self.points.len()], 0);
        let mut of = |&cell: &usize| {
            let Some(&node) = self.cell(cell).nodes.first() else { return usize::MAX };
            let first = sets.root(node);
            if number[first] == usize::MAX {
                number[first] = count;
                count += 1;
            }
            number[first]
        };
        cells.iter().map(&mut of).collect()
    }
    /// Those of some cells that hang together with the cells behind some sides.
    pub fn cells_behind(&self, sides: &[Side], cells: impl Iterator<Item = usize>) -> Vec<usize> {
        let wholes = self.wholes();
        let behind: BTreeSet<usize> = sides.iter().map(|side| wholes[side.cell]).collect();
        let cells: BTreeSet<usize> = cells.filter(|&cell| behind.contains(&wholes[cell])).collect();
        cells.into_iter().collect()
    }
}

#[cfg(test)]
mod tests {
    use crate::mesh::{Cell, generate::Rectangle};

    #[test]
    fn cells_that_share_a_node_are_one_whole() {
        let cell = Cell::named("quad4").unwrap();
        let mut mesh = Rectangle::new([0.0, 0.0], [1.0, 1.0], [2, 2], cell).mesh("one").unwrap();
        let other = Rectangle::new([1.0, 0.0], [2.0, 1.0], [1, 2], cell).mesh("other").unwrap();
        mesh.append(other).unwrap();
        assert_eq!(mesh.wholes(), [0, 0, 0, 0, 1, 1]);
    }
}
