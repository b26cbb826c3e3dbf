//! Which of the places that a ray meets is the contact: the paper's rules against false contacts, made deterministic.
//!
//! With `e` the direction of the ray (the inward normal of the body at its origin) and `n` the outward normal of the
//! target at the hit, a hit is admissible if `e . n > c_min` (the two faces look at each other) and `u <= u_max` (the
//! target's face is not behind half of the body). Of the admissible hits that with the smallest `|u|` is taken, of
//! equal ones that of the lowest segment.

use super::Hit;
use crate::tensor::Vec3;

/// When a hit is admissible.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rules {
    /// Largest penetration, a length.
    pub deepest: f64,
    /// Distances that differ by less are equal, a length: rounding must not choose between two neighbours at their
    /// common node.
    pub equal: f64,
}

impl Rules {
    /// Least cosine of the angle between the ray and the target's outward normal, a ratio; it also keeps the tangent's factor `1 / (e . n)` below ten.
    pub const LEAST_COSINE: f64 = 0.1;

    /// With penetrations up to `deepest`, on a target of the given `size`; both lengths.
    pub fn new(deepest: f64, size: f64) -> Self {
        Self { deepest, equal: 1e-12 * size }
    }
}

/// False contacts: hits that without the rules would have been penetrations.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Rejected {
    /// Faces that do not look at the body, within the admissible depth.
    pub wrong_side: usize,
    /// Faces that look at the body from beyond the admissible depth.
    pub too_deep: usize,
}

impl Rejected {
    /// Both reasons together.
    pub fn total(&self) -> usize {
        self.wrong_side + self.too_deep
    }
    fn count(&mut self, facing: bool, u: f64, rules: &Rules) {
        self.wrong_side += usize::from(!facing && u > 0.0 && u <= rules.deepest);
        self.too_deep += usize::from(facing && u > rules.deepest);
    }
}

/// The contact among the hits of a ray along `direction`, if there is one. What the rules reject is counted in
/// `rejected`.
pub fn select(direction: Vec3, hits: &[Hit], rules: &Rules, rejected: &mut Rejected) -> Option<Hit> {
    let facing = |hit: &Hit| direction.dot(hit.normal) > Rules::LEAST_COSINE;
    let admissible = |hit: &&Hit| facing(hit) && hit.u <= rules.deepest;
    hits.iter().for_each(|hit| rejected.count(facing(hit), hit.u, rules));
    let nearest = hits.iter().filter(admissible).map(|hit| hit.u.abs()).fold(f64::INFINITY, f64::min);
    let equal = |hit: &&Hit| hit.u.abs() <= nearest + rules.equal;
    hits.iter().filter(admissible).filter(equal).min_by_key(|hit| hit.segment).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hit(segment: usize, u: f64, cosine: f64) -> Hit {
        Hit { segment, s: [0.5, 0.0], u, normal: Vec3::new((1.0 - cosine * cosine).sqrt(), cosine, 0.0) }
    }

    fn choose(hits: &[Hit]) -> (Option<usize>, Rejected) {
        let mut rejected = Rejected::default();
        let chosen = select(Vec3::new(0.0, 1.0, 0.0), hits, &Rules::new(2.0, 1.0), &mut rejected);
        (chosen.map(|hit| hit.segment), rejected)
    }

    #[test]
    fn the_nearest_admissible_hit_wins() {
        assert_eq!(choose(&[hit(0, -3.0, 1.0), hit(1, 1.0, 0.2), hit(2, -1.5, 1.0)]).0, Some(1));
        assert_eq!(choose(&[]).0, None);
    }

    #[test]
    fn a_face_that_looks_away_and_one_behind_the_body_are_rejected_and_counted() {
        let (chosen, rejected) = choose(&[hit(0, 0.1, -1.0), hit(1, 0.2, 0.1), hit(2, 5.0, 1.0), hit(3, -4.0, 0.9)]);
        assert_eq!(chosen, Some(3));
        assert_eq!(rejected, Rejected { wrong_side: 2, too_deep: 1 });
        assert_eq!(rejected.total(), 3);
    }

    #[test]
    fn faces_that_would_not_be_penetrations_are_not_counted() {
        let (_, rejected) = choose(&[hit(0, -0.1, -1.0), hit(1, 7.0, -1.0), hit(2, -9.0, 1.0)]);
        assert_eq!(rejected.total(), 0);
    }

    #[test]
    fn equal_distances_go_to_the_lowest_segment_in_any_order() {
        let (a, b) = (hit(4, 1.0, 1.0), hit(7, -1.0 + 1e-14, 1.0));
        assert_eq!(choose(&[a, b]).0, Some(4));
        assert_eq!(choose(&[b, a]).0, Some(4));
    }
}
