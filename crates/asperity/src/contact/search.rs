//! The search: which segments the rays of a surface meet, and where on its edges the target ends.

use super::capture::positions;
use super::geometry::laid;
use super::open::OpenContact;
use super::pair::Contact;
use super::placed::Placed;
use super::point::triad;
use super::split::Seeker;
use super::surface::MAX_EDGE_NODES;
use super::target::{Cast, Hit, Memory, Standing, Target};
use crate::system::{Stencil, Stencils};
use crate::tensor::Vec3;
use crate::tool::{Ray, Rejected};
use std::cell::RefCell;
use std::collections::BTreeMap;

thread_local! {
    static MEMORY: RefCell<Memory> = RefCell::default();
}

impl Contact {
    /// What the search finds at displacements `u`, point by point, and how many false contacts it rejects.
    pub fn search(&self, u: &[f64]) -> (Vec<Option<Hit>>, Rejected) {
        self.search_within(u, f64::INFINITY)
    }

    pub(super) fn search_within(&self, u: &[f64], reach: f64) -> (Vec<Option<Hit>>, Rejected) {
        let depths = self.depths(u);
        let (standing, mut memory) = (self.target.stand(u), Memory::default());
        let points = self.surface.points.iter().zip(depths).enumerate();
        let hits = points.map(|(i, (point, depth))| {
            let (origin, tangent) = self.locate(point, u);
            let (_, direction, _) = triad(tangent);
            standing.cast(&Cast { ray: Ray { origin, direction }, ..self.bounds(i, depth, reach) }, &mut memory)
        });
        (hits.collect(), memory.rejected)
    }

    /// What rays of a point may meet; the ray itself is yet to be given.
    pub(super) fn bounds(&self, point: usize, depth: f64, reach: f64) -> Cast<'_> {
        let ray = Ray { origin: Vec3::zero(), direction: Vec3::zero() };
        Cast { ray, reach, depth, relatives: &self.relatives[self.surface.points[point].edge] }
    }

    /// An edge of the surface with its nodes in place.
    pub(super) fn placed(&self, edge: usize, u: &[f64]) -> Placed<'_> {
        let at = |nodes| positions(&self.mesh, &self.dofs, nodes, u);
        let around = self.around.get(edge).map_or(&[][..], |around| &around.nodes);
        self.placed_at(edge, at(&self.surface.edges[edge].nodes), at(around))
    }

    /// The same for values of the unknowns of its nodes, and of the nodes around it.
    pub(super) fn placed_locally(&self, edge: usize, own: &[f64], around: &[f64]) -> Placed<'_> {
        let here = |(&node, u): (&usize, &[f64])| self.mesh.points[node] + Vec3::new(u[0], u[1], 0.0);
        let others = self.around.get(edge).map_or(&[][..], |around| &around.nodes);
        let own = self.surface.edges[edge].nodes.iter().zip(own.chunks_exact(2)).map(here);
        self.placed_at(edge, own, others.iter().zip(around.chunks_exact(2)).map(here))
    }

    fn placed_at(
        &self,
        edge: usize,
        own: impl Iterator<Item = Vec3>,
        around: impl Iterator<Item = Vec3>,
    ) -> Placed<'_> {
        let (averaged, edge) = (self.around.get(edge), &self.surface.edges[edge]);
        let mut x = [Vec3::zero(); MAX_EDGE_NODES];
        x.iter_mut().zip(own).for_each(|(x, here)| *x = here);
        let field = averaged.map(|averaged| averaged.field(x[..edge.nodes.len()].iter().copied().chain(around)));
        Placed { edge, x, field }
    }

    /// The largest gap at which the target is seen in the increment after `last_change`: a tool at any distance; faces,
    /// whose unknowns would couple for nothing, within an edge's length and twice the motion of the last increment.
    pub(super) fn reach(&self, last_change: &[f64]) -> f64 {
        match self.target {
            Target::Tool(_) => f64::INFINITY,
            Target::Faces(_) => reach(self.longest, last_change),
        }
    }
}

impl OpenContact<'_> {
    /// Lists the stencils of all points at unknowns `u`.
    pub(super) fn list(&self, u: &[f64], out: &mut Stencils) {
        let standing = self.contact.target.stand(u);
        MEMORY.with_borrow_mut(|memory| {
            for edge in 0..self.contact.surface.edges.len() {
                let vertices = self.vertices(edge, &standing, u, memory);
                for index in self.contact.surface.points_of(edge) {
                    let stencil = self.seek((index, vertices), &standing, u, memory);
                    let start = out.dofs.len();
                    self.unknowns(index, &stencil, &mut out.dofs);
                    out.close(start, stencil);
                }
            }
        });
    }

    /// The vertices between which a target that deforms covers an edge.
    fn vertices(&self, edge: usize, standing: &Standing, u: &[f64], memory: &mut Memory) -> [u32; 2] {
        let (contact, Standing::Faces(standing)) = (self.contact, standing) else { return [0; 2] };
        let points = contact.surface.points_of(edge);
        let Some(index) = points.clone().next() else { return [0; 2] };
        let depth = self.depths[points].iter().copied().fold(0.0, f64::max);
        let (placed, cast) = (contact.placed(edge, u), contact.bounds(index, depth, self.reach));
        Seeker { standing, placed, cast }.vertices(memory)
    }

    /// The choices of a point on an edge that is covered between two vertices.
    fn seek(
        &self,
        (index, vertices): (usize, [u32; 2]),
        standing: &Standing,
        u: &[f64],
        memory: &mut Memory,
    ) -> Stencil {
        let (contact, point) = (self.contact, &self.contact.surface.points[index]);
        let placed = contact.placed(point.edge, u);
        let ends = vertices.map(|vertex| {
            let faces = contact.target.as_faces().filter(|_| vertex > 0)?;
            Some(placed.foot(faces.place_of(vertex, &faces.unknowns_of(vertex).map(|dof| u[dof]))))
        });
        let spot = contact.surface.moved(index, laid(point, &ends));
        let (origin, tangent) = placed.stand(&spot);
        let (_, direction, _) = triad(tangent);
        let cast = Cast { ray: Ray { origin, direction }, ..contact.bounds(index, self.depths[index], self.reach) };
        let Some(hit) = standing.cast(&cast, memory) else {
            let also = [0, 0, u32::from(cast.lies_within(memory))];
            return Stencil { also, ..Stencil::default() };
        };
        let also = [vertices[0], vertices[1], self.recall(index, (&spot, hit.segment), memory)];
        Stencil { choice: hit.segment as u32 + 1, near: hit.s, also, ..Stencil::default() }
    }
}

/// The largest gap at which faces no longer than `longest` are seen in the increment after `last_change`.
pub fn reach(longest: f64, last_change: &[f64]) -> f64 {
    longest + 2.0 * last_change.iter().fold(0.0_f64, |most, d| most.max(d.abs()))
}

/// For each piece of the surface, by its nodes, the segments of the target that share a node with it.
pub fn relatives<'a>(
    surface: impl Iterator<Item = &'a Vec<usize>>,
    target: impl Iterator<Item = &'a Vec<usize>>,
) -> Vec<Vec<usize>> {
    let mut behind: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (segment, nodes) in target.enumerate() {
        nodes.iter().for_each(|&node| behind.entry(node).or_default().push(segment));
    }
    let of = |nodes: &Vec<usize>| {
        let mut segments: Vec<usize> = nodes.iter().filter_map(|node| behind.get(node)).flatten().copied().collect();
        segments.sort_unstable();
        segments.dedup();
        segments
    };
    surface.map(of).collect()
}
