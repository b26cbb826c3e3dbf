//! What is wrong with a tool's profiles, or worth knowing about them.
//!
//! The material lies on the left of a profile, so that a closed one must run counter-clockwise, and a left turn is a
//! convex edge of the tool. All tolerances are ratios of the tool's size.

use super::shapes::{Bounds, Crossing, Ray, Shape, turn};
use super::tool::{Chain, Tool};
use crate::tensor::Vec3;
use std::fmt;

/// Ends nearer to each other than this part of the tool's size are one point.
pub(super) const TOGETHER: f64 = 1e-9;
/// Smaller kinks are the rounding of coordinates, in degrees.
const KINK: f64 = 0.1;
/// A kink from which the profile runs back along itself, in degrees.
const REVERSAL: f64 = 179.0;
/// Curves are compared as polylines this near to them, as a part of the tool's size.
const FLAT: f64 = 1e-6;
/// Neighbours may meet within this part of the shorter one from their common node.
const NEIGHBOUR: f64 = 1e-4;

/// How grave a finding is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Worth knowing.
    Note,
    /// The tool cannot be used.
    Error,
}

/// One finding. Segments are counted from zero here and from one in the sentence that [`Display`](fmt::Display) gives.
#[derive(Debug, Clone, PartialEq)]
pub enum Finding {
    /// There is no segment.
    Empty,
    /// A coordinate is not a finite number.
    NotFinite(usize),
    /// A segment begins and ends in the same place.
    NoLength(usize),
    /// The nodes of a segment do not suit its shape; the rest of the sentence.
    Flaw(usize, String),
    /// A profile reaches negative radii: the segment and the radius.
    NegativeRadius(usize, f64),
    /// Two consecutive segments do not meet: the first of them, the second, and their distance.
    Gap(usize, usize, f64),
    /// Two segments cross: the two and where.
    Crossing(usize, usize, Vec3),
    /// A closed profile runs clockwise: its first and last segments.
    Clockwise(usize, usize),
    /// Two consecutive segments meet at an angle: the two and the turn in degrees, positive at a convex edge.
    Kink(usize, usize, f64),
    /// A profile does not close: its first and last segments, where it begins and where it ends.
    Open(usize, usize, [Vec3; 2]),
}

impl Finding {
    /// How grave it is.
    pub fn severity(&self) -> Severity {
        match self {
            Self::Kink(_, _, angle) if angle.abs() < REVERSAL => Severity::Note,
            Self::Open(..) => Severity::Note,
            _ => Severity::Error,
        }
    }
    /// The segments it is about, counted from zero; none if it is about the whole tool.
    pub fn segments(&self) -> Vec<usize> {
        match self {
            Self::Empty => vec![],
            Self::NotFinite(a) | Self::NoLength(a) | Self::Flaw(a, _) | Self::NegativeRadius(a, _) => vec![*a],
            Self::Gap(a, b, _)
            | Self::Crossing(a, b, _)
            | Self::Clockwise(a, b)
            | Self::Kink(a, b, _)
            | Self::Open(a, b, _) => vec![*a, *b],
        }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let at = |p: &Vec3| format!("({}, {})", p[0], p[1]);
        match self {
            Self::Empty => f.write_str("the tool has no segments"),
            Self::NotFinite(a) => write!(f, "segment {} has a coordinate that is not a finite number", a + 1),
            Self::NoLength(a) => write!(f, "segment {} begins and ends in the same place", a + 1),
            Self::Flaw(a, flaw) => write!(f, "segment {} {flaw}", a + 1),
            Self::NegativeRadius(a, r) => write!(f, "segment {} reaches the negative radius {r}", a + 1),
            Self::Gap(a, b, gap) => {
                write!(f, "segments {} and {} do not meet: {gap:.3e} lies between them", a + 1, b + 1)
            }
            Self::Crossing(a, b, p) => write!(f, "segments {} and {} cross at {}", a + 1, b + 1, at(p)),
            Self::Clockwise(a, b) => {
                write!(f, "the closed profile of segments {} to {} runs clockwise, ", a + 1, b + 1)?;
                f.write_str(
                    "which puts the tool's material outside it: reverse the order of its segments and of their nodes",
                )
            }
            Self::Kink(a, b, angle) => {
                let kind = if *angle > 0.0 { "convex" } else { "concave" };
                write!(f, "segments {} and {} meet at a {kind} edge of {:.1} degrees", a + 1, b + 1, angle.abs())
            }
            Self::Open(a, b, [from, to]) => {
                write!(
                    f,
                    "the profile of segments {} to {} is open: it runs from {} to {}",
                    a + 1,
                    b + 1,
                    at(from),
                    at(to)
                )
            }
        }
    }
}

/// All findings, by chain and segment. What would make no sense after a grave one is not looked for.
pub(super) fn findings(tool: &Tool, axisymmetric: bool) -> Vec<Finding> {
    if tool.segments().is_empty() {
        return vec![Finding::Empty];
    }
    let all = 0..tool.segments().len();
    let is_finite = |i: &usize| tool.segments()[*i].nodes().iter().all(|node| node.is_finite());
    let mut found: Vec<Finding> = all.clone().filter(|i| !is_finite(i)).map(Finding::NotFinite).collect();
    if found.is_empty() {
        // From the nodes: nodes that make no arc can bound a box of any size.
        let nodes = tool.segments().iter().flat_map(|segment| segment.nodes().iter().copied());
        let together = TOGETHER * Bounds::of(nodes).size();
        found.extend(all.filter_map(|i| single(tool.segments()[i].as_ref(), i, together, axisymmetric)));
    }
    if found.is_empty() {
        tool.chains().iter().for_each(|chain| along(tool, chain, &mut found));
        crossings(tool, &mut found);
    }
    found
}

/// What can be said of one segment alone.
fn single(segment: &dyn Shape, i: usize, together: f64, axisymmetric: bool) -> Option<Finding> {
    let (ends, least) = ([segment.point(0.0), segment.point(1.0)], segment.bounds().min[0]);
    if (ends[1] - ends[0]).norm() <= together {
        return Some(Finding::NoLength(i));
    }
    if let Some(flaw) = segment.flaw() {
        return Some(Finding::Flaw(i, flaw));
    }
    (axisymmetric && least < -together).then_some(Finding::NegativeRadius(i, least))
}

/// Gaps, kinks, ends and orientation of one profile.
fn along(tool: &Tool, chain: &Chain, found: &mut Vec<Finding>) {
    let before = found.len();
    let pairs = (chain.first + 1..chain.end).map(|b| (b - 1, b));
    for (a, b) in pairs.chain(chain.closed.then_some((chain.end - 1, chain.first))) {
        found.extend(joint(tool, a, b));
    }
    let broken = found[before..].iter().any(|finding| matches!(finding, Finding::Gap(..)));
    let (first, last) = (chain.first, chain.end - 1);
    if !chain.closed {
        let ends = [tool.segments()[first].point(0.0), tool.segments()[last].point(1.0)];
        found.push(Finding::Open(first, last, ends));
    } else if !broken && area(tool, chain) < 0.0 {
        found.push(Finding::Clockwise(first, last));
    }
}

/// What is to be said of the place where segment `b` follows `a`.
fn joint(tool: &Tool, a: usize, b: usize) -> Option<Finding> {
    let (first, second) = (&tool.segments()[a], &tool.segments()[b]);
    let gap = (second.point(0.0) - first.point(1.0)).norm();
    if gap > TOGETHER * tool.size() {
        return Some(Finding::Gap(a, b, gap));
    }
    let (from, to) = (first.tangent(1.0), second.tangent(0.0));
    let angle = turn(from, to).atan2(from.dot(to)).to_degrees();
    (angle.abs() > KINK).then_some(Finding::Kink(a, b, angle))
}

/// The area on the left of a closed profile.
fn area(tool: &Tool, chain: &Chain) -> f64 {
    let segments = &tool.segments()[chain.first..chain.end];
    let origin = segments[0].point(0.0);
    let points: Vec<Vec3> = segments.iter().flat_map(|s| s.flatten(1e-4 * tool.size())).collect();
    0.5 * points.windows(2).map(|p| turn(p[0] - origin, p[1] - origin)).sum::<f64>()
}

fn crossings(tool: &Tool, found: &mut Vec<Finding>) {
    for (a, segment) in tool.segments().iter().enumerate() {
        let mut others = Vec::new();
        tool.tree().near(&segment.bounds(), &mut |b| others.push(b));
        others.retain(|&b| b > a);
        others.sort_unstable();
        let crossed = |b: usize| crossing(tool, a, b).map(|place| Finding::Crossing(a, b, place));
        found.extend(others.into_iter().filter_map(crossed));
    }
}

/// Where two segments meet elsewhere than at a node in which one follows the other.
fn crossing(tool: &Tool, a: usize, b: usize) -> Option<Vec3> {
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
fn shared(tool: &Tool, a: usize, b: usize) -> Option<Vec3> {
    let chain = tool.chains().iter().find(|chain| (chain.first..chain.end).contains(&a))?;
    let follows = b == a + 1 && b < chain.end || chain.closed && a + 1 == chain.end && b == chain.first;
    follows.then(|| tool.segments()[a].point(1.0))
}

/// Places where the straight piece from `from` to `to` meets a segment.
fn meet(from: Vec3, to: Vec3, segment: &dyn Shape, found: &mut dyn FnMut(Vec3)) {
    let (box_a, box_b) = (Bounds::of([from, to]), segment.bounds());
    if (0..2).any(|i| box_a.max[i] < box_b.min[i] || box_b.max[i] < box_a.min[i]) {
        return;
    }
    let length = (to - from).norm();
    let ray = Ray { origin: from, direction: (to - from) * (1.0 / length) };
    segment.cast(&ray, &mut |Crossing { u, .. }| {
        if u >= 0.0 && u <= length {
            found(ray.point(u));
        }
    });
}
