//! What is wrong with a tool's profiles, or worth knowing about them.
//!
//! The material lies on the left of a profile, so that a closed one must run counter-clockwise, and a left turn is a
//! convex edge of the tool. All tolerances are ratios of the tool's size.

use super::ProfileFinding;
use super::facet::{Meeting, ToolFacet};
use super::shapes::{ProfileRay, ProfileShape, turn};
use super::tool::{Chain, ProfileTool};
use crate::tensor::{BoundingBox, Vec3};

/// Ends nearer to each other than this part of the tool's size are one point.
pub(super) const TOGETHER: f64 = 1e-9;
/// Smaller kinks are the rounding of coordinates, in degrees.
const KINK: f64 = 0.1;
/// Curves are compared as polylines this near to them, as a part of the tool's size.
const FLAT: f64 = 1e-6;
/// Neighbours may meet within this part of the shorter one from their common node.
const NEIGHBOUR: f64 = 1e-4;

/// All findings, by chain and segment. What would make no sense after a grave one is not looked for.
pub(super) fn findings(tool: &ProfileTool, axisymmetric: bool) -> Vec<ProfileFinding> {
    if tool.segments().is_empty() {
        return vec![ProfileFinding::Empty];
    }
    let all = 0..tool.segments().len();
    let is_finite = |i: &usize| tool.segments()[*i].nodes().iter().all(|node| node.is_finite());
    let mut found: Vec<ProfileFinding> = all.clone().filter(|i| !is_finite(i)).map(ProfileFinding::NotFinite).collect();
    if found.is_empty() {
        // From the nodes: nodes that make no arc can bound a box of any size.
        let nodes = tool.segments().iter().flat_map(|segment| segment.nodes().iter().copied());
        let together = TOGETHER * BoundingBox::of(nodes).size();
        found.extend(all.filter_map(|i| single(tool.segments()[i].as_ref(), i, together, axisymmetric)));
    }
    if found.is_empty() {
        tool.chains().iter().for_each(|chain| along(tool, chain, &mut found));
        crossings(tool, &mut found);
    }
    found
}

/// What can be said of one segment alone.
fn single(segment: &dyn ProfileShape, i: usize, together: f64, axisymmetric: bool) -> Option<ProfileFinding> {
    let (ends, least) = ([segment.point(0.0), segment.point(1.0)], segment.bounds().min[0]);
    if (ends[1] - ends[0]).norm() <= together {
        return Some(ProfileFinding::NoLength(i));
    }
    if let Some(flaw) = segment.flaw() {
        return Some(ProfileFinding::Flaw(i, flaw));
    }
    (axisymmetric && least < -together).then_some(ProfileFinding::NegativeRadius(i, least))
}

/// Gaps, kinks, ends and orientation of one profile.
fn along(tool: &ProfileTool, chain: &Chain, found: &mut Vec<ProfileFinding>) {
    let before = found.len();
    found.extend(chain.joints().filter_map(|(a, b)| joint(tool, a, b)));
    let broken = found[before..].iter().any(|finding| matches!(finding, ProfileFinding::Gap(..)));
    let (first, last) = (chain.first, chain.end - 1);
    if !chain.closed {
        let ends = [tool.segments()[first].point(0.0), tool.segments()[last].point(1.0)];
        found.push(ProfileFinding::Open(first, last, ends));
    } else if !broken && area(tool, chain) < 0.0 {
        found.push(ProfileFinding::Clockwise(first, last));
    }
}

/// What is to be said of the place where segment `b` follows `a`.
fn joint(tool: &ProfileTool, a: usize, b: usize) -> Option<ProfileFinding> {
    let (first, second) = (&tool.segments()[a], &tool.segments()[b]);
    let gap = (second.point(0.0) - first.point(1.0)).norm();
    if gap > TOGETHER * tool.size() {
        return Some(ProfileFinding::Gap(a, b, gap));
    }
    let angle = tool.turn_behind(a, b).to_degrees();
    (angle.abs() > KINK).then_some(ProfileFinding::Kink(a, b, angle))
}

/// The area on the left of a closed profile.
fn area(tool: &ProfileTool, chain: &Chain) -> f64 {
    let segments = &tool.segments()[chain.first..chain.end];
    let origin = segments[0].point(0.0);
    let points: Vec<Vec3> = segments.iter().flat_map(|s| s.flatten(1e-4 * tool.size())).collect();
    0.5 * points.windows(2).map(|p| turn(p[0] - origin, p[1] - origin)).sum::<f64>()
}

fn crossings(tool: &ProfileTool, found: &mut Vec<ProfileFinding>) {
    for (a, segment) in tool.segments().iter().enumerate() {
        let mut others = Vec::new();
        tool.tree().near(&segment.bounds(), &mut |b| others.push(b));
        others.retain(|&b| b > a);
        others.sort_unstable();
        let crossed = |b: usize| crossing(tool, a, b).map(|place| ProfileFinding::Crossing(a, b, place));
        found.extend(others.into_iter().filter_map(crossed));
    }
}

/// Where two segments meet elsewhere than at a node in which one follows the other.
fn crossing(tool: &ProfileTool, a: usize, b: usize) -> Option<Vec3> {
    let (mut first, mut second) = (tool.segments()[a].as_ref(), tool.segments()[b].as_ref());
    if first.pieces(FLAT * tool.size()) > second.pieces(FLAT * tool.size()) {
        (first, second) = (second, first);
    }
    let shared: Vec<Vec3> = [shared(tool, a, b), shared(tool, b, a)].into_iter().flatten().collect();
    let near = NEIGHBOUR * first.length().min(second.length());
    let is_shared = |p: Vec3| shared.iter().any(|&node| (p - node).norm() <= near);
    let mut place = None;
    for chord in first.flatten(FLAT * tool.size()).windows(2) {
        meet(chord[0], chord[1], second, &mut |p| {
            if place.is_none() && !is_shared(p) {
                place = Some(p);
            }
        });
    }
    place
}

/// The node in which `b` follows `a`, if it does.
fn shared(tool: &ProfileTool, a: usize, b: usize) -> Option<Vec3> {
    let chain = tool.chains().iter().find(|chain| (chain.first..chain.end).contains(&a))?;
    (chain.behind(a) == Some(b)).then(|| tool.segments()[a].point(1.0))
}

/// Places where the straight piece from `from` to `to` meets a segment.
fn meet(from: Vec3, to: Vec3, segment: &dyn ProfileShape, found: &mut dyn FnMut(Vec3)) {
    let (box_a, box_b) = (BoundingBox::of([from, to]), segment.bounds());
    if (0..2).any(|i| box_a.max[i] < box_b.min[i] || box_b.max[i] < box_a.min[i]) {
        return;
    }
    let length = (to - from).norm();
    let ray = ProfileRay { origin: from, direction: (to - from) * (1.0 / length) };
    segment.cast(&ray, &mut |Meeting { u, .. }| {
        if u >= 0.0 && u <= length {
            found(ray.point(u));
        }
    });
}

#[cfg(test)]
mod tests {
    use super::super::conformance::at;
    use super::super::shapes::{ALL, find};
    use super::super::{FindingSeverity, ProfileFinding, ProfileTool};
    use crate::tensor::Vec3;

    fn square(corners: [[f64; 2]; 4], sides: usize) -> ProfileTool {
        let corner = |i: usize| at(corners[i % 4][0], corners[i % 4][1]);
        let side = |i: usize| ALL[0].build(&[corner(i), corner(i + 1)]).unwrap();
        ProfileTool::new("square", vec![(0..sides).map(side).collect()], at(0.0, 0.0))
    }

    const UNIT: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

    fn errors(tool: &ProfileTool) -> Vec<ProfileFinding> {
        let grave = |finding: &ProfileFinding| finding.severity() == FindingSeverity::Error;
        tool.check(false).into_iter().filter(grave).collect()
    }

    #[test]
    fn a_sound_square_has_four_convex_edges_and_no_error() {
        let found = square(UNIT, 4).check(true);
        assert_eq!(found.len(), 4);
        for finding in &found {
            assert!(matches!(finding, ProfileFinding::Kink(_, _, angle) if (angle - 90.0).abs() < 1e-12), "{finding}");
        }
        assert_eq!(found[3].segments(), [3, 0]);
        assert_eq!(found[0].to_string(), "segments 1 and 2 meet at a convex edge of 90.0 degrees");
    }

    #[test]
    fn clockwise_open_gapped_and_crossing_profiles_are_found() {
        let clockwise = square([UNIT[0], UNIT[3], UNIT[2], UNIT[1]], 4);
        assert_eq!(errors(&clockwise), [ProfileFinding::Clockwise(0, 3)]);
        assert!(clockwise.check(false).iter().any(|f| matches!(f, ProfileFinding::Kink(_, _, angle) if *angle < 0.0)));

        let open = square(UNIT, 3).check(false);
        assert!(open.contains(&ProfileFinding::Open(0, 2, [at(0.0, 0.0), at(0.0, 1.0)])));

        let bow_tie = square([UNIT[0], UNIT[2], UNIT[1], UNIT[3]], 4);
        assert!(errors(&bow_tie).contains(&ProfileFinding::Crossing(0, 2, at(0.5, 0.5))), "{:?}", errors(&bow_tie));

        let piece = |a: [f64; 2], b: [f64; 2]| ALL[0].build(&[at(a[0], a[1]), at(b[0], b[1])]).unwrap();
        let gapped = ProfileTool::new(
            "gapped",
            vec![vec![piece([0.0, 0.0], [1.0, 0.0]), piece([1.0, 0.25], [1.0, 1.0])]],
            at(0.0, 0.0),
        );
        assert_eq!(errors(&gapped), [ProfileFinding::Gap(0, 1, 0.25)]);
        assert_eq!(errors(&gapped)[0].to_string(), "segments 1 and 2 do not meet: 2.500e-1 lies between them");
    }

    #[test]
    fn bad_segments_are_named() {
        let tool = |key: &str, nodes: &[Vec3]| {
            ProfileTool::new("bad", vec![vec![find(key).unwrap().build(nodes).unwrap()]], at(0.0, 0.0))
        };
        assert_eq!(errors(&ProfileTool::new("none", vec![], at(0.0, 0.0))), [ProfileFinding::Empty]);
        assert_eq!(errors(&tool("line", &[at(0.0, f64::NAN), at(1.0, 0.0)])), [ProfileFinding::NotFinite(0)]);
        assert_eq!(
            errors(&tool("arc", &[at(0.0, 0.0), at(f64::INFINITY, 0.0), at(1.0, 0.0)])),
            [ProfileFinding::NotFinite(0)]
        );
        assert_eq!(errors(&tool("line", &[at(1.0, 1.0), at(1.0, 1.0)])), [ProfileFinding::NoLength(0)]);
        assert_eq!(errors(&tool("arc", &[at(1.0, 1.0), at(2.0, 1.0), at(1.0, 1.0)])), [ProfileFinding::NoLength(0)]);
        for key in ["arc", "parabola"] {
            let beyond = errors(&tool(key, &[at(0.0, 0.0), at(3.0, 0.0), at(1.0, 0.0)]));
            assert!(matches!(beyond[..], [ProfileFinding::Flaw(0, _)]), "{key}: {beyond:?}");
        }
        let left = tool("arc", &[at(0.0, 0.0), at(-1.0, 1.0), at(0.0, 2.0)]).check(true);
        assert!(matches!(left[..], [ProfileFinding::NegativeRadius(0, r)] if (r + 1.0).abs() < 1e-15), "{left:?}");
    }

    #[test]
    fn crossing_curves_are_found_and_smooth_joints_are_not_crossings() {
        let arc = |nodes: [[f64; 2]; 3]| ALL[2].build(&nodes.map(|[x, y]| at(x, y))).unwrap();
        let wave = vec![arc([[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]]), arc([[2.0, 0.0], [3.0, -1.0], [4.0, 0.0]])];
        assert!(errors(&ProfileTool::new("wave", vec![wave], at(0.0, 0.0))).is_empty());
        let lens =
            vec![vec![arc([[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]])], vec![arc([[0.0, 1.0], [1.0, 0.0], [2.0, 1.0]])]];
        let crossed = errors(&ProfileTool::new("lens", lens, at(0.0, 0.0)));
        assert!(matches!(crossed[..], [ProfileFinding::Crossing(0, 1, p)] if (p[1] - 0.5).abs() < 1e-5), "{crossed:?}");
    }
}
