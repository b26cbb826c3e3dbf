//! Where a straight way over the faces of a target leaves it.
//!
//! A face is taken for the polygon of its corners, seen along its normal `n`: with `d = n x (q - p).(x - p)` the distance
//! from an edge `p q` on its inner side, the way from `a` to `b` leaves by the edge that it meets first of those it comes
//! nearer to, after the part `d_a / (d_a - d_b)`.

use super::faces::Standing;
use crate::tensor::Vec3;
use crate::tool::{Ray, Rules};

/// A way's end on a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exit {
    /// The edge by which it leaves.
    edge: usize,
    /// Coordinates of the place on the face.
    pub s: [f64; 2],
    /// Their direction along the edge.
    along: [f64; 2],
    /// Motion of the place along the edge, as a part of it, per motion of the end of the way.
    rate: Vec3,
}

impl Exit {
    /// Motion of the place, in coordinates, for a motion of the end of the way.
    pub fn follow(&self, motion: Vec3) -> [f64; 2] {
        self.along.map(|along| along * self.rate.dot(motion))
    }
}

/// Coordinates of the corners of a face with so many.
fn coordinates(corners: usize, k: usize) -> [f64; 2] {
    let all = if corners == 3 { [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0, 0.0]] } else { SQUARE };
    all[k % corners]
}
const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

/// Where the way leaves the polygon of `corners`, anticlockwise about `normal`; None if it ends before.
pub fn exit(corners: &[Vec3], normal: Vec3, [from, to]: [Vec3; 2]) -> Option<Exit> {
    let (n, way) = (corners.len(), to - from);
    let mut first: Option<(f64, usize, Vec3)> = None;
    for k in 0..n {
        let (p, q) = (corners[k], corners[(k + 1) % n]);
        let inner = normal.cross(q - p);
        let (start, end) = (inner.dot(from - p), inner.dot(to - p));
        let part = start / (start - end);
        if end < start && first.is_none_or(|(least, ..)| part < least) {
            // What the part gains per motion of the way's end.
            first = Some((part, k, inner * (part / (start - end))));
        }
    }
    let (part, edge, gain) = first.filter(|(part, ..)| *part < 1.0)?;
    let (p, side) = (corners[edge], corners[(edge + 1) % n] - corners[edge]);
    let size = 1.0 / side.dot(side);
    let share = (from + way * part - p).dot(side) * size;
    let [a, b] = [edge, edge + 1].map(|k| coordinates(n, k));
    let along = [b[0] - a[0], b[1] - a[1]];
    let held = share.clamp(0.0, 1.0);
    let rate = if share == held { (side * part + gain * way.dot(side)) * size } else { Vec3::zero() };
    Some(Exit { edge, s: [0, 1].map(|i| a[i] + held * along[i]), along, rate })
}

impl Standing<'_> {
    /// Where the way leaves a face.
    pub(super) fn exit(&self, segment: usize, way: [Vec3; 2]) -> Option<Exit> {
        let (corners, patch) = (self.corners(segment), self.patch(segment));
        let mut places = [Vec3::zero(); 4];
        places[..corners].iter_mut().enumerate().for_each(|(k, place)| *place = patch.corner(k));
        exit(&places[..corners], patch.normal(), way)
    }

    /// From a face on along the way, the last face that looks at the ray at its end, if the way leaves that too.
    pub(super) fn last_towards(&self, mut segment: usize, way: [Vec3; 2], ray: &Ray) -> Option<usize> {
        let looks = |&next: &usize| ray.direction.dot(self.patch(next).normal()) > Rules::LEAST_COSINE;
        let (first, mut last) = (segment, segment);
        while let Some(next) = self.beyond(segment, self.exit(segment, way)?.edge).filter(looks) {
            // Round a ring, or to and fro in a fold.
            if next == first || next == last {
                return None;
            }
            (last, segment) = (segment, next);
        }
        Some(segment)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_way_leaves_by_the_edge_it_meets() {
        let at = |x: f64, y: f64, z: f64| Vec3::new(x, y, z);
        let corners = [at(0.0, 0.0, 0.0), at(2.0, 0.0, 0.0), at(2.5, 1.5, 0.0), at(0.0, 1.0, 0.0)];
        let normal = at(0.0, 0.0, 1.0);
        let from = at(1.0, 0.5, 0.0);
        let to = at(1.5, -0.75, 0.3);
        let out = exit(&corners, normal, [from, to]).unwrap();
        assert!(out.edge == 0 && (out.s[0] - 0.6).abs() < 1e-15 && out.s[1] == 0.0, "{out:?}");
        for motion in [at(1.0, 0.0, 0.0), at(0.0, 1.0, 0.0), at(0.0, 0.0, 1.0)] {
            let [ahead, back] = [1e-6, -1e-6].map(|h| exit(&corners, normal, [from, to + motion * h]).unwrap().s);
            let slope = [0, 1].map(|i| (ahead[i] - back[i]) / 2e-6);
            let follow = out.follow(motion);
            assert!((0..2).all(|i| (slope[i] - follow[i]).abs() < 1e-9), "{slope:?} {follow:?}");
        }
        assert!(exit(&corners, normal, [from, at(1.9, 0.3, 5.0)]).is_none(), "it ends on the face");
        // A way that begins beyond an edge by which it comes in.
        let through = exit(&corners[..3], normal, [at(1.0, -1.0, 0.0), at(1.0, 3.0, 0.0)]).unwrap();
        assert!(through.edge == 2 && through.s[0] == 0.0 && (through.s[1] - 0.4).abs() < 1e-15, "{through:?}");
    }
}
