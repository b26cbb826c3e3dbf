//! The boundary of a connected whole of cells: which vertices and pieces it has, once; where they stand, at each state.

use super::hierarchy::{Bounds, Hierarchy, bounds};
use super::inside::{Depth, depth, is_inside};
use super::simplex::Simplex;
use crate::mesh::{Mesh, Side};
use crate::system::Dofs;
use crate::tensor::Vec3;
use std::collections::{BTreeMap, BTreeSet};

/// A vertex of the boundary: a node, or the centre of a side as a sum over its nodes.
#[derive(Debug, Clone)]
struct Vertex {
    nodes: Vec<(usize, f64)>,
    /// The sides around it.
    sides: Vec<usize>,
}

/// The boundary of a whole.
#[derive(Debug)]
pub struct Surface {
    plane: bool,
    vertices: Vec<Vertex>,
    /// Vertices of each piece, the third twice in the plane.
    pieces: Vec<[usize; 3]>,
    /// The side that each piece is a part of.
    parents: Vec<usize>,
    /// The pieces across the edges of each.
    neighbours: Vec<Vec<usize>>,
    sides: Vec<SideOf>,
    /// Vertices at which it has an edge before any motion.
    sharp: Vec<bool>,
    /// Its nodes.
    pub nodes: Vec<usize>,
}

/// A side and whose it is.
#[derive(Debug)]
struct SideOf {
    body: usize,
    /// Its nodes, sorted.
    nodes: Vec<usize>,
    /// The vertex at its centre, if that is no node.
    centre: Option<usize>,
    /// Whether its edges are of second degree.
    second: bool,
    /// How thick the cell behind it is, undeformed, a length.
    thickness: f64,
}

/// The boundary where it stands.
#[derive(Debug)]
pub struct Placed<'a> {
    /// What it is.
    pub surface: &'a Surface,
    /// The vertices now and at the accepted state.
    pub now: Vec<Vec3>,
    /// The same at the accepted state.
    pub before: Vec<Vec3>,
    /// A box around both.
    pub swept: Bounds,
    /// A box around it now.
    pub bounds: Bounds,
    /// Pieces now, in boxes that hold them before and now.
    pub tree: Hierarchy,
    /// The size of each side: its length, or the root of its area.
    pub sizes: Vec<f64>,
    /// For each side how far the arc through the corners of a curved boundary may lie from its pieces.
    pub sagittas: Vec<f64>,
    /// Unit outward normals of the pieces.
    pub normals: Vec<Vec3>,
}

/// Pieces that turn by less than this against each other stand for a curved boundary, others meet at an edge.
pub const CURVED: f64 = 0.8;

impl Surface {
    /// The boundary of cells that hang together; `body` says whose a cell is.
    pub fn new(mesh: &Mesh, cells: &[usize], body: &dyn Fn(usize) -> usize, plane: bool) -> Self {
        let mut surface = Self {
            plane,
            vertices: Vec::new(),
            pieces: Vec::new(),
            parents: Vec::new(),
            neighbours: Vec::new(),
            sides: Vec::new(),
            sharp: Vec::new(),
            nodes: Vec::new(),
        };
        let mut known = BTreeMap::new();
        for side in mesh.boundary(cells) {
            surface.add(mesh, side, body(side.cell), &mut known);
        }
        surface.nodes = known.into_keys().collect();
        let pieces = surface.at_rest(mesh);
        surface.thicknesses(&pieces);
        surface.neighbours = neighbours(&surface.pieces, plane);
        surface.sharp = surface.edges(&pieces);
        surface
    }

    /// Its pieces before any motion.
    fn at_rest(&self, mesh: &Mesh) -> Vec<Simplex> {
        let at = |vertex: &Vertex| {
            vertex.nodes.iter().fold(Vec3::zero(), |sum, &(node, weight)| sum + mesh.points[node] * weight)
        };
        let x: Vec<Vec3> = self.vertices.iter().map(at).collect();
        (0..self.pieces.len()).map(|i| self.piece(&x, i)).collect()
    }

    /// Vertices at which two of these pieces meet at an edge.
    fn edges(&self, pieces: &[Simplex]) -> Vec<bool> {
        let normals: Vec<Vec3> = pieces.iter().map(Simplex::direction).collect();
        let mut sharp = vec![false; self.vertices.len()];
        for (i, around) in self.neighbours.iter().enumerate() {
            for &j in around.iter().filter(|&&j| (normals[i] - normals[j]).norm() >= CURVED) {
                let shared = self.pieces[i].iter().filter(|vertex| self.pieces[j].contains(vertex));
                shared.for_each(|&vertex| sharp[vertex] = true);
            }
        }
        sharp
    }
    /// Whether a vertex lies on an edge of the boundary,
    pub fn is_sharp(&self, vertex: usize) -> bool {
        self.sharp[vertex]
    }
    /// and a piece at one.
    pub fn is_at_edge(&self, piece: usize) -> bool {
        self.pieces[piece].iter().any(|&vertex| self.sharp[vertex])
    }

    fn add(&mut self, mesh: &Mesh, side: Side, body: usize, known: &mut BTreeMap<usize, usize>) {
        let (kind, nodes) = mesh.side(side);
        let (nodes, number): (Vec<usize>, _) = (nodes.collect(), self.sides.len());
        let mut vertex = |node: usize| {
            let place = *known.entry(node).or_insert_with(|| {
                self.vertices.push(Vertex { nodes: vec![(node, 1.0)], sides: Vec::new() });
                self.vertices.len() - 1
            });
            self.vertices[place].sides.push(number);
            place
        };
        let mut vertices: Vec<usize> = nodes.iter().map(|&node| vertex(node)).collect();
        let corners = kind.linear.nodes.len();
        let centre = !matches!((corners, nodes.len()), (2, 3) | (4, 9));
        if centre {
            let mut weights = vec![0.0; nodes.len()];
            (kind.shape)(kind.center(), &mut weights, &mut vec![[0.0; 3]; nodes.len()]);
            // No corner of a piece: where a thin cell is curved that of the side itself lies over a piece of another.
            if let (3, 6) = (corners, nodes.len()) {
                weights = vec![0.0, 0.0, 0.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0];
            }
            let nodes = nodes.iter().copied().zip(weights).collect();
            self.vertices.push(Vertex { nodes, sides: vec![number] });
            vertices.push(self.vertices.len() - 1);
        }
        let parts = pieces(&vertices, corners, nodes.len());
        self.parents.extend(parts.iter().map(|_| number));
        self.pieces.extend(parts);
        let centre = centre.then(|| vertices[vertices.len() - 1]);
        let mut nodes = nodes;
        nodes.sort_unstable();
        // A cell that tapers from the side to a node or an edge is so many times as thick as one that does not.
        let cell = mesh.kinds[side.cell];
        let taper = match (cell.linear.nodes.len() - corners, cell.dimension) {
            (1, dimension) => dimension,
            (2, 3) => 2,
            _ => 1,
        };
        let (second, thickness) = (kind.degree > 1, taper as f64 * mesh.measure(side.cell).abs());
        self.sides.push(SideOf { body, nodes, centre, second, thickness });
    }

    /// Divides the measures of the cells by those of their sides, which consist of these pieces.
    fn thicknesses(&mut self, pieces: &[Simplex]) {
        let sizes = self.sizes(pieces);
        for (side, size) in self.sides.iter_mut().zip(sizes) {
            side.thickness /= if self.plane { size } else { size * size };
        }
    }

    /// Whose the material behind a piece is.
    pub fn body_of(&self, piece: usize) -> usize {
        self.sides[self.parents[piece]].body
    }
    /// Whose the material behind a vertex is.
    pub fn body_at(&self, vertex: usize) -> usize {
        self.sides[self.vertices[vertex].sides[0]].body
    }
    /// Whether a vertex lies among these nodes.
    pub fn lies_among(&self, vertex: usize, nodes: &BTreeSet<usize>) -> bool {
        self.vertices[vertex].nodes.iter().all(|(node, _)| nodes.contains(node))
    }
    /// Number of vertices.
    pub fn len(&self) -> usize {
        self.vertices.len()
    }
    /// Whether a piece is a part of a side around a vertex.
    pub fn touches(&self, vertex: usize, piece: usize) -> bool {
        self.vertices[vertex].sides.contains(&self.parents[piece])
    }
    /// Whether a piece belongs to a side that shares a node with one around a vertex.
    pub fn is_near(&self, vertex: usize, piece: usize) -> bool {
        let own = &self.sides[self.parents[piece]].nodes;
        let shares = |side: &usize| self.sides[*side].nodes.iter().any(|node| own.binary_search(node).is_ok());
        self.vertices[vertex].sides.iter().any(shares)
    }

    fn positions(&self, (mesh, dofs): (&Mesh, &Dofs), u: &[f64]) -> Vec<Vec3> {
        let at = |&(node, weight): &(usize, f64)| {
            let mut x = mesh.points[node];
            (0..dofs.per_node()).for_each(|axis| x[axis] += u[dofs.node(node) + axis]);
            x * weight
        };
        self.vertices.iter().map(|v| v.nodes.iter().map(at).fold(Vec3::zero(), |sum, x| sum + x)).collect()
    }

    fn piece(&self, x: &[Vec3], number: usize) -> Simplex {
        Simplex { corners: self.pieces[number].map(|vertex| x[vertex]), plane: self.plane }
    }

    /// The boundary at unknowns `u`, reached from the accepted ones.
    pub fn place(&self, model: (&Mesh, &Dofs), accepted: &[f64], u: &[f64]) -> Placed<'_> {
        let (before, now) = (self.positions(model, accepted), self.positions(model, u));
        let pieces: Vec<Simplex> = (0..self.pieces.len()).map(|i| self.piece(&now, i)).collect();
        let boxes = self.pieces.iter().map(|piece| bounds(piece.iter().flat_map(|&v| [before[v], now[v]])));
        let tree = Hierarchy::new(self.plane, pieces.iter().copied().zip(boxes));
        let (normals, sizes): (Vec<Vec3>, _) = (pieces.iter().map(Simplex::direction).collect(), self.sizes(&pieces));
        Placed {
            surface: self,
            swept: bounds(before.iter().chain(&now).copied()),
            bounds: bounds(now.iter().copied()),
            tree,
            sagittas: self.sagittas(&pieces, &normals, &sizes),
            sizes,
            normals,
            before,
            now,
        }
    }

    fn sizes(&self, pieces: &[Simplex]) -> Vec<f64> {
        let mut sizes = vec![0.0; self.sides.len()];
        for (piece, &side) in pieces.iter().zip(&self.parents) {
            sizes[side] += piece.normal().norm();
        }
        sizes.into_iter().map(|size| if self.plane { size } else { (0.5 * size).sqrt() }).collect()
    }

    /// Those of the pieces, and of sides of second degree by what they turn at their ends more than within: all of it where they are
    /// straight, none where they follow a curve.
    fn sagittas(&self, pieces: &[Simplex], normals: &[Vec3], sizes: &[f64]) -> Vec<f64> {
        let span = |i: usize| {
            let size = pieces[i].normal().norm();
            if self.plane { size } else { size.sqrt() }
        };
        let turn = |i: usize, j: usize| (normals[i] - normals[j]).norm();
        let (mut sagittas, mut turns) = (vec![0.0_f64; self.sides.len()], vec![[0.0_f64; 2]; self.sides.len()]);
        for (i, around) in self.neighbours.iter().enumerate() {
            let side = self.parents[i];
            for (j, turn) in around.iter().map(|&j| (j, turn(i, j))).filter(|(_, turn)| *turn < CURVED) {
                let most = &mut turns[side][usize::from(self.parents[j] != side)];
                (*most, sagittas[side]) = (most.max(turn), sagittas[side].max(turn * span(i) / 8.0));
            }
        }
        for (side, [within, at_ends]) in turns.into_iter().enumerate().filter(|(side, _)| self.sides[*side].second) {
            sagittas[side] = sagittas[side].max((at_ends - within) * sizes[side] / 8.0);
        }
        sagittas
    }
}

/// The pieces of a side from its vertices in the order of its nodes, a centre that is no node behind them.
fn pieces(v: &[usize], corners: usize, nodes: usize) -> Vec<[usize; 3]> {
    match (corners, nodes) {
        (2, 2) => vec![[v[0], v[1], v[1]]],
        (2, _) => vec![[v[0], v[2], v[2]], [v[2], v[1], v[1]]],
        (3, 3) => vec![[v[0], v[1], v[2]]],
        (3, _) => vec![[v[0], v[3], v[5]], [v[3], v[1], v[4]], [v[5], v[4], v[2]], [v[3], v[4], v[5]]],
        (_, nodes) => {
            let ring: Vec<usize> = match nodes {
                4 => v[..4].to_vec(),
                _ => (0..4).flat_map(|k| [v[k], v[k + 4]]).collect(),
            };
            (0..ring.len()).map(|k| [v[v.len() - 1], ring[k], ring[(k + 1) % ring.len()]]).collect()
        }
    }
}

/// For each piece those that share an end or an edge with it.
fn neighbours(pieces: &[[usize; 3]], plane: bool) -> Vec<Vec<usize>> {
    let keys = |piece: &[usize; 3]| -> Vec<[usize; 2]> {
        let [a, b, c] = *piece;
        let pairs = if plane { vec![[a, a], [b, b]] } else { vec![[a, b], [b, c], [c, a]] };
        pairs.into_iter().map(|[p, q]| [p.min(q), p.max(q)]).collect()
    };
    let mut at: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
    for (i, piece) in pieces.iter().enumerate() {
        keys(piece).into_iter().for_each(|key| at.entry(key).or_default().push(i));
    }
    let around = |(i, piece): (usize, &[usize; 3])| {
        keys(piece).iter().flat_map(|key| at[key].iter().copied().filter(move |&j| j != i)).collect()
    };
    pieces.iter().enumerate().map(around).collect()
}

impl Placed<'_> {
    /// How deep a place lies in what is enclosed, as it stands now.
    pub fn depth(&self, p: Vec3) -> Option<Depth> {
        let found = depth(&self.tree, p, (f64::INFINITY, false), &|_, _| true)?;
        is_inside(&self.tree, self.bounds, (p, self.normals[found.piece]), &|_| true).then_some(found)
    }
    /// A piece at a part of the way from the accepted state to now.
    pub fn piece_at(&self, number: usize, part: f64) -> Simplex {
        let corners = self.surface.pieces[number].map(|vertex| self.at(vertex, part));
        Simplex { corners, plane: self.surface.plane }
    }
    /// A vertex at a part of the way from the accepted state to now.
    pub fn at(&self, vertex: usize, part: f64) -> Vec3 {
        self.before[vertex] + (self.now[vertex] - self.before[vertex]) * part
    }
    /// Size of the cell behind a side: its thickness or the size of the side, whichever is less.
    fn cell(&self, side: usize) -> f64 {
        self.sizes[side].min(self.surface.sides[side].thickness)
    }
    /// Size of the cell behind a piece.
    pub fn size_of(&self, piece: usize) -> f64 {
        self.cell(self.surface.parents[piece])
    }
    /// Size of the side that a piece is a part of.
    pub fn length_of(&self, piece: usize) -> f64 {
        self.sizes[self.surface.parents[piece]]
    }
    /// Smallest size of the cells behind a vertex.
    pub fn size_at(&self, vertex: usize) -> f64 {
        self.surface.vertices[vertex].sides.iter().map(|&side| self.cell(side)).fold(f64::INFINITY, f64::min)
    }
    /// Largest size of the sides around a vertex.
    pub fn length_at(&self, vertex: usize) -> f64 {
        self.surface.vertices[vertex].sides.iter().map(|&side| self.sizes[side]).fold(0.0, f64::max)
    }
    /// Largest sagitta of the sides around a vertex.
    pub fn sagitta_at(&self, vertex: usize) -> f64 {
        self.surface.vertices[vertex].sides.iter().map(|&side| self.sagittas[side]).fold(0.0, f64::max)
    }
    /// Sagitta of the side that a piece is a part of.
    pub fn sagitta_of(&self, piece: usize) -> f64 {
        self.sagittas[self.surface.parents[piece]]
    }
    /// Unit outward normals at the vertices: means over the pieces around them.
    pub fn vertex_normals(&self) -> Vec<Vec3> {
        let mut sums = vec![Vec3::zero(); self.now.len()];
        for (piece, normal) in self.surface.pieces.iter().zip(&self.normals) {
            piece[..if self.surface.plane { 2 } else { 3 }].iter().for_each(|&vertex| sums[vertex] += *normal);
        }
        for (side, normal) in self.surface.parents.iter().zip(&self.normals) {
            if let Some(centre) = self.surface.sides[*side].centre {
                sums[centre] += *normal;
            }
        }
        sums.into_iter().map(|sum| if sum.norm() > 0.0 { sum.unit() } else { sum }).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Cell;
    use crate::mesh::cells::ALL;
    use crate::mesh::generate::{Annulus, Block, Rectangle};

    /// Cells of any kind in a block of one cell are as thick as the block.
    #[test]
    fn cells_that_taper_are_as_thick_as_those_that_do_not() {
        for &kind in ALL.iter().filter(|kind| kind.dimension > 1) {
            let mesh = match kind.dimension {
                2 => Rectangle::new([0.0; 2], [2.0; 2], [1, 1], kind).mesh("b").unwrap(),
                _ => Block::new([0.0; 3], [2.0; 3], [1, 1, 1], kind).mesh("b").unwrap(),
            };
            let cells: Vec<usize> = (0..mesh.cell_count()).collect();
            let surface = Surface::new(&mesh, &cells, &|_| 0, kind.dimension == 2);
            let thick = |side: &SideOf| (side.thickness - 2.0).abs() < 1e-12;
            assert!(surface.sides.iter().all(thick), "{}: {:?}", kind.name, surface.sides);
        }
    }

    /// Straight edges of second degree stand off a circle as those of first degree do, curved ones by what their halves do.
    #[test]
    fn straight_edges_of_either_degree_stand_off_a_circle_alike() {
        let largest = |cell: &str, straight: bool| {
            let ring = Annulus::new([0.0; 2], [1.0, 2.0], [0.0, 360.0], [4, 24], Cell::named(cell).unwrap());
            let mut mesh = ring.mesh("r").unwrap();
            let cells: Vec<usize> = (0..mesh.cell_count()).collect();
            for &cell in cells.iter().filter(|_| straight) {
                let view = mesh.cell(cell);
                let middles: Vec<_> =
                    view.kind.middles().map(|(m, e)| (view.nodes[m], e.map(|e| view.nodes[e]))).collect();
                middles.iter().for_each(|&(m, [a, b])| mesh.points[m] = (mesh.points[a] + mesh.points[b]) * 0.5);
            }
            let surface = Surface::new(&mesh, &cells, &|_| 0, true);
            let x: Vec<Vec3> = surface.vertices.iter().map(|vertex| mesh.points[vertex.nodes[0].0]).collect();
            let pieces: Vec<Simplex> = (0..surface.pieces.len()).map(|i| surface.piece(&x, i)).collect();
            let normals: Vec<Vec3> = pieces.iter().map(Simplex::direction).collect();
            surface.sagittas(&pieces, &normals, &surface.sizes(&pieces)).into_iter().fold(0.0, f64::max)
        };
        let exact = 2.0 * (1.0 - 7.5_f64.to_radians().cos());
        for (cell, straight, part) in [("tri3", false, 1.0), ("tri6", true, 1.0), ("tri6", false, 0.25)] {
            let found = largest(cell, straight) / exact;
            assert!((found / part - 1.0).abs() < 0.02, "{cell} {straight}: {found}");
        }
    }
}
