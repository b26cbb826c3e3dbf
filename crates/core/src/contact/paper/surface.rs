//! Where the Gauss points lie on the faces that carry the element.

use crate::contact::field::FieldSurface;
use crate::contact::field::face::{FieldFace, ShapeFunctions};
use crate::mesh::Mesh;
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

/// The points of a surface, face by face, with `gauss` along an edge or each side of a face; by default as many as
/// the degree of the face, and around the axis of axial symmetry, where a point stands for a circumference, two also on an edge of
/// first degree over which the radius changes markedly. More points than the face adds nodes enforce more conditions than it can
/// meet.
pub fn gauss_points(mesh: &Mesh, surface: &FieldSurface, gauss: Option<usize>) -> Vec<GaussPoint> {
    let least = |face: &FieldFace| if surface.revolves && is_marked(face, mesh) { 2 } else { 1 };
    let mut points = Vec::new();
    for (number, face) in surface.faces.iter().enumerate() {
        let order = gauss.unwrap_or_else(|| face.kind.degree.max(least(face)));
        for ([a, b, _], weight) in face.kind.surface_rule(order) {
            points.push(GaussPoint { face: number, xi: [a, b], shape: face.shape([a, b]), weight });
        }
    }
    points
}

/// Numbers of the points of a face.
pub fn points_of(points: &[GaussPoint], face: usize) -> Range<usize> {
    let place = |face: usize| points.partition_point(|point| point.face < face);
    place(face)..place(face + 1)
}

/// Whether the radius changes markedly over an edge.
fn is_marked(edge: &FieldFace, mesh: &Mesh) -> bool {
    let [from, to] = [0, 1].map(|end| mesh.points[edge.nodes[end]][0]);
    (to - from).abs() > MARKED * (from + to).abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::generate::Rectangle;
    use crate::mesh::{Cell, Space};

    /// Near the axis two points, and one on edges along it or far away; what the user says holds everywhere.
    #[test]
    fn edges_near_the_axis_have_two_points() {
        let cell = Cell::named("quad4").unwrap();
        let plate = Rectangle::new([0.0, 0.0], [15.0, 1.0], [15, 1], cell).mesh("plate").unwrap();
        let counts = |group: &str, gauss| {
            let surface = FieldSurface::whole(&plate, &plate.groups[group].sides, Space::Axisymmetric, 1.0);
            let points = gauss_points(&plate, &surface, gauss);
            (0..surface.faces.len()).map(|edge| points_of(&points, edge).len()).collect::<Vec<_>>()
        };
        let mut top = counts("plate.top", None);
        top.sort_unstable();
        assert_eq!(top, [[1; 5].as_slice(), &[2; 10]].concat());
        assert_eq!(counts("plate.right", None), [1]);
        assert_eq!(counts("plate.top", Some(1)), [1; 15]);
    }
}
