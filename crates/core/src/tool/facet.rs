//! What the facets of a tool in space and the segments of a profile have in common.
//!
//! A facet is a smooth piece of surface with two coordinates `s`, each in `[0, 1]` (a triangle's also `s0 + s1 <= 1`).
//! It stands in the tool's own frame and never moves. Its outward normal is along `dx/ds0 x dx/ds1`. A ray meets the
//! *carrier* of a facet (the whole plane, quadric or torus); the places whose `s` are in range are the facet's own. A segment of a
//! profile is one whose second tangent is `e_z`, and its second coordinate zero.

use super::shapes::{ProfileRay, ProfileShape, RayCrossing};
use crate::tensor::{BoundingBox, Vec3};
use std::fmt::Debug;

/// How far beyond its edges a facet still counts as hit, in units of `s`: a ray through a common edge must not slip
/// between two neighbours by rounding.
const EDGE: f64 = 1e-10;

/// How far beyond its edges a facet's own carrier is followed when a ray is to meet this facet and no other.
const EXTENSION: f64 = 0.1;

/// Where a ray meets a facet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Meeting {
    /// Signed distance from the ray's origin along its direction.
    pub u: f64,
    /// Coordinates on the facet.
    pub s: [f64; 2],
}

/// A smooth piece of a tool's surface, in the tool's own frame.
pub trait ToolFacet: Debug + Send + Sync {
    /// The point at `s`.
    fn point(&self, s: [f64; 2]) -> Vec3;
    /// `dx/ds`, two lengths.
    fn tangents(&self, s: [f64; 2]) -> [Vec3; 2];
    /// Where a ray meets the carrier, in any order and whatever `s`.
    fn meet(&self, ray: &ProfileRay, found: &mut dyn FnMut(Meeting));
    /// A box around the facet.
    fn bounds(&self) -> BoundingBox;
    /// How many equal parts of each coordinate make tiles nowhere much farther than `sagitta` from the facet.
    fn parts(&self, sagitta: f64) -> [usize; 2];
    /// Its corners, if its edges are straight: three or four.
    fn corners(&self) -> &[Vec3] {
        &[]
    }
    /// The unit outward normal at `s`.
    fn normal(&self, s: [f64; 2]) -> Vec3 {
        let [a, b] = self.tangents(s);
        a.cross(b).unit()
    }
    /// Whether `s` is on the facet, enlarged at its edges by the part `beyond`.
    fn holds(&self, s: [f64; 2], beyond: f64) -> bool {
        s.iter().all(|s| (-beyond..=1.0 + beyond).contains(s))
    }
    /// The places of the facet itself, its edges included.
    fn cast(&self, ray: &ProfileRay, found: &mut dyn FnMut(Meeting)) {
        self.meet(ray, &mut |place| {
            if place.u.is_finite() && self.holds(place.s, EDGE) {
                found(Meeting { s: place.s.map(|s| s.clamp(0.0, 1.0)), ..place });
            }
        });
    }
    /// Where a ray meets this facet or what continues it, with the normal there: the place on the carrier, followed a little
    /// beyond the edges, that is nearest to that at `near`; where there is none, that on the tangent plane at `near`. None if the
    /// ray runs along that plane. Continuous in the ray, so that a point whose ray is perturbed keeps its facet.
    fn follow(&self, ray: &ProfileRay, near: [f64; 2]) -> Option<(Meeting, Vec3)> {
        let near = near.map(|s| s.clamp(0.0, 1.0));
        let (there, mut best, mut least) = (self.point(near), None, f64::INFINITY);
        self.meet(ray, &mut |place| {
            let off = (ray.point(place.u) - there).norm();
            if off < least && self.holds(place.s, EXTENSION) {
                (best, least) = (Some((place, self.normal(place.s))), off);
            }
        });
        best.or_else(|| Some((flat(there, self.tangents(near), ray, near)?, self.normal(near))))
    }
}

impl ToolFacet for dyn ProfileShape + '_ {
    fn point(&self, [s, _]: [f64; 2]) -> Vec3 {
        self.point(s)
    }
    fn tangents(&self, [s, _]: [f64; 2]) -> [Vec3; 2] {
        [self.tangent(s), Vec3::axis(2)]
    }
    fn meet(&self, ray: &ProfileRay, found: &mut dyn FnMut(Meeting)) {
        self.meet(ray).into_iter().for_each(|RayCrossing { u, s }| found(Meeting { u, s: [s, 0.0] }));
    }
    fn bounds(&self) -> BoundingBox {
        self.bounds()
    }
    fn parts(&self, sagitta: f64) -> [usize; 2] {
        [self.pieces(sagitta), 1]
    }
}

/// Where a ray meets the plane through a point with two tangents, whose coordinates there are `near`.
pub(super) fn flat(point: Vec3, [a, b]: [Vec3; 2], ray: &ProfileRay, near: [f64; 2]) -> Option<Meeting> {
    let normal = a.cross(b);
    let u = normal.dot(point - ray.origin) / normal.dot(ray.direction);
    let off = ray.point(u) - point;
    let size = normal.dot(normal);
    let s = [near[0] + off.cross(b).dot(normal) / size, near[1] + a.cross(off).dot(normal) / size];
    (u.is_finite() && s[0].is_finite() && s[1].is_finite()).then_some(Meeting { u, s })
}
