//! What a contact point was at the last accepted state: the target's material point it touched, and its friction stress.
//!
//! Points stand at the same places of their edge as long as the target covers all of it, and then the history says. On
//! an edge that is covered in part they move along it, and a point is another material point than the history's: what it
//! touched is found again in the accepted configuration, and the stress is the linear field that fits those of the
//! edge's closed points best. Both are functions of the place, and their slopes are part of the tangent.
//!
//! A point over which the target came from the side lay beyond its last vertex. That vertex is what it touched when it
//! became covered: its slip is the way from there, which grows from nothing at the end of the covered part.

use super::faces;
use super::open::OpenContact;
use super::placed::{Frame, Placed};
use super::point::triad;
use super::record::entry;
use super::split::Vertex;
use super::surface::SurfacePoint;
use super::target::{Cast, Memory, Standing};
use crate::system::Stencil;
use crate::tensor::Vec3;
use crate::tool::{Ray, Rules};

impl faces::Standing<'_> {
    /// The end of an edge beyond which a ray passes it, and the next edge there if that looks at the ray.
    fn beside(&self, segment: usize, ray: &Ray) -> Option<(usize, Option<usize>)> {
        let vertices = [1, 2].map(|end| 2 * segment as Vertex + end);
        let along = -ray.direction.left();
        let [a, b] = vertices.map(|vertex| along.dot(self.faces_at(vertex).0 - ray.origin));
        let end = usize::from(b.abs() < a.abs());
        let look =
            self.faces_at(vertices[end]).2.filter(|(normal, _)| ray.direction.dot(*normal) > Rules::LEAST_COSINE);
        (a * b > 0.0).then(|| (end, look.and_then(|_| self.beyond(vertices[end]))))
    }

    /// From an edge on towards a ray, the last edge that looks at it, if the ray passes beyond the end of that too.
    fn last_towards(&self, mut segment: usize, ray: &Ray) -> Option<usize> {
        let (first, mut last) = (segment, segment);
        while let Some(next) = self.beside(segment, ray)?.1 {
            // Round a ring, or to and fro in a fold.
            if next == first || next == last {
                return None;
            }
            (last, segment) = (segment, next);
        }
        Some(segment)
    }
}

/// See the module.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Before {
    /// Segment and place on it that was touched.
    pub touched: Option<(usize, [f64; 2])>,
    /// Its motion along that segment per motion of the point along its edge.
    pub sliding: f64,
    /// Friction stress.
    pub shear: f64,
    /// Its slope along the edge.
    pub shear_slope: f64,
    /// Whether the target came over the point from the side.
    pub entered: bool,
}

/// The stencil's third choice: the history says what was touched,
pub(super) const AS_BEFORE: u32 = 0;
/// or nothing was; anything else is a segment and one,
pub(super) const NOTHING: u32 = u32::MAX;
/// and this where the target came over the point from the side.
pub(super) const ENTERED: u32 = 1 << 31;

/// The segment touched at the last accepted state, by a stencil's choice and the history of its point.
pub(super) fn touched_segment(choice: u32, old: &[f64]) -> Option<usize> {
    match choice {
        AS_BEFORE => (old[entry::SEGMENT] >= 0.0).then_some(old[entry::SEGMENT] as usize),
        NOTHING => None,
        other => Some((other & !ENTERED) as usize - 1),
    }
}

/// A stencil's choice for a segment that was seen, or else the last one over which the target came.
pub(super) fn chosen(seen: Option<usize>, passed: impl FnOnce() -> Option<usize>) -> u32 {
    let passed = || passed().map(|segment| (segment as u32 + 1) | ENTERED);
    seen.map(|segment| segment as u32 + 1).or_else(passed).unwrap_or(NOTHING)
}

impl OpenContact<'_> {
    /// The stencil's choice of what a point at `spot` touched that now meets the segment `now`.
    pub(super) fn recall(&self, index: usize, (spot, now): (&SurfacePoint, usize), memory: &mut Memory) -> u32 {
        let (Some(Standing::Faces(standing)), old) = (&self.standing, self.history.slot(index)) else {
            return AS_BEFORE;
        };
        let stays = spot.half == 1.0 && spot.xi == old[entry::XI];
        if stays && old[entry::SEGMENT] >= 0.0 {
            return AS_BEFORE;
        }
        let (_, ray) = self.ray_before(spot);
        let cast = Cast { ray, ..self.contact.bounds(index, self.depths[index], self.reach) };
        let seen = if stays { None } else { standing.select(&cast, memory).map(|hit| hit.segment) };
        chosen(seen, || standing.last_towards(now, &ray))
    }

    /// The segment touched at the last accepted state.
    pub(super) fn touched_segment(&self, index: usize, stencil: &Stencil) -> Option<usize> {
        touched_segment(stencil.also[2], self.history.slot(index))
    }

    /// What a point at `spot` was.
    pub(super) fn before(&self, index: usize, stencil: &Stencil, spot: &SurfacePoint) -> Before {
        let old = self.history.slot(index);
        let Some(segment) = self.touched_segment(index, stencil) else { return Before::default() };
        if stencil.also[2] == AS_BEFORE {
            let touched = Some((segment, [old[entry::S], old[entry::S2]]));
            return Before { touched, shear: old[entry::SHEAR], ..Before::default() };
        }
        let [shear, shear_slope] = self.shear_before(spot);
        let entered = stencil.also[2] & ENTERED > 0;
        let found = if entered { self.vertex_passed(segment, spot) } else { self.slide(segment, spot) };
        let Some((s, sliding)) = found else { return Before::default() };
        Before { touched: Some((segment, [s, 0.0])), sliding, shear, shear_slope, entered }
    }

    /// The end of a segment beyond which a point at `spot` lay; it does not move.
    fn vertex_passed(&self, segment: usize, spot: &SurfacePoint) -> Option<(f64, f64)> {
        let Some(Standing::Faces(standing)) = &self.standing else { return None };
        let (end, _) = standing.beside(segment, &self.ray_before(spot).1)?;
        Some((end as f64, 0.0))
    }

    /// Edge and ray of a point in the accepted configuration.
    fn ray_before(&self, spot: &SurfacePoint) -> (Placed<'_>, Ray) {
        let placed = self.contact.placed(spot.edge, self.accepted);
        let Frame { x: origin, tangent, .. } = placed.frame(spot.xi);
        let (_, direction, _) = triad(tangent);
        (placed, Ray { origin, direction })
    }

    /// Where a point at `spot` met a segment in the accepted configuration, and how that moves along the segment per
    /// motion of the point: `(e_S.x' - u (e_R.T') / J) / (e_S.t)`.
    fn slide(&self, segment: usize, spot: &SurfacePoint) -> Option<(f64, f64)> {
        let faces = self.contact.target.as_faces()?;
        let (u, (placed, ray)) = (faces.values(segment, self.accepted), self.ray_before(spot));
        let hit = faces.meet(segment, &u, &ray, [0.5, 0.0])?;
        let Frame { slope, tangent, bend, .. } = placed.frame(spot.xi);
        let (along, inward, length) = triad(tangent);
        let t: Vec3 = faces.tangent(segment, hit.s[0], &u);
        Some((hit.s[0], (along.dot(slope) - hit.u * inward.dot(bend) / length) / along.dot(t)))
    }

    /// Friction stress at a place of an edge and its slope: the straight line nearest to the closed points of the edge,
    /// or the stress of the only one.
    fn shear_before(&self, spot: &SurfacePoint) -> [f64; 2] {
        let slots = self.contact.surface.points_of(spot.edge).map(|i| self.history.slot(i));
        let closed: Vec<[f64; 2]> =
            slots.filter(|old| old[entry::STATUS] > 0.0).map(|old| [old[entry::XI], old[entry::SHEAR]]).collect();
        let mean = |k: usize| closed.iter().map(|point| point[k]).sum::<f64>() / closed.len().max(1) as f64;
        let [xi, shear] = [mean(0), mean(1)];
        let spread: f64 = closed.iter().map(|point| (point[0] - xi).powi(2)).sum();
        let product: f64 = closed.iter().map(|point| (point[0] - xi) * (point[1] - shear)).sum();
        let slope = if spread > 0.0 { product / spread } else { 0.0 };
        [shear + slope * (spot.xi - xi), slope]
    }
}
