//! A rigid tool and what a ray meets on it.

use super::facet::{Meeting, ToolFacet};
use super::search::BoxTree;
use super::shapes::{ProfileRay, ProfileShape};
use super::{Pose, ProfileFinding, check};
use crate::tensor::{BoundingBox, Scalar, Vec3};

/// A rigid tool: facets, or segments of profiles, with the material behind them, and a reference point.
#[derive(Debug)]
pub struct FacetTool<F: ?Sized> {
    name: String,
    reference: Vec3,
    facets: Vec<Box<F>>,
    /// Of a tool in the plane.
    chains: Vec<Chain>,
    bounds: BoundingBox,
    tree: BoxTree,
}

/// A rigid tool in the plane: chains of segments with the material on their left.
pub type ProfileTool = FacetTool<dyn ProfileShape>;

/// One profile: segments that follow each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Chain {
    /// Its first segment.
    pub first: usize,
    /// One behind its last segment.
    pub end: usize,
    /// Whether its last segment ends where its first begins.
    pub closed: bool,
}

impl Chain {
    /// Its segments, each with that which follows it.
    pub(super) fn joints(self) -> impl Iterator<Item = (usize, usize)> {
        (self.first..self.end).filter_map(move |i| Some((i, self.behind(i)?)))
    }
    /// The segment that follows one of its own.
    pub(super) fn behind(self, segment: usize) -> Option<usize> {
        Some(segment + 1).filter(|&next| next < self.end).or(self.closed.then_some(self.first))
    }
}

/// A place where a ray meets a segment of a profile, a facet of a tool in space, or a face of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// The segment, facet or face.
    pub segment: usize,
    /// Coordinates on it; on a segment of the plane the second is zero.
    pub s: [f64; 2],
    /// Signed distance along the ray.
    pub u: f64,
    /// Outward unit normal of the target there, in space.
    pub normal: Vec3,
}

impl<F: ToolFacet + ?Sized> FacetTool<F> {
    /// Of facets in its own frame; `reference` is the point that its translation moves and about which it turns.
    pub(super) fn of(name: String, facets: Vec<Box<F>>, reference: Vec3) -> Self {
        let boxes: Vec<BoundingBox> = facets.iter().map(|facet| facet.bounds()).collect();
        let bounds = boxes.iter().fold(BoundingBox::EMPTY, |all, &b| all.union(b));
        let tree = BoxTree::new(&boxes, 1e-9 * bounds.size());
        Self { name, reference, facets, chains: Vec::new(), bounds, tree }
    }

    /// The user's name for it.
    pub fn name(&self) -> &str {
        &self.name
    }
    /// The reference point, where it stood before any motion.
    pub fn reference(&self) -> Vec3 {
        self.reference
    }
    /// Its facets, or the segments of its profiles in their order.
    pub fn facets(&self) -> &[Box<F>] {
        &self.facets
    }
    /// The box around it in its own frame.
    pub fn bounds(&self) -> BoundingBox {
        self.bounds
    }
    /// The diagonal of that box, a length.
    pub fn size(&self) -> f64 {
        self.bounds.size()
    }
    pub(super) fn tree(&self) -> &BoxTree {
        &self.tree
    }

    /// Present position of the material point at `s` on a facet.
    pub fn point<T: Scalar>(&self, pose: &Pose<T>, facet: usize, s: [f64; 2]) -> Vec3<T> {
        pose.place(self.reference, self.facets[facet].point(s))
    }
    /// Present outward unit normal there.
    pub fn normal(&self, pose: &Pose, facet: usize, s: [f64; 2]) -> Vec3 {
        pose.rotate(self.facets[facet].normal(s))
    }

    /// All places with `u` in `range` where the line through `ray` meets the tool, by facet and then by `u`; `hits` is
    /// cleared first and its memory reused.
    pub fn cast(&self, pose: &Pose, ray: &ProfileRay, range: [f64; 2], hits: &mut Vec<Hit>) {
        hits.clear();
        let own = pose.own_frame(self.reference, ray);
        self.tree.along(&own, range, &mut |segment| {
            self.facets[segment].cast(&own, &mut |Meeting { u, s }| {
                if (range[0]..=range[1]).contains(&u) {
                    hits.push(Hit { segment, s, u, normal: self.normal(pose, segment, s) });
                }
            });
        });
        hits.sort_unstable_by(|a, b| a.segment.cmp(&b.segment).then(a.u.total_cmp(&b.u)));
    }

    /// Where a ray meets one given facet or what continues it, whether or not others are nearer: see [`ToolFacet::follow`].
    pub fn meet(&self, pose: &Pose, segment: usize, ray: &ProfileRay, near: [f64; 2]) -> Option<Hit> {
        let (Meeting { u, s }, normal) = self.facets[segment].follow(&pose.own_frame(self.reference, ray), near)?;
        Some(Hit { segment, s, u, normal: pose.rotate(normal) })
    }
}

impl ProfileTool {
    /// A tool of one or more profiles, each a list of segments in the order of travel; `reference` is the point that
    /// its translation moves and about which it turns. Anything is accepted here; [`check`](Self::check) says what is
    /// wrong with it.
    pub fn new(name: impl Into<String>, profiles: Vec<Vec<Box<dyn ProfileShape>>>, reference: Vec3) -> Self {
        let lengths: Vec<usize> = profiles.iter().map(Vec::len).collect();
        let tool = Self::of(name.into(), profiles.into_iter().flatten().collect(), reference);
        let chains = chains(&tool.facets, &lengths, check::TOGETHER * tool.size());
        Self { chains, ..tool }
    }
    /// Its segments, in the order of the profiles.
    pub fn segments(&self) -> &[Box<dyn ProfileShape>] {
        &self.facets
    }
    /// Its profiles.
    pub fn chains(&self) -> &[Chain] {
        &self.chains
    }
    /// What is wrong with its profiles or worth knowing; `axisymmetric` ones must have `r >= 0`.
    pub fn check(&self, axisymmetric: bool) -> Vec<ProfileFinding> {
        check::findings(self, axisymmetric)
    }

    /// The profiles in space as polylines nowhere farther than `sagitta` from them, for drawing.
    pub fn outline(&self, pose: &Pose, sagitta: f64) -> Vec<Vec<Vec3>> {
        let polyline = |chain: &Chain| {
            let mut points: Vec<Vec3> = Vec::new();
            for segment in &self.facets[chain.first..chain.end] {
                let skip = usize::from(!points.is_empty());
                points.extend(segment.flatten(sagitta).into_iter().skip(skip));
            }
            points.iter().map(|&p| pose.place(self.reference, p)).collect()
        };
        self.chains.iter().map(polyline).collect()
    }
}

/// Cuts the list of all segments into profiles and finds which of them close.
fn chains(segments: &[Box<dyn ProfileShape>], lengths: &[usize], together: f64) -> Vec<Chain> {
    let mut end = 0;
    let ranges = lengths.iter().filter(|&&length| length > 0).map(|length| {
        end += length;
        (end - length, end)
    });
    ranges
        .map(|(first, end)| {
            let gap = (segments[end - 1].point(1.0) - segments[first].point(0.0)).norm();
            Chain { first, end, closed: end - first > 1 && gap <= together }
        })
        .collect()
}
