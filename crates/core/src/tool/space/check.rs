//! What is wrong with the facets of a tool in space, or worth knowing about them.
//!
//! Facets with straight edges are compared edge by edge: each edge of a closed surface lies on two facets, which run
//! along it in opposite directions if both look outward. Facets made of profiles are judged with their profile.

use super::tool::SpaceTool;
use crate::tensor::Vec3;
use crate::tool::FindingSeverity;
use crate::tool::facet::ToolFacet;
use std::collections::BTreeMap;
use std::fmt;

/// A facet whose height is below this part of its longest edge has no direction.
const THIN: f64 = 1e-9;

/// One finding. Facets are counted from zero here and from one in the sentence that [`Display`](fmt::Display) gives.
#[derive(Debug, Clone, PartialEq)]
pub enum FacetFinding {
    /// There is no facet.
    Empty,
    /// A coordinate is not a finite number.
    NotFinite(usize),
    /// A facet has no area.
    Degenerate(usize),
    /// Edges of only one facet: how many, and one of them with its facet.
    OpenEdges(usize, usize, [Vec3; 2]),
    /// Two facets that meet at an edge look to opposite sides.
    Opposed(usize, usize),
    /// Edges of more than two facets: how many, and a facet of one of them.
    Branching(usize, usize),
    /// A closed surface whose facets look inward.
    InsideOut,
}

impl FacetFinding {
    /// How grave it is.
    pub fn severity(&self) -> FindingSeverity {
        match self {
            Self::OpenEdges(..) | Self::Branching(..) => FindingSeverity::Note,
            _ => FindingSeverity::Error,
        }
    }
    /// The first facet it is about, counted from zero; none if it is about the whole tool.
    pub fn facet(&self) -> Option<usize> {
        match self {
            Self::Empty | Self::InsideOut => None,
            Self::NotFinite(a)
            | Self::Degenerate(a)
            | Self::OpenEdges(_, a, _)
            | Self::Opposed(a, _)
            | Self::Branching(_, a) => Some(*a),
        }
    }
}

impl fmt::Display for FacetFinding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let at = |p: &Vec3| format!("({}, {}, {})", p[0], p[1], p[2]);
        match self {
            Self::Empty => f.write_str("the tool has no facets"),
            Self::NotFinite(a) => write!(f, "facet {} has a coordinate that is not a finite number", a + 1),
            Self::Degenerate(a) => write!(f, "facet {} has no area", a + 1),
            Self::OpenEdges(n, a, [from, to]) => {
                let edges = if *n == 1 { "1 edge has".into() } else { format!("{n} edges have") };
                let (from, to) = (at(from), at(to));
                write!(f, "the surface is open: {edges} one facet only, as that of facet {} from {from} to {to}", a + 1)
            }
            Self::Opposed(a, b) => {
                write!(f, "facets {} and {} meet at an edge and look to opposite sides", a + 1, b + 1)
            }
            Self::Branching(n, a) => write!(f, "edges with more than two facets: {n}, one of them of facet {}", a + 1),
            Self::InsideOut => f.write_str("the facets of the closed surface look inward"),
        }
    }
}

/// Facets on either side of an edge: those that run along it and those that run against it.
#[derive(Default)]
struct FacetEdge {
    along: Vec<usize>,
    against: Vec<usize>,
}

/// A point as a key: its bits, so that points are one that are equal.
type Key = [u64; 3];

fn key(p: Vec3) -> Key {
    p.0.map(|x| (x + 0.0).to_bits())
}

/// All findings.
pub(super) fn findings(tool: &SpaceTool) -> Vec<FacetFinding> {
    if tool.facets().is_empty() {
        return vec![FacetFinding::Empty];
    }
    let mut found: Vec<FacetFinding> =
        tool.facets().iter().enumerate().filter_map(|(i, facet)| single(facet.as_ref(), i)).collect();
    if found.is_empty() {
        edges(tool, &mut found);
    }
    found
}

fn single(facet: &dyn ToolFacet, i: usize) -> Option<FacetFinding> {
    let corners = facet.corners();
    if corners.is_empty() {
        return None;
    }
    if corners.iter().any(|corner| !corner.is_finite()) {
        return Some(FacetFinding::NotFinite(i));
    }
    is_thin(corners).then_some(FacetFinding::Degenerate(i))
}

/// Whether a polygon has no area; a quadrilateral with a corner on the line of its neighbours has no normal there.
pub fn is_thin(corners: &[Vec3]) -> bool {
    let n = corners.len();
    let longest = (0..n).map(|k| (corners[(k + 1) % n] - corners[k]).norm()).fold(0.0, f64::max);
    let area = |k: usize| (corners[(k + 1) % n] - corners[k]).cross(corners[(k + n - 1) % n] - corners[k]).norm();
    (0..n).any(|k| area(k) <= THIN * longest * longest)
}

fn edges(tool: &SpaceTool, found: &mut Vec<FacetFinding>) {
    let mut edges: BTreeMap<(Key, Key), FacetEdge> = BTreeMap::new();
    for (i, facet) in tool.facets().iter().enumerate() {
        let corners = facet.corners();
        for k in 0..corners.len() {
            let (from, to) = (key(corners[k]), key(corners[(k + 1) % corners.len()]));
            let edge = edges.entry((from.min(to), from.max(to))).or_default();
            if from < to { edge.along.push(i) } else { edge.against.push(i) }
        }
    }
    judge(&edges, found);
    let swept = tool.facets().iter().any(|facet| facet.corners().is_empty());
    if found.is_empty() && !swept && volume(tool) < 0.0 {
        found.push(FacetFinding::InsideOut);
    }
}

fn judge(edges: &BTreeMap<(Key, Key), FacetEdge>, found: &mut Vec<FacetFinding>) {
    let (mut open, mut many) = (None, None);
    for (&(from, to), edge) in edges {
        match (edge.along.as_slice(), edge.against.as_slice()) {
            ([_], [_]) => {}
            ([a], []) | ([], [a]) => {
                let ends = [from, to].map(|key| Vec3(key.map(f64::from_bits)));
                open.get_or_insert((0, *a, ends)).0 += 1;
            }
            ([a, b], []) | ([], [a, b]) => found.push(FacetFinding::Opposed(*a, *b)),
            (along, against) => {
                let first = along.iter().chain(against).copied().min().unwrap_or(0);
                many.get_or_insert((0, first)).0 += 1;
            }
        }
    }
    found.extend(open.map(|(n, facet, ends)| FacetFinding::OpenEdges(n, facet, ends)));
    found.extend(many.map(|(n, facet)| FacetFinding::Branching(n, facet)));
}

/// Six times the volume behind the facets of a closed surface, by tetrahedra from one of its corners.
fn volume(tool: &SpaceTool) -> f64 {
    let all = || tool.facets().iter().map(|facet| facet.corners());
    let Some(origin) = all().flatten().next().copied() else { return 0.0 };
    let of = |c: &[Vec3]| -> f64 {
        (1..c.len() - 1).map(|k| (c[0] - origin).dot((c[k] - origin).cross(c[k + 1] - origin))).sum()
    };
    all().map(of).sum()
}
