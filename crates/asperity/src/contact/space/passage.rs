//! Whether the target has passed a contact point in space, as in the plane (`contact::passage`).

use super::open::OpenContact;
use super::target::Memory;
use crate::Failure;
use crate::contact::passage::{Way, came_through, passed};
use crate::contact::record::entry;
use crate::system::History;
use crate::tool::space::Hit;

impl OpenContact<'_> {
    /// Refuses an equilibrium at unknowns `u` in which the target has passed a point that sees nothing.
    ///
    /// # Errors
    /// A [`Failure`] that names the first such point.
    pub(super) fn refuse_passage(&self, u: &[f64], new: &History) -> Result<(), Failure> {
        let parts = &self.contact.parts;
        let (now, mut memory, mut dofs) = (parts.target.stand(u), Memory::default(), Vec::new());
        let blind = |&index: &usize| new.slot(index)[entry::SEGMENT] < 0.0 && self.depths[index].is_finite();
        for index in (0..parts.surface.points.len()).filter(blind) {
            let place = |u: &[f64]| self.contact.ray(&parts.surface.points[index], u);
            let (ray, from) = (place(u), place(self.accepted).origin);
            let saw = self.history.slot(index)[entry::SEGMENT] >= 0.0;
            let way = Way { from, ray, depth: self.depths[index], saw };
            let motion = |hit: &Hit| {
                dofs.clear();
                parts.target.unknowns(hit.facet, &mut dofs);
                let at = |u: &[f64]| {
                    let own: Vec<f64> = dofs.iter().map(|&dof| u[dof]).collect();
                    parts.target.point(hit.facet, hit.s, &own)
                };
                at(u) - at(self.accepted)
            };
            if let Some(depth) = passed(&way, |ray, range| now.all(ray, range, &mut memory).to_vec(), motion) {
                return Err(came_through(&self.contact.describe(index), way.ray.origin, depth));
            }
        }
        Ok(())
    }
}
