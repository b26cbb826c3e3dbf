//! What an attempt does once its iterations have converged: augmentation, bonds that break, tips that yield, wear, and what it refuses.

use super::FieldAttempt;
use crate::contact::augment;
use crate::contact::field::configuration::Configuration;
use crate::contact::field::corner::Pointing;
use crate::contact::field::corners::WAYS;
use crate::contact::field::cover::{CornerTouch, FEET, Patch};
use crate::contact::field::tip::{TipFoot, landing, landings};
use crate::contact::record::entry;
use crate::system::{History, Term};
use crate::{Failure, FailureKind};

/// Part of the excess over its strength of the bond that breaks first above which others break with it.
const FIRST: f64 = 0.8;

/// Excess over a strength, as a part of it, that is rounding.
const ROUNDED: f64 = 1e-9;

/// Part of what a tip had in the area of a face below which a converged increment goes on with what it has now.
const CHANGED: f64 = 0.75;

/// Difference of a share beyond which the first increment of a contact goes on with the one that its strains leave.
const ANOTHER: f64 = 0.1;

impl FieldAttempt<'_> {
    /// Augments, or changes the penalty, and says whether it did.
    pub(super) fn improve(&mut self, new: &mut History, taken: [f64; 2]) -> Result<bool, Failure> {
        let Some(augmentation) = self.contact.parts.options.augmentation else { return Ok(self.stiffen(new, taken)) };
        let (mut better, mut left) = (self.shifts.clone(), augment::Left::default());
        for (slot, shift) in better.iter_mut().enumerate() {
            let (new, size) = (new.slot(slot), self.contact.size_at(slot));
            if new[entry::SEGMENT] < 0.0 {
                shift[0] = 0.0;
                continue;
            }
            let stretch = new[entry::HALF];
            let borne = new[entry::PRESSURE] * stretch / self.normal;
            let closed = new[entry::STATUS] > 0.0;
            let raised = if closed { borne } else { (shift[0] + new[entry::PENETRATION]).max(0.0) };
            left.penetration = left.penetration.max((raised - shift[0]).abs() / size);
            shift[0] = raised;
            if closed {
                let old = self.history.slot(slot);
                let elastic = [(entry::SHEAR, 1), (entry::SHEAR2, 2)]
                    .map(|(shear, c)| ((new[shear] - old[shear]) * stretch / self.tangential[slot], c));
                let sticks = new[entry::STATUS] == 1.0;
                for (borne, c) in elastic {
                    if sticks {
                        left.slip = left.slip.max((borne - shift[c]).abs() / size);
                    }
                    shift[c] = borne;
                }
            }
        }
        if !augmentation.goes_on(&left, self.augmented, self.contact.title())? {
            let kept = new.slot_mut(self.contact.slots());
            kept.iter_mut().zip(&self.shifts).for_each(|(closure, shift)| *closure = shift[0]);
            return Ok(false);
        }
        let part = self.hasten(left.penetration);
        better.iter_mut().for_each(|shift| shift[0] *= part);
        (self.shifts, self.augmented) = (better, self.augmented + 1);
        Ok(true)
    }

    /// Nodes beneath a place of a face, with the functions of its corners there.
    fn beneath(&self, f: usize, xi: [f64; 2]) -> impl Iterator<Item = (usize, f64)> + '_ {
        let (surface, face) = (&self.contact.parts.surface, &self.contact.parts.surface.faces[f]);
        let functions = face.corner_functions(face.nearest(xi));
        (0..face.corners()).map(move |corner| (surface.field[f][corner], functions.n[corner]))
    }

    /// What has been rubbed of the surface beneath a foot of a tip at the accepted state.
    pub(super) fn worn_beneath(&self, slot: usize) -> f64 {
        let foot = self.tips_before.get(slot - self.contact.nodal_slots()).copied().flatten();
        let Some((face, landing)) = foot.and_then(|foot| Some((foot.patch.face, foot.patch.tip?))) else { return 0.0 };
        let rubbed = |node: usize| {
            let pieces = (0..self.contact.pieces).map(|piece| self.history.slot(self.contact.slot(node, piece)));
            pieces.map(|values| values[entry::RUBBED]).fold(0.0, f64::max)
        };
        self.beneath(face, landing.xi).map(|(node, n)| n * rubbed(node)).sum()
    }

    /// What tips rubbed in a converged increment wears the nodes beneath them: the volume is that of the tip (Archard), its place the one
    /// to which the tip has come.
    pub(super) fn wear_beneath_tips(&self, new: &mut History) {
        let found = self.found();
        for slot in self.contact.nodal_slots()..self.contact.slots() {
            let rubbed = new.slot(slot)[entry::RUBBED] - self.history.slot(slot)[entry::RUBBED];
            let Some(&(number, _)) = found.supports[slot].patches.first().filter(|_| rubbed > 0.0) else { continue };
            let (patch, area) = (&found.patches[number].patch, new.slot(slot)[entry::XI]);
            let Some(landing) = patch.tip else { continue };
            for (node, n) in self.beneath(patch.face, landing.xi) {
                let depth = rubbed * area * n / self.contact.areas[node];
                for piece in 0..self.contact.pieces {
                    let values = new.slot_mut(self.contact.slot(node, piece));
                    values[entry::RUBBED] += depth;
                    values[entry::WORN] += if piece == 0 { depth } else { 0.0 };
                }
            }
        }
    }

    /// Refuses a state in which a node has closed on a side of a body behind which it lay: it has gone through the body, as where iterations push off a
    /// block that stands on an edge. So has a corner that lies in a body and bears nothing.
    pub(super) fn refuse_passage(&self, u: &[f64], new: &History) -> Result<(), Failure> {
        let bears = |number: usize| self.contact.bears(number, new);
        if !self.contact.corners.is_empty()
            && let Some(number) = self.in_place(u).unseen_corner(&self.before, bears)
        {
            let name = self.contact.name_of(self.contact.nodal_slots() + WAYS * number);
            return Err(Failure::new(format!("{name} came to lie in the other body unseen")).of(FailureKind::Passage));
        }
        let found = self.found();
        for slot in 0..self.contact.nodal_slots() {
            let closes = self.history.slot(slot)[entry::STATUS] == 0.0 && new.slot(slot)[entry::STATUS] > 0.0;
            let patches = found.supports[slot].patches.iter().filter(|_| closes);
            let mut patches = patches.map(|&(number, _)| &found.patches[number]);
            if patches.any(|found| self.contact.comes_out(found, (&self.before, self.history))) {
                let reason = format!("{} came out through another side of the body", self.contact.name_of(slot));
                return Err(Failure::new(reason).of(FailureKind::Passage));
            }
        }
        Ok(())
    }

    /// Breaks the bonds that bear more than their strength at a converged state, those that bear most alone: what others bear follows from it. A
    /// state from which all of them broke at once would depend on the increment, and on the iterates that led there. Says whether any did.
    pub(super) fn break_bonds(&mut self, new: &History) -> Result<bool, Failure> {
        let beyond = |slot: usize| {
            let (old, values) = (self.history.slot(slot), new.slot(slot));
            if !self.bonds[slot] || values[entry::SEGMENT] < 0.0 {
                return Ok(0.0);
            }
            let past = self.past(slot, values[entry::HALF]);
            let [s, t] = [entry::SLIP, entry::SLIP2].map(|slip| values[slip] - old[slip]);
            let here = values[entry::PENETRATION] + self.contact.least + self.closure(slot);
            let lift = self.lift(slot, &past, [here, s, t]);
            let held = self.extended(slot, self.answer_of((slot, &past), &[here + lift, s, t, 0.0])?, lift).stress;
            let own = self.answer_of((slot, &past), &[here, s, t, 0.0])?.stress;
            let open = here - self.contact.least <= self.law.opens(&past, [s, t]);
            let strength = self.law.tensile_strength(&past);
            let [sheared, shear] = [held, own].map(|stress| stress[1].hypot(stress[2]));
            let beyond = if open { -held[0] - strength } else { sheared - shear };
            Ok::<_, Failure>(if beyond > ROUNDED * strength { beyond } else { 0.0 })
        };
        let beyond = (0..self.contact.slots()).map(beyond).collect::<Result<Vec<f64>, _>>()?;
        let most = beyond.iter().copied().fold(0.0, f64::max);
        let breaks = |beyond: f64| beyond > 0.0 && beyond >= FIRST * most;
        self.bonds.iter_mut().zip(&beyond).filter(|(_, beyond)| breaks(**beyond)).for_each(|(bond, _)| *bond = false);
        Ok(most > 0.0)
    }

    /// Where nothing bore at the accepted state, no strain there tells how flat a flank is pressed: once converged, corners and tips have the
    /// shares that the strains now leave them, which then stay. Says whether any is another by much.
    pub(super) fn share_anew(&mut self, u: &[f64], new: &History) -> bool {
        let none = self.contact.corners.is_empty() && self.tips_before.is_empty();
        if std::mem::replace(&mut self.shared, true) || none {
            return false;
        }
        let differs = |had: f64, has: f64| (has - had).abs() > ANOTHER;
        let mut changed = false;
        let now = Configuration::with(self.contact, u, self.before.arcs.clone());
        let pointings = now.pointings(new, (self.far, self.reach));
        for (number, now) in pointings.into_iter().enumerate() {
            let (had, has) = (self.pointings[number].along.norm(), now.along.norm());
            if !differs(had, has) {
                continue;
            }
            let touch = CornerTouch { number, along: now.along };
            let saw = self.before.seen_along(touch, self.reach);
            let gap = saw.map_or(self.pointings[number].gap, |(_, hit)| hit.gap);
            let saw = saw.map(|(face, hit)| (face, hit.shape));
            (self.pointings[number], changed) = (Pointing { along: now.along, gap, saw, laid: 0.0 }, true);
        }
        let found = self.found();
        let differ = |patch: &Patch| patch.taken.iter().zip(now.taken(patch)).any(|(&had, has)| differs(had, has));
        let take_another = found.patches.iter().any(|found| differ(&found.patch));
        let found = now.tips(self.contact.longest, Some(&[]), |_| None, Some(new));
        for (before, now) in self.tips_before.chunks_mut(FEET).zip(found.chunks(FEET)) {
            match (landing(before), landing(now)) {
                (Some(had), Some(has)) if differs(had.share, has.share) => {
                    landings(before).for_each(|landing| (landing.share, landing.slender) = (has.share, has.slender));
                }
                // A flank that lay flat to rounding saw nothing.
                (None, Some(has)) if has.slender => before.copy_from_slice(now),
                _ => continue,
            }
            changed = true;
        }
        if take_another {
            (self.taking, changed) = (Some(now), true);
        }
        changed
    }

    /// Leaves tips the part that their surroundings leave them in a converged state, where that has become smaller, and says whether it
    /// did.
    pub(super) fn yield_tips(&mut self, u: &[f64]) -> bool {
        let share = |feet: &[Option<TipFoot>]| landing(feet).map(|landing| landing.share);
        if self.tips_before.chunks(FEET).filter_map(share).all(|before| before == 0.0) {
            return false;
        }
        let mut changed = false;
        let found = self.in_place(u).tips(self.contact.longest, Some(&[]), |_| None, Some(self.history));
        for (before, now) in self.tips_before.chunks_mut(FEET).zip(found.chunks(FEET)) {
            if let (Some(had), Some(share)) = (share(before), share(now))
                && share < CHANGED * had
            {
                landings(before).for_each(|landing| (landing.share, changed) = (share, true));
            }
        }
        changed
    }
}
