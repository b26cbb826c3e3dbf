//! What a contact in space gives to its augmentation: what its points report, and where its multipliers are kept.
//!
//! They stand at the corners of the surface's faces. Accepted closures are the last slot of the history; slips are kept
//! as vectors, by the tangents that the points had in the accepted state.

use super::open::OpenContact;
use super::pair::Contact;
use super::point::Triad;
use crate::Failure;
use crate::contact::augment::{Corners, Left, Report, Shift, closures_alone};
use crate::contact::overlap::recession;
use crate::contact::partner::{Role, Touch, between, changed, changes};
use crate::contact::record::{PointStatus, entry, touch_after};
use crate::system::History;
use crate::tensor::Vec3;

impl Contact {
    /// The corners of the surface.
    pub(super) fn corners_of_faces(&self) -> Corners {
        let surface = &self.parts.surface;
        let faces = surface.faces.iter().map(|face| (&face.nodes[..face.corners()], self.parts.length(face)));
        Corners::new(faces, surface.points.iter().map(|point| (point.face, point.xi)))
    }

    /// Those of its target, where it follows them.
    pub(super) fn corners_of_target(&self) -> Corners {
        let faces = self.parts.target.as_faces().map_or(&[][..], |faces| faces.list());
        let faces = faces.iter().map(|face| (&face.nodes[..face.corners()], self.parts.length(face)));
        Corners::new(faces, std::iter::empty())
    }

    /// Where the points touch their target, and the areas they stand for.
    fn touches<'a>(&'a self, u: &'a [f64], history: &'a History) -> impl Iterator<Item = Option<Touch>> + 'a {
        (0..self.parts.surface.points.len()).map(move |i| {
            let values = history.slot(i);
            let face = (values[entry::SEGMENT] >= 0.0).then_some(values[entry::SEGMENT] as usize)?;
            let other = self.parts.target.as_faces()?.list().get(face)?;
            let spot = self.spot(i, values);
            let area = self.acting_area(i, &spot, self.locate(&spot, u).1);
            Some(Touch { face, at: other.own_place([values[entry::S], values[entry::S2]]), area })
        })
    }

    /// What both sides of a surface that touches itself make of multipliers and of better ones, and how far its corners
    /// have moved.
    fn shared(&self, (from, to): (&[Shift], &[Shift]), (u, history): (&[f64], &History)) -> (Vec<Shift>, f64) {
        let own = changes(from, to);
        let found = self.corners.found((&self.corners, &own), self.touches(u, history), -1.0);
        let better = changed(from, &between(&own, &found));
        let moved = self.corners.moved(from, &better).penetration;
        (better, moved)
    }

    /// The multipliers at the beginning of an increment.
    pub(super) fn begun(&self, u: &[f64], history: &History) -> Vec<Shift> {
        let accepted = closures_alone(self.closures(history));
        if self.parts.options.augmentation.is_none_or(|augmentation| augmentation.role != Role::Itself) {
            return accepted;
        }
        between(&accepted, &self.corners.found((&self.corners, &accepted), self.touches(u, history), -1.0))
    }

    /// Closures of the corners in an accepted state; none without augmentation.
    pub(super) fn closures<'a>(&self, history: &'a History) -> &'a [f64] {
        let augmented = self.parts.options.augmentation.is_some();
        if augmented { history.slot(self.parts.surface.points.len()) } else { &[] }
    }

    /// The largest penetration that augmentation leaves at a node of an accepted state, over the size of its faces; none
    /// without augmentation.
    pub fn nodal_penetration(&self, u: &[f64], history: &History) -> Option<f64> {
        let augmentation = self.parts.options.augmentation.filter(|augmentation| augmentation.role != Role::Follows)?;
        let accepted = closures_alone(self.closures(history));
        let reports = (0..self.parts.surface.points.len()).map(|i| {
            let (values, still) = (history.slot(i), [Vec3::zero(); 2]);
            self.report(u, (i, still), self.corners.at(i, &accepted), (values, values))
        });
        let mut better = accepted.clone();
        let left = self.corners.improve(&mut better, reports);
        let itself = augmentation.role == Role::Itself;
        Some(if itself { self.shared((&accepted, &better), (u, history)).1 } else { left.penetration })
    }

    /// Tangents of all points, which slips refer to.
    pub(super) fn frames(&self, u: &[f64]) -> Vec<[Vec3; 2]> {
        let points = self.parts.surface.points.iter().filter(|_| self.parts.options.augmentation.is_some());
        points.map(|point| Triad::new(self.locate(point, u).1).along).collect()
    }

    /// What a point with two tangents and its share of the multipliers reports, from its history before and after an
    /// increment.
    fn report(
        &self,
        u: &[f64],
        (index, frame): (usize, [Vec3; 2]),
        shift: Shift,
        (old, new): (&[f64], &[f64]),
    ) -> Option<Report> {
        if new[entry::SEGMENT] < 0.0 {
            return None;
        }
        let (parts, point) = (&self.parts, self.spot(index, new));
        let status = PointStatus::from_value(new[entry::STATUS]);
        let borne = new[entry::PRESSURE] / parts.options.penalty;
        let (closed, sticks) = (status != PointStatus::Open, status == PointStatus::Stick);
        let seen = || new[entry::PENETRATION] + new[entry::CLOSURE] - shift.closure;
        let gap = || seen() - touch_after(parts.law.first(), &parts.options, new);
        let [slip, borne_shear] = slips(old, new, parts.options.tangential_penalty);
        let along = |[s, t]: [f64; 2]| frame[0] * s + frame[1] * t;
        Some(Report {
            area: self.acting_area(index, &point, self.locate(&point, u).1),
            penetration: if closed { borne - shift.closure } else { gap() },
            closed,
            sticks,
            slip: along(slip),
            raise: if sticks { along(slip) } else { along(borne_shear) - shift.slip },
            least: borne.min(0.0),
        })
    }
}

/// Slip of an increment that is no sliding, and the slip that would bear the change of the shear stress.
fn slips(old: &[f64], new: &[f64], penalty: f64) -> [[f64; 2]; 2] {
    let shear = [new[entry::SHEAR], new[entry::SHEAR2]];
    let (size, sliding) = (shear[0].hypot(shear[1]), new[entry::SLIPPED] - old[entry::SLIPPED]);
    let slid = shear.map(|shear| if size > 0.0 { sliding * shear / size } else { 0.0 });
    let change = |entry: usize| new[entry] - old[entry];
    let slip = [change(entry::SLIP) - slid[0], change(entry::SLIP2) - slid[1]];
    [slip, [change(entry::SHEAR) / penalty, change(entry::SHEAR2) / penalty]]
}

impl OpenContact<'_> {
    /// What multipliers stand for at a point: a closure, and slips along its tangents.
    pub(super) fn shift(&self, index: usize) -> (f64, [f64; 2]) {
        if self.shifts.is_empty() {
            return (0.0, [0.0; 2]);
        }
        let shift: Shift = self.contact.corners.at(index, &self.shifts);
        (shift.closure, self.frames[index].map(|along| along.dot(shift.slip)))
    }

    /// What is added to the penetration of a point before the law sees it.
    pub(super) fn closure(&self, index: usize) -> f64 {
        let (old, wear) = (self.history.slot(index), self.contact.parts.options.wear);
        self.shift(index).0 + recession(wear, self.settled[1], old)
    }

    /// Improves the multipliers unless they suffice; those that follow others are kept as they are.
    pub(super) fn improve(&mut self, u: &[f64], new: &mut History) -> Result<bool, Failure> {
        let (contact, parts) = (self.contact, &self.contact.parts);
        let Some(augmentation) = parts.options.augmentation else { return Ok(false) };
        let (mut better, mut left, points) = (self.shifts.clone(), Left::default(), parts.surface.points.len());
        if augmentation.role != Role::Follows {
            let reports = (0..points).map(|i| {
                let shift = contact.corners.at(i, &self.shifts);
                contact.report(u, (i, self.frames[i]), shift, (self.history.slot(i), new.slot(i)))
            });
            left = contact.corners.improve(&mut better, reports);
        }
        if augmentation.role == Role::Itself {
            (better, left.penetration) = contact.shared((&self.shifts, &better), (u, new));
        }
        if !augmentation.goes_on(&left, self.augmented, &parts.name)? {
            let closures = new.slot_mut(points).iter_mut().zip(&self.shifts);
            closures.for_each(|(closure, shift)| *closure = shift.closure);
            return Ok(false);
        }
        (self.shifts, self.augmented) = (better, self.augmented + 1);
        Ok(true)
    }

    /// Takes up the multipliers of the other side at `u`, whose slips point the other way, and says whether that changes
    /// anything.
    pub(super) fn take_up(&mut self, leading: &[[f64; 4]], u: &[f64], new: &History) -> bool {
        let (contact, augmentation) = (self.contact, self.contact.parts.options.augmentation);
        let Some(augmentation) = augmentation.filter(|a| a.role == Role::Follows) else { return false };
        let leading: Vec<Shift> = leading.iter().copied().map(Shift::of).collect();
        let found = contact.corners.found((&contact.opposite, &leading), contact.touches(u, new), -1.0);
        let felt = augmentation.is_felt(&contact.corners.moved(&self.shifts, &found));
        if felt {
            self.shifts = found;
        }
        felt
    }
}
