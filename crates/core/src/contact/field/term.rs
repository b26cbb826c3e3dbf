//! The field as a term of equilibrium: one stencil for each node of the field and each smooth piece of the target.

use super::attempt::FieldAttempt;
use super::configuration::Configuration;
use super::contact::FieldContact;
use super::nearer::Nearer;
use crate::Failure;
use crate::contact::Overlap;
use crate::contact::increment::reach;
use crate::contact::record::{entry, past};
use crate::interface::{Interface, Past};
use crate::system::{Attempt, History, Instant, State, Term};
use std::sync::atomic::AtomicBool;
use std::sync::{Mutex, RwLock};

impl FieldContact {
    /// The history of nodes that begin at displacements `u`; `added` as in [`Overlap::begin`].
    fn begun(&self, u: &[f64], added: Option<[f64; 2]>) -> History {
        let vars: usize = self.parts.law.first().variables().iter().map(|v| v.len()).sum();
        let slots = (0..self.slots()).map(|_| entry::COUNT + vars);
        let mut history = History::new(slots.chain(self.parts.options.augmentation.map(|_| self.slots())));
        for slot in 0..self.slots() {
            let values = history.slot_mut(slot);
            values[entry::SEGMENT] = -1.0;
            (values[entry::HALF], values[entry::UNBENT], values[entry::AT_REST]) = (1.0, 1.0, 1.0);
            self.parts.law.first().initial(&mut values[entry::COUNT..]);
        }
        let still = vec![0.0; u.len()];
        self.each_seen(u, (self.reach(&still), None), |slot, stencil, sums| {
            let values = history.slot_mut(slot);
            (values[entry::PENETRATION], values[entry::XI]) = (sums.y[0], sums.area);
            values[entry::SEGMENT] = stencil.segment();
        });
        let near = (reach(self.longest, &still), &self.depths(u)[..]);
        let penalties = [self.parts.options.penalty; 2];
        let (fits, nearer) = (FITS * self.sagitta(), Configuration::new(self, u).nearer(&history, near));
        for (slot, nearer) in nearer.into_iter().enumerate() {
            let values = history.slot_mut(slot);
            if values[entry::SEGMENT] < 0.0 {
                continue;
            }
            let gap = -values[entry::PENETRATION];
            let bond = is_bond(self.parts.law.first(), &past(values, penalties, 0.0));
            let fits = match self.parts.options.overlap {
                Overlap::Fit => gap > 0.0 && gap <= fits,
                // A bond is made between surfaces that fit.
                Overlap::Ramp(_) => bond && gap.abs() <= fits,
                Overlap::Keep => false,
            };
            values[entry::NEARER] = if bond { 0.0 } else { nearer.most };
            if fits {
                Overlap::fit(values);
            } else {
                self.parts.options.overlap.begin(values, self.least, added);
            }
        }
        history
    }

    /// Nodes that saw little of a piece of a tool in space beside others of their faces: a face of first degree cannot bend, and one that
    /// bore at a node beyond the border would have the tool reach to there.
    pub(super) fn idle(&self, history: &History) -> Vec<bool> {
        let Some(shares) = self.shares(history) else { return vec![false; self.slots()] };
        let mut most = vec![0.0_f64; self.slots()];
        let faces = self.parts.surface.faces.iter().zip(&self.parts.surface.field);
        for (face, field) in faces.filter(|(face, _)| face.kind.degree == 1) {
            for piece in 0..self.pieces {
                let slots = || field[..face.corners()].iter().map(|&node| self.slot(node, piece));
                let largest = slots().map(|slot| shares[slot]).fold(0.0, f64::max);
                slots().for_each(|slot| most[slot] = most[slot].max(largest));
            }
        }
        let saw = |slot: usize| history.slot(slot)[entry::SEGMENT] >= 0.0;
        (0..self.slots()).map(|slot| saw(slot) && shares[slot] < LITTLE * most[slot]).collect()
    }

    /// Which slots have a brittle bond after an accepted history: what is closed, and before the first increment what touches.
    fn bonds(&self, law: &dyn Interface, history: &History, normal: f64) -> Vec<bool> {
        let bonded = |slot: usize| {
            let old = history.slot(slot);
            let past = past(old, [normal; 2], 0.0);
            let touches = || old[entry::SEGMENT] >= 0.0 && past.penetration > law.touch(&past) + self.least;
            is_bond(law, &past) && (old[entry::STATUS] > 0.0 || touches())
        };
        (0..self.slots()).map(bonded).collect()
    }

    /// The tangential penalties of an attempt after an accepted history: a node that is about to slide under its pressure has
    /// slipped elastically by the stated part of its faces, and one under less than the mean pressure as under that. A stiffer
    /// interface resolves nothing that the mesh shows, and has nodes change between stick and slip with every small motion.
    fn tangential_penalties(&self, law: &dyn Interface, history: &History, normal: f64) -> Vec<f64> {
        let most = self.parts.options.tangential_penalty;
        let Some(part) = self.parts.options.elastic_slip else { return vec![most; self.slots()] };
        let most = most.max(normal);
        let stiffness = |slot: usize| {
            let values = history.slot(slot);
            let sliding = law.sliding_stress(values[entry::PRESSURE]).unwrap_or(0.0);
            (values[entry::STATUS] > 0.0).then(|| sliding * values[entry::HALF] / (part * self.size_at(slot)))
        };
        let closed: Vec<f64> = (0..self.slots()).filter_map(stiffness).filter(|found| *found > 0.0).collect();
        let mean = if closed.is_empty() { 0.0 } else { closed.iter().sum::<f64>() / closed.len() as f64 };
        let least = mean.max(SOFTEST * most);
        (0..self.slots()).map(|slot| stiffness(slot).unwrap_or(0.0).max(least).min(most)).collect()
    }
}

/// Whether a law has a brittle bond, one that keeps its shear strength under some tension.
fn is_bond(law: &dyn Interface, past: &Past) -> bool {
    law.tensile_strength(past) > 0.0 && law.keeps(past) < law.stays(past.vars)
}

/// Part of the largest share of the nodes of its faces below which that of a node leaves the stress to them.
const LITTLE: f64 = 0.45;
/// Least tangential penalty over the largest, which is many times the stiffness of the cells behind: what slips elastically stays
/// small against what those shear, also in a metal, whose friction is small against its modulus.
const SOFTEST: f64 = 0.05;
/// Gaps up to this multiple of what the facets of both sides stand off a smooth surface are theirs, where bodies fit.
const FITS: f64 = 2.0;

impl Term for FieldContact {
    fn name(&self) -> &str {
        self.title()
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
        let augmented = self.parts.options.augmentation.is_some();
        let before = Configuration::new(self, &accepted.u);
        let shifts = if augmented { history.slot(self.slots()) } else { &[] };
        let law = self.parts.law.at(at.step, at.step_time)?;
        let normal = self.kept_penalty(history);
        let (far, depths) = (reach(self.longest, &accepted.last_change), self.depths(&accepted.u));
        let bore = (0..self.slots()).any(|slot| history.slot(slot)[entry::STATUS] > 0.0);
        let (bonds, mut nearer) = (self.bonds(&*law, history, normal), before.nearer(history, (far, &depths)));
        let reach = self.reach(&accepted.last_change);
        let idle = self.idle(history).into_iter().zip(before.held(at.step)).map(|(idle, held)| idle || held);
        // What is glued does not begin to touch.
        nearer.iter_mut().zip(&bonds).filter(|(_, bond)| **bond).for_each(|(nearer, _)| *nearer = Nearer::default());
        Ok(Box::new(FieldAttempt {
            contact: self,
            history,
            accepted: &accepted.u,
            tips_before: self.tips_before(&before, history),
            pointings: before.pointings(history, (far, reach)),
            duals: self.dual_limits(&before.placed, history),
            nearer,
            redrawn: if before.arcs == self.rest { Vec::new() } else { self.redrawn(&accepted.u, history) },
            before,
            depths,
            reach,
            ahead: accepted.ahead(at.dt),
            shifts: shifts.iter().map(|&closure| [closure, 0.0, 0.0]).collect(),
            augmented: 0,
            before_augmented: f64::INFINITY,
            at,
            tangential: self.tangential_penalties(&*law, history, normal),
            bonds,
            normal,
            stiffened: false,
            law,
            found: RwLock::default(),
            linear: (0..self.slots()).map(|_| Mutex::default()).collect(),
            idle: idle.collect(),
            bore,
            shared: bore,
            taking: None,
            far,
            part: if accepted.last_dt > 0.0 { at.dt / accepted.last_dt } else { 0.0 },
            hold: AtomicBool::default(),
            held: AtomicBool::default(),
        }))
    }

    fn name_of(&self, slot: usize) -> String {
        match (self.node_of(slot), self.corner_of(slot)) {
            (Some(node), _) => format!("node {} of contact '{}'", self.parts.surface.nodes[node].node, self.parts.name),
            (_, Some(corner)) => format!("corner at node {} of contact '{}'", corner.nodes[0], self.parts.name),
            (None, None) => format!("tip {} of the tool of contact '{}'", self.tip_of(slot) + 1, self.parts.name),
        }
    }

    fn bends(&self) -> bool {
        true
    }

    fn branches(&self) -> &'static [&'static str] {
        &["open", "stick", "slip"]
    }
}
