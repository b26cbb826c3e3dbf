//! Convex corners of a surface of bodies: in the plane where two smooth pieces meet, in space points along the edges between them, and
//! vertices.

use super::surface::{BodyEdge, FieldSurface};
use crate::mesh::Mesh;
use std::collections::BTreeMap;

/// Ways in which a corner touches: the face before which it lies, or, where it does not see that any more, one beyond whose end it lies, as
/// a corner that goes past another.
pub const WAYS: usize = 2;

/// A convex corner of one of the two sides of a contact of bodies, in space a point of an edge or a vertex.
#[derive(Debug, Clone)]
pub struct BodyCorner {
    /// Whether it is one of the surface, or else of the target.
    pub own: bool,
    /// The faces that meet in it.
    pub flanks: Vec<Flank>,
    /// The node of the mesh that it is, or the nearer end of its edge, and those to which edges run from that.
    pub nodes: Vec<usize>,
    /// In space the nodes between which its edge runs; none at a vertex, nor in the plane.
    pub edge: Option<[usize; 2]>,
    /// Undeformed area of the flanks around it.
    pub area: f64,
    /// The length of the shortest of them.
    pub size: f64,
    /// The angle by which they bend beside it before any motion.
    pub bend: f64,
}

/// A face beside a corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flank {
    /// The face.
    pub face: usize,
    /// The place of the corner on it,
    pub xi: [f64; 2],
    /// and the number of that among the corners of the face, none between the ends of an edge.
    pub at: Option<usize>,
}

impl BodyCorner {
    /// Those of a surface; in space also points of its edges half of such a length apart.
    pub fn all(surface: &FieldSurface, mesh: &Mesh, own: bool, length: f64) -> Vec<Self> {
        let edges = surface.edges(mesh);
        let node = |edge: &BodyEdge, end: usize| surface.faces[edge.faces[0]].corner_node(edge.ends[end]);
        let flank = |face: usize, [a, b]: [usize; 2], t: f64| {
            let of = &surface.faces[face];
            let corner = |node: usize| (0..of.corners()).find(|&corner| of.corner_node(corner) == node);
            let [from, to] = [a, b].map(|node| corner(node).map_or([0.0; 2], |corner| of.corner_place(corner)));
            let at = if t == 0.0 { corner(a) } else { None };
            Flank { face, xi: std::array::from_fn(|k| from[k] + t * (to[k] - from[k])), at }
        };
        let half = |face: usize| {
            let (of, rest) = (&surface.faces[face], surface.faces[face].at_rest(mesh));
            0.5 * (0..of.corners()).map(|corner| surface.corner_area(of, &rest, corner).0).sum::<f64>()
        };
        let strip = |edge: &BodyEdge| edge.faces.iter().map(|&face| half(face)).sum::<f64>();
        let parts = |edge: &BodyEdge| {
            let [a, b] = [0, 1].map(|end| mesh.points[node(edge, end)]);
            if surface.plane { 1 } else { ((2.0 * (b - a).norm() / length).ceil() as usize).clamp(1, PARTS) }
        };
        let make = |flanks: Vec<Flank>, nodes: Vec<usize>, edge: Option<[usize; 2]>, area: f64| {
            let sizes = flanks.iter().map(|flank| surface.size(flank.face, mesh));
            let bends = flanks.iter().map(|flank| surface.bends[flank.face]);
            let (size, bend) = (sizes.fold(f64::INFINITY, f64::min), bends.fold(0.0, f64::max));
            Self { own, flanks, nodes, edge, area, size, bend }
        };
        let mut around: BTreeMap<usize, Vec<(&BodyEdge, usize)>> = BTreeMap::new();
        let mut all = Vec::new();
        for edge in &edges {
            let [a, b] = [0, 1].map(|end| node(edge, end));
            around.entry(a).or_default().push((edge, b));
            if surface.plane {
                continue;
            }
            around.entry(b).or_default().push((edge, a));
            let count = parts(edge);
            for t in (1..count).map(|k| k as f64 / count as f64) {
                let flanks = edge.faces.iter().map(|&face| flank(face, [a, b], t)).collect();
                let nodes = if t > 0.5 { [b, a] } else { [a, b] };
                all.push(make(flanks, nodes.to_vec(), Some([a, b]), strip(edge) / count as f64));
            }
        }
        for (node, edges) in around {
            let mut flanks: Vec<Flank> = Vec::new();
            for flank in edges.iter().flat_map(|(edge, other)| edge.faces.map(|face| flank(face, [node, *other], 0.0)))
            {
                if !flanks.contains(&flank) {
                    flanks.push(flank);
                }
            }
            // In the plane half of both flanks; of an edge in space half of the part next to its end.
            let part = |edge: &BodyEdge| strip(edge) / if surface.plane { 1.0 } else { 2.0 * parts(edge) as f64 };
            let area = edges.iter().map(|(edge, _)| part(edge)).sum();
            let way = |other: usize| (mesh.points[other] - mesh.points[node]).unit();
            let edge = match edges[..] {
                [(_, a), (_, b)] if !surface.plane && way(a).dot(way(b)) < STRAIGHT => Some([a, b]),
                _ => None,
            };
            let nodes = std::iter::once(node).chain(edges.iter().map(|(_, other)| *other)).collect();
            all.push(make(flanks, nodes, edge, area));
        }
        all
    }

    /// The nodes of the line that tangents follow in space.
    pub fn line(&self) -> [usize; 2] {
        self.edge.unwrap_or([self.nodes[0], self.nodes[self.nodes.len() - 1]])
    }
}

/// Most points of an edge.
const PARTS: usize = 16;
/// Cosine between both parts of an edge at a node below which it is none of a vertex.
const STRAIGHT: f64 = -0.8;
