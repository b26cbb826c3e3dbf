//! What a contact point in space touched at the last accepted state: as in the plane, a point that the rule on a part of
//! its face has moved finds that in the accepted configuration. It is a function of the place, and its slope is part of the
//! tangent. The friction stress stays with the number of the point: a law integrates it along the slip of the increment,
//! and what it would answer to another one is not known as a derivative. A point over which the target came from the side
//! touched the place where the straight way to it, from what it touches now, leaves the target.

use super::open::OpenContact;
use super::placed::Placed;
use super::point::Triad;
use super::surface::SurfacePoint;
use super::target::{Cast, Memory, Standing};
use crate::contact::before::{AS_BEFORE, ENTERED, chosen, touched_segment};
use crate::contact::record::entry;
use crate::system::Stencil;
use crate::tensor::Vec3;
use crate::tool::Ray;
use crate::tool::space::Hit;

/// See the module.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Before {
    /// Segment and place on it that was touched.
    pub touched: Option<(usize, [f64; 2])>,
    /// `ds_b / d xi_a` at `[a][b]`: its motion over that segment per motion of the point over its face.
    pub sliding: [[f64; 2]; 2],
    /// Whether the target came over the point from the side.
    pub entered: bool,
}

/// A place on a segment, and `ds_b / d xi_a` at `[a][b]`.
type Slide = ([f64; 2], [[f64; 2]; 2]);

impl OpenContact<'_> {
    /// The stencil's choice of what a point at `spot` touched that now meets the target at `now`.
    pub(super) fn recall(&self, index: usize, (spot, now): (&SurfacePoint, &Hit), memory: &mut Memory) -> u32 {
        let (Some(Standing::Faces(standing)), old) = (&self.standing, self.history.slot(index)) else {
            return AS_BEFORE;
        };
        let stays = spot.scale == 1.0 && spot.xi == [old[entry::XI], old[entry::XI2]];
        if stays && old[entry::SEGMENT] >= 0.0 {
            return AS_BEFORE;
        }
        let (_, ray) = self.ray_before(spot);
        let cast = Cast { ray, ..self.contact.bounds(index, self.depths[index], self.reach) };
        let seen = if stays { None } else { standing.select(&cast, memory).map(|hit| hit.facet) };
        chosen(seen, || standing.last_towards(now.facet, [self.at_before((now.facet, now.s))?, ray.origin], &ray))
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
            return Before { touched, ..Before::default() };
        }
        let entered = stencil.also[2] & ENTERED > 0;
        let now = (stencil.choice as usize - 1, stencil.near);
        let found = if entered { self.border_passed(segment, spot, now) } else { self.slide(segment, spot) };
        let Some((s, sliding)) = found else { return Before::default() };
        Before { touched: Some((segment, s)), sliding, entered }
    }

    /// Where a material point of the target was in the accepted configuration.
    fn at_before(&self, (segment, s): (usize, [f64; 2])) -> Option<Vec3> {
        let faces = self.contact.parts.target.as_faces()?;
        Some(faces.point(segment, s, &faces.values(segment, self.accepted)))
    }

    /// Where the way from the material point `now` to a point at `spot` left a segment, and how that place moves.
    fn border_passed(&self, segment: usize, spot: &SurfacePoint, now: (usize, [f64; 2])) -> Option<Slide> {
        let Some(Standing::Faces(standing)) = &self.standing else { return None };
        let (origin, tangents) = self.ray_before(spot).0.at(spot.xi);
        let exit = standing.exit(segment, [self.at_before(now)?, origin])?;
        Some((exit.s, tangents.map(|g| exit.follow(g))))
    }

    /// Face and ray of a point in the accepted configuration.
    fn ray_before(&self, spot: &SurfacePoint) -> (Placed<'_>, Ray) {
        let placed = self.contact.placed(spot.face, self.accepted);
        let (origin, tangents) = placed.frame(spot.xi);
        (placed, Ray { origin, direction: Triad::new(tangents).inward })
    }

    /// Where a point at `spot` met a segment in the accepted configuration, and how that moves over the segment per
    /// motion of the point: `t_b ds_b = g_a dxi_a + u de_R` across the ray.
    fn slide(&self, segment: usize, spot: &SurfacePoint) -> Option<Slide> {
        let faces = self.contact.parts.target.as_faces()?;
        let (u, (placed, ray)) = (faces.values(segment, self.accepted), self.ray_before(spot));
        let hit = faces.meet(segment, &u, &ray, [0.5; 2])?;
        let [t, v] = faces.tangents(segment, hit.s, &u);
        let ((_, g), turning, e) = (placed.at(spot.xi), placed.normal_slopes(spot.xi), ray.direction);
        let span = t.cross(v).dot(e);
        let sliding = [0, 1].map(|a| {
            let to: Vec3 = g[a] + turning[a] * hit.u;
            [to.cross(v).dot(e) / span, t.cross(to).dot(e) / span]
        });
        Some((hit.s, sliding))
    }
}
