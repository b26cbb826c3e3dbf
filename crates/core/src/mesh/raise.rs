//! Cells of first degree raised to second degree (p-refinement) by a node in the middle of each edge.

use super::{Group, Mesh};
use std::collections::HashMap;

/// The corners of an edge, the lesser first.
pub(super) type Ends = [usize; 2];

pub(super) fn ends(one: usize, other: usize) -> Ends {
    [one.min(other), one.max(other)]
}

impl Mesh {
    /// The mesh with some of its cells raised to the serendipity cells of second degree on the same corners. Cells that share an
    /// edge share its middle, which is that of a cell of second degree beside it if there is one; nodes, cells and sides keep their
    /// numbers. Middles of boundary edges lie on a smooth surface through the corners. A group has the middles of the edges of its
    /// cells and sides; one of nodes alone has those between two of its nodes, but for a chord of the body: an edge inside that joins
    /// two nodes of the boundary.
    pub fn raised(mut self, cells: &[usize]) -> Self {
        let mut middles = HashMap::<Ends, usize>::new();
        for cell in (0..self.cell_count()).map(|cell| self.cell(cell)).filter(|cell| cell.kind.degree == 2) {
            middles.extend(
                cell.kind.middles().map(|(node, [a, b])| (ends(cell.nodes[a], cell.nodes[b]), cell.nodes[node])),
            );
        }
        let mut raise = vec![false; self.cell_count()];
        cells.iter().for_each(|&cell| raise[cell] = true);
        let mut fresh: Vec<(Ends, usize)> = Vec::new();
        let (kinds, starts, nodes) =
            (std::mem::take(&mut self.kinds), std::mem::take(&mut self.starts), std::mem::take(&mut self.nodes));
        self.starts.push(0);
        for (cell, kind) in kinds.into_iter().enumerate() {
            let corners = &nodes[starts[cell]..starts[cell + 1]];
            let raised = kind.raised().filter(|_| raise[cell] && kind.degree == 1);
            let mut own = corners.to_vec();
            for (_, [a, b]) in raised.into_iter().flat_map(|raised| raised.middles()) {
                let edge = ends(corners[a], corners[b]);
                own.push(*middles.entry(edge).or_insert_with(|| {
                    fresh.push((edge, self.points.len()));
                    self.points.push((self.points[edge[0]] + self.points[edge[1]]) * 0.5);
                    self.points.len() - 1
                }));
            }
            self.push_cell(raised.unwrap_or(kind), &own);
        }
        if let Some(&last) = self.numbers.nodes.iter().max() {
            self.numbers.nodes.extend((0..fresh.len() as u64).map(|place| last + 1 + place));
        }
        self.before_raised.get_or_insert(self.points.len() - fresh.len());
        self.smooth(&fresh);
        self.with_middles(&fresh);
        self
    }

    /// The groups with the middles that are theirs.
    fn with_middles(&mut self, fresh: &[(Ends, usize)]) {
        let all: Vec<usize> = (0..self.cell_count()).collect();
        let mut on_boundary = vec![false; self.points.len()];
        for side in self.boundary(&all) {
            self.side(side).1.for_each(|node| on_boundary[node] = true);
        }
        let groups = std::mem::take(&mut self.groups);
        let raised = groups.into_iter().map(|(name, mut group)| {
            let mut among = vec![false; self.points.len()];
            group.nodes.iter().for_each(|&node| among[node] = true);
            let inner = std::mem::take(&mut group.inner);
            let mut nodes = group.nodes;
            nodes.extend(inner.iter().flat_map(|sides| self.side(sides[0]).1));
            if group.cells.is_empty() && group.sides.is_empty() && inner.is_empty() {
                let chord = |[a, b]: Ends, middle: usize| on_boundary[a] && on_boundary[b] && !on_boundary[middle];
                let within = fresh.iter().filter(|&&([a, b], middle)| among[a] && among[b] && !chord([a, b], middle));
                nodes.extend(within.map(|&(_, middle)| middle));
            }
            (name, Group { inner, ..Group::new(self, group.cells, group.sides, nodes) })
        });
        self.groups = raised.collect();
    }
}

#[cfg(test)]
mod tests {
    use crate::mesh::cells::ALL;
    use crate::mesh::generate::{Block, Rectangle};
    use crate::mesh::{Cell, Group, Mesh};
    use crate::tensor::Vec3;

    fn drawn(kind: &'static Cell) -> Mesh {
        match kind.dimension {
            2 => Rectangle::new([0.0; 2], [3.0, 1.0], [3, 2], kind).mesh("b").unwrap(),
            _ => Block::new([0.0; 3], [3.0, 1.0, 2.0], [3, 1, 2], kind).mesh("b").unwrap(),
        }
    }

    /// A raised mesh is the generated one of second degree: as many nodes at the same places, as many sides and nodes of groups.
    #[test]
    fn a_raised_mesh_is_that_of_second_degree() {
        let sorted = |points: &[Vec3]| {
            let mut points: Vec<[f64; 3]> = points.iter().map(|point| point.0).collect();
            points.sort_by(|one, other| one.partial_cmp(other).unwrap());
            points
        };
        for &kind in ALL.iter().filter(|kind| kind.degree == 1 && kind.dimension > 1) {
            let (mut plain, wanted) = (drawn(kind), drawn(kind.raised().unwrap()));
            let left = plain.groups["b.left"].nodes.clone();
            plain.groups.insert("nodes".into(), Group::new(&plain, vec![], vec![], left));
            let all: Vec<usize> = (0..plain.cell_count()).collect();
            let raised = plain.raised(&all);
            assert_eq!(sorted(&raised.points), sorted(&wanted.points), "{}", kind.name);
            assert_eq!(raised.kinds, wanted.kinds, "{}", kind.name);
            for (name, group) in &wanted.groups {
                let found = &raised.groups[name];
                assert_eq!((&found.cells, &found.sides), (&group.cells, &group.sides), "{} {name}", kind.name);
                assert_eq!(found.nodes.len(), group.nodes.len(), "{} {name}", kind.name);
            }
            assert_eq!(raised.groups["nodes"].nodes, raised.groups["b.left"].nodes, "{}", kind.name);
            for cell in 0..raised.cell_count() {
                assert!((raised.measure(cell) - wanted.measure(cell)).abs() < 1e-13, "{} {cell}", kind.name);
            }
        }
    }

    /// A middle between a raised cell and one of second degree is that of the latter.
    #[test]
    fn a_middle_beside_a_cell_of_second_degree_is_its_own() {
        let (four, eight) = (Cell::named("quad4").unwrap(), Cell::named("quad8").unwrap());
        let mut mesh = Mesh::new();
        mesh.points =
            [[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1]].map(|[x, y]| Vec3::new(x as f64, y as f64, 0.0)).to_vec();
        mesh.points.extend([[0.5, 0.0], [1.0, 0.4], [0.5, 1.0], [0.0, 0.5]].map(|[x, y]| Vec3::new(x, y, 0.0)));
        mesh.push_cell(eight, &[0, 1, 4, 3, 6, 7, 8, 9]);
        mesh.push_cell(four, &[1, 2, 5, 4]);
        let raised = mesh.raised(&[1]);
        assert_eq!(raised.points.len(), 13);
        assert_eq!(raised.cell(1).nodes[7], 7);
    }
}
