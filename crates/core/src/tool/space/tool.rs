//! A rigid tool in space and what a ray meets on it.

use super::facet::{Meeting, ToolFacet};
use super::nearest::RigidFacet;
use super::{FacetFinding, check};
use crate::tensor::{Scalar, Vec3};
use crate::tool::search::BoxTree;
use crate::tool::shapes::{BoundingBox, ProfileRay};
use crate::tool::{Hit, Pose};

/// A rigid tool in space: facets with the material behind them, and a reference point.
#[derive(Debug)]
pub struct SpaceTool {
    name: String,
    reference: Vec3,
    facets: Vec<Box<dyn RigidFacet>>,
    bounds: BoundingBox,
    tree: BoxTree,
}

/// The surface of a tool as triangles and quadrilaterals, for drawing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tiles {
    /// Points.
    pub points: Vec<Vec3>,
    /// Three or four points a tile, outward by the right-hand rule, with the facet it lies on.
    pub tiles: Vec<(usize, Vec<usize>)>,
}

impl SpaceTool {
    /// A tool of facets; `reference` is the point that its translation moves and about which it turns. Anything is
    /// accepted here; [`check`](Self::check) says what is wrong with it.
    pub fn new(name: impl Into<String>, facets: Vec<Box<dyn RigidFacet>>, reference: Vec3) -> Self {
        let boxes: Vec<BoundingBox> = facets.iter().map(|facet| facet.bounds()).collect();
        let bounds = boxes.iter().fold(BoundingBox::EMPTY, |all, &b| all.union(b));
        let tree = BoxTree::new(&boxes, 1e-9 * bounds.size());
        Self { name: name.into(), reference, facets, bounds, tree }
    }

    /// The user's name for it.
    pub fn name(&self) -> &str {
        &self.name
    }
    /// The reference point, where it stood before any motion.
    pub fn reference(&self) -> Vec3 {
        self.reference
    }
    /// Its facets.
    pub fn facets(&self) -> &[Box<dyn RigidFacet>] {
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
    /// What is wrong with its facets or worth knowing.
    pub fn check(&self) -> Vec<FacetFinding> {
        check::findings(self)
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
        self.tree.along(&own, range, &mut |facet| {
            self.facets[facet].cast(&own, &mut |place| {
                if (range[0]..=range[1]).contains(&place.u) {
                    hits.push(self.hit(pose, facet, place));
                }
            });
        });
        hits.sort_unstable_by(|a, b| a.segment.cmp(&b.segment).then(a.u.total_cmp(&b.u)));
    }

    /// Where a ray meets one given facet or what continues it, whether or not others are nearer: see
    /// [`ToolFacet::follow`]. Continuous in the ray, so that a point whose ray is perturbed keeps its facet.
    pub fn cast_facet(&self, pose: &Pose, facet: usize, ray: &ProfileRay, near: [f64; 2]) -> Option<Hit> {
        let own = pose.own_frame(self.reference, ray);
        self.facets[facet].follow(&own, near).map(|place| self.hit(pose, facet, place))
    }

    /// Its surface in space, nowhere much farther than `sagitta` from it.
    pub fn surface(&self, pose: &Pose, sagitta: f64) -> Tiles {
        let mut out = Tiles::default();
        for (i, facet) in self.facets.iter().enumerate() {
            tile(i, facet.as_ref(), sagitta, &mut out);
        }
        out.points.iter_mut().for_each(|p| *p = pose.place(self.reference, *p));
        out
    }

    fn hit(&self, pose: &Pose, facet: usize, place: Meeting) -> Hit {
        Hit { segment: facet, s: place.s, u: place.u, normal: self.normal(pose, facet, place.s) }
    }
}

/// The tiles of one facet.
fn tile(number: usize, facet: &dyn ToolFacet, sagitta: f64, out: &mut Tiles) {
    let first = out.points.len();
    if let corners @ [_, _, _] = facet.corners() {
        out.points.extend(corners);
        out.tiles.push((number, (first..first + 3).collect()));
        return;
    }
    let [n, m] = facet.parts(sagitta);
    let at = |i: usize, j: usize| facet.point([i as f64 / n as f64, j as f64 / m as f64]);
    out.points.extend((0..=n).flat_map(|i| (0..=m).map(move |j| (i, j))).map(|(i, j)| at(i, j)));
    let place = |i: usize, j: usize| first + i * (m + 1) + j;
    let tiles = (0..n).flat_map(|i| (0..m).map(move |j| (i, j)));
    out.tiles
        .extend(tiles.map(|(i, j)| (number, vec![place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)])));
}
