//! Sharp edges, free ends and roundings of a profile: what may touch a body within one of its faces.

use super::shapes::{ProfileShape, angle};
use super::tool::ProfileTool;
use crate::tensor::Vec3;
use std::f64::consts::TAU;

/// A vertex that turns outward by at least this angle, in radians, is a tip; a blunter one is felt by its flanks to a twentieth of a face.
const VERTEX: f64 = 20.0 * std::f64::consts::PI / 180.0;
/// A rounding that turns by at least this angle, in radians, has two flanks: the material between them takes less than 100 degrees.
const SHARP: f64 = 80.0 * std::f64::consts::PI / 180.0;

/// What of a tool's profile may touch a body within one of its faces: the edge of a wedge, or a rounding by its closest point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tip {
    /// Its edge, or the centre of its rounding, in the tool's own frame.
    pub centre: Vec3,
    /// Radius of the rounding, a length; zero for an edge.
    pub radius: f64,
    /// Unit vector out of the material, along the bisector of the flanks.
    pub outward: Vec3,
    /// Outward unit normals of the flanks; zero where there is none, as of a full circle and on a plane of symmetry.
    pub flanks: [Vec3; 2],
    /// Cosine of the largest angle between `outward` and a direction in which it points.
    pub least_cosine: f64,
    /// In space the length of the edge that it stands for.
    pub length: f64,
}

/// Cosine by which a direction may lie beyond the end of an arc, for rounding.
const AT_FLANK: f64 = 1e-6;

impl Tip {
    /// One on an edge.
    pub(super) fn on_edge(centre: Vec3, outward: Vec3, flanks: [Vec3; 2], length: f64) -> Self {
        Self { centre, radius: 0.0, outward, flanks, least_cosine: POINTS, length }
    }
    /// Its foremost point, in the tool's own frame.
    pub fn foremost(&self) -> Vec3 {
        self.centre + self.outward * self.radius
    }
}

/// Cosine of the angle between the surface's inward normal and the bisector of an edge above which that points at the surface.
const POINTS: f64 = 0.1;

impl ProfileTool {
    /// Its tips: sharp edges, free ends and arcs that turn outward.
    pub fn tips(&self) -> Vec<Tip> {
        let mut tips = Vec::new();
        let mut edge = |centre, outward, flanks| tips.push(Tip::on_edge(centre, outward, flanks, 0.0));
        let mut arcs: Vec<Rounding> = Vec::new();
        for chain in self.chains() {
            for (one, next) in chain.joints() {
                let [one, next] = [one, next].map(|i| &self.segments()[i]);
                let (a, b) = (one.tangent(1.0).unit(), next.tangent(0.0).unit());
                if angle(a, b) >= VERTEX {
                    edge(one.point(1.0), (a - b).unit(), [-a.left(), -b.left()]);
                }
            }
            // Of a wedge that is drawn from its plane or axis of symmetry the edge is an end of the profile.
            if !chain.closed {
                let [first, last] = [chain.first, chain.end - 1].map(|i| &self.segments()[i]);
                let (a, b) = (last.tangent(1.0).unit(), first.tangent(0.0).unit());
                edge(first.point(0.0), -b, [-b.left(); 2]);
                edge(last.point(1.0), a, [-a.left(); 2]);
            }
            let begun = arcs.len();
            for i in chain.first..chain.end {
                let ends = [i == chain.first, i + 1 == chain.end].map(|ends| ends && !chain.closed);
                let Some(arc) = Rounding::of(self.segments()[i].as_ref(), ends) else { continue };
                if !arcs[begun..].last_mut().is_some_and(|last| last.join(&arc)) {
                    arcs.push(arc);
                }
            }
            if chain.closed && arcs.len() > begun + 1 {
                let first = arcs[begun];
                if arcs.last_mut().is_some_and(|last| last.join(&first)) {
                    arcs.swap_remove(begun);
                }
            }
        }
        tips.extend(arcs.iter().map(Rounding::tip));
        tips
    }
}

/// Arcs about one centre that follow each other and turn outward.
#[derive(Debug, Clone, Copy)]
struct Rounding {
    centre: Vec3,
    radius: f64,
    /// Tangent where they begin, and by how much they turn.
    begin: Vec3,
    turn: f64,
    /// Whether the profile begins and ends with them, as on a plane of symmetry.
    ends: [bool; 2],
}

impl Rounding {
    fn of(segment: &(dyn ProfileShape + 'static), ends: [bool; 2]) -> Option<Self> {
        let (radius, begin) = (segment.curvature(0.5).recip(), segment.tangent(0.0).unit());
        (segment.kind().key == "arc" && radius > 0.0 && radius.is_finite()).then(|| Self {
            centre: segment.point(0.0) + begin.left() * radius,
            radius,
            begin,
            turn: segment.turn(),
            ends,
        })
    }
    /// Takes an arc that continues it, if it does.
    fn join(&mut self, next: &Self) -> bool {
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-6 * self.radius;
        let joins = near(self.radius, next.radius)
            && near((self.centre - next.centre).norm(), 0.0)
            && (self.direction(self.turn) - next.begin).norm() < 1e-6;
        if joins {
            self.turn += next.turn;
            self.ends[1] = next.ends[1];
        }
        joins
    }
    /// Tangent where they have turned by `turn`.
    fn direction(&self, turn: f64) -> Vec3 {
        self.begin * turn.cos() + self.begin.left() * turn.sin()
    }
    fn tip(&self) -> Tip {
        let [begin, middle, end] = [0.0, 0.5, 1.0].map(|part| -self.direction(part * self.turn).left());
        let whole = self.turn > TAU - 1e-6;
        Tip {
            centre: self.centre,
            radius: self.radius,
            outward: middle,
            flanks: [(begin, self.ends[0]), (end, self.ends[1])]
                .map(|(normal, ends)| if whole || ends { Vec3::zero() } else { normal }),
            least_cosine: if whole { -2.0 } else { (0.5 * self.turn).cos() - AT_FLANK },
            length: 0.0,
        }
    }
}

impl dyn ProfileShape {
    /// Whether it is an arc that turns outward as sharply as a tip, with a radius of at most `largest`.
    pub(super) fn is_tip(&self, largest: f64) -> bool {
        self.kind().key == "arc" && self.turn() >= SHARP && self.curvature(0.5).recip() <= largest
    }
    /// By how much it turns, in radians: both halves of an arc turn by the same angle.
    fn turn(&self) -> f64 {
        let [begin, middle] = [0.0, 0.5].map(|s| self.tangent(s).unit());
        2.0 * angle(begin, middle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tool::shapes::find;

    fn tips(profile: &[(&str, &[[f64; 2]])]) -> Vec<Tip> {
        let build = |&(kind, nodes): &(&str, &[[f64; 2]])| {
            let nodes: Vec<Vec3> = nodes.iter().map(|&[x, y]| Vec3::new(x, y, 0.0)).collect();
            find(kind).and_then(|kind| kind.build(&nodes)).unwrap()
        };
        ProfileTool::new("t", vec![profile.iter().map(build).collect()], Vec3::zero()).tips()
    }

    #[test]
    fn wedges_and_needles_have_tips() {
        let sharp = tips(&[("line", &[[-1.0, 2.0], [0.0, 0.0]]), ("line", &[[0.0, 0.0], [1.0, 2.0]])]);
        // The edge, and the two ends.
        assert_eq!(sharp.len(), 3);
        assert!((sharp[0].outward - Vec3::new(0.0, -1.0, 0.0)).norm() < 1e-12);
        let roof = tips(&[("line", &[[-2.0, 1.0], [0.0, 0.0]]), ("line", &[[0.0, 0.0], [2.0, 1.0]])]);
        assert_eq!(roof.len(), 3);
        let blunt = tips(&[("line", &[[-2.0, 0.3], [0.0, 0.0]]), ("line", &[[0.0, 0.0], [2.0, 0.3]])]);
        assert_eq!(blunt.len(), 2);
        assert!(blunt.iter().all(|tip| tip.outward[1] > 0.0), "both ends point away from what is below");
        let arc: &[[f64; 2]] = &[[-0.2, 0.0], [0.0, -0.2], [0.2, 0.0]];
        let needle = tips(&[("line", &[[-0.2, 2.0], [-0.2, 0.0]]), ("arc", arc), ("line", &[[0.2, 0.0], [0.2, 2.0]])]);
        assert_eq!(needle.len(), 3);
        let Tip { centre, radius, outward, .. } = needle[2];
        assert!(centre.norm() < 1e-12 && (radius - 0.2).abs() < 1e-12 && outward[1] < -0.99);
        let roller = tips(&[
            ("arc", &[[0.0, 0.0], [10.0, 10.0], [0.0, 20.0]]),
            ("arc", &[[0.0, 20.0], [-10.0, 10.0], [0.0, 0.0]]),
        ]);
        assert_eq!(roller.len(), 1, "arcs about one centre are one");
        assert!((roller[0].centre - Vec3::new(0.0, 10.0, 0.0)).norm() < 1e-9 && roller[0].least_cosine < -1.0);
        let bowl = tips(&[("arc", &[[-2.0, 0.0], [0.0, 2.0], [2.0, 0.0]])]);
        assert!(bowl.iter().all(|tip| tip.radius == 0.0), "an arc that turns inward has only its ends");
    }
}
