//! The point of a facet that is closest to another, in the tool's own frame.
//!
//! Profiles answer in their own plane: extruded ones at the same height, revolved ones on the same meridian. Polygons
//! answer inside by projection, beyond by their straight edges.

use super::polygons::{Quad, Triangle};
use super::swept::{Extruded, Revolved};
use crate::tensor::Vec3;
use crate::tool::facet::ToolFacet;
use crate::tool::shapes::ProfileShape;

/// The closest point of a facet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FacetPoint {
    /// The point.
    pub point: Vec3,
    /// Outward unit normal of the facet there.
    pub normal: Vec3,
    /// Principal directions and curvatures there, positive where normals spread: `dn = sum k e (e . dx)`.
    pub bends: [(Vec3, f64); 2],
    /// Whether the facet ends there, before the other point.
    pub border: FacetBorder,
}

/// Where on its facet a closest point lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FacetBorder {
    /// Inside: the other point lies along the normal.
    Inside,
    /// On an edge, with its unit tangent, and `q = k . v`, its curvature vector (towards the outside) times the way to
    /// the other point: zero for straight edges.
    Edge(Vec3, f64),
    /// In a corner.
    Corner,
}

/// A facet that tells its closest point.
pub trait RigidFacet: ToolFacet {
    /// The point closest to `x`.
    fn nearest(&self, x: Vec3) -> FacetPoint;
}

/// A part of the size of a facet by which a point must lie beyond an edge to count as beyond it.
const PAST: f64 = 1e-12;

/// The closest point of straight edges, with the edge's tangent unless it is one of their ends.
fn on_edges(corners: &[Vec3], x: Vec3) -> (Vec3, FacetBorder) {
    let (mut best, mut least) = ((x, FacetBorder::Corner), f64::INFINITY);
    for (k, &a) in corners.iter().enumerate() {
        let along = corners[(k + 1) % corners.len()] - a;
        let s = (along.dot(x - a) / along.dot(along)).clamp(0.0, 1.0);
        let point = a + along * s;
        let distance = (x - point).norm();
        if distance < least {
            let border = if s > 0.0 && s < 1.0 { FacetBorder::Edge(along.unit(), 0.0) } else { FacetBorder::Corner };
            (best, least) = ((point, border), distance);
        }
    }
    best
}

/// The closest point of a flat polygon with this unit normal, `along` one of its directions.
fn on_flat(corners: &[Vec3], normal: Vec3, along: Vec3, x: Vec3) -> FacetPoint {
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    let inside = edges.into_iter().all(|(&a, &b)| (b - a).cross(x - a).dot(normal) >= 0.0);
    let above = || (x - normal * normal.dot(x - corners[0]), FacetBorder::Inside);
    let (point, border) = if inside { above() } else { on_edges(corners, x) };
    FacetPoint { point, normal, bends: [(along, 0.0), (normal.cross(along), 0.0)], border }
}

impl RigidFacet for Triangle {
    fn nearest(&self, x: Vec3) -> FacetPoint {
        let [p, q] = self.tangents([0.0; 2]);
        on_flat(&self.0, p.cross(q).unit(), p.unit(), x)
    }
}

/// Iterations on a twisted quadrilateral.
const ITERATIONS: usize = 30;
/// They end with a step of this part of its sides: they are quadratic, and what is left is its square.
const CLOSE: f64 = 1e-11;
/// A quadrilateral whose twist leaves its plane by no more than this part of its diagonals is flat.
const FLAT: f64 = 1e-14;

impl RigidFacet for Quad {
    fn nearest(&self, x: Vec3) -> FacetPoint {
        let [a, b, c, d] = self.0;
        let twist = (a - b) + (c - d);
        let (one, other) = (c - a, d - b);
        let normal = one.cross(other).unit();
        if normal.dot(twist).abs() <= FLAT * (one.norm() + other.norm()) {
            return on_flat(&self.0, normal, (b - a + (c - d)).unit(), x);
        }
        let mut s = [0.5; 2];
        for _ in 0..ITERATIONS {
            let ([p, q], to) = (self.tangents(s), x - self.point(s));
            // Newton's method on (x - point) . tangents = 0.
            let [e, f, g] = [p.dot(p), p.dot(q) - twist.dot(to), q.dot(q)];
            let [r, t] = [p.dot(to), q.dot(to)];
            let det = e * g - f * f;
            let step = [(g * r - f * t) / det, (e * t - f * r) / det];
            if !step.iter().all(|step| step.is_finite()) {
                break;
            }
            (0..2).for_each(|i| s[i] += step[i].clamp(-0.5, 0.5));
            if step.iter().all(|step| step.abs() < CLOSE) {
                break;
            }
        }
        if s.iter().all(|s| (0.0..=1.0).contains(s)) {
            let [p, q] = self.tangents(s);
            let normal = p.cross(q).unit();
            let bends = principal([p, q], [0.0, normal.dot(twist), 0.0], normal);
            return FacetPoint { point: self.point(s), normal, bends, border: FacetBorder::Inside };
        }
        let (point, border) = on_edges(&self.0, x);
        let [along, across] = self.tangents(s.map(|s| s.clamp(0.0, 1.0)));
        let normal = along.cross(across).unit();
        FacetPoint { point, normal, bends: [(along.unit(), 0.0), (normal.cross(along.unit()), 0.0)], border }
    }
}

/// Principal directions and curvatures of a surface with tangents `a`, `b`, unit normal `n` and second fundamental form
/// `n . x_aa`, `n . x_ab`, `n . x_bb`.
fn principal([a, b]: [Vec3; 2], [l, m, n]: [f64; 3], normal: Vec3) -> [(Vec3, f64); 2] {
    let e = [a.unit(), normal.cross(a.unit())];
    let (size, b) = (a.norm(), e.map(|e| e.dot(b)));
    // In the orthonormal basis; normals spread where the surface bends away from its normal.
    let xx = -l / (size * size);
    let xy = (-m / size - b[0] * xx) / b[1];
    let yy = (-n + 2.0 * b[0] * m / size - b[0] * b[0] * xx) / (b[1] * b[1]);
    let (sin, cos) = (0.5 * (2.0 * xy).atan2(xx - yy)).sin_cos();
    let along = |c: f64, s: f64| (e[0] * c + e[1] * s, xx * c * c + 2.0 * xy * c * s + yy * s * s);
    [along(cos, sin), along(-sin, cos)]
}

/// The closest point of a segment of a profile that is carried across its plane, to a place that is at `flat` in that: `turn` and `place`
/// put directions and points of the plane in space, `across` is the way it is carried with whether that ends before the place, and
/// `round` the curvature along that with the edge's `q`, none on an axis.
fn on_carried(
    (shape, flat): (&dyn ProfileShape, Vec3),
    (turn, place): (impl Fn(Vec3) -> Vec3, impl Fn(Vec3) -> Vec3),
    (across, over): (Vec3, bool),
    round: impl Fn(Vec3, Vec3) -> Option<(f64, f64)>,
) -> FacetPoint {
    let s = shape.closest(flat);
    let (point, tangent, bend) = (shape.point(s), shape.tangent(s).unit(), shape.curvature(s));
    let (normal, aside) = (-tangent.left(), tangent.dot(flat - point));
    let past = (s <= PAST && aside < -PAST * shape.length()) || (s >= 1.0 - PAST && aside > PAST * shape.length());
    let (along, round) = (turn(tangent), round(point, normal));
    let border = match (past, over, round) {
        (false, false, _) => FacetBorder::Inside,
        (true, false, Some((_, q))) => FacetBorder::Edge(across, q),
        (false, true, _) => FacetBorder::Edge(along, bend * normal.dot(flat - point)),
        _ => FacetBorder::Corner,
    };
    let bends = [(along, bend), (across, round.map_or(bend, |(around, _)| around))];
    FacetPoint { point: place(point), normal: turn(normal), bends, border }
}

impl RigidFacet for Extruded {
    fn nearest(&self, x: Vec3) -> FacetPoint {
        let frame = &self.frame;
        let [a, b, z] = frame.coordinates(x - frame.origin).0;
        let height = z.clamp(0.0, self.length);
        let over = (z - height).abs() > PAST * self.length;
        let place = |p: Vec3| frame.place(p + Vec3::new(0.0, 0.0, height));
        let flat = Vec3::new(a, b, 0.0);
        on_carried((&*self.shape, flat), (|v| frame.turn(v), place), (frame.z, over), |_, _| Some((0.0, 0.0)))
    }
}

/// Radii below this part of the facet's size are on the axis.
const ON_AXIS: f64 = 1e-9;

impl RigidFacet for Revolved {
    fn nearest(&self, x: Vec3) -> FacetPoint {
        let frame = self.frame();
        let at = frame.coordinates(x - frame.origin);
        let (t, radius) = (self.around(at), at[0].hypot(at[2]));
        let over = !self.is_whole() && !(-PAST..=1.0 + PAST).contains(&t);
        // Beyond its ends the closest point lies on the last meridian, in whose plane x may lie behind the axis.
        let (out, radius) = if over || radius == 0.0 {
            let out = self.meridian(t.clamp(0.0, 1.0)).0;
            (out, out.dot(x - frame.origin))
        } else {
            ((frame.x * at[0] + frame.z * at[2]) * radius.recip(), radius)
        };
        let turn = |v: Vec3| out * v[0] + frame.y * v[1];
        let flat = Vec3::new(radius, at[1], 0.0);
        let off_axis = |p: Vec3| p[0] > ON_AXIS * self.radius();
        let round = |p: Vec3, n: Vec3| off_axis(p).then(|| (n[0] / p[0], radius / p[0] - 1.0));
        on_carried((self.shape(), flat), (turn, |p| frame.origin + turn(p)), (out.cross(frame.y), over), round)
    }
}
