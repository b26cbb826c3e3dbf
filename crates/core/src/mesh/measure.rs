//! Measures of a mesh and its cells: positions, Jacobians, volumes, extent; and which cells a node belongs to.
//!
//! The Jacobian of a solid cell is `det(dx/dxi)`, of a plane cell its area ratio in the plane (positive when its nodes
//! run counter-clockwise), of a line its length ratio.

use super::cells::MAX_NODES;
use super::{CellView, Mesh, Side};
use crate::tensor::{BoundingBox, Vec3};

impl CellView<'_> {
    /// Position of a reference point and the tangents `dx/dxi` along the reference directions.
    pub fn map(&self, points: &[Vec3], xi: [f64; 3]) -> (Vec3, [Vec3; 3]) {
        let (mut n, mut dn) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
        (self.kind.shape)(xi, &mut n, &mut dn);
        let (mut x, mut tangents) = (Vec3::zero(), [Vec3::zero(); 3]);
        for (i, &node) in self.nodes.iter().enumerate() {
            x += points[node] * n[i];
            (0..3).for_each(|a| tangents[a] += points[node] * dn[i][a]);
        }
        (x, tangents)
    }

    /// Ratio of the measure in space to that on the reference cell; negative where the cell is turned inside out.
    pub fn jacobian(&self, points: &[Vec3], xi: [f64; 3]) -> f64 {
        let [u, v, w] = self.map(points, xi).1;
        match self.kind.dimension {
            1 => u.norm(),
            2 => u[0] * v[1] - u[1] * v[0],
            _ => u.cross(v).dot(w),
        }
    }

    /// Length of an edge or area of a face, however it stands in space.
    pub fn extent(&self, points: &[Vec3]) -> f64 {
        let rule = self.kind.full;
        let ratio = |xi: [f64; 3]| match (self.kind.dimension, self.map(points, xi).1) {
            (1, [u, ..]) => u.norm(),
            (_, [u, v, _]) => u.cross(v).norm(),
        };
        rule.points.iter().zip(rule.weights).map(|(&xi, weight)| weight * ratio(xi)).sum()
    }

    /// Length, area or volume by the full quadrature of the cell.
    pub fn measure(&self, points: &[Vec3]) -> f64 {
        let rule = self.kind.full;
        rule.points.iter().zip(rule.weights).map(|(&xi, weight)| weight * self.jacobian(points, xi)).sum()
    }
}

impl Mesh {
    /// Area of a plane cell, volume of a solid one, in the undeformed mesh; the factor `2 pi r` of an axisymmetric
    /// space is the caller's.
    pub fn measure(&self, cell: usize) -> f64 {
        self.cell(cell).measure(&self.points)
    }

    /// Length of an edge or area of a face of a cell, however it stands in space.
    pub fn extent(&self, side: Side) -> f64 {
        let (kind, nodes) = self.side(side);
        CellView { kind, nodes: &nodes.collect::<Vec<_>>() }.extent(&self.points)
    }

    /// Middle and unit normal of a side, to the right of an edge.
    pub fn frame(&self, side: Side) -> (Vec3, Vec3) {
        let (kind, nodes) = self.side(side);
        let nodes: Vec<usize> = nodes.collect();
        let (x, [g, h, _]) = CellView { kind, nodes: &nodes }.map(&self.points, kind.center());
        let normal = if kind.dimension == 1 { Vec3::new(g[1], -g[0], 0.0) } else { g.cross(h) };
        (x, normal * (1.0 / normal.norm()))
    }

    /// The axis that a side lies across.
    pub fn faces(&self, side: Side) -> Option<usize> {
        let (kind, nodes) = self.side(side);
        let points: Vec<Vec3> = nodes.map(|node| self.points[node]).collect();
        let size = points.iter().map(|&x| (x - points[0]).norm()).fold(0.0, f64::max);
        (0..=kind.dimension).find(|&axis| points.iter().all(|x| (x[axis] - points[0][axis]).abs() <= 1e-9 * size))
    }

    /// Volume of the cell behind a side over the area of the side.
    pub fn depth(&self, side: Side) -> f64 {
        self.measure(side.cell) / self.extent(side)
    }

    /// The longest straight distance between two corners that an edge of a cell joins.
    pub fn longest_edge(&self, cell: usize) -> f64 {
        let cell = self.cell(cell);
        let point = |corner: usize| self.points[cell.nodes[corner]];
        cell.kind.edges().map(|[one, other]| (point(one) - point(other)).norm()).fold(0.0, f64::max)
    }

    /// The box around all points.
    pub fn bounds(&self) -> BoundingBox {
        BoundingBox::of(self.points.iter().copied())
    }

    /// Length of the diagonal of [`Mesh::bounds`], the characteristic length of the whole.
    pub fn size(&self) -> f64 {
        self.bounds().size()
    }

    /// The highest dimension of any cell: 2 for a plane mesh, 3 for a solid one, 0 without cells.
    pub fn dimension(&self) -> usize {
        self.kinds.iter().map(|kind| kind.dimension).max().unwrap_or(0)
    }

    /// Which cells each node belongs to.
    pub fn adjacency(&self) -> Adjacency {
        let mut starts = vec![0; self.points.len() + 1];
        self.nodes.iter().for_each(|&node| starts[node + 1] += 1);
        (1..starts.len()).for_each(|i| starts[i] += starts[i - 1]);
        let (mut next, mut cells) = (starts.clone(), vec![0; self.nodes.len()]);
        for cell in 0..self.cell_count() {
            for &node in self.cell(cell).nodes {
                cells[next[node]] = cell;
                next[node] += 1;
            }
        }
        Adjacency { starts, cells }
    }
}

/// The cells around each node.
#[derive(Debug, Clone, PartialEq)]
pub struct Adjacency {
    starts: Vec<usize>,
    cells: Vec<usize>,
}

impl Adjacency {
    /// The cells around one node, in increasing order.
    pub fn cells(&self, node: usize) -> &[usize] {
        &self.cells[self.starts[node]..self.starts[node + 1]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Cell;
    use crate::mesh::generate::Rectangle;

    #[test]
    fn a_rectangle_has_its_area_its_bounds_and_its_neighbours() {
        let mesh = Rectangle::new([1.0, -2.0], [4.0, 2.0], [3, 2], Cell::named("quad4").unwrap()).mesh("r").unwrap();
        assert!((0..6).all(|cell| (mesh.measure(cell) - 2.0).abs() < 1e-14));
        assert_eq!(mesh.bounds(), BoundingBox { min: Vec3([1.0, -2.0, 0.0]), max: Vec3([4.0, 2.0, 0.0]) });
        assert_eq!((mesh.size(), mesh.dimension()), (5.0, 2));
        let adjacency = mesh.adjacency();
        assert_eq!(adjacency.cells(5), [0, 1, 3, 4]);
        assert_eq!(adjacency.cells(0), [0]);
    }
}
