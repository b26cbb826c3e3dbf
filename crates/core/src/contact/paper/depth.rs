//! How deep a contact may lie: half the distance from a Gauss point, along its inward normal, to where the ray leaves the
//! point's own body. Derived from the accepted state, so that no depth has to be given.

use super::contact::PaperContact;
use super::segment::met;
use crate::contact::field::faces;
use crate::tool::Hit;

/// Where a ray crosses the boundary of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
struct BodyCrossing {
    /// Distance along the ray.
    u: f64,
    /// Whether it leaves the body there, or enters it.
    leaves: bool,
}

/// Crossings of one kind that are no farther apart than this part of their distance are one: a ray through a common node.
const TOGETHER: f64 = 1e-9;

/// Where a ray that begins on a body's boundary and goes inward leaves the body. Where the body penetrates itself the ray
/// begins inside it twice, and the first face that it leaves by is that of the other part: the end is where it is inside
/// nothing.
fn end_of_body(mut crossings: Vec<BodyCrossing>) -> f64 {
    crossings.sort_unstable_by(|a, b| a.u.total_cmp(&b.u));
    crossings.dedup_by(|b, a| a.leaves == b.leaves && b.u - a.u <= TOGETHER * b.u);
    let way = |crossing: &BodyCrossing| if crossing.leaves { -1 } else { 1 };
    let mut inside = 1.max(-crossings.iter().map(way).sum::<i32>());
    let end = crossings.iter().find(|crossing| {
        inside += way(crossing);
        inside <= 0
    });
    end.map_or(f64::INFINITY, |crossing| crossing.u)
}

impl PaperContact {
    /// The largest admissible penetration at each point; infinite where its ray never leaves the body. A point of a curved face lies off
    /// its chord, so that its own face is left out, and what is within rounding of a corner.
    pub(super) fn depths(&self, u: &[f64]) -> Vec<f64> {
        let sides = &self.boundary.surface.faces;
        let boundary = self.boundary.in_place(self.site(), u);
        let depth = |index: usize| {
            let (own, (origin, triad)) = (self.parts.surface.face(index).side, self.triad(index, u));
            let least = 1e-3 * if self.parts.surface.faces.plane { triad.area } else { triad.area.sqrt() };
            let mut crossings = Vec::new();
            let ray = faces::FaceRay { x: origin, n: triad.inward };
            boundary.nearest(&ray, [least, f64::MAX], |number, at| {
                let side = sides[number].side;
                if side != own && self.wholes[side.cell] == self.wholes[own.cell] {
                    let crossing = |hit: Hit| BodyCrossing { u: hit.u, leaves: hit.normal.dot(triad.inward) > 0.0 };
                    crossings.extend(met(number, &ray, at).map(crossing));
                }
                false
            });
            0.5 * end_of_body(crossings)
        };
        (0..self.parts.surface.points.len()).map(depth).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_that_penetrates_itself_does_not_end_at_its_other_part() {
        let crossing = |&u: &f64| BodyCrossing { u: u.abs(), leaves: u > 0.0 };
        let at = |list: &[f64]| end_of_body(list.iter().map(crossing).collect());
        assert_eq!(at(&[2.0]), 2.0);
        // Out of the other part, then out of its own.
        assert_eq!(at(&[2.0, 0.1]), 2.0);
        // Through a ring, whose far wall is met in a node.
        assert_eq!(at(&[1.0, -7.0, 8.0, 8.0 + 1e-13]), 1.0);
        assert_eq!(at(&[0.1, 1.0, -7.0, 8.0]), 1.0);
        assert_eq!(at(&[]), f64::INFINITY);
        // Beyond a gap that was missed.
        assert_eq!(at(&[1.0, -3.0]), 1.0);
    }
}
