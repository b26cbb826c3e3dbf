//! What of a mesh is seen: the cells of a plane mesh, the outer faces of a solid one from far to near; their outlines,
//! curved for second degree, and the tiles that carry a colour field.

use super::drawing::{Point, Segment};
use super::view::View;
use asperity_core::mesh::cells::MAX_NODES;
use asperity_core::mesh::{Cell, Mesh};
use std::collections::BTreeMap;

/// A plane piece of the picture: a reference cell of dimension 2 and its nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct Facet {
    /// Its reference cell.
    pub kind: &'static Cell,
    /// Its nodes.
    pub nodes: Vec<usize>,
}

/// An edge of a facet: its nodes in the order of a line (ends first, then the middle).
pub type Edge = Vec<usize>;

/// The facets of a mesh: its plane cells, or the faces of its solid cells that no other cell shares.
pub fn facets(mesh: &Mesh) -> Vec<Facet> {
    let mut outer: BTreeMap<Vec<usize>, Option<Facet>> = BTreeMap::new();
    let mut plane = Vec::new();
    for cell in (0..mesh.cell_count()).map(|c| mesh.cell(c)) {
        if cell.kind.dimension == 2 {
            plane.push(Facet { kind: cell.kind, nodes: cell.nodes.to_vec() });
        }
        for face in cell.kind.faces.iter().filter(|face| face.cell.dimension == 2) {
            let nodes: Vec<usize> = face.nodes.iter().map(|&i| cell.nodes[i]).collect();
            let mut key = nodes.clone();
            key.sort_unstable();
            outer.entry(key).and_modify(|facet| *facet = None).or_insert(Some(Facet { kind: face.cell, nodes }));
        }
    }
    plane.into_iter().chain(outer.into_values().flatten()).collect()
}

/// The edges of facets with the number of facets at each, in a fixed order.
pub fn edges(facets: &[Facet]) -> Vec<(Edge, usize)> {
    let mut found: BTreeMap<[usize; 2], (Edge, usize)> = BTreeMap::new();
    for edge in facets.iter().flat_map(Facet::edges) {
        let key = [edge[0].min(edge[1]), edge[0].max(edge[1])];
        found.entry(key).and_modify(|(_, count)| *count += 1).or_insert((edge, 1));
    }
    found.into_values().collect()
}

/// An edge as a path; the parabola through three nodes is drawn exactly.
pub fn edge_path(edge: &[usize], at: impl Fn(usize) -> Point) -> Vec<Segment> {
    vec![Segment::Move(at(edge[0])), edge_segment(edge, at)]
}

fn edge_segment(edge: &[usize], at: impl Fn(usize) -> Point) -> Segment {
    let end = at(edge[1]);
    match edge.get(2) {
        None => Segment::Line(end),
        Some(&middle) => {
            let (start, middle) = (at(edge[0]), at(middle));
            Segment::Quad([0, 1].map(|a| 2.0 * middle[a] - 0.5 * (start[a] + end[a])), end)
        }
    }
}

impl Facet {
    /// Its edges, in turn around it.
    pub fn edges(&self) -> impl Iterator<Item = Edge> + '_ {
        self.kind.faces.iter().map(|face| face.nodes.iter().map(|&i| self.nodes[i]).collect())
    }
    /// Its outline.
    pub fn outline(&self, at: impl Fn(usize) -> Point) -> Vec<Segment> {
        let mut path = vec![Segment::Move(at(self.nodes[0]))];
        path.extend(self.edges().map(|edge| edge_segment(&edge, &at)));
        path.push(Segment::Close);
        path
    }
    /// How near its middle is to the eye.
    pub fn nearness(&self, view: &View, points: &[[f64; 3]]) -> f64 {
        let sum: f64 = self.nodes.iter().map(|&n| view.projection.nearness(points[n])).sum();
        sum / self.nodes.len() as f64
    }
    /// Tiles of about `size` points of the page with the mean of a nodal field on each.
    pub fn tiles(&self, at: impl Fn(usize) -> Point, field: &[f64], size: f64) -> Vec<(Vec<Point>, f64)> {
        let corners = self.kind.linear.nodes.len();
        let span = self.edges().map(|edge| distance(at(edge[0]), at(edge[1]))).fold(0.0, f64::max);
        let parts = ((span / size).ceil() as usize).clamp(1, 12);
        let sample = |xi: [f64; 2]| self.sample(xi, &at, |node| field[node]);
        let tile = |corners: Vec<[f64; 2]>| {
            let (points, values): (Vec<Point>, Vec<f64>) = corners.into_iter().map(sample).unzip();
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            (points, mean)
        };
        pieces(corners, parts).into_iter().map(tile).collect()
    }
    /// Its middle, and a nodal field there.
    pub fn middle(&self, at: impl Fn(usize) -> Point, field: impl Fn(usize) -> f64) -> (Point, f64) {
        self.sample(if self.kind.linear.nodes.len() == 4 { [0.0; 2] } else { [1.0 / 3.0; 2] }, at, field)
    }
    fn sample(&self, xi: [f64; 2], at: impl Fn(usize) -> Point, field: impl Fn(usize) -> f64) -> (Point, f64) {
        let (mut n, mut dn) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
        let count = self.nodes.len();
        (self.kind.shape)([xi[0], xi[1], 0.0], &mut n[..count], &mut dn[..count]);
        self.nodes.iter().zip(n).fold(([0.0, 0.0], 0.0), |([x, y], value), (&node, n)| {
            let p = at(node);
            ([x + n * p[0], y + n * p[1]], value + n * field(node))
        })
    }
}

/// The reference triangle or square cut into `parts` along each side.
fn pieces(corners: usize, parts: usize) -> Vec<Vec<[f64; 2]>> {
    let step = 1.0 / parts as f64;
    let mut out = Vec::new();
    for (i, j) in (0..parts).flat_map(|i| (0..parts).map(move |j| (i, j))) {
        let at = |di: usize, dj: usize| [(i + di) as f64 * step, (j + dj) as f64 * step];
        if corners == 4 {
            out.push([at(0, 0), at(1, 0), at(1, 1), at(0, 1)].map(|[x, y]| [2.0 * x - 1.0, 2.0 * y - 1.0]).to_vec());
        } else if i + j < parts {
            out.push(vec![at(0, 0), at(1, 0), at(0, 1)]);
            if i + j + 1 < parts {
                out.push(vec![at(1, 0), at(1, 1), at(0, 1)]);
            }
        }
    }
    out
}

fn distance(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

#[cfg(test)]
mod tests {
    use super::super::drawing::Rect;
    use super::super::view::{Projection, Window};
    use super::*;
    use asperity_core::tensor::Vec3;

    /// Two quads of second degree side by side.
    fn pair() -> Mesh {
        let mut mesh = Mesh::new();
        let kind = Cell::named("quad8").unwrap();
        for shift in [0.0, 2.0] {
            let nodes: Vec<usize> = kind
                .nodes
                .iter()
                .map(|x| {
                    let p = Vec3::new(x[0] + shift, x[1], 0.0);
                    mesh.points.iter().position(|q| *q == p).unwrap_or_else(|| {
                        mesh.points.push(p);
                        mesh.points.len() - 1
                    })
                })
                .collect();
            mesh.push_cell(kind, &nodes);
        }
        mesh
    }

    #[test]
    fn a_shared_edge_is_drawn_once() {
        let edges = edges(&facets(&pair()));
        assert_eq!(edges.len(), 7);
        assert_eq!(edges.iter().filter(|(_, count)| *count == 2).count(), 1);
        assert!(edges.iter().all(|(edge, _)| edge.len() == 3));
    }

    #[test]
    fn a_curved_edge_passes_through_its_middle_node() {
        let points = [[0.0, 0.0], [2.0, 0.0], [1.0, 1.0]];
        let path = edge_path(&[0, 1, 2], |i| points[i]);
        assert_eq!(path[1], Segment::Quad([1.0, 2.0], [2.0, 0.0]));
    }

    #[test]
    fn tiles_fill_a_facet_and_follow_the_field() {
        let mesh = pair();
        let facet = &facets(&mesh)[0];
        let at = |i: usize| [10.0 * mesh.points[i][0], 10.0 * mesh.points[i][1]];
        let field: Vec<f64> = mesh.points.iter().map(|p| p[0]).collect();
        let tiles = facet.tiles(at, &field, 5.0);
        let area = |p: &[Point]| -> f64 {
            (0..p.len()).map(|i| (p[i], p[(i + 1) % p.len()])).map(|(a, b)| 0.5 * (a[0] * b[1] - a[1] * b[0])).sum()
        };
        assert!((tiles.iter().map(|(p, _)| area(p)).sum::<f64>() - 400.0).abs() < 1e-9);
        for (points, value) in &tiles {
            let mean = points.iter().map(|p| p[0]).sum::<f64>() / points.len() as f64;
            assert!((10.0 * value - mean).abs() < 1e-9);
        }
    }

    #[test]
    fn triangles_are_cut_without_gaps() {
        let area = |p: &[[f64; 2]]| {
            0.5 * ((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[2][0] - p[0][0]) * (p[1][1] - p[0][1]))
        };
        for parts in 1..6 {
            let total: f64 = pieces(3, parts).iter().map(|p| area(p)).sum();
            assert!((total - 0.5).abs() < 1e-12);
        }
    }

    #[test]
    fn near_facets_are_known() {
        let frame = Rect { x: 0.0, y: 0.0, width: 1.0, height: 1.0 };
        let window = Window { low: [0.0; 2], high: [1.0; 2] };
        let view = View { projection: Projection::Corner, window, frame };
        let facet = |node| Facet { kind: Cell::named("quad4").unwrap(), nodes: vec![node; 4] };
        let points = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
        assert!(facet(1).nearness(&view, &points) > facet(0).nearness(&view, &points));
    }
}
