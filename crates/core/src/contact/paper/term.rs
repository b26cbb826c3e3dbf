//! A contact of Gauss points as a term of equilibrium: one stencil a point.

use super::attempt::{PaperAttempt, write_hit};
use super::contact::PaperContact;
use super::stencil::D;
use crate::Failure;
use crate::contact::Overlap;
use crate::contact::kink::{answer, answer_by_mean};
use crate::contact::record::{entry, leave, stresses};
use crate::system::{
    Answer, Attempt, Branch, Coordinates, Couplings, History, Instant, Kinks, Local, State, Stencil, Stencils, Term,
};
use crate::tool::{Hit, Rejected};
use rayon::prelude::*;

impl PaperContact {
    /// The history of points that begin at displacements `u`; `added` as in [`Overlap::begin`].
    fn begun(&self, u: &[f64], added: Option<[f64; 2]>) -> History {
        let vars: usize = self.parts.law.first().variables().iter().map(|v| v.len()).sum();
        let mut history = History::new(self.points.iter().map(|_| entry::COUNT + vars));
        for (i, hit) in self.search_within(u, self.reach(&vec![0.0; u.len()])).0.into_iter().enumerate() {
            let values = history.slot_mut(i);
            write_hit(hit, values);
            self.parts.options.overlap.begin(values, self.least, added);
            self.parts.law.first().initial(&mut values[entry::COUNT..]);
        }
        history
    }
}

impl Term for PaperContact {
    fn name(&self) -> &str {
        &self.parts.name
    }

    fn initial(&self) -> History {
        self.begun(&vec![0.0; self.parts.dofs.count()], None)
    }

    fn returned(&self, accepted: &State, at: Instant, until: f64) -> Result<History, Failure> {
        Ok(match self.parts.options.overlap {
            Overlap::Fit => self.initial(),
            _ => self.begun(&accepted.u, Some([at.time, until])),
        })
    }

    fn attempt<'a>(
        &'a self,
        accepted: &'a State,
        history: &'a History,
        at: Instant,
    ) -> Result<Box<dyn Attempt + 'a>, Failure> {
        Ok(Box::new(PaperAttempt {
            contact: self,
            law: self.parts.law.at(at.step, at.step_time)?,
            history,
            accepted: &accepted.u,
            depths: self.depths(&accepted.u),
            reach: self.reach(&accepted.last_change),
            ahead: accepted.ahead(at.dt),
            at,
        }))
    }

    fn name_of(&self, point: usize) -> String {
        let face = self.face(point);
        let kind = if self.surface().plane { "edge" } else { "face" };
        format!("point {point} of contact '{}' ({kind} with nodes {:?})", self.parts.name, face.nodes)
    }

    fn bends(&self) -> bool {
        true
    }

    fn branches(&self) -> &'static [&'static str] {
        &["open", "stick", "slip"]
    }
}

impl Attempt for PaperAttempt<'_> {
    fn is_fixed(&self) -> bool {
        false
    }

    fn scratch(&self, index: usize) -> Vec<f64> {
        vec![0.0; self.history.slot(index).len()]
    }

    fn reach(&self, couplings: &mut Couplings) {
        if self.contact.parts.target.deforms() {
            let mut stencils = Stencils::default();
            self.list(&self.ahead, &mut stencils);
            stencils.list.iter().for_each(|stencil| couplings.push(stencils.dofs(stencil)));
        }
    }

    fn stencils(&self, u: &[f64], out: &mut Stencils) -> Result<(), Failure> {
        self.list(u, out);
        Ok(())
    }

    fn evaluate(&self, index: usize, stencil: &Stencil, new: &mut [f64], local: &mut Local) -> Result<Branch, Failure> {
        let Some(geometry) = self.geometry(index, stencil, &local.u)? else {
            write_hit(None, new);
            leave(&*self.law, self.history.slot(index), new);
            return Ok(0);
        };
        if local.wants_tangent {
            self.evaluate_over::<D>(index, &geometry, new, local)
        } else {
            self.evaluate_over::<f64>(index, &geometry, new, local)
        }
    }

    fn kink(&self, index: usize, stencil: &Stencil, u: &[f64], out: &mut Kinks) -> Result<(), Failure> {
        if let Some(geometry) = self.geometry(index, stencil, u)? {
            self.bend((index, stencil), &geometry, u, out);
        }
        Ok(())
    }

    fn before(&self, stencil: usize) -> Coordinates {
        stresses(self.history.slot(stencil))
    }

    fn answer(&self, stencil: usize, y: &Coordinates) -> Result<Answer, Failure> {
        let (law, past, least) = (&*self.law, self.past(stencil), self.contact.least);
        if self.contact.neighbours.is_empty() {
            return answer(law, &past, least, y);
        }
        answer_by_mean(law, &past, (least, if self.contact.surface().plane { 1 } else { 2 }), y)
    }
}

/// Fewest points that are searched by one thread.
const TOGETHER: usize = 64;

impl PaperAttempt<'_> {
    /// Lists the stencils of all points at unknowns `u`.
    fn list(&self, u: &[f64], out: &mut Stencils) {
        let (contact, target) = (self.contact, self.contact.target_at(u));
        let seek = |index: usize| {
            let cast = contact.cast(index, contact.ray(index, u), (self.depths[index], self.reach));
            let hit = target.see(&cast, &mut Rejected::default());
            let found = |hit: Hit| Stencil { choice: hit.segment as u32 + 1, near: hit.s, ..Stencil::default() };
            hit.map_or_else(Stencil::default, found)
        };
        // Each point for itself: the order of the threads decides nothing.
        let points = (0..contact.points.len()).into_par_iter().with_min_len(TOGETHER);
        let found: Vec<Stencil> = points.map(seek).collect();
        for (index, stencil) in found.into_iter().enumerate() {
            let start = out.dofs.len();
            self.unknowns(index, &stencil, &mut out.dofs);
            out.close(start, stencil);
        }
    }
}
