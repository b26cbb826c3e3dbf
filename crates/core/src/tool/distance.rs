//! Signed distance to a profile: positive outside the material, with the closest point, the outward normal and the curvature
//! of the line of equal distance there.
//!
//! Segments that meet at less than a crease form a smooth piece, over which the closest point moves without a jump of its
//! normal that matters; across a crease nothing is continuous, and each piece is asked for itself. A piece ends where the
//! profile ends, across its tangent there, and where it turns outward by a crease, at the bisector: of two flanks a place
//! within an edge of the material is asked of the nearer one. At an inward crease two faces bound one corner of the material
//! around it, and each goes on straight.

use super::shapes::angle;
use super::tool::ProfileTool;
use crate::tensor::Vec3;

/// Segments that meet at a larger angle, in radians, form a crease.
pub(in crate::tool) const CREASE: f64 = 0.7;
/// The closest point is at an end of its segment within this part of it.
const AT_END: f64 = 1e-12;

/// Segments of a profile without a crease.
#[derive(Debug, Clone, PartialEq)]
pub struct SmoothPiece {
    segments: Vec<usize>,
    /// The lines across its first and its last end beyond which it is not seen; none where it goes on straight.
    pub ends: [Option<PieceEnd>; 2],
    /// How many of its first and of its last segments these lines bound: the flank too where a rounding is cut.
    bounded: [usize; 2],
    /// Whether its last segment ends where its first begins, without a crease.
    closed: bool,
}

/// The point of a smooth piece of a tool that is closest to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearestPoint {
    /// Signed distance, negative inside the material.
    pub gap: f64,
    /// Outward unit normal: the gradient of the distance.
    pub normal: Vec3,
    /// The point itself.
    pub point: Vec3,
    /// Principal directions and curvatures of the surface of equal distance, positive where normals spread: `dn = sum k e (e . dx)`;
    /// in the plane the second is none.
    pub bends: [(Vec3, f64); 2],
    /// The end of the piece, 0 or 1, beyond which the other point lies, in space 0 for any border; and the way to it from there, across
    /// what ends the piece.
    pub beyond: Option<(usize, Vec3)>,
}

impl NearestPoint {
    /// Change of the normal for a motion of the other point relative to the tool.
    pub fn turned(&self, motion: Vec3) -> Vec3 {
        self.bends.iter().fold(Vec3::zero(), |sum, &(along, bend)| sum + along * (bend * along.dot(motion)))
    }
    /// Motion of the closest point, as one of the tool's material, for that motion.
    pub fn slide(&self, motion: Vec3) -> Vec3 {
        motion - self.normal * self.normal.dot(motion) - self.turned(motion) * self.gap
    }
}

/// An end of a piece: its point, and the normal of the line there beyond which the piece is not seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PieceEnd {
    /// The point.
    pub point: Vec3,
    /// Unit normal of the line that ends the piece, along the profile.
    pub along: Vec3,
}

impl ProfileTool {
    /// Its smooth pieces, profile by profile. An arc that turns as sharply as a crease, with a radius of at most `rounding`, counts as
    /// one in its middle.
    pub fn smooth_pieces(&self, rounding: f64) -> Vec<SmoothPiece> {
        let mut pieces = Vec::new();
        for chain in self.chains() {
            let segment = |i: usize| &self.segments()[i];
            let end = |i: usize, s: f64| {
                let (point, along) = (segment(i).point(s), segment(i).tangent(s).unit());
                Some(PieceEnd { point, along })
            };
            // Segments with what cuts the profile behind them; a sharp rounding is there once for each half.
            let mut parts: Vec<(usize, Option<Option<PieceEnd>>)> = Vec::new();
            for i in chain.first..chain.end {
                if segment(i).is_tip(rounding) {
                    parts.push((i, Some(end(i, 0.5))));
                }
                let open = || Some(end(i, 1.0));
                parts.push((i, chain.behind(i).map_or_else(open, |next| self.crease(i, next))));
            }
            let Some(first) = parts.iter().position(|(_, cut)| cut.is_some()) else {
                let segments = (chain.first..chain.end).collect();
                pieces.push(SmoothPiece { segments, ends: [None; 2], bounded: [0; 2], closed: true });
                continue;
            };
            let mut before = end(chain.first, 0.0);
            if chain.closed {
                before = parts[first].1.flatten();
                parts.rotate_left(first + 1);
            }
            let mut segments = Vec::new();
            for (i, cut) in parts {
                segments.push(i);
                let Some(after) = cut else { continue };
                let segments = std::mem::take(&mut segments);
                let cut = |place: Option<&usize>| place.is_some_and(|&number| segment(number).is_tip(rounding));
                let bounded = [cut(segments.first()), cut(segments.last())].map(|cut| if cut { 2 } else { 1 });
                pieces.push(SmoothPiece { segments, ends: [before, after], bounded, closed: false });
                before = after;
            }
        }
        pieces
    }

    /// By how much the profile turns to the left from one segment to the next, in radians.
    pub(super) fn turn_behind(&self, one: usize, next: usize) -> f64 {
        angle(self.segments()[one].tangent(1.0), self.segments()[next].tangent(0.0))
    }

    /// Where the piece before a crease ends and the one behind it begins: the bisector where the profile turns outward, none where
    /// it turns inward. Nothing where the two segments meet at less than a crease.
    fn crease(&self, one: usize, next: usize) -> Option<Option<PieceEnd>> {
        let turn = self.turn_behind(one, next);
        let (one, next) = (&self.segments()[one], &self.segments()[next]);
        let along = one.tangent(1.0).unit() + next.tangent(0.0).unit();
        // A profile that turns right back ends across its tangent.
        let along = if along.norm() > 1e-6 { along.unit() } else { one.tangent(1.0).unit() };
        (turn.abs() >= CREASE).then(|| (turn > 0.0).then(|| PieceEnd { point: one.point(1.0), along }))
    }

    /// Whether a piece is straight.
    pub fn is_straight(&self, piece: &SmoothPiece) -> bool {
        piece.segments.iter().all(|&number| self.segments()[number].curvature(0.5) == 0.0)
    }

    /// The point of a piece closest to `x`, in the tool's own frame.
    pub fn closest(&self, piece: &SmoothPiece, x: Vec3) -> NearestPoint {
        let (mut best, mut least) = ((0, 0.0), f64::INFINITY);
        for (place, &number) in piece.segments.iter().enumerate() {
            let segment = &self.segments()[number];
            let s = segment.closest(x);
            let distance = (x - segment.point(s)).norm();
            // Of equals the first, but rather the inside of a segment than an end.
            if distance < least * (1.0 - 1e-14) {
                (best, least) = ((place, s), distance);
            }
        }
        let (place, s) = best;
        let segment = &self.segments()[piece.segments[place]];
        let point = segment.point(s);
        let normal = -segment.tangent(s).left().unit();
        let last = piece.segments.len() - 1;
        let beyond = (0..2).find_map(|k| {
            let from_end = [place, last - place][k];
            let end = piece.ends[k].filter(|_| from_end < piece.bounded[k])?;
            let past = end.along.dot(x - end.point);
            (past * [-1.0, 1.0][k] > AT_END * segment.length()).then(|| (k, end.along * past))
        });
        let bends = |normal: Vec3, curvature: f64| [(normal.left(), curvature), (Vec3::zero(), 0.0)];
        let smooth = |curvature: f64| {
            let gap = normal.dot(x - point);
            NearestPoint { gap, normal, point, bends: bends(normal, curvature / (1.0 + curvature * gap)), beyond }
        };
        let end = usize::from(s > 0.5);
        let past = segment.tangent(s).unit().dot(x - point) * [-1.0, 1.0][end];
        if s.min(1.0 - s) > AT_END || past <= AT_END * segment.length() {
            return smooth(segment.curvature(s));
        }
        let next = (place + 2 * end).checked_sub(1).filter(|&next| next <= last);
        let Some(next) = next.or(piece.closed.then_some([last, 0][end])) else {
            // A straight continuation, whether or not it is seen.
            return NearestPoint { point: x - normal * normal.dot(x - point), ..smooth(0.0) };
        };
        let other = &self.segments()[piece.segments[next]];
        let both = normal - other.tangent(1.0 - end as f64).left().unit();
        let sign = 1.0_f64.copysign(both.dot(x - point));
        let gap = sign * (x - point).norm();
        let normal = (x - point) * gap.recip();
        NearestPoint { gap, normal, point, bends: bends(normal, gap.recip()), beyond: None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tool::shapes::find;

    /// A segment by its key and its nodes.
    type Segment<'a> = (&'a str, &'a [[f64; 2]]);

    fn tool(profiles: &[&[Segment]]) -> ProfileTool {
        let profile = |segments: &&[Segment]| {
            let build = |(key, nodes): &Segment| {
                let nodes: Vec<Vec3> = nodes.iter().map(|&[x, y]| Vec3::new(x, y, 0.0)).collect();
                find(key).unwrap().build(&nodes).unwrap()
            };
            segments.iter().map(build).collect()
        };
        ProfileTool::new("t", profiles.iter().map(profile).collect(), Vec3::zero())
    }

    fn round() -> ProfileTool {
        // A stadium with a parabolic bottom would do as well: lines, arcs and a parabola that join smoothly or not.
        tool(&[&[
            ("line", &[[2.0, 0.0], [2.0, 1.0]]),
            ("arc", &[[2.0, 1.0], [1.0, 2.0], [0.0, 1.0]]),
            ("line", &[[0.0, 1.0], [0.0, 0.0]]),
            ("parabola", &[[0.0, 0.0], [1.0, -0.3], [2.0, 0.0]]),
        ]])
    }

    #[test]
    fn pieces_end_at_creases() {
        let round = round();
        let pieces = round.smooth_pieces(0.0);
        assert_eq!(pieces.iter().map(|piece| piece.segments.clone()).collect::<Vec<_>>(), [vec![3], vec![0, 1, 2]]);
        assert!(pieces.iter().all(|piece| piece.ends.iter().all(Option::is_some) && !piece.closed));
        let corner = tool(&[&[("line", &[[0.0, 5.0], [0.0, 0.0]]), ("line", &[[0.0, 0.0], [5.0, 0.0]])]]);
        let pieces = corner.smooth_pieces(0.0);
        // Material on the left of a path down and then to the right: above it, a convex edge.
        let seen = |piece: &SmoothPiece| piece.ends.map(|end| end.is_some());
        assert_eq!(pieces.iter().map(seen).collect::<Vec<_>>(), [[true; 2]; 2]);
        // Within the edge the nearer face is seen, and one of the two everywhere.
        for (x, y, face) in [(0.5, 0.1, 1), (0.1, 0.5, 0), (-0.2, -0.1, 0), (-0.1, -0.2, 1)] {
            let beyond = |piece| corner.closest(piece, Vec3::new(x, y, 0.0)).beyond;
            assert_eq!([0, 1].map(|k| beyond(&pieces[k]).is_none()), [face == 0, face == 1], "{x} {y}");
        }
        let inner = tool(&[&[("line", &[[5.0, 0.0], [0.0, 0.0]]), ("line", &[[0.0, 0.0], [0.0, 5.0]])]]);
        let pieces = inner.smooth_pieces(0.0);
        assert_eq!(pieces.iter().map(seen).collect::<Vec<_>>(), [[true, false], [false, true]]);
    }

    /// Distance, normal and curvature against brute force and differences.
    #[test]
    fn closest_points_are_the_closest() {
        let round = round();
        for piece in &round.smooth_pieces(0.0) {
            for i in 0..400 {
                let x =
                    Vec3::new(-1.0 + 4.0 * f64::from(i % 20) / 19.0 + 0.01, -1.0 + 4.0 * f64::from(i / 20) / 19.0, 0.0);
                let found = round.closest(piece, x);
                if found.beyond.is_some() {
                    continue;
                }
                let samples = piece.segments.iter().flat_map(|&number| {
                    let segment = &round.segments()[number];
                    (0..=2000).map(move |k| (x - segment.point(f64::from(k) / 2000.0)).norm())
                });
                let least = samples.fold(f64::INFINITY, f64::min);
                if found.gap > 0.0 && found.gap < least - 1e-3 {
                    // Between the end of a face and the bisector of its crease it is the distance to its continuation.
                    continue;
                }
                assert!((found.gap.abs() - least).abs() < 1e-3 * (1.0 + least), "{x:?} {found:?} {least}");
                assert!((found.point + found.normal * found.gap - x).norm() < 1e-12);
                let h = 1e-6;
                for axis in 0..2 {
                    let step = Vec3(std::array::from_fn(|k| if k == axis { h } else { 0.0 }));
                    let [up, down] = [x + step, x - step].map(|x| round.closest(piece, x));
                    if (up.normal - down.normal).norm() > 1e-3 {
                        continue;
                    }
                    assert!(((up.gap - down.gap) / (2.0 * h) - found.normal[axis]).abs() < 1e-5);
                    let slope = (up.normal - down.normal) * (0.5 / h);
                    let exact = found.turned(Vec3::axis(axis));
                    assert!((slope - exact).norm() < 1e-3 * (1.0 + found.bends[0].1.abs()), "{x:?}");
                }
            }
        }
    }
}
