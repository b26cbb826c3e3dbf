//! What of a solid picture is hidden: a depth test of single points against the triangles of all facets, exact for plane
//! facets and near for warped ones. Nothing here draws.

use super::facets::Facet;
use super::view::View;

/// A point of a facet must lie this part of its triangle's size nearer to the eye than what it hides: what lies on the
/// facet itself is seen.
const SLACK: f64 = 0.1;
/// Strips of the picture in which triangles are looked for.
const STRIPS: usize = 256;

/// A corner of a triangle: right, up, towards the eye.
type Corner = [f64; 3];

/// All facets of a picture, as triangles by strips from left to right.
pub struct Cover {
    left: f64,
    width: f64,
    strips: Vec<Vec<[Corner; 3]>>,
}

impl Cover {
    /// The facets of a mesh whose nodes are at `points`, as `view` sees them.
    pub fn new(facets: &[Facet], view: &View, points: &[[f64; 3]]) -> Self {
        let nodes: Vec<Corner> = points.iter().map(|&point| seen(view, point)).collect();
        let triangles: Vec<[Corner; 3]> = facets.iter().flat_map(|facet| triangles(facet, &nodes)).collect();
        let ends = |t: &[Corner; 3]| t.iter().fold([f64::MAX, f64::MIN], |[l, h], c| [l.min(c[0]), h.max(c[0])]);
        let [left, right] =
            triangles.iter().map(ends).fold([f64::MAX, f64::MIN], |[l, h], [a, b]| [l.min(a), h.max(b)]);
        let mut cover = Self { left, width: right - left, strips: vec![Vec::new(); STRIPS] };
        for triangle in triangles {
            let [from, to] = ends(&triangle).map(|x| cover.strip(x));
            cover.strips[from..=to].iter_mut().for_each(|strip| strip.push(triangle));
        }
        cover
    }
    /// Whether something stands between a point of space and the eye.
    pub fn hides(&self, view: &View, point: [f64; 3]) -> bool {
        let point = seen(view, point);
        self.strips[self.strip(point[0])].iter().any(|triangle| stands_before(triangle, point))
    }
    fn strip(&self, x: f64) -> usize {
        // A cast of what is no number, or below zero, gives zero.
        (((x - self.left) / self.width * STRIPS as f64) as usize).min(STRIPS - 1)
    }
}

/// A facet as triangles about its middle; with middle nodes two of them stand on an edge.
fn triangles(facet: &Facet, nodes: &[Corner]) -> Vec<[Corner; 3]> {
    let nearness = |node: usize| nodes[node][2];
    let ([right, up], near) = facet.middle(|node| [nodes[node][0], nodes[node][1]], nearness);
    let middle = [right, up, near];
    let halves = |edge: Vec<usize>| match edge[..] {
        [a, b, between, ..] => vec![[a, between], [between, b]],
        [a, b] => vec![[a, b]],
        _ => Vec::new(),
    };
    facet.edges().flat_map(halves).map(|[a, b]| [nodes[a], nodes[b], middle]).collect()
}

fn seen(view: &View, point: [f64; 3]) -> Corner {
    let [right, up] = view.projection.flat(point);
    [right, up, view.projection.nearness(point)]
}

fn stands_before(&[a, b, c]: &[Corner; 3], point: Corner) -> bool {
    let cross = |o: Corner, p: Corner, q: Corner| (p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0]);
    let area = cross(a, b, c);
    let weights = [cross(point, b, c), cross(point, c, a), cross(point, a, b)].map(|part| part / area);
    if !weights.iter().all(|&weight| weight >= 0.0) {
        return false;
    }
    let nearness = weights[0] * a[2] + weights[1] * b[2] + weights[2] * c[2];
    let size = |p: Corner, q: Corner| (0..3).map(|i| (p[i] - q[i]).powi(2)).sum::<f64>().sqrt();
    nearness - point[2] > SLACK * size(a, b).max(size(b, c)).max(size(c, a))
}

#[cfg(test)]
mod tests {
    use super::super::drawing::Rect;
    use super::super::facets::facets;
    use super::super::view::{Projection, Window};
    use super::*;
    use asperity_core::mesh::{Cell, Mesh};
    use asperity_core::tensor::Vec3;

    #[test]
    fn only_the_sides_that_look_to_the_eye_are_seen() {
        let mut mesh = Mesh::new();
        let kind = Cell::named("hex8").unwrap();
        mesh.points = kind.nodes.iter().map(|&x| Vec3(x)).collect();
        mesh.push_cell(kind, &[0, 1, 2, 3, 4, 5, 6, 7]);
        let frame = Rect { x: 0.0, y: 0.0, width: 100.0, height: 100.0 };
        let view = View { projection: Projection::Corner, window: Window { low: [-2.0; 2], high: [2.0; 2] }, frame };
        let points: Vec<[f64; 3]> = mesh.points.iter().map(|p| p.0).collect();
        let cover = Cover::new(&facets(&mesh), &view, &points);
        for (axis, end) in (0..3).flat_map(|axis| [(axis, -1.0), (axis, 1.0)]) {
            let mut middle = [0.1, 0.2, 0.3];
            middle[axis] = end;
            assert_eq!(cover.hides(&view, middle), end < 0.0, "axis {axis}, end {end}");
        }
        // A warped side: the point lies on it, behind the planes through three of its corners.
        let mut points = points;
        let corner = points.iter().position(|p| *p == [-1.0, 1.0, -1.0]).unwrap();
        points[corner][1] = 0.5;
        let cover = Cover::new(&facets(&mesh), &view, &points);
        assert!(!cover.hides(&view, [0.0, 0.875, 0.0]) && cover.hides(&view, [0.0, 0.5, 0.0]));
        assert!(!cover.hides(&view, [9.0, 0.0, 0.0]) && !cover.hides(&view, [0.0, 9.0, 0.0]), "beside the body");
        assert!(!Cover::new(&[], &view, &[]).hides(&view, [0.0; 3]));
    }
}
