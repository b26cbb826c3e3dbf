//! Facets made of a segment of a profile in the plane: revolved about an axis or extruded along one. The profile has
//! the tool's material on its left, and so has the facet.
//!
//! *Extruded*: seen along the axis a ray is a ray of the plane, and the segment's own crossings are the answer.
//! *Revolved*: with `r` the distance from the axis, the carrier of a segment is the zero surface of a polynomial
//! `P(r, z) = E(r^2, z) + r O(z)` of second degree, a line, a circle or a parabola. Along a ray `z` is linear and `r^2`
//! quadratic in `u`, so that the hits are among the roots of the quartic `E^2 - r^2 O^2`: planes, cylinders, cones,
//! spheres, tori and paraboloids in one. Each root is then carried to the zero of `P` itself by Newton's method, which
//! restores the digits that squaring loses.

use crate::tensor::{BoundingBox, Vec3, roots};
use crate::tool::facet::{Meeting, ToolFacet};
use crate::tool::shapes::{Conic, ProfileRay, ProfileShape};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Axes of the plane in which a profile is drawn: x, y, and the axis of revolution or extrusion. They are of unit
/// length, at right angles and right-handed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProfileFrame {
    /// The profile's origin.
    pub origin: Vec3,
    /// The profile's x axis.
    pub x: Vec3,
    /// The profile's y axis.
    pub y: Vec3,
    /// Across the profile.
    pub z: Vec3,
}

impl ProfileFrame {
    /// With y along `y` and x anywhere across it: of a revolution the first meridian matters to nothing.
    ///
    /// # Errors
    /// In words, if `y` has no direction.
    pub fn about(origin: Vec3, y: Vec3) -> Result<Self, String> {
        let y = unit(y).ok_or("the axis has no direction")?;
        let z = Vec3::axis(y.least_axis()).cross(y).unit();
        Ok(Self { origin, x: y.cross(z), y, z })
    }
    /// With z along `z` and x along the part of `x` across it.
    ///
    /// # Errors
    /// In words, if they are parallel or one of them has no direction.
    pub fn across(origin: Vec3, z: Vec3, x: Vec3) -> Result<Self, String> {
        let z = unit(z).ok_or("the direction of extrusion has no length")?;
        let x = unit(x).ok_or("the profile's x axis has no direction")?;
        let x = x - z * z.dot(x);
        if x.norm() < 1e-6 {
            return Err("the profile's x axis is parallel to the direction of extrusion".into());
        }
        let x = x.unit();
        Ok(Self { origin, x, y: z.cross(x), z })
    }
    /// A point by its coordinates.
    pub(super) fn place(&self, p: Vec3) -> Vec3 {
        self.origin + self.turn(p)
    }
    pub(super) fn turn(&self, v: Vec3) -> Vec3 {
        self.x * v[0] + self.y * v[1] + self.z * v[2]
    }
    pub(super) fn coordinates(&self, v: Vec3) -> Vec3 {
        Vec3::new(self.x.dot(v), self.y.dot(v), self.z.dot(v))
    }
}

fn unit(v: Vec3) -> Option<Vec3> {
    (v.is_finite() && v.norm() > 0.0).then(|| v.unit())
}

/// A segment carried along an axis.
#[derive(Debug)]
pub struct Extruded {
    /// The segment.
    pub shape: Arc<dyn ProfileShape>,
    /// Its plane.
    pub frame: ProfileFrame,
    /// How far it is carried, a length.
    pub length: f64,
}

impl ToolFacet for Extruded {
    fn point(&self, [s, t]: [f64; 2]) -> Vec3 {
        self.frame.place(self.shape.point(s) + Vec3::new(0.0, 0.0, t * self.length))
    }
    fn tangents(&self, [s, _]: [f64; 2]) -> [Vec3; 2] {
        // Along a profile, with its material on the left, then along the axis: their product points to the right.
        [self.frame.turn(self.shape.tangent(s)), self.frame.z * self.length]
    }
    fn meet(&self, ray: &ProfileRay, found: &mut dyn FnMut(Meeting)) {
        let (origin, along) =
            (self.frame.coordinates(ray.origin - self.frame.origin), self.frame.coordinates(ray.direction));
        let flat = Vec3::new(along[0], along[1], 0.0);
        let speed = flat.norm();
        if speed <= 1e-14 {
            return;
        }
        let seen = ProfileRay { origin: Vec3::new(origin[0], origin[1], 0.0), direction: flat * speed.recip() };
        for place in self.shape.meet(&seen) {
            let u = place.u / speed;
            found(Meeting { u, s: [place.s, (origin[2] + u * along[2]) / self.length] });
        }
    }
    fn bounds(&self) -> BoundingBox {
        let BoundingBox { min, max } = self.shape.bounds();
        let depth = [0.0, self.length];
        let corner = |i: usize| {
            let pick = |bit: usize, axis: usize| if i >> bit & 1 == 0 { min[axis] } else { max[axis] };
            self.frame.place(Vec3::new(pick(0, 0), pick(1, 1), depth[i >> 2 & 1]))
        };
        BoundingBox::of((0..8).map(corner))
    }
    fn parts(&self, sagitta: f64) -> [usize; 2] {
        [self.shape.pieces(sagitta).clamp(1, 1024), 1]
    }
}

/// A segment revolved about the y axis of its plane, from x towards z.
#[derive(Debug)]
pub struct Revolved {
    shape: Arc<dyn ProfileShape>,
    frame: ProfileFrame,
    /// By which angle.
    turn: f64,
    conic: Conic,
    /// Middle of the facet on the axis and a radius that holds all of it.
    middle: f64,
    radius: f64,
}

impl Revolved {
    /// The segment's x is its distance from the axis; a turn is at most a whole one.
    pub fn new(shape: Arc<dyn ProfileShape>, frame: ProfileFrame, turn: f64) -> Self {
        let bounds = shape.bounds();
        let middle = 0.5 * (bounds.min[1] + bounds.max[1]);
        let radius = bounds.max[0].hypot(0.5 * (bounds.max[1] - bounds.min[1]));
        Self { conic: shape.conic(), shape, frame, turn, middle, radius }
    }
    pub(super) fn shape(&self) -> &dyn ProfileShape {
        &*self.shape
    }
    pub(super) fn frame(&self) -> &ProfileFrame {
        &self.frame
    }
    pub(super) fn radius(&self) -> f64 {
        self.radius
    }
    /// The frame's x, z turned by the angle: the direction away from the axis, and that of a growing angle.
    pub(super) fn meridian(&self, t: f64) -> (Vec3, Vec3) {
        // From x to z, so that the normal is to the right of the profile.
        let (sin, cos) = (t * self.turn).sin_cos();
        (self.frame.x * cos + self.frame.z * sin, self.frame.z * cos - self.frame.x * sin)
    }
    /// Coordinate around the axis of a point of the frame: of those a whole turn apart that nearest to the facet's middle.
    pub(super) fn around(&self, x: Vec3) -> f64 {
        let from_middle = x[2].atan2(x[0]) - 0.5 * self.turn;
        0.5 + ((from_middle + PI).rem_euclid(TAU) - PI) / self.turn
    }
    /// Whether it comes back to where it begins.
    pub(super) fn is_whole(&self) -> bool {
        self.turn >= TAU
    }
    /// Coordinate along the segment of a point of the carrier.
    fn along(&self, p: Vec3, gradient: Vec3) -> f64 {
        let places = self.shape.meet(&ProfileRay { origin: p, direction: gradient.unit() });
        let nearer = |best: (f64, f64), u: f64, s: f64| if u.abs() < best.0 { (u.abs(), s) } else { best };
        places.iter().filter(|p| p.u.is_finite()).fold((f64::INFINITY, f64::NAN), |best, p| nearer(best, p.u, p.s)).1
    }
}

/// A ray seen in the half-plane of the profile: `z` is linear along it and `r^2` quadratic.
struct MeridianRay {
    z: [f64; 2],
    r2: [f64; 3],
}

impl MeridianRay {
    fn at(&self, u: f64) -> Vec3 {
        let r2 = (self.r2[0] + u * (self.r2[1] + u * self.r2[2])).max(0.0);
        Vec3::new(r2.sqrt(), self.z[0] + u * self.z[1], 0.0)
    }
    /// `dr/du` where `r` is not zero.
    fn slope(&self, u: f64, r: f64) -> Vec3 {
        Vec3::new((0.5 * self.r2[1] + u * self.r2[2]) / r, self.z[1], 0.0)
    }
    /// `E` and `O` as polynomials of `u`.
    fn parts(&self, conic: &Conic) -> ([f64; 3], [f64; 2]) {
        let ([a, b, c, d, e, f], [r0, z0, _]) = (conic.c, conic.origin.0);
        let z = [self.z[0] - z0, self.z[1]];
        let odd = [b * z[0] + d - 2.0 * a * r0, b * z[1]];
        let shift = e - b * r0;
        let even = [
            a * (self.r2[0] + r0 * r0) + c * z[0] * z[0] + shift * z[0] - d * r0 + f,
            a * self.r2[1] + 2.0 * c * z[0] * z[1] + shift * z[1],
            a * self.r2[2] + c * z[1] * z[1],
        ];
        (even, odd)
    }
}

/// `E^2 - r^2 O^2`, or `E` where `r O` is too small to tell the two sheets apart.
fn quartic(even: [f64; 3], odd: [f64; 2], r2: [f64; 3]) -> [f64; 5] {
    let size = |c: &[f64]| c.iter().map(|c| c.abs()).sum::<f64>();
    if size(&odd) * size(&r2).sqrt() <= 1e-6 * size(&even) {
        return [even[0], even[1], even[2], 0.0, 0.0];
    }
    let mut c = [0.0; 5];
    for i in 0..3 {
        (0..3).for_each(|j| c[i + j] += even[i] * even[j]);
    }
    let square = [odd[0] * odd[0], 2.0 * odd[0] * odd[1], odd[1] * odd[1]];
    for i in 0..3 {
        (0..3).for_each(|j| c[i + j] -= r2[i] * square[j]);
    }
    c
}

/// Roots are looked for this far beyond the facet, as a multiple of its size.
const BEYOND: f64 = 1.5;
/// A root of the quartic that is none of `P` stays farther from it than this part of the size.
const OFF: f64 = 1e-7;

impl ToolFacet for Revolved {
    fn point(&self, [s, t]: [f64; 2]) -> Vec3 {
        let (p, (out, _)) = (self.shape.point(s), self.meridian(t));
        self.frame.origin + out * p[0] + self.frame.y * p[1]
    }
    fn tangents(&self, [s, t]: [f64; 2]) -> [Vec3; 2] {
        let (p, d, (out, around)) = (self.shape.point(s), self.shape.tangent(s), self.meridian(t));
        [out * d[0] + self.frame.y * d[1], around * (self.turn * p[0])]
    }
    fn normal(&self, [s, t]: [f64; 2]) -> Vec3 {
        let (n, (out, _)) = (-self.shape.tangent(s).left().unit(), self.meridian(t));
        out * n[0] + self.frame.y * n[1]
    }
    fn meet(&self, ray: &ProfileRay, found: &mut dyn FnMut(Meeting)) {
        let frame = &self.frame;
        let e = frame.coordinates(ray.direction);
        let to = frame.coordinates(ray.origin - frame.origin) - Vec3::new(0.0, self.middle, 0.0);
        // From the point of the ray nearest to the middle, in units of the facet's size.
        let (shift, size) = (-to.dot(e), self.radius);
        let near = to + e * shift;
        if near.norm() > BEYOND * size {
            return;
        }
        let seen = MeridianRay {
            z: [near[1] + self.middle, size * e[1]],
            r2: [
                near[0] * near[0] + near[2] * near[2],
                2.0 * size * (near[0] * e[0] + near[2] * e[2]),
                size * size * (e[0] * e[0] + e[2] * e[2]),
            ],
        };
        let (even, odd) = seen.parts(&self.conic);
        for &v in roots(quartic(even, odd, seen.r2), [-BEYOND, BEYOND]).as_slice() {
            if let Some((v, p, gradient)) = self.polish(&seen, v) {
                let (x, u) = (near + e * (size * v), shift + size * v);
                found(Meeting { u, s: [self.along(p, gradient), self.around(x)] });
            }
        }
    }
    fn bounds(&self) -> BoundingBox {
        let BoundingBox { min, max } = self.shape.bounds();
        if self.turn < 0.9 * PI {
            // An arc lies within the triangle of its ends and the point in which its tangents there meet.
            let corner = |t: f64, r: f64| self.meridian(t).0 * r;
            let far = max[0] / (0.5 * self.turn).cos();
            let around = [(0.0, min[0]), (1.0, min[0]), (0.0, max[0]), (0.5, far), (1.0, max[0])];
            let at = |z: f64| around.map(|(t, r)| self.frame.origin + corner(t, r) + self.frame.y * z);
            return BoundingBox::of([min[1], max[1]].into_iter().flat_map(at));
        }
        // A circle about y reaches r sqrt(1 - y_i^2) along axis i.
        let reach = Vec3(self.frame.y.0.map(|y| max[0].max(0.0) * (1.0 - y * y).max(0.0).sqrt()));
        let ends = [min[1], max[1]].map(|z| self.frame.origin + self.frame.y * z);
        BoundingBox::of(ends.into_iter().flat_map(|end| [end - reach, end + reach]))
    }
    fn parts(&self, sagitta: f64) -> [usize; 2] {
        let radius = self.shape.bounds().max[0];
        let half = (1.0 - (sagitta / radius).min(0.5)).acos();
        let around = (0.5 * self.turn / half).ceil().clamp((8.0 * self.turn / TAU).ceil(), 512.0) as usize;
        [self.shape.pieces(sagitta).clamp(1, 1024), around]
    }
    fn holds(&self, s: [f64; 2], beyond: f64) -> bool {
        let within = |s: f64| (-beyond..=1.0 + beyond).contains(&s);
        within(s[0]) && (self.is_whole() || within(s[1]))
    }
}

impl Revolved {
    /// From a root of the quartic to the zero of `P` beside it: there, the place in the half-plane, and the gradient.
    /// None for a root that only squaring made.
    fn polish(&self, seen: &MeridianRay, mut v: f64) -> Option<(f64, Vec3, Vec3)> {
        for _ in 0..4 {
            let p = seen.at(v);
            let (value, gradient) = self.conic.at(p);
            let slope = gradient.dot(seen.slope(v, p[0]));
            let step = value / slope;
            if !step.is_finite() || step.abs() > 1e-3 {
                break;
            }
            v -= step;
        }
        let p = seen.at(v);
        let (value, gradient) = self.conic.at(p);
        (value.abs() <= OFF * self.radius * gradient.norm()).then_some((v, p, gradient))
    }
}
