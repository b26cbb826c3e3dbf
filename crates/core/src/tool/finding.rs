//! What may be found in a tool's profiles, and the sentences that say it.

use crate::tensor::Vec3;
use std::fmt;

/// A kink from which the profile runs back along itself, in degrees.
const REVERSAL: f64 = 179.0;

/// How grave a finding is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum FindingSeverity {
    /// Worth knowing.
    Note,
    /// The tool cannot be used.
    Error,
}

/// One finding. Segments are counted from zero here and from one in the sentence that [`Display`](fmt::Display) gives.
#[derive(Debug, Clone, PartialEq)]
pub enum ProfileFinding {
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

impl ProfileFinding {
    /// How grave it is.
    pub fn severity(&self) -> FindingSeverity {
        match self {
            Self::Kink(_, _, angle) if angle.abs() < REVERSAL => FindingSeverity::Note,
            Self::Open(..) => FindingSeverity::Note,
            _ => FindingSeverity::Error,
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

impl fmt::Display for ProfileFinding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let at = |p: &Vec3| format!("({}, {})", p[0], p[1]);
        let both = |a: &usize, b: &usize| format!("segments {} and {}", a + 1, b + 1);
        let all = |a: &usize, b: &usize| format!("profile of segments {} to {}", a + 1, b + 1);
        match self {
            Self::Empty => f.write_str("the tool has no segments"),
            Self::NotFinite(a) => write!(f, "segment {} has a coordinate that is not a finite number", a + 1),
            Self::NoLength(a) => write!(f, "segment {} begins and ends in the same place", a + 1),
            Self::Flaw(a, flaw) => write!(f, "segment {} {flaw}", a + 1),
            Self::NegativeRadius(a, r) => write!(f, "segment {} reaches the negative radius {r}", a + 1),
            Self::Gap(a, b, gap) => write!(f, "{} do not meet: {gap:.3e} lies between them", both(a, b)),
            Self::Crossing(a, b, p) => write!(f, "{} cross at {}", both(a, b), at(p)),
            Self::Clockwise(a, b) => {
                let remedy = "reverse the order of its segments and of their nodes";
                let outside = "runs clockwise, which puts the tool's material outside it";
                write!(f, "the closed {} {outside}: {remedy}", all(a, b))
            }
            Self::Kink(a, b, angle) => {
                let kind = if *angle > 0.0 { "convex" } else { "concave" };
                write!(f, "{} meet at a {kind} edge of {:.1} degrees", both(a, b), angle.abs())
            }
            Self::Open(a, b, [from, to]) => {
                write!(f, "the {} is open: it runs from {} to {}", all(a, b), at(from), at(to))
            }
        }
    }
}
