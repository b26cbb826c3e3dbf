//! A normal penalty that is raised where penetration takes up energy that is the bodies'.
//!
//! A penalty from the undeformed modulus gives way to what is far stiffer: a body that is confined and nearly incompressible, rubber that
//! is squeezed to less than half its height. When an iterate has converged, the work of the mean pressure on its penetration is compared
//! with what the bodies have taken up, and the increment goes on with a higher penalty where it is too much; later increments keep that.

use super::attempt::FieldAttempt;
use super::contact::FieldContact;
use crate::contact::RaisedPenalty;
use crate::contact::record::entry;
use crate::system::History;
use std::ops::Range;

/// Share of the energy of the bodies above which the penalty is raised: the force is then off by one to four times as much,
const MOST: f64 = 0.01;
/// as is that of the energy which an increment adds, where it adds more than this of it: rubber becomes stiffer as it is squeezed,
const TELLS: f64 = 0.05;
/// unless it falls faster than this from one increment to the next, as it does where bodies have just begun to touch.
const STEADY: f64 = 0.95;
/// Part of the penetration that an augmentation may leave before the penalty is raised, and that it is raised for (Bertsekas, Constrained
/// Optimization and Lagrange Multiplier Methods, 1982, section 2.2).
const LEFT: [f64; 2] = [0.25, 0.1];
/// Share that it is raised for, and below which the least would leave it again.
const AIM: f64 = 0.003;
/// Part of the radius of a rounding that may penetrate: where the whole does the rounding presses no more, and the place under it flips
/// to one side.
const SUNK: f64 = 0.25;
/// It is raised by powers of this, so that it seldom changes.
const STEP: f64 = 4.0;

/// Those of some stencils that are closed, with their records.
fn closed(history: &History, slots: Range<usize>) -> impl Iterator<Item = (usize, &[f64])> {
    slots.map(|slot| (slot, history.slot(slot))).filter(|(_, values)| values[entry::STATUS] > 0.0)
}

impl FieldContact {
    /// The normal penalty that an accepted history was found with.
    pub(super) fn kept_penalty(&self, history: &History) -> f64 {
        let kept = closed(history, 0..self.slots()).map(|(_, values)| values[entry::PENALTY]);
        kept.fold(self.parts.options.penalty, f64::max)
    }

    /// Records of the nodes that are closed.
    pub(super) fn closed<'a>(&self, history: &'a History) -> impl Iterator<Item = &'a [f64]> {
        closed(history, 0..self.nodal_slots()).map(|(_, values)| values)
    }

    /// What a penalty lets the mean pressure penetrate, and half its work on that: peaks at a corner ask for none.
    fn penetrated(&self, history: &History, penalty: f64) -> [f64; 2] {
        let nodes = self.closed(history).map(|values| {
            let area = values[entry::XI];
            (area, values[entry::PRESSURE] * values[entry::HALF] * area)
        });
        let (area, force) = nodes.fold((0.0, 0.0), |(area, force), node| (area + node.0, force + node.1));
        let mean = if area > 0.0 { force / (penalty * area) } else { 0.0 };
        [mean, 0.5 * mean * force]
    }
}

impl FieldAttempt<'_> {
    /// Raises a penalty that no user gave where augmentation leaves much of a penetration, `left` of it now: `K / (K + penalty)` of it with
    /// `K` the stiffness of the bodies. Returns the old penalty over the new one.
    pub(super) fn hasten(&mut self, left: f64) -> f64 {
        let part = left / std::mem::replace(&mut self.before_augmented, left);
        let options = &self.contact.parts.options;
        let Some(RaisedPenalty { most, .. }) =
            options.raised.filter(|raised| part > LEFT[0] && self.normal < raised.most)
        else {
            return 1.0;
        };
        // Where states of contact changed as well, more may be left than there was.
        let ratio = if part < 1.0 { (1.0 / LEFT[1] - 1.0) / (1.0 / part - 1.0) } else { STEP };
        let old = self.normal;
        self.normal = (old * STEP.powf(ratio.log(STEP).ceil())).min(most);
        self.before_augmented = f64::INFINITY;
        old / self.normal
    }

    /// Changes the penalty where the share of the energy asks for it, and says whether it did.
    pub(super) fn stiffen(&mut self, new: &History, taken: [f64; 2]) -> bool {
        let options = &self.contact.parts.options;
        let raised = options.raised.filter(|_| !self.law.is_compliant() && taken.iter().all(|taken| *taken > 0.0));
        let Some(RaisedPenalty { from, most }) = raised else { return false };
        // Where a tip parts the surface the pressure changes from cell to cell, and few nodes follow a stiffer penalty.
        let mut tips = closed(new, self.contact.tip_slots()).peekable();
        if tips.peek().is_some() {
            let sunk = |(slot, values): (usize, &[f64])| {
                let radius = self.contact.tips()[self.contact.tip_of(slot)].radius;
                radius > 0.0 && values[entry::PENETRATION] > SUNK * radius
            };
            let sinks = self.normal < most && tips.any(sunk);
            if sinks {
                (self.normal, self.stiffened) = ((self.normal * STEP).min(most), true);
            }
            return sinks;
        }
        let [[_, before], [mean, now]] =
            [self.history, new].map(|history| self.contact.penetrated(history, self.normal));
        let [first, share] = [before / taken[0], now / taken[1]];
        // What an increment adds is the stiffness of the bodies over that of the penalty, by which the force is off.
        let added = taken[1] - taken[0];
        let worst = if added > TELLS * taken[1] { share.max((now - before) / added) } else { share };
        let least = options.penalty;
        let wanted = if mean >= from && worst > MOST && share > STEADY * first {
            (self.normal * STEP.powf((worst / AIM).log(STEP).ceil())).min(most)
        } else if share * self.normal < AIM * least {
            least
        } else {
            self.normal
        };
        let changes = wanted > self.normal || (wanted < self.normal && !self.stiffened);
        if changes {
            (self.normal, self.stiffened) = (wanted, true);
        }
        changes
    }
}
