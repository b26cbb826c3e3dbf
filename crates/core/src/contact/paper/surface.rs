//! The faces that carry the element, with their Gauss points.

use crate::contact::field::FieldSurface;
use crate::contact::field::face::{FieldFace, ShapeFunctions};
use crate::mesh::{Mesh, Side, Space};
use std::ops::Range;

/// Change of the radius over an edge, as a part of the sum of those of its ends, from which one point does not integrate it:
/// that of the tenth of equal edges from the axis on. Beyond, the nodes between two edges get what is theirs within a
/// hundredth.
const MARKED: f64 = 0.05;

/// One integration point of a surface.
#[derive(Debug, Clone, Copy)]
pub struct GaussPoint {
    /// The face it lies on.
    pub face: usize,
    /// Reference coordinates.
    pub xi: [f64; 2],
    /// Shape functions there.
    pub shape: ShapeFunctions,
    /// Quadrature weight.
    pub weight: f64,
}

/// Faces and their Gauss points, in a fixed order.
#[derive(Debug, Clone)]
pub struct PointSurface {
    /// The faces.
    pub faces: FieldSurface,
    /// The points, face by face.
    pub points: Vec<GaussPoint>,
}

impl PointSurface {
    /// The surface made of `sides`, with `gauss` points along an edge or each side of a face; by default as many as
    /// the degree of the face, and around the axis of axial symmetry, where a point stands for a circumference, two also on an edge of
    /// first degree over which the radius changes markedly. More points than the face adds nodes enforce more conditions than it can
    /// meet.
    pub fn new(mesh: &Mesh, sides: &[Side], (space, thickness): (Space, f64), gauss: Option<usize>) -> Self {
        let faces = FieldSurface::whole(mesh, sides, space, thickness);
        let least = |face: &FieldFace| if space == Space::Axisymmetric && is_marked(face, mesh) { 2 } else { 1 };
        let mut points = Vec::new();
        for (number, face) in faces.faces.iter().enumerate() {
            let order = gauss.unwrap_or_else(|| face.kind.degree.max(least(face)));
            for ([a, b, _], weight) in face.kind.surface_rule(order) {
                points.push(GaussPoint { face: number, xi: [a, b], shape: face.shape([a, b]), weight });
            }
        }
        Self { faces, points }
    }

    /// Numbers of the points of a face, which follow each other.
    pub fn points_of(&self, face: usize) -> Range<usize> {
        let place = |face: usize| self.points.partition_point(|point| point.face < face);
        place(face)..place(face + 1)
    }

    /// The face of a point.
    pub fn face(&self, point: usize) -> &FieldFace {
        &self.faces.faces[self.points[point].face]
    }
}

/// Whether the radius changes markedly over an edge.
fn is_marked(edge: &FieldFace, mesh: &Mesh) -> bool {
    let [from, to] = [0, 1].map(|end| mesh.points[edge.nodes[end]][0]);
    (to - from).abs() > MARKED * (from + to).abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Cell;
    use crate::mesh::generate::Rectangle;

    /// Near the axis two points, and one on edges along it or far away; what the user says holds everywhere.
    #[test]
    fn edges_near_the_axis_have_two_points() {
        let cell = Cell::named("quad4").unwrap();
        let plate = Rectangle::new([0.0, 0.0], [15.0, 1.0], [15, 1], cell).mesh("plate").unwrap();
        let counts = |group: &str, gauss| {
            let place = (Space::Axisymmetric, 1.0);
            let surface = PointSurface::new(&plate, &plate.groups[group].sides, place, gauss);
            (0..surface.faces.faces.len()).map(|edge| surface.points_of(edge).len()).collect::<Vec<_>>()
        };
        let mut top = counts("plate.top", None);
        top.sort_unstable();
        assert_eq!(top, [[1; 5].as_slice(), &[2; 10]].concat());
        assert_eq!(counts("plate.right", None), [1]);
        assert_eq!(counts("plate.top", Some(1)), [1; 15]);
    }
}
