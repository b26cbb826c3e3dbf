//! How thick a body is: the median, over its surface, of the straight way through it.

use super::{Mesh, Side};
use crate::tensor::Vec3;

/// Sides from which ways through a body are measured, at most.
const SAMPLES: usize = 200;
/// Part of an edge or triangle by which a ray may pass beside it.
const SLACK: f64 = 1e-9;

impl Mesh {
    /// The median, by area, of the lengths of rays from the middles of boundary sides along their inward normals to where they leave the
    /// body; of many sides some. Zero where no ray leaves.
    pub fn thickness(&self, sides: &[Side], boundary: &[Side]) -> f64 {
        let chosen = sides.iter().step_by(sides.len().div_ceil(SAMPLES).max(1));
        let ways = chosen.filter_map(|&side| Some((self.way_through(side, boundary)?, self.extent(side))));
        median(ways.collect())
    }

    /// Length of the ray inward from the middle of a side to the nearest other side.
    fn way_through(&self, side: Side, boundary: &[Side]) -> Option<f64> {
        let corners = self.corners(side);
        let middle = corners.iter().fold(Vec3::zero(), |sum, &x| sum + x) * (corners.len() as f64).recip();
        let inward = match corners[..] {
            [a, b] => (b - a).left().unit(),
            _ => (corners[2] - corners[0]).cross(corners[1] - corners[0]).unit(),
        };
        let others = boundary.iter().filter(|&&other| other != side);
        others.filter_map(|&other| meets(middle, inward, &self.corners(other))).min_by(f64::total_cmp)
    }

    fn corners(&self, side: Side) -> Vec<Vec3> {
        let (kind, nodes) = self.side(side);
        nodes.take(kind.linear.nodes.len()).map(|node| self.points[node]).collect()
    }
}

/// The value below which half of the weights lie.
pub fn median(mut weighted: Vec<(f64, f64)>) -> f64 {
    weighted.sort_by(|one, other| one.0.total_cmp(&other.0));
    let half = 0.5 * weighted.iter().map(|(_, weight)| weight).sum::<f64>();
    let mut passed = 0.0;
    let middle = weighted.iter().find(|(_, weight)| {
        passed += weight;
        passed >= half
    });
    middle.map_or(0.0, |(value, _)| *value)
}

/// How far along a ray an edge of the plane, or a face taken as triangles about its first corner, is met.
fn meets(from: Vec3, along: Vec3, corners: &[Vec3]) -> Option<f64> {
    let ahead = |way: f64, size: f64| (way > 1e-6 * size).then_some(way);
    if let [a, b] = *corners {
        let (edge, across) = (b - a, along.left());
        let s = (from - a).dot(across) / edge.dot(across);
        return if (-SLACK..=1.0 + SLACK).contains(&s) {
            ahead((a + edge * s - from).dot(along), edge.norm())
        } else {
            None
        };
    }
    // Moeller and Trumbore's test of a ray and a triangle.
    (2..corners.len()).find_map(|k| {
        let [a, p, q] = [corners[0], corners[k - 1] - corners[0], corners[k] - corners[0]];
        let (h, to) = (along.cross(q), from - a);
        let scale = p.dot(h).recip();
        let (s, r) = (scale * to.dot(h), to.cross(p));
        let t = scale * along.dot(r);
        let inside = s >= -SLACK && t >= -SLACK && s + t <= 1.0 + SLACK;
        if inside { ahead(scale * q.dot(r), p.norm()) } else { None }
    })
}

#[cfg(test)]
mod tests {
    use crate::mesh::cells::{HEX8, QUAD4, TET4, TRI3};
    use crate::mesh::generate::{Annulus, Block, Rectangle, Spacing};

    /// Plates, rods, cubes and rings, whatever their cells.
    #[test]
    fn thickness_is_the_way_through() {
        let of = |mesh: &crate::mesh::Mesh| {
            let boundary = mesh.boundary(&(0..mesh.cell_count()).collect::<Vec<_>>());
            mesh.thickness(&boundary, &boundary)
        };
        for (size, cells, wanted) in [([20.0, 1.0], [40, 3], 1.0), ([3.0, 3.0], [5, 5], 3.0)] {
            for kind in [&TRI3, &QUAD4] {
                let mesh = Rectangle::new([1.0, 2.0], [1.0 + size[0], 2.0 + size[1]], cells, kind).mesh("b").unwrap();
                assert!((of(&mesh) - wanted).abs() < 1e-12, "{size:?} {kind:?}: {}", of(&mesh));
            }
        }
        for (size, wanted) in [([20.0, 1.0, 1.0], 1.0), ([10.0, 10.0, 0.5], 0.5), ([2.0, 2.0, 2.0], 2.0)] {
            for kind in [&TET4, &HEX8] {
                let mesh = Block::new([0.0; 3], size, [6, 5, 4], kind).mesh("b").unwrap();
                assert!((of(&mesh) - wanted).abs() < 1e-12, "{size:?} {kind:?}: {}", of(&mesh));
            }
        }
        let [radius, angle] = [Spacing::graded(10.0, 10.5, 2, 1.0), Spacing::graded(0.0, 360.0, 120, 1.0)];
        let ring = Annulus { centre: [0.0; 2], radius, angle, cell: &QUAD4 }.mesh("b").unwrap();
        assert!((of(&ring) - 0.5).abs() < 0.01, "{}", of(&ring));
    }
}
