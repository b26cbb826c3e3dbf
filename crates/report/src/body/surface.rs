//! What of a mesh is seen: the cells of a plane mesh, the outer faces of a solid one, as triangles and edges.

use asperity_core::mesh::{Cell, Mesh};
use std::collections::BTreeMap;

/// The visible part of a mesh.
#[derive(Debug, Default)]
pub struct Surface {
    /// Corners of triangles, by node.
    pub triangles: Vec<[usize; 3]>,
    /// The cell of each triangle.
    pub cells: Vec<usize>,
    /// Pieces of the edges of cells, by node; those of the boundary of a plane mesh come first.
    pub edges: Vec<[usize; 2]>,
    /// How many of them are the boundary.
    pub boundary: usize,
}

/// A face of the picture: its cell, its kind and its nodes.
type Facet = (usize, &'static Cell, Vec<usize>);

impl Surface {
    /// The surface of a mesh.
    pub fn of(mesh: &Mesh) -> Self {
        let facets = facets(mesh);
        let mut surface = Self::default();
        let mut edges: BTreeMap<[usize; 2], (Vec<usize>, usize)> = BTreeMap::new();
        for (cell, kind, nodes) in &facets {
            let around: Vec<Vec<usize>> =
                kind.faces.iter().map(|face| face.nodes.iter().map(|&i| nodes[i]).collect()).collect();
            for triangle in triangles(kind, nodes, &around) {
                surface.triangles.push(triangle);
                surface.cells.push(*cell);
            }
            for edge in around {
                let key = [edge[0].min(edge[1]), edge[0].max(edge[1])];
                edges.entry(key).and_modify(|(_, count)| *count += 1).or_insert((edge, 1));
            }
        }
        let (outer, inner): (Vec<_>, Vec<_>) = edges.into_values().partition(|(_, count)| *count == 1);
        surface.edges = outer.iter().flat_map(|(edge, _)| pieces(edge)).collect();
        surface.boundary = surface.edges.len();
        surface.edges.extend(inner.iter().flat_map(|(edge, _)| pieces(edge)));
        surface
    }
}

/// An edge as straight pieces; the node between stands last.
fn pieces(edge: &[usize]) -> Vec<[usize; 2]> {
    match *edge {
        [a, b, between, ..] => vec![[a, between], [between, b]],
        [a, b] => vec![[a, b]],
        _ => Vec::new(),
    }
}

/// Plane cells, and the faces of solid cells that no other cell shares.
fn facets(mesh: &Mesh) -> Vec<Facet> {
    let mut outer: BTreeMap<Vec<usize>, Option<Facet>> = BTreeMap::new();
    let mut plane = Vec::new();
    for (index, cell) in (0..mesh.cell_count()).map(|c| (c, mesh.cell(c))) {
        if cell.kind.dimension == 2 {
            plane.push((index, cell.kind, cell.nodes.to_vec()));
        }
        for face in cell.kind.faces.iter().filter(|face| face.cell.dimension == 2) {
            let nodes: Vec<usize> = face.nodes.iter().map(|&i| cell.nodes[i]).collect();
            let mut key = nodes.clone();
            key.sort_unstable();
            outer.entry(key).and_modify(|facet| *facet = None).or_insert(Some((index, face.cell, nodes)));
        }
    }
    plane.into_iter().chain(outer.into_values().flatten()).collect()
}

/// A facet as triangles on its nodes, with nodes between the corners as corners of their own.
fn triangles(kind: &Cell, nodes: &[usize], around: &[Vec<usize>]) -> Vec<[usize; 3]> {
    let corners = kind.linear.nodes.len();
    let middles: Vec<usize> = around.iter().filter_map(|edge| edge.get(2).copied()).collect();
    if middles.len() != corners {
        return fan(&nodes[..corners]);
    }
    let corner = |i: usize| [middles[(i + corners - 1) % corners], nodes[i], middles[i]];
    let inner = match nodes.get(2 * corners) {
        Some(&centre) => (0..corners).map(|i| [centre, middles[i], middles[(i + 1) % corners]]).collect(),
        None => fan(&middles),
    };
    (0..corners).map(corner).chain(inner).collect()
}

fn fan(corners: &[usize]) -> Vec<[usize; 3]> {
    corners.windows(2).skip(1).map(|pair| [corners[0], pair[0], pair[1]]).collect()
}

/// Tetrahedra on the corners of a solid cell, positions in its list of nodes.
pub fn tetrahedra(kind: &Cell) -> &'static [[usize; 4]] {
    match kind.linear.name {
        "tet4" => &[[0, 1, 2, 3]],
        "wedge6" => &[[0, 1, 2, 5], [0, 1, 5, 4], [0, 4, 5, 3]],
        "hex8" => &[[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]],
        _ => &[],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_core::mesh::cells::ALL;
    use asperity_core::tensor::Vec3;

    fn single(kind: &'static Cell) -> Mesh {
        let mut mesh = Mesh::new();
        mesh.points = kind.nodes.iter().map(|&x| Vec3(x)).collect();
        mesh.push_cell(kind, &(0..kind.nodes.len()).collect::<Vec<_>>());
        mesh
    }

    fn cross(a: Vec3<f64>, b: Vec3<f64>) -> Vec3<f64> {
        Vec3([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
    }
    fn dot(a: Vec3<f64>, b: Vec3<f64>) -> f64 {
        (0..3).map(|i| a[i] * b[i]).sum()
    }

    /// The triangles close: what flows out of a constant field is nothing, and they enclose the volume of the cell, as do
    /// the tetrahedra.
    #[test]
    fn triangles_enclose_each_solid_cell_and_tetrahedra_fill_it() {
        for kind in ALL.iter().copied().filter(|kind| kind.dimension == 3) {
            let mesh = single(kind);
            let surface = Surface::of(&mesh);
            let p = |i: usize| mesh.points[i];
            let volume: f64 = surface.triangles.iter().map(|&[a, b, c]| dot(p(a), cross(p(b), p(c))) / 6.0).sum();
            let reference: f64 = kind.full.weights.iter().sum();
            assert!((volume - reference).abs() < 1e-12, "{}: {volume} of {reference}", kind.name);
            let tets = tetrahedra(kind);
            let tet = |t: &[usize; 4]| dot(p(t[1]) - p(t[0]), cross(p(t[2]) - p(t[0]), p(t[3]) - p(t[0]))) / 6.0;
            assert!(tets.iter().all(|t| tet(t) > 0.0), "{}", kind.name);
            let filled: f64 = tets.iter().map(tet).sum();
            assert!((filled - reference).abs() < 1e-12, "{}: {filled}", kind.name);
        }
    }

    #[test]
    fn triangles_cover_each_plane_cell() {
        for kind in ALL.iter().copied().filter(|kind| kind.dimension == 2) {
            let mesh = single(kind);
            let surface = Surface::of(&mesh);
            let p = |i: usize| mesh.points[i];
            let area: f64 = surface.triangles.iter().map(|&[a, b, c]| 0.5 * cross(p(b) - p(a), p(c) - p(a))[2]).sum();
            assert!((area - kind.full.weights.iter().sum::<f64>()).abs() < 1e-12, "{}", kind.name);
            assert_eq!(surface.boundary, surface.edges.len());
        }
    }
}
