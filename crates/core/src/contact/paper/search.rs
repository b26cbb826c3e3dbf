//! The search: which segments the rays of a surface meet.

use super::contact::PaperContact;
use super::segment::met;
use crate::contact::field::configuration::TargetInPlace;
use crate::contact::field::faces;
use crate::tensor::Vec3;
use crate::tool::{Hit, ProfileRay, Rejected, Rules, select};

/// A ray to be cast, and what it may meet.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cast<'a> {
    /// The ray, along the inward normal of the surface.
    pub ray: ProfileRay,
    /// Largest gap at which the target is seen, a length.
    pub reach: f64,
    /// Largest admissible penetration, a length.
    pub depth: f64,
    /// Segments that share a node with the face the ray comes from.
    pub relatives: &'a [usize],
    /// Diagonal of the box around the target, a length.
    pub size: f64,
}

/// Least cosine between a ray and the normal of a face next to the one that the ray comes from: such faces are no
/// contact unless a fold is closing.
const FOLD: f64 = 0.5;

impl TargetInPlace<'_> {
    /// All that a ray meets within a range.
    pub(super) fn cast(&self, ray: &ProfileRay, range: [f64; 2]) -> Vec<Hit> {
        let mut hits = Vec::new();
        match self {
            Self::Tool(tool) => tool.cast(ray, range, &mut hits),
            Self::Faces(faces) => {
                let ray = faces::FaceRay { x: ray.origin, n: ray.direction };
                faces.meet(&ray, range, |segment, at| hits.extend(met(segment, &ray, at)));
            }
        }
        hits
    }

    /// What a ray meets by the rules against false contacts, to the far side of the body; what they reject is counted.
    pub(super) fn see(&self, cast: &Cast, rejected: &mut Rejected) -> Option<Hit> {
        let mut hits = self.cast(&cast.ray, [-cast.reach, 2.0 * cast.depth]);
        let direction = cast.ray.direction;
        hits.retain(|hit| !cast.relatives.contains(&hit.segment) || direction.dot(hit.normal) > FOLD);
        select(direction, &hits, &Rules::new(cast.depth, cast.size), rejected)
    }
}

impl PaperContact {
    /// What the search finds at displacements `u`, point by point, and how many false contacts it rejects.
    pub fn search(&self, u: &[f64]) -> (Vec<Option<Hit>>, Rejected) {
        self.search_within(u, f64::INFINITY)
    }

    /// The largest admissible penetration at each point; infinite where its ray never leaves the body. A point of a curved face lies off
    /// its chord, so that its own face is left out, and what is within rounding of a corner.
    pub(super) fn depths(&self, u: &[f64]) -> Vec<f64> {
        let boundary = self.boundary.in_place(self.site(), u);
        let depth = |index: usize| {
            let (own, (origin, triad)) = (self.face(index).side, self.triad(index, u));
            let least = 1e-3 * if self.parts.surface.plane { triad.area } else { triad.area.sqrt() };
            0.5 * boundary.depth(own, &faces::FaceRay { x: origin, n: triad.inward }, least)
        };
        (0..self.points.len()).map(depth).collect()
    }

    pub(super) fn search_within(&self, u: &[f64], reach: f64) -> (Vec<Option<Hit>>, Rejected) {
        let (depths, target, mut rejected) = (self.depths(u), self.target_at(u), Rejected::default());
        let points = depths.into_iter().enumerate();
        let hits = points.map(|(i, depth)| target.see(&self.cast(i, self.ray(i, u), (depth, reach)), &mut rejected));
        (hits.collect(), rejected)
    }

    /// The target at unknowns `u`.
    pub(super) fn target_at(&self, u: &[f64]) -> TargetInPlace<'_> {
        self.parts.target.at(self.site(), u)
    }

    /// The ray of a point at unknowns `u`.
    pub(super) fn ray(&self, point: usize, u: &[f64]) -> ProfileRay {
        let (origin, triad) = self.triad(point, u);
        ProfileRay { origin, direction: triad.inward }
    }

    /// A ray on behalf of a point, up to a depth and a reach.
    pub(super) fn cast(&self, point: usize, ray: ProfileRay, (depth, reach): (f64, f64)) -> Cast<'_> {
        let relatives = &self.relatives[self.points[point].face];
        Cast { ray, reach, depth, relatives, size: self.parts.target.size() }
    }

    /// Rays from these places on the undeformed surface, each on behalf of a point: how deep they meet the target.
    pub(super) fn penetrations(&self, rays: impl Iterator<Item = (Vec3, Vec3, usize)>) -> Vec<Option<f64>> {
        let still = vec![0.0; self.parts.dofs.count()];
        let (depths, target) = (self.depths(&still), self.target_at(&still));
        let deep = |(origin, direction, point): (Vec3, Vec3, usize)| {
            let cast = self.cast(point, ProfileRay { origin, direction }, (depths[point], f64::INFINITY));
            target.see(&cast, &mut Rejected::default()).map(|hit| hit.u)
        };
        rays.map(deep).collect()
    }
}
