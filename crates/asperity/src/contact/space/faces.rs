//! Faces of bodies as a target in space: triangles and quadrilaterals of first and second degree, where their nodes are.
//!
//! A tree of boxes, fitted anew for each search, keeps a ray from being tried against every face.

use super::patch::Patch;
use super::surface::Face;
use super::target::{Cast, MAX_UNKNOWNS, Memory};
use crate::mesh::{Mesh, Side};
use crate::system::Dofs;
use crate::tensor::{Scalar, Vec3};
use crate::tool::space::Hit;
use crate::tool::{Bounds, Ray, Tree};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Faces of bodies.
#[derive(Debug)]
pub struct Faces {
    mesh: Arc<Mesh>,
    dofs: Dofs,
    faces: Vec<Face>,
    /// The face beyond each edge of a face.
    neighbours: Vec<Vec<Option<usize>>>,
    tree: Tree,
    size: f64,
}

/// Faces at given displacements.
pub struct Standing<'a> {
    faces: &'a Faces,
    patches: Vec<Patch>,
    /// Outward normals at their middles.
    normals: Vec<Vec3>,
    tree: Tree,
}

/// Margin of the boxes, as a part of the size: what is found must not depend on rounding.
const MARGIN: f64 = 1e-9;

impl Faces {
    /// The faces `sides` of a mesh.
    pub fn new(mesh: Arc<Mesh>, dofs: Dofs, sides: &[Side]) -> Self {
        let list: Vec<Face> = sides.iter().map(|&side| Face::new(&mesh, side)).collect();
        let still = vec![0.0; dofs.count()];
        let neighbours = neighbours(&list);
        let mut faces = Self { mesh, dofs, faces: list, neighbours, tree: Tree::new(&[], 0.0), size: 0.0 };
        let boxes = boxes(&faces.patches(&still));
        faces.size = boxes.iter().fold(Bounds::EMPTY, |all, &b| all.union(b)).size();
        faces.tree = Tree::new(&boxes, MARGIN * faces.size);
        faces
    }

    /// The faces, in the order of their numbers as segments.
    pub fn list(&self) -> &[Face] {
        &self.faces
    }
    /// Diagonal of the box around them before any motion, a length.
    pub fn size(&self) -> f64 {
        self.size
    }
    pub(super) fn nodes(&self, segment: usize) -> &[usize] {
        &self.faces[segment].nodes
    }
    pub(super) fn unknowns(&self, segment: usize) -> impl Iterator<Item = usize> {
        self.nodes(segment).iter().flat_map(|&node| [0, 1, 2].map(|axis| self.dofs.node(node) + axis))
    }

    pub(super) fn stand(&self, u: &[f64]) -> Standing<'_> {
        let patches = self.patches(u);
        let tree = self.tree.refit(&boxes(&patches), MARGIN * self.size);
        let normals = patches.iter().map(Patch::normal).collect();
        Standing { faces: self, patches, normals, tree }
    }

    fn patches(&self, u: &[f64]) -> Vec<Patch> {
        let sites = (&*self.mesh, &self.dofs);
        self.faces.iter().map(|face| Patch::through(face.kind, face.placed(sites, u))).collect()
    }

    /// The face whose nodes have the displacements `u`.
    fn patch(&self, segment: usize, u: &[f64]) -> Patch {
        let face = &self.faces[segment];
        Patch::through(face.kind, face.moved(&self.mesh, u))
    }

    pub(super) fn meet(&self, segment: usize, u: &[f64], ray: &Ray, near: [f64; 2]) -> Option<Hit> {
        let patch = self.patch(segment, u);
        let place = patch.facet().follow(ray, near)?;
        Some(Hit { facet: segment, s: place.s, u: place.u, normal: patch.facet().normal(place.s) })
    }

    pub(super) fn point(&self, segment: usize, s: [f64; 2], u: &[f64]) -> Vec3 {
        self.patch(segment, u).facet().point(s)
    }

    pub(super) fn rates(&self, segment: usize, s: [f64; 2]) -> [Vec3; MAX_UNKNOWNS] {
        let (n, _) = self.faces[segment].shape_at(s);
        let mut rates = [Vec3::zero(); MAX_UNKNOWNS];
        for (k, rate) in rates[..3 * self.nodes(segment).len()].iter_mut().enumerate() {
            rate[k % 3] = n[k / 3];
        }
        rates
    }

    /// The force shared out by the shape functions where it acts: `N_k(s) f`, with `ds_a = g^a.(dx - dx_B)` the sliding
    /// of the place over the face, `g^a` its two vectors along the dual of its tangents.
    pub(super) fn receive<T: Scalar>(
        &self,
        (hit, u): (&Hit, &[f64]),
        sliding: Vec3<T>,
        force: Vec3<T>,
    ) -> [T; MAX_UNKNOWNS] {
        let [a, b] = self.patch(hit.facet, u).facet().tangents(hit.s);
        let normal = a.cross(b);
        let size = 1.0 / normal.dot(normal);
        let ds = [b.cross(normal), normal.cross(a)].map(|along| sliding.dot((along * size).lift()));
        let (n, dn) = self.faces[hit.facet].shape_at(hit.s);
        let mut rows = [T::zero(); MAX_UNKNOWNS];
        for (k, row) in rows[..3 * self.nodes(hit.facet).len()].iter_mut().enumerate() {
            let [s, t] = dn[k / 3];
            let moving = ds[0] * s + ds[1] * t;
            *row = force[k % 3] * moving.chain(n[k / 3], 1.0);
        }
        rows
    }
}

/// The faces that share an edge with each, edge by edge.
fn neighbours(faces: &[Face]) -> Vec<Vec<Option<usize>>> {
    let edges = |face: &Face| face.edges().collect::<Vec<_>>();
    let runs: BTreeMap<[usize; 2], usize> =
        faces.iter().enumerate().flat_map(|(i, face)| edges(face).into_iter().map(move |ends| (ends, i))).collect();
    let beyond = |face: &Face| face.edges().map(|[a, b]| runs.get(&[b, a]).copied()).collect();
    faces.iter().map(beyond).collect()
}

impl Faces {
    /// Place of a node for its displacements `u`.
    pub(super) fn place_of(&self, node: usize, u: &[f64]) -> Vec3 {
        self.mesh.points[node] + Vec3::new(u[0], u[1], u[2])
    }
    /// The unknowns of a node.
    pub(super) fn unknowns_of(&self, node: usize) -> [usize; 3] {
        [0, 1, 2].map(|axis| self.dofs.node(node) + axis)
    }
    /// Values of the unknowns of a segment among all unknowns.
    pub(super) fn values(&self, segment: usize, u: &[f64]) -> [f64; MAX_UNKNOWNS] {
        let mut here = [0.0; MAX_UNKNOWNS];
        self.unknowns(segment).zip(&mut here).for_each(|(dof, value)| *value = u[dof]);
        here
    }
    /// `dx_B/ds` at `s` on a segment whose unknowns are `u`.
    pub(super) fn tangents(&self, segment: usize, s: [f64; 2], u: &[f64]) -> [Vec3; 2] {
        self.patch(segment, u).facet().tangents(s)
    }
}

fn boxes(patches: &[Patch]) -> Vec<Bounds> {
    patches.iter().map(|patch| patch.facet().bounds()).collect()
}

impl Standing<'_> {
    /// Edges near a box of faces that look, beyond which there is none that does: the face, and the ends by node and
    /// position.
    pub(super) fn borders_near(
        &self,
        around: &Bounds,
        looks: &dyn Fn(Vec3) -> bool,
        found: &mut dyn FnMut(usize, [(usize, Vec3); 2]),
    ) {
        let looks = |segment: usize| looks(self.normals[segment]);
        self.tree.near(around, &mut |segment| {
            let (face, patch) = (&self.faces.faces[segment], &self.patches[segment]);
            for (k, beyond) in self.faces.neighbours[segment].iter().enumerate().filter(|_| looks(segment)) {
                if !beyond.is_some_and(looks) {
                    found(segment, [k, (k + 1) % face.corners()].map(|k| (face.nodes[k], patch.corner(k))));
                }
            }
        });
    }

    /// A face.
    pub(super) fn patch(&self, segment: usize) -> &Patch {
        &self.patches[segment]
    }
    /// Number of its corners.
    pub(super) fn corners(&self, segment: usize) -> usize {
        self.faces.faces[segment].corners()
    }
    /// The face beyond one of its edges.
    pub(super) fn beyond(&self, segment: usize, edge: usize) -> Option<usize> {
        self.faces.neighbours[segment][edge]
    }

    /// What a ray meets by the rules against false contacts; what they reject is counted.
    pub(super) fn select(&self, cast: &Cast, memory: &mut Memory) -> Option<Hit> {
        self.cast(&cast.ray, cast.range(), &mut memory.hits);
        cast.select(self.faces.size, memory)
    }

    /// All places with `u` in `range` where a ray meets the faces, by face and then by `u`.
    pub(super) fn cast(&self, ray: &Ray, range: [f64; 2], hits: &mut Vec<Hit>) {
        hits.clear();
        self.tree.along(ray, range, &mut |segment| {
            let facet = self.patches[segment].facet();
            facet.cast(ray, &mut |place| {
                if (range[0]..=range[1]).contains(&place.u) {
                    hits.push(Hit { facet: segment, s: place.s, u: place.u, normal: facet.normal(place.s) });
                }
            });
        });
        hits.sort_unstable_by(|a, b| a.facet.cmp(&b.facet).then(a.u.total_cmp(&b.u)));
    }
}
