//! The search in space: which segments the rays of a surface meet.

use super::capture::depths;
use super::open::OpenContact;
use super::pair::Contact;
use super::surface::SurfacePoint;
use super::target::{Cast, Memory};
use crate::contact::search;
use crate::system::{Stencil, Stencils};
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
        let depths = depths(&parts.surface, &parts.mesh, &parts.dofs, &parts.boundary, u);
        let (standing, mut memory) = (parts.target.stand(u), Memory::default());
        let points = parts.surface.points.iter().zip(depths);
        let hits = points.map(|(point, depth)| standing.cast(&self.ray_of(point, (depth, reach), u), &mut memory));
        (hits.collect(), memory.rejected)
    }

    /// The ray of a point, along its inward normal, and what it may meet.
    fn ray_of(&self, point: &SurfacePoint, (depth, reach): (f64, f64), u: &[f64]) -> Cast<'_> {
        Cast { ray: self.ray(point, u), reach, depth, relatives: &self.relatives[point.face] }
    }

    /// The rays of all points of the undeformed surface.
    pub(in crate::contact) fn rays(&self) -> Vec<Ray> {
        let still = vec![0.0; self.parts.dofs.count()];
        self.parts.surface.points.iter().map(|point| self.ray(point, &still)).collect()
    }

    /// How far the target is penetrated along rays, each from beside a point of the undeformed surface.
    pub(in crate::contact) fn penetrations(&self, rays: &[(Ray, usize)]) -> Vec<Option<f64>> {
        let (parts, still) = (&self.parts, vec![0.0; self.parts.dofs.count()]);
        let depths = depths(&parts.surface, &parts.mesh, &parts.dofs, &parts.boundary, &still);
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
        let parts = &self.contact.parts;
        let (standing, points) = (parts.target.stand(u), &parts.surface.points);
        let cast = |index: usize| {
            let cast = self.contact.ray_of(&points[index], (self.depths[index], self.reach), u);
            MEMORY.with_borrow_mut(|memory| standing.cast(&cast, memory))
        };
        // Each ray for itself: the order of the threads decides nothing.
        let hits: Vec<Option<Hit>> = (0..points.len()).into_par_iter().with_min_len(64).map(cast).collect();
        for (index, hit) in hits.into_iter().enumerate() {
            let start = out.dofs.len();
            let (choice, near) = hit.map_or((0, [0.0; 2]), |hit| (hit.facet as u32 + 1, hit.s));
            let stencil = Stencil { choice, near, ..Stencil::default() };
            self.unknowns(index, &stencil, &mut out.dofs);
            out.close(start, stencil);
        }
    }
}
