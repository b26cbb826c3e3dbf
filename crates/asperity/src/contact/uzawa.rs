//! What a contact in the plane gives to its augmentation: what its points report, and where its multipliers are kept.
//!
//! They stand at the corners of the surface's edges. On an edge that the target covers in part they belong to the covered
//! part, as the points do. Accepted closures are the last slot of the history.

use super::augment::{Corners, Left, Report, Shift, closures_alone};
use super::open::OpenContact;
use super::overlap::recession;
use super::pair::Contact;
use super::partner::{Role, Touch, between, changed, changes};
use super::record::{PointStatus, entry, touch_after};
use crate::Failure;
use crate::system::History;
use crate::tensor::Vec3;

impl Contact {
    /// The corners of the surface.
    pub(super) fn corners_of_edges(&self) -> Corners {
        let edges = self.surface.edges.iter().map(|edge| (&edge.nodes[..2], edge.chord(&self.mesh)));
        Corners::new(edges, self.surface.points.iter().map(|point| (point.edge, [point.rule, 0.0])))
    }

    /// Those of its target, where it follows them.
    pub(super) fn corners_of_target(&self) -> Corners {
        let edges = self.target.as_faces().map_or(&[][..], |faces| faces.edges());
        let edges = edges.iter().map(|edge| (&edge.nodes[..2], edge.chord(&self.mesh)));
        Corners::new(edges, std::iter::empty())
    }

    /// Where the points touch their target, and the areas they stand for.
    fn touches<'a>(&'a self, u: &'a [f64], history: &'a History) -> impl Iterator<Item = Option<Touch>> + 'a {
        (0..self.surface.points.len()).map(move |i| {
            let values = history.slot(i);
            let spot = self.spot(i, values);
            let face = (values[entry::SEGMENT] >= 0.0).then_some(values[entry::SEGMENT] as usize)?;
            let area = self.acting_area(i, &spot, self.locate(&spot, u));
            Some(Touch { face, at: [2.0 * values[entry::S] - 1.0, 0.0], area })
        })
    }

    /// What both sides of a surface that touches itself make of multipliers and of better ones, and how far its corners
    /// have moved.
    fn shared(&self, (from, to): (&[Shift], &[Shift]), (u, history): (&[f64], &History)) -> (Vec<Shift>, f64) {
        let own = changes(from, to);
        let found = self.corners.found((&self.corners, &own), self.touches(u, history), 1.0);
        let better = changed(from, &between(&own, &found));
        let moved = self.corners.moved(from, &better).penetration;
        (better, moved)
    }

    /// The multipliers at the beginning of an increment.
    pub(super) fn begun(&self, u: &[f64], history: &History) -> Vec<Shift> {
        let accepted = closures_alone(self.closures(history));
        if self.options.augmentation.is_none_or(|augmentation| augmentation.role != Role::Itself) {
            return accepted;
        }
        between(&accepted, &self.corners.found((&self.corners, &accepted), self.touches(u, history), 1.0))
    }

    /// Closures of the corners in an accepted state; none without augmentation.
    pub(super) fn closures<'a>(&self, history: &'a History) -> &'a [f64] {
        if self.options.augmentation.is_some() { history.slot(self.surface.points.len()) } else { &[] }
    }

    /// The largest penetration that augmentation leaves at a node of an accepted state, over the length of its edges;
    /// none without augmentation.
    pub fn nodal_penetration(&self, u: &[f64], history: &History) -> Option<f64> {
        let augmentation = self.options.augmentation.filter(|augmentation| augmentation.role != Role::Follows)?;
        let accepted = closures_alone(self.closures(history));
        let reports = (0..self.surface.points.len()).map(|i| {
            let shift = self.corners.at(i, &accepted);
            self.report(u, (i, shift), history.slot(i), history.slot(i))
        });
        let mut better = accepted.clone();
        let left = self.corners.improve(&mut better, reports);
        let itself = augmentation.role == Role::Itself;
        Some(if itself { self.shared((&accepted, &better), (u, history)).1 } else { left.penetration })
    }

    /// What a point with its share of the multipliers reports, from its history before and after an increment.
    fn report(&self, u: &[f64], (index, shift): (usize, Shift), old: &[f64], new: &[f64]) -> Option<Report> {
        if new[entry::SEGMENT] < 0.0 {
            return None;
        }
        let spot = self.spot(index, new);
        let (a, tangent) = self.locate(&spot, u);
        let status = PointStatus::from_value(new[entry::STATUS]);
        let borne = new[entry::PRESSURE] / self.options.penalty;
        let (closed, sticks) = (status != PointStatus::Open, status == PointStatus::Stick);
        let seen = || new[entry::PENETRATION] + new[entry::CLOSURE] - shift.closure;
        let gap = || seen() - touch_after(self.law.first(), &self.options, new);
        let sliding = (new[entry::SLIPPED] - old[entry::SLIPPED]).copysign(new[entry::SHEAR]);
        let slip = new[entry::SLIP] - old[entry::SLIP] - sliding;
        let borne_shear = (new[entry::SHEAR] - old[entry::SHEAR]) / self.options.tangential_penalty;
        let along = |slip: f64| Vec3::new(slip, 0.0, 0.0);
        Some(Report {
            area: self.acting_area(index, &spot, (a, tangent)),
            penetration: if closed { borne - shift.closure } else { gap() },
            closed,
            sticks,
            slip: along(slip),
            raise: if sticks { along(slip) } else { along(borne_shear) - shift.slip },
            least: borne.min(0.0),
        })
    }
}

impl OpenContact<'_> {
    /// What multipliers stand for at a point.
    pub(super) fn shift(&self, index: usize) -> Shift {
        if self.shifts.is_empty() { Shift::default() } else { self.contact.corners.at(index, &self.shifts) }
    }

    /// What is added to the penetration of a point before the law sees it.
    pub(super) fn closure(&self, index: usize) -> f64 {
        let (old, wear) = (self.history.slot(index), self.contact.options.wear);
        self.shift(index).closure + recession(wear, self.settled[1], old)
    }

    /// Improves the multipliers unless they suffice; those that follow others are kept as they are.
    pub(super) fn improve(&mut self, u: &[f64], new: &mut History) -> Result<bool, Failure> {
        let (contact, points) = (self.contact, self.contact.surface.points.len());
        let Some(augmentation) = contact.options.augmentation else { return Ok(false) };
        let (mut better, mut left) = (self.shifts.clone(), Left::default());
        if augmentation.role != Role::Follows {
            let report = |i| contact.report(u, (i, self.shift(i)), self.history.slot(i), new.slot(i));
            left = contact.corners.improve(&mut better, (0..points).map(report));
        }
        if augmentation.role == Role::Itself {
            (better, left.penetration) = contact.shared((&self.shifts, &better), (u, new));
        }
        if !augmentation.goes_on(&left, self.augmented, contact.title())? {
            let closures = new.slot_mut(points).iter_mut().zip(&self.shifts);
            closures.for_each(|(closure, shift)| *closure = shift.closure);
            return Ok(false);
        }
        (self.shifts, self.augmented) = (better, self.augmented + 1);
        Ok(true)
    }

    /// Takes up the multipliers of the other side at `u`, and says whether that changes anything. Along the tangents of
    /// both sides a slip is the same.
    pub(super) fn take_up(&mut self, leading: &[[f64; 4]], u: &[f64], new: &History) -> bool {
        let contact = self.contact;
        let Some(augmentation) = contact.options.augmentation.filter(|a| a.role == Role::Follows) else { return false };
        let leading: Vec<Shift> = leading.iter().copied().map(Shift::of).collect();
        let found = contact.corners.found((&contact.opposite, &leading), contact.touches(u, new), 1.0);
        let felt = augmentation.is_felt(&contact.corners.moved(&self.shifts, &found));
        if felt {
            self.shifts = found;
        }
        felt
    }
}
