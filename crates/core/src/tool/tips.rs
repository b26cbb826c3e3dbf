//! Sharp edges, free ends and small roundings of a profile: what may lie within one face of a body.

use super::shapes::{ProfileShape, angle};
use super::tool::ProfileTool;
use crate::tensor::Vec3;

/// A crease or an arc that turns outward by at least this angle, in radians, is a tip: the material between its flanks takes less
/// than 100 degrees. A blunter one is felt by its flanks.
const SHARP: f64 = 80.0 * std::f64::consts::PI / 180.0;

/// The tip of a wedge or a needle, in the tool's own frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tip {
    /// Its foremost point.
    pub point: Vec3,
    /// Unit vector out of the material, along the bisector of the flanks.
    pub outward: Vec3,
    /// Outward unit normals of the flanks.
    pub flanks: [Vec3; 2],
}

impl ProfileTool {
    /// Its tips, with roundings of radii up to `rounding`.
    pub fn tips(&self, rounding: f64) -> Vec<Tip> {
        let mut tips = Vec::new();
        for chain in self.chains() {
            for (one, next) in chain.joints() {
                let [one, next] = [one, next].map(|i| &self.segments()[i]);
                let (a, b) = (one.tangent(1.0).unit(), next.tangent(0.0).unit());
                if angle(a, b) >= SHARP {
                    let (outward, flanks) = ((a - b).unit(), [-a.left(), -b.left()]);
                    tips.push(Tip { point: one.point(1.0), outward, flanks });
                }
            }
            // Of a wedge that is drawn from its plane or axis of symmetry the edge is an end of the profile.
            if !chain.closed {
                let [first, last] = [chain.first, chain.end - 1].map(|i| &self.segments()[i]);
                let (a, b) = (last.tangent(1.0).unit(), first.tangent(0.0).unit());
                tips.push(Tip { point: first.point(0.0), outward: -b, flanks: [-b.left(); 2] });
                tips.push(Tip { point: last.point(1.0), outward: a, flanks: [-a.left(); 2] });
            }
            for segment in &self.segments()[chain.first..chain.end] {
                if segment.is_tip(rounding) {
                    let normal = |s: f64| -segment.tangent(s).unit().left();
                    let flanks = [normal(0.0), normal(1.0)];
                    tips.push(Tip { point: segment.point(0.5), outward: normal(0.5), flanks });
                }
            }
        }
        tips
    }
}

impl dyn ProfileShape {
    /// Whether it is an arc that turns outward as sharply as a tip, with a radius of at most `largest`.
    pub(super) fn is_tip(&self, largest: f64) -> bool {
        // Both halves of an arc turn by the same angle.
        let [begin, middle] = [0.0, 0.5].map(|s| self.tangent(s).unit());
        self.kind().key == "arc" && 2.0 * angle(begin, middle) >= SHARP && self.curvature(0.5).recip() <= largest
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
        ProfileTool::new("t", vec![profile.iter().map(build).collect()], Vec3::zero()).tips(0.3)
    }

    #[test]
    fn wedges_and_needles_have_tips() {
        let sharp = tips(&[("line", &[[-1.0, 2.0], [0.0, 0.0]]), ("line", &[[0.0, 0.0], [1.0, 2.0]])]);
        // The edge, and the two ends.
        assert_eq!(sharp.len(), 3);
        assert!((sharp[0].outward - Vec3::new(0.0, -1.0, 0.0)).norm() < 1e-12);
        let blunt = tips(&[("line", &[[-2.0, 1.0], [0.0, 0.0]]), ("line", &[[0.0, 0.0], [2.0, 1.0]])]);
        assert_eq!(blunt.len(), 2);
        assert!(blunt.iter().all(|tip| tip.outward[1] > 0.0), "both ends point away from what is below");
        let arc: &[[f64; 2]] = &[[-0.2, 0.0], [0.0, -0.2], [0.2, 0.0]];
        let needle = tips(&[("line", &[[-0.2, 2.0], [-0.2, 0.0]]), ("arc", arc), ("line", &[[0.2, 0.0], [0.2, 2.0]])]);
        assert_eq!(needle.len(), 3);
        let Tip { point, outward, .. } = needle[2];
        assert!((point - Vec3::new(0.0, -0.2, 0.0)).norm() < 1e-12 && outward[1] < -0.99);
        let ends = tips(&[("arc", &[[-2.0, 0.0], [0.0, -2.0], [2.0, 0.0]])]);
        assert!(ends.iter().all(|tip| tip.point[1] == 0.0), "the arc is felt by the faces it touches");
    }
}
