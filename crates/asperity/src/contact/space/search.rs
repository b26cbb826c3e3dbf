//! The search in space: which segments the rays of a surface meet, and which border of the target runs over
//! its faces.

use super::averaged::Around;
use super::border::Seeker;
use super::open::OpenContact;
use super::pair::Contact;
use super::placed::Placed;
use super::point::Triad;
use super::split::{self, Border};
use super::surface::{MAX_NODES, SurfacePoint};
use super::target::{Cast, Memory, Standing};
use crate::contact::capture::positions;
use crate::contact::search;
use crate::system::{Stencil, Stencils};
use crate::tensor::Vec3;
use crate::tool::space::Hit;
use crate::tool::{Ray, Rejected};
use rayon::prelude::*;
use std::cell::RefCell;

thread_local! {
    static MEMORY: RefCell<Memory> = RefCell::default();
}

impl Contact {
    /// What the search finds at displacements `u`, point by point, and how many false contacts it rejects.
    pub fn search(&self, u: &[f64]) -> (Vec<Option<Hit>>, Rejected) {
        self.search_within(u, f64::INFINITY)
    }

    pub(super) fn search_within(&self, u: &[f64], reach: f64) -> (Vec<Option<Hit>>, Rejected) {
        let parts = &self.parts;
        let depths = self.depths(u);
        let (standing, mut memory) = (parts.target.stand(u), Memory::default());
        let points = parts.surface.points.iter().zip(depths).enumerate();
        let hits = points.map(|(i, (point, depth))| {
            standing.cast(&Cast { ray: self.ray(point, u), ..self.bounds(i, depth, reach) }, &mut memory)
        });
        (hits.collect(), memory.rejected)
    }

    /// What rays of a point may meet; the ray itself is yet to be given.
    pub(super) fn bounds(&self, point: usize, depth: f64, reach: f64) -> Cast<'_> {
        let ray = Ray { origin: Vec3::zero(), direction: Vec3::zero() };
        Cast { ray, reach, depth, relatives: &self.relatives[self.parts.surface.points[point].face] }
    }

    /// A face of the surface with its nodes in place.
    pub(super) fn placed(&self, face: usize, u: &[f64]) -> Placed<'_> {
        let parts = &self.parts;
        let at = |nodes| positions(&parts.mesh, &parts.dofs, nodes, u);
        self.placed_at(face, at(&parts.surface.faces[face].nodes), at(self.nodes_around(face)))
    }

    /// The same for values of the unknowns of its nodes, and of the nodes around it.
    pub(super) fn placed_locally(&self, face: usize, own: &[f64], around: &[f64]) -> Placed<'_> {
        let parts = &self.parts;
        let here = |(&node, u): (&usize, &[f64])| parts.mesh.points[node] + Vec3::new(u[0], u[1], u[2]);
        let own = parts.surface.faces[face].nodes.iter().zip(own.chunks_exact(3)).map(here);
        self.placed_at(face, own, self.nodes_around(face).iter().zip(around.chunks_exact(3)).map(here))
    }

    fn placed_at(
        &self,
        face: usize,
        own: impl Iterator<Item = Vec3>,
        around: impl Iterator<Item = Vec3>,
    ) -> Placed<'_> {
        let (averaged, face) = (self.around.get(face), &self.parts.surface.faces[face]);
        let mut x = [Vec3::zero(); MAX_NODES];
        x.iter_mut().zip(own).for_each(|(x, here)| *x = here);
        let all = |_: &Around| x[..face.nodes.len()].iter().copied().chain(around).collect();
        let field = averaged.map(|averaged| averaged.field(all(averaged)));
        Placed { face, x, field }
    }

    /// The nodes around a face that turn its normals; none where it has its own.
    pub(super) fn nodes_around(&self, face: usize) -> &[usize] {
        self.around.get(face).map_or(&[], |around| &around.nodes)
    }

    /// The rays of all points of the undeformed surface.
    pub(in crate::contact) fn rays(&self) -> Vec<Ray> {
        let still = vec![0.0; self.parts.dofs.count()];
        self.parts.surface.points.iter().map(|point| self.ray(point, &still)).collect()
    }

    /// How far the target is penetrated along rays, each from beside a point of the undeformed surface.
    pub(in crate::contact) fn penetrations(&self, rays: &[(Ray, usize)]) -> Vec<Option<f64>> {
        let (parts, still) = (&self.parts, vec![0.0; self.parts.dofs.count()]);
        let depths = self.depths(&still);
        let (standing, mut memory) = (parts.target.stand(&still), Memory::default());
        let along = |&(ray, point): &(Ray, usize)| {
            let relatives = &self.relatives[parts.surface.points[point].face];
            let cast = Cast { ray, reach: f64::INFINITY, depth: depths[point], relatives };
            standing.cast(&cast, &mut memory).map(|hit| hit.u)
        };
        rays.iter().map(along).collect()
    }

    /// The largest gap at which the target is seen in the increment after `last_change`: a tool at any distance.
    pub(super) fn reach(&self, last_change: &[f64]) -> f64 {
        if self.parts.target.deforms() { search::reach(self.longest, last_change) } else { f64::INFINITY }
    }
}

impl OpenContact<'_> {
    /// Lists the stencils of all points at unknowns `u`.
    pub(super) fn list(&self, u: &[f64], out: &mut Stencils) {
        let surface = &self.contact.parts.surface;
        let standing = self.contact.parts.target.stand(u);
        let seek = |face: usize| MEMORY.with_borrow_mut(|memory| self.seek(face, &standing, u, memory));
        // Each face for itself: the order of the threads decides nothing.
        let found: Vec<Vec<Stencil>> = (0..surface.faces.len()).into_par_iter().with_min_len(16).map(seek).collect();
        for (index, stencil) in found.into_iter().flatten().enumerate() {
            let start = out.dofs.len();
            self.unknowns(index, &stencil, &mut out.dofs);
            out.close(start, stencil);
        }
    }

    /// The choices of the points of a face.
    fn seek(&self, face: usize, standing: &Standing, u: &[f64], memory: &mut Memory) -> Vec<Stencil> {
        let (contact, placed) = (self.contact, self.contact.placed(face, u));
        let border = self.border(face, &placed, standing, memory);
        let one = |index: usize| {
            let spot = self.spot_within(index, &placed, border, |node| self.corner(node, u))?;
            let (origin, tangents) = placed.stand(&spot);
            let ray = Ray { origin, direction: Triad::new(tangents).inward };
            let hit = standing.cast(&Cast { ray, ..contact.bounds(index, self.depths[index], self.reach) }, memory)?;
            let (nodes, [first, closed]) = border.choices();
            let also = [first, closed, self.recall(index, (&spot, &hit), memory)];
            Some(Stencil { choice: hit.facet as u32 + 1, near: hit.s, also, border: nodes, ..Stencil::default() })
        };
        contact.parts.surface.points_of(face).map(one).map(Option::unwrap_or_default).collect()
    }

    /// The border of a target that deforms over a face.
    fn border(&self, face: usize, placed: &Placed, standing: &Standing, memory: &mut Memory) -> Border {
        let (contact, Standing::Faces(standing)) = (self.contact, standing) else { return Border::default() };
        let points = contact.parts.surface.points_of(face);
        let Some(index) = points.clone().next() else { return Border::default() };
        let depth = self.depths[points].iter().copied().fold(0.0, f64::max);
        let cast = contact.bounds(index, depth, self.reach);
        Seeker { standing, placed, cast }.border(memory).unwrap_or_default()
    }

    /// Place of a node of the target at unknowns `u`.
    fn corner(&self, node: usize, u: &[f64]) -> Vec3 {
        let faces = self.contact.parts.target.as_faces();
        faces.map_or(Vec3::zero(), |faces| faces.place_of(node, &faces.unknowns_of(node).map(|dof| u[dof])))
    }

    /// A point with the rule laid within a border whose nodes are where `corner` says.
    fn spot_within(
        &self,
        index: usize,
        placed: &Placed,
        border: Border,
        corner: impl Fn(usize) -> Vec3,
    ) -> Option<SurfacePoint> {
        let surface = &self.contact.parts.surface;
        if border == Border::default() {
            return Some(surface.points[index]);
        }
        let vertices: Vec<Vec3> = border.list().map(corner).collect();
        let (xi, scale) = split::laid(placed, border, &vertices, &surface.points[index])?;
        Some(surface.moved(index, xi, scale))
    }
}
