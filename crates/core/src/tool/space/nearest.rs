//! The point of a facet that is closest to another, in the tool's own frame.
//!
//! Profiles answer in their own plane: extruded ones at the same height, revolved ones on the same meridian. Polygons
//! answer inside by projection, beyond by their straight edges.

use super::facet::ToolFacet;
use super::polygons::{Quad, Triangle};
use super::swept::{Extruded, Revolved};
use crate::tensor::Vec3;
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

impl RigidFacet for Triangle {
    fn nearest(&self, x: Vec3) -> FacetPoint {
        let [a, b, c] = self.0;
        let ([p, q], to) = ([b - a, c - a], x - a);
        let m = p.cross(q);
        let normal = m.unit();
        let size = m.dot(m).recip();
        let s = [to.cross(q).dot(m) * size, p.cross(to).dot(m) * size];
        let (point, border) =
            if self.holds(s, 0.0) { (x - normal * normal.dot(to), FacetBorder::Inside) } else { on_edges(&self.0, x) };
        FacetPoint { point, normal, bends: [(p.unit(), 0.0), (normal.cross(p.unit()), 0.0)], border }
    }
}

/// Iterations on a twisted quadrilateral.
const ITERATIONS: usize = 30;
/// They end with a step of this part of its sides: they are quadratic, and what is left is its square.
const CLOSE: f64 = 1e-11;
/// A quadrilateral whose twist leaves its plane by no more than this part of its diagonals is flat.
const FLAT: f64 = 1e-14;

impl Quad {
    /// The closest point of a quadrilateral in a plane with this unit normal: by its straight edges.
    fn nearest_flat(&self, x: Vec3, normal: Vec3) -> FacetPoint {
        let [a, b, c, d] = self.0;
        let left = |from: Vec3, to: Vec3| (to - from).cross(x - from).dot(normal) >= 0.0;
        let (point, border) = if left(a, b) && left(b, c) && left(c, d) && left(d, a) {
            (x - normal * normal.dot(x - a), FacetBorder::Inside)
        } else {
            on_edges(&self.0, x)
        };
        let along = (b - a + (c - d)).unit();
        FacetPoint { point, normal, bends: [(along, 0.0), (normal.cross(along), 0.0)], border }
    }
}

impl RigidFacet for Quad {
    fn nearest(&self, x: Vec3) -> FacetPoint {
        let [a, b, c, d] = self.0;
        let twist = (a - b) + (c - d);
        let (one, other) = (c - a, d - b);
        let normal = one.cross(other).unit();
        if normal.dot(twist).abs() <= FLAT * (one.norm() + other.norm()) {
            return self.nearest_flat(x, normal);
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

/// The closest point of a segment to `p`: its coordinate, place, unit tangent, outward normal and whether the segment ends
/// there before `p`.
fn on_profile(shape: &dyn ProfileShape, p: Vec3) -> (f64, Vec3, Vec3, Vec3, bool) {
    let s = shape.closest(p);
    let (point, tangent) = (shape.point(s), shape.tangent(s).unit());
    let aside = tangent.dot(p - point);
    let past = (s <= PAST && aside < -PAST * shape.length()) || (s >= 1.0 - PAST && aside > PAST * shape.length());
    (s, point, tangent, -tangent.left(), past)
}

impl RigidFacet for Extruded {
    fn nearest(&self, x: Vec3) -> FacetPoint {
        let frame = &self.frame;
        let at = frame.coordinates(x - frame.origin);
        let flat = Vec3::new(at[0], at[1], 0.0);
        let (s, point, tangent, normal, past) = on_profile(&*self.shape, flat);
        let height = at[2].clamp(0.0, self.length);
        let over = (at[2] - height).abs() > PAST * self.length;
        let (along, bend) = (frame.turn(tangent), self.shape.curvature(s));
        let border = match (past, over) {
            (false, false) => FacetBorder::Inside,
            (true, false) => FacetBorder::Edge(frame.z, 0.0),
            (false, true) => FacetBorder::Edge(along, bend * normal.dot(flat - point)),
            (true, true) => FacetBorder::Corner,
        };
        FacetPoint {
            point: frame.place(point + Vec3::new(0.0, 0.0, height)),
            normal: frame.turn(normal),
            bends: [(along, bend), (frame.z, 0.0)],
            border,
        }
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
        let around = out.cross(frame.y);
        let flat = Vec3::new(radius, at[1], 0.0);
        let (s, p, tangent, n, past) = on_profile(self.shape(), flat);
        let turn = |v: Vec3| out * v[0] + frame.y * v[1];
        let bend = self.shape().curvature(s);
        let tip = p[0] <= ON_AXIS * self.radius();
        let border = match (past, tip, over) {
            (false, _, false) => FacetBorder::Inside,
            (true, false, false) => FacetBorder::Edge(around, radius / p[0] - 1.0),
            (false, _, true) => FacetBorder::Edge(turn(tangent), bend * n.dot(flat - p)),
            _ => FacetBorder::Corner,
        };
        FacetPoint {
            point: frame.origin + turn(p),
            normal: turn(n),
            bends: [(turn(tangent), bend), (around, if tip { bend } else { n[0] / p[0] })],
            border,
        }
    }
}
