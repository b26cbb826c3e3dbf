//! Whether the target has passed a contact point from one accepted state to the next.
//!
//! A target that lies deeper in a body than its middle is no contact: the rules of the search cannot tell it from the body's
//! own far side. A point that sees nothing for that reason carries no force, and an equilibrium found without it would be one
//! in which the target went through. So where iterations have converged and a point sees nothing, the faces that it would see
//! deeper down are asked where they came from: if one was in front of the point in the accepted state, and the way of the
//! point, seen from that face, enters the target, then the target came through, however large the increment was.

use super::open::OpenContact;
use super::point::triad;
use super::record::entry;
use super::target::Memory;
use crate::system::History;
use crate::tensor::Vec3;
use crate::tool::{self, Met, Ray, Rules};
use crate::{Failure, Kind};

/// How far before a face the way of a point begins that touched it, as a part of the admissible depth: off its rounding.
const OFF: f64 = 1e-6;

/// The way of a contact point over an increment.
pub struct Way {
    /// Where it was.
    pub from: Vec3,
    /// Where it is, along its inward normal.
    pub ray: Ray,
    /// Its largest admissible penetration in the accepted state, a length.
    pub depth: f64,
    /// Whether it saw the target in the accepted state, and may have been in touch with it; else it must have been in front.
    pub saw: bool,
}

/// How deep a face lies that passed a point, if one did. `cast` lists what a ray meets within a range, `motion` tells by how
/// much the material point of a hit moved over the increment.
pub fn passed<H: Met>(
    way: &Way,
    mut cast: impl FnMut(&Ray, [f64; 2]) -> Vec<H>,
    mut motion: impl FnMut(&H) -> Vec3,
) -> Option<f64> {
    let deep = |hit: &H| hit.u() > way.depth && way.ray.direction.dot(hit.normal()) > Rules::LEAST_COSINE;
    let mut found: Vec<H> = cast(&way.ray, [way.depth, f64::INFINITY]).into_iter().filter(deep).collect();
    found.sort_by(|a, b| a.u().total_cmp(&b.u()));
    found.iter().find(|hit| way.enters(*hit, motion(hit), &mut cast)).map(|hit| hit.u())
}

impl Way {
    /// Whether the way, seen from a face that moved by `motion`, begins in front of it and enters the target.
    fn enters<H: Met>(&self, face: &H, motion: Vec3, mut cast: impl FnMut(&Ray, [f64; 2]) -> Vec<H>) -> bool {
        // Where the point was, seen from the face as it is now.
        let start = self.from + motion;
        let behind = face.normal().dot(self.ray.point(face.u()) - start);
        if behind > if self.saw { self.depth } else { OFF * self.depth } {
            return false;
        }
        let start = start + face.normal() * (behind + OFF * self.depth).max(0.0);
        let way = self.ray.origin - start;
        let ray = Ray { origin: start, direction: way.unit() };
        cast(&ray, [0.0, way.norm()]).iter().any(|hit| ray.direction.dot(hit.normal()) < 0.0)
    }
}

/// The refusal of an increment over which the target passed a point that is now `at` a place.
pub fn came_through(point: &str, at: Vec3, depth: f64) -> Failure {
    let Vec3([x, y, z]) = at;
    Failure::new(format!(
        "the target came through at {point}, ({x:.6}, {y:.6}, {z:.6}): it lies {depth:.3e} deep, beyond the middle of the \
         body; take smaller increments, or a larger `penalty` if the target is pressed through"
    ))
    .of(Kind::Passage)
}

impl OpenContact<'_> {
    /// Refuses an equilibrium at unknowns `u` in which the target has passed a point that sees nothing.
    ///
    /// # Errors
    /// A [`Failure`] that names the first such point.
    pub(super) fn refuse_passage(&self, u: &[f64], new: &History) -> Result<(), Failure> {
        let (contact, now) = (self.contact, self.contact.target.stand(u));
        let (mut memory, mut dofs) = (Memory::default(), Vec::new());
        let blind = |&index: &usize| new.slot(index)[entry::SEGMENT] < 0.0 && self.depths[index].is_finite();
        for index in (0..contact.surface.points.len()).filter(blind) {
            let place = |u: &[f64]| contact.locate(&contact.surface.points[index], u);
            let ((origin, tangent), (from, _)) = (place(u), place(self.accepted));
            let (direction, saw) = (triad(tangent).1, self.history.slot(index)[entry::SEGMENT] >= 0.0);
            let way = Way { from, ray: Ray { origin, direction }, depth: self.depths[index], saw };
            let motion = |hit: &tool::Hit| {
                dofs.clear();
                contact.target.unknowns(hit.segment, &mut dofs);
                let at = |u: &[f64]| {
                    let own: Vec<f64> = dofs.iter().map(|&dof| u[dof]).collect();
                    contact.target.point(hit.segment, [hit.s, 0.0], &own)
                };
                at(u) - at(self.accepted)
            };
            if let Some(depth) = passed(&way, |ray, range| now.all(ray, range, &mut memory).to_vec(), motion) {
                return Err(came_through(&contact.describe(index), origin, depth));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hit(u: f64, up: f64) -> tool::Hit {
        tool::Hit { segment: 0, s: 0.5, u, normal: Vec3::new(0.0, up, 0.0) }
    }

    /// A point on the lower side of a body of height 1, which fell from 0.2 above a plate to `to` below its upper face; the
    /// plate moved by `plate`, and ends beside the way of the point or not.
    fn falls(to: f64, plate: f64, beside: bool) -> Option<f64> {
        let (origin, direction) = (Vec3::new(0.0, plate - to, 0.0), Vec3::new(0.0, 1.0, 0.0));
        let way = Way { from: Vec3::new(0.0, 0.2, 0.0), ray: Ray { origin, direction }, depth: 0.5, saw: true };
        let cast = |ray: &Ray, [least, most]: [f64; 2]| {
            let u = (plate - ray.origin[1]) / ray.direction[1];
            let upwards = ray.direction[1] > 0.0;
            let seen = (least..=most).contains(&u) && (upwards || !beside);
            if seen { vec![hit(u, 1.0)] } else { Vec::new() }
        };
        passed(&way, cast, |_| Vec3::new(0.0, plate, 0.0))
    }

    #[test]
    fn a_face_that_came_from_the_front_has_passed() {
        assert_eq!(falls(0.6, 0.0, false), Some(0.6));
        assert_eq!(falls(50.0, 3.0, false), Some(50.0));
        assert_eq!(falls(0.4, 0.0, false), None, "admissible");
        assert_eq!(falls(5.0, 0.0, true), None, "past its end");
    }

    #[test]
    fn a_face_that_was_behind_already_has_not() {
        let still = Ray { origin: Vec3::zero(), direction: Vec3::new(0.0, 1.0, 0.0) };
        let way = Way { from: Vec3::zero(), ray: still, depth: 0.5, saw: true };
        assert_eq!(passed(&way, |_, _| vec![hit(1.0, 1.0)], |_| Vec3::zero()), None);
        assert_eq!(passed(&way, |_, _| vec![hit(1.0, -1.0)], |_| Vec3::zero()), None);
    }
}
