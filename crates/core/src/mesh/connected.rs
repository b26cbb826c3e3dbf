//! Cells that hang together.

use super::Mesh;

impl Mesh {
    /// For each cell the number of the connected whole that it belongs to: cells that share a node, whatever groups they
    /// are in, have the same. Wholes are numbered by their first cells.
    pub fn wholes(&self) -> Vec<usize> {
        let mut leader: Vec<usize> = (0..self.points.len()).collect();
        for cell in 0..self.cell_count() {
            let leaders: Vec<usize> = self.cell(cell).nodes.iter().map(|&node| lead(&mut leader, node)).collect();
            let first = leaders.iter().copied().fold(usize::MAX, usize::min);
            leaders.into_iter().for_each(|node| leader[node] = first);
        }
        let (mut number, mut count) = (vec![usize::MAX; self.points.len()], 0);
        let mut of = |cell: usize| {
            let Some(&node) = self.cell(cell).nodes.first() else { return usize::MAX };
            let first = lead(&mut leader, node);
            if number[first] == usize::MAX {
                number[first] = count;
                count += 1;
            }
            number[first]
        };
        (0..self.cell_count()).map(&mut of).collect()
    }
}

/// The node that leads those which hang together with this one; the way there is shortened.
fn lead(leader: &mut [usize], mut node: usize) -> usize {
    while leader[node] != node {
        leader[node] = leader[leader[node]];
        node = leader[node];
    }
    node
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
