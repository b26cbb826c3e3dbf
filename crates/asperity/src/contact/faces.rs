//! Faces of bodies as a target: edges of first and second degree in the plane, where their nodes are.
//!
//! An edge is the line or the parabola through its nodes, `x_B(s) = N_k(s) x_k` with `s` from 0 to 1, the solid on its
//! left. A tree of boxes, fitted anew for each search, keeps a ray from being tried against every edge.

use super::split::Vertex;
use super::surface::{Edge, MAX_EDGE_NODES};
use super::target::{Cast, Hit, MAX_UNKNOWNS, Memory};
use crate::mesh::{Mesh, Side};
use crate::system::Dofs;
use crate::tensor::{Scalar, Vec3};
use crate::tool::shapes::{Line, Parabola};
use crate::tool::{self, Bounds, Ray, Shape, Tree};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Edges of bodies.
#[derive(Debug)]
pub struct Faces {
    mesh: Arc<Mesh>,
    dofs: Dofs,
    edges: Vec<Edge>,
    /// The edges before and behind each.
    neighbours: Vec<[Option<usize>; 2]>,
    tree: Tree,
    size: f64,
}

/// Edges at given displacements.
pub struct Standing<'a> {
    faces: &'a Faces,
    curves: Vec<Curve>,
    tree: Tree,
}

/// An edge as a curve.
#[derive(Debug, Clone, Copy)]
enum Curve {
    Line(Line),
    Parabola(Parabola),
}

/// Margin of the boxes, as a part of the size: what is found must not depend on rounding.
const MARGIN: f64 = 1e-9;

impl Curve {
    /// Through nodes in the order of the mesh: the ends, then the middle where there is one.
    fn through(x: &[Vec3]) -> Self {
        match *x {
            [a, b, middle] => Self::Parabola(Parabola { nodes: [a, middle, b] }),
            _ => Self::Line(Line([x[0], x[1]])),
        }
    }
    fn shape(&self) -> &dyn Shape {
        match self {
            Self::Line(line) => line,
            Self::Parabola(parabola) => parabola,
        }
    }
}

/// Outward normal of a curve with the solid on its left.
fn outward(tangent: Vec3) -> Vec3 {
    -tangent.left().unit()
}

impl Faces {
    /// The faces `sides` of a mesh.
    pub fn new(mesh: Arc<Mesh>, dofs: Dofs, sides: &[Side]) -> Self {
        let edges: Vec<Edge> = sides.iter().map(|&side| Edge::new(&mesh, side)).collect();
        let still = vec![0.0; dofs.count()];
        let neighbours = neighbours(&edges);
        let mut faces = Self { mesh, dofs, edges, neighbours, tree: Tree::new(&[], 0.0), size: 0.0 };
        let boxes = boxes(&faces.curves(&still));
        faces.size = boxes.iter().fold(Bounds::EMPTY, |all, &b| all.union(b)).size();
        faces.tree = Tree::new(&boxes, MARGIN * faces.size);
        faces
    }

    /// The edges, in the order of their numbers as segments.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }
    /// Diagonal of the box around them before any motion, a length.
    pub fn size(&self) -> f64 {
        self.size
    }
    pub(super) fn nodes(&self, segment: usize) -> &[usize] {
        &self.edges[segment].nodes
    }
    pub(super) fn unknowns(&self, segment: usize) -> impl Iterator<Item = usize> {
        self.nodes(segment).iter().flat_map(|&node| [0, 1].map(|axis| self.dofs.node(node) + axis))
    }

    pub(super) fn stand(&self, u: &[f64]) -> Standing<'_> {
        let curves = self.curves(u);
        let tree = self.tree.refit(&boxes(&curves), MARGIN * self.size);
        Standing { faces: self, curves, tree }
    }

    fn curves(&self, u: &[f64]) -> Vec<Curve> {
        (0..self.edges.len()).map(|segment| self.curve(segment, &self.values(segment, u))).collect()
    }

    /// The edge whose nodes have the displacements `u`.
    fn curve(&self, segment: usize, u: &[f64]) -> Curve {
        let nodes = self.nodes(segment);
        let mut x = [Vec3::zero(); MAX_EDGE_NODES];
        for ((x, u), &node) in x.iter_mut().zip(u.chunks_exact(2)).zip(nodes) {
            *x = self.mesh.points[node] + Vec3::new(u[0], u[1], 0.0);
        }
        Curve::through(&x[..nodes.len()])
    }

    pub(super) fn meet(&self, segment: usize, u: &[f64], ray: &Ray, near: [f64; 2]) -> Option<Hit> {
        let (place, tangent) = self.curve(segment, u).shape().meet_near(ray, near[0])?;
        Some(Hit { segment, s: [place.s, 0.0], u: place.u, normal: outward(tangent) })
    }

    pub(super) fn point(&self, segment: usize, s: [f64; 2], u: &[f64]) -> Vec3 {
        self.curve(segment, u).shape().point(s[0])
    }

    pub(super) fn rates(&self, segment: usize, s: [f64; 2]) -> [Vec3; MAX_UNKNOWNS] {
        let (n, _) = self.edges[segment].shape_at(2.0 * s[0] - 1.0);
        let mut rates = [Vec3::zero(); MAX_UNKNOWNS];
        for (k, rate) in rates[..2 * self.nodes(segment).len()].iter_mut().enumerate() {
            rate[k % 2] = n[k / 2];
        }
        rates
    }

    /// The force shared out by the shape functions where it acts: `N_k(s) f`, with `ds = t.(dx - dx_B) / t.t` the
    /// sliding of the place over the edge.
    pub(super) fn receive<T: Scalar>(
        &self,
        (hit, u): (&Hit, &[f64]),
        sliding: Vec3<T>,
        force: Vec3<T>,
    ) -> [T; MAX_UNKNOWNS] {
        let tangent = self.curve(hit.segment, u).shape().tangent(hit.s[0]);
        let along = sliding.dot(tangent.lift()) * T::from(1.0 / tangent.dot(tangent));
        let (n, dn) = self.edges[hit.segment].shape_at(2.0 * hit.s[0] - 1.0);
        let mut rows = [T::zero(); MAX_UNKNOWNS];
        for (k, row) in rows[..2 * self.nodes(hit.segment).len()].iter_mut().enumerate() {
            *row = force[k % 2] * along.chain(n[k / 2], 2.0 * dn[k / 2]);
        }
        rows
    }
}

/// The edges that end where each begins, and begin where it ends.
pub(super) fn neighbours(edges: &[Edge]) -> Vec<[Option<usize>; 2]> {
    let at =
        |end: usize| edges.iter().enumerate().map(move |(i, edge)| (edge.nodes[end], i)).collect::<BTreeMap<_, _>>();
    let (beginning, ending) = (at(0), at(1));
    let of = |edge: &Edge| [ending.get(&edge.nodes[0]).copied(), beginning.get(&edge.nodes[1]).copied()];
    edges.iter().map(of).collect()
}

/// Outward normal of an edge at one of its ends, and the direction along it away from that end.
pub type Look = (Vec3, Vec3);

/// The segment and the end that a vertex means.
fn parts(vertex: Vertex) -> (usize, usize) {
    ((vertex as usize - 1) / 2, (vertex as usize - 1) % 2)
}

impl Faces {
    /// The node of a vertex.
    pub(super) fn node_of(&self, vertex: Vertex) -> usize {
        let (segment, end) = parts(vertex);
        self.edges[segment].nodes[end]
    }
    /// The unknowns of a vertex.
    pub(super) fn unknowns_of(&self, vertex: Vertex) -> [usize; 2] {
        [0, 1].map(|axis| self.dofs.node(self.node_of(vertex)) + axis)
    }
    /// Place of a vertex whose unknowns are `u`.
    pub(super) fn place_of(&self, vertex: Vertex, u: &[f64]) -> Vec3 {
        self.mesh.points[self.node_of(vertex)] + Vec3::new(u[0], u[1], 0.0)
    }
    /// `dx_B/ds` at `s` on a segment whose unknowns are `u`.
    pub(super) fn tangent(&self, segment: usize, s: f64, u: &[f64]) -> Vec3 {
        self.curve(segment, u).shape().tangent(s)
    }
    /// Values of the unknowns of a segment among all unknowns.
    pub(super) fn values(&self, segment: usize, u: &[f64]) -> [f64; MAX_UNKNOWNS] {
        let mut here = [0.0; MAX_UNKNOWNS];
        self.unknowns(segment).zip(&mut here).for_each(|(dof, value)| *value = u[dof]);
        here
    }
}

fn boxes(curves: &[Curve]) -> Vec<Bounds> {
    curves.iter().map(|curve| curve.shape().bounds()).collect()
}

impl Standing<'_> {
    pub(super) fn size(&self) -> f64 {
        self.faces.size
    }

    /// What a ray meets by the rules against false contacts; what they reject is counted.
    pub(super) fn select(&self, cast: &Cast, memory: &mut Memory) -> Option<Hit> {
        self.cast(&cast.ray, cast.range(), &mut memory.hits);
        cast.select(self.size(), memory).map(Hit::plane)
    }

    /// Vertices of the edges near a chord, within `margin` of the box around it; each as the end of every edge it ends.
    pub(super) fn vertices_near(&self, chord: [Vec3; 2], margin: f64, out: &mut Vec<Vertex>) {
        let (around, wide) = (Bounds::of(chord), Vec3([margin; 3]));
        let around = Bounds { min: around.min - wide, max: around.max + wide };
        self.tree.near(&around, &mut |segment| out.extend([1, 2].map(|end| 2 * segment as u32 + end)));
        out.sort_unstable();
    }

    /// Place of a vertex, and the looks of its edge and of the edge beyond it.
    pub(super) fn faces_at(&self, vertex: Vertex) -> (Vec3, Look, Option<Look>) {
        let (segment, end) = parts(vertex);
        let look = |segment: usize, end: usize| {
            let tangent = self.curves[segment].shape().tangent(end as f64);
            (outward(tangent), if end == 0 { tangent } else { -tangent })
        };
        let beyond = self.faces.neighbours[segment][end].map(|other| look(other, 1 - end));
        (self.curves[segment].shape().point(end as f64), look(segment, end), beyond)
    }

    /// The node of a vertex.
    pub(super) fn node_of(&self, vertex: Vertex) -> usize {
        self.faces.node_of(vertex)
    }
    /// The edge beyond a vertex.
    pub(super) fn beyond(&self, vertex: Vertex) -> Option<usize> {
        let (segment, end) = parts(vertex);
        self.faces.neighbours[segment][end]
    }

    /// All places with `u` in `range` where a ray meets the edges, by edge and then by `u`.
    pub(super) fn cast(&self, ray: &Ray, range: [f64; 2], hits: &mut Vec<tool::Hit>) {
        hits.clear();
        self.tree.along(ray, range, &mut |segment| {
            let shape = self.curves[segment].shape();
            shape.cast(ray, &mut |place| {
                if (range[0]..=range[1]).contains(&place.u) {
                    let normal = outward(shape.tangent(place.s));
                    hits.push(tool::Hit { segment, s: place.s, u: place.u, normal });
                }
            });
        });
        hits.sort_unstable_by(|a, b| a.segment.cmp(&b.segment).then(a.u.total_cmp(&b.u)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Cell, generate::Rectangle};

    /// Numbers in (-1, 1) from a linear congruence (Knuth's MMIX).
    fn random(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Rays over bodies that are bent out of all shape: the tree finds what trying every edge finds.
    #[test]
    fn no_candidate_is_missed() {
        let (mut state, mut found) = (5, 0);
        for cell in ["quad4", "quad8"] {
            let mesh = Rectangle::new([0.0; 2], [3.0, 1.0], [30, 9], Cell::named(cell).unwrap()).mesh("b").unwrap();
            let (sides, mesh) = (mesh.boundary(&mesh.groups["b"].cells), Arc::new(mesh));
            let dofs = Dofs::new(2, mesh.points.len(), 0);
            let faces = Faces::new(mesh, dofs.clone(), &sides);
            for scene in 0..40 {
                let u: Vec<f64> = (0..dofs.count()).map(|_| 0.05 * f64::from(scene) * random(&mut state)).collect();
                let standing = faces.stand(&u);
                for _ in 0..50 {
                    let [x, y, angle] = [0, 1, 2].map(|_| random(&mut state));
                    let (sin, cos) = (4.0 * angle).sin_cos();
                    let origin = Vec3::new(1.5 + 3.0 * x, 0.5 + 2.0 * y, 0.0);
                    let ray = Ray { origin, direction: Vec3::new(cos, sin, 0.0) };
                    let range = [-2.0 * random(&mut state).abs(), 2.0 * random(&mut state).abs()];
                    let mut hits = Vec::new();
                    standing.cast(&ray, range, &mut hits);
                    let mut all = Vec::new();
                    for (segment, curve) in standing.curves.iter().enumerate() {
                        curve.shape().cast(&ray, &mut |place| all.push((segment, place.u)));
                    }
                    all.retain(|(_, u)| (range[0]..=range[1]).contains(u));
                    all.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
                    assert_eq!(hits.iter().map(|hit| (hit.segment, hit.u)).collect::<Vec<_>>(), all);
                    found += all.len();
                }
            }
        }
        assert!(found > 2000, "{found}");
    }
}
