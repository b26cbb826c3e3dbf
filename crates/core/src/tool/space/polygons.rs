//! Facets with straight edges: the triangle and the bilinear quadrilateral, outward by the right-hand rule.
//!
//! Triangle: `x = a + s0 (b - a) + s1 (c - a)`; a ray meets its plane as Moeller and Trumbore (1997) solve it.
//! Quadrilateral `a b c d`: `x = a + s0 p + s1 q + s0 s1 r` with `p = b - a`, `q = d - a`, `r = a - b + c - d`. Crossed
//! with the ray's direction `e`, `x = o + u e` loses `u`; eliminating `s0` leaves a quadratic in `s1`.

use crate::tensor::{BoundingBox, Vec3, quadratic};
use crate::tool::facet::{Meeting, ToolFacet};
use crate::tool::shapes::ProfileRay;

/// Three corners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triangle(pub [Vec3; 3]);

impl ToolFacet for Triangle {
    fn point(&self, [s, t]: [f64; 2]) -> Vec3 {
        let [a, b, c] = self.0;
        a + (b - a) * s + (c - a) * t
    }
    fn tangents(&self, _: [f64; 2]) -> [Vec3; 2] {
        let [a, b, c] = self.0;
        [b - a, c - a]
    }
    fn meet(&self, ray: &ProfileRay, found: &mut dyn FnMut(Meeting)) {
        let ([p, q], to) = (self.tangents([0.0; 2]), ray.origin - self.0[0]);
        let h = ray.direction.cross(q);
        let k = to.cross(p);
        let span = p.dot(h);
        let s = [to.dot(h) / span, ray.direction.dot(k) / span];
        found(Meeting { u: q.dot(k) / span, s });
    }
    fn bounds(&self) -> BoundingBox {
        BoundingBox::of(self.0)
    }
    fn parts(&self, _: f64) -> [usize; 2] {
        [1, 1]
    }
    fn corners(&self) -> &[Vec3] {
        &self.0
    }
    fn holds(&self, [s, t]: [f64; 2], beyond: f64) -> bool {
        s >= -beyond && t >= -beyond && s + t <= 1.0 + beyond
    }
}

/// Four corners, which need not lie in a plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quad(pub [Vec3; 4]);

impl Quad {
    fn twist(&self) -> Vec3 {
        let [a, b, c, d] = self.0;
        (a - b) + (c - d)
    }
}

impl ToolFacet for Quad {
    fn point(&self, [s, t]: [f64; 2]) -> Vec3 {
        let [a, b, _, d] = self.0;
        a + (b - a) * s + (d - a) * t + self.twist() * (s * t)
    }
    fn tangents(&self, [s, t]: [f64; 2]) -> [Vec3; 2] {
        let ([a, b, _, d], r) = (self.0, self.twist());
        [b - a + r * t, d - a + r * s]
    }
    fn meet(&self, ray: &ProfileRay, found: &mut dyn FnMut(Meeting)) {
        let ([a, b, _, d], e) = (self.0, ray.direction);
        // Two directions across the ray.
        let v = e.cross(Vec3::axis(e.least_axis())).unit();
        let w = e.cross(v);
        let across = |x: Vec3| (x.dot(v), x.dot(w));
        let (o, p, q, r) = (across(a - ray.origin), across(b - a), across(d - a), across(self.twist()));
        let turn = |x: (f64, f64), y: (f64, f64)| x.0 * y.1 - x.1 * y.0;
        // (o + t q) x (p + t r) = 0.
        let roots = quadratic(turn(q, r), turn(o, r) + turn(q, p), turn(o, p));
        for t in roots.into_iter().filter(|t| t.is_finite()) {
            let (left, right) = ((o.0 + t * q.0, o.1 + t * q.1), (p.0 + t * r.0, p.1 + t * r.1));
            let s = -(left.0 * right.0 + left.1 * right.1) / (right.0 * right.0 + right.1 * right.1);
            found(Meeting { u: (self.point([s, t]) - ray.origin).dot(e), s: [s, t] });
        }
    }
    fn bounds(&self) -> BoundingBox {
        BoundingBox::of(self.0)
    }
    fn parts(&self, sagitta: f64) -> [usize; 2] {
        // Half of the twist over a part of the whole square leaves it by a quarter of that part's twist.
        let n = (0.25 * self.twist().norm() / sagitta).sqrt().ceil().clamp(1.0, 64.0) as usize;
        [n, n]
    }
    fn corners(&self) -> &[Vec3] {
        &self.0
    }
}
