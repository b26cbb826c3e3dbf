//! The parabola through three nodes, the middle one at half its coordinate.
//!
//! About the middle node, with `w = s - 1/2`: `x = m + b1 w + b2 w^2`, `b1 = c - a`, `b2 = 2 (a - m) + 2 (c - m)`.
//! A ray meets it where `(e x b2) w^2 + (e x b1) w + e x (m - o) = 0`; `b2 = 0` leaves the straight line.

use super::{Conic, ProfileRay, ProfileShape, RayCrossing, ShapeKind, turn};
use crate::tensor::{BoundingBox, Vec3, integral, quadratic};

pub(super) static KIND: ShapeKind = ShapeKind {
    key: "parabola",
    meaning: "parabola through three nodes: end, middle, end",
    nodes: 3,
    build: |nodes| Box::new(Parabola { nodes: [nodes[0], nodes[1], nodes[2]] }),
};

/// The curve; see the equations above.
#[derive(Debug, Clone, Copy)]
pub struct Parabola {
    /// First end, middle, last end.
    pub nodes: [Vec3; 3],
}

impl Parabola {
    fn b1(&self) -> Vec3 {
        self.nodes[2] - self.nodes[0]
    }
    fn b2(&self) -> Vec3 {
        ((self.nodes[0] - self.nodes[1]) + (self.nodes[2] - self.nodes[1])) * 2.0
    }
    /// The smallest length of `dx/ds` over the segment: the hodograph is a straight line run through once.
    fn slowest(&self) -> f64 {
        let (b1, b2) = (self.b1(), self.b2());
        let nearest = (-0.5 * b1.dot(b2) / b2.dot(b2)).clamp(-0.5, 0.5);
        self.tangent(0.5 + if nearest.is_nan() { 0.0 } else { nearest }).norm()
    }
}

impl ProfileShape for Parabola {
    fn kind(&self) -> &'static ShapeKind {
        &KIND
    }
    fn nodes(&self) -> &[Vec3] {
        &self.nodes
    }
    fn point(&self, s: f64) -> Vec3 {
        let w = s - 0.5;
        match s {
            0.0 => self.nodes[0],
            1.0 => self.nodes[2],
            _ => self.nodes[1] + (self.b1() + self.b2() * w) * w,
        }
    }
    fn tangent(&self, s: f64) -> Vec3 {
        self.b1() + self.b2() * (2.0 * (s - 0.5))
    }
    fn meet(&self, ray: &ProfileRay) -> [RayCrossing; 2] {
        let e = ray.direction;
        let roots = quadratic(turn(e, self.b2()), turn(e, self.b1()), turn(e, self.nodes[1] - ray.origin));
        roots.map(|w| {
            let x = self.nodes[1] + (self.b1() + self.b2() * w) * w;
            RayCrossing { u: (x - ray.origin).dot(e), s: 0.5 + w }
        })
    }
    fn conic(&self) -> Conic {
        // With d = b2 / |b2|: |b2| (d x q)^2 = (b1 x d) (b1 x q).
        let (b1, size) = (self.b1(), self.b2().norm());
        let d = self.b2() * size.recip();
        let span = turn(b1, d);
        // Nodes on a straight line, however they are spaced.
        if size == 0.0 || span.abs() <= 1e-12 * b1.norm() {
            return Conic::straight(self.nodes[1], b1);
        }
        let squares = [d[1] * d[1], -2.0 * d[0] * d[1], d[0] * d[0]].map(|c| c * size);
        let [x2, xy, y2] = squares;
        Conic { origin: self.nodes[1], c: [x2, xy, y2, span * b1[1], -span * b1[0], 0.0] }
    }
    fn bounds(&self) -> BoundingBox {
        let (b1, b2) = (self.b1(), self.b2());
        let turning = |axis: usize| Some(-0.5 * b1[axis] / b2[axis]).filter(|w| w.abs() < 0.5);
        let extremes = [0, 1].into_iter().filter_map(turning).map(|w| self.point(0.5 + w));
        BoundingBox::of(extremes.chain([self.nodes[0], self.nodes[2]]))
    }
    fn length(&self) -> f64 {
        integral(&|s| self.tangent(s).norm(), [0.0, 1.0])
    }
    fn curvature(&self, s: f64) -> f64 {
        let tangent = self.tangent(s);
        2.0 * turn(tangent, self.b2()) / tangent.norm().powi(3)
    }
    fn closest(&self, x: Vec3) -> f64 {
        let off = |s: f64| (self.point(s) - x).dot(self.point(s) - x);
        let places = (0..=8).map(|k| f64::from(k) / 8.0);
        let mut s = places.fold(0.0, |best, s| if off(s) < off(best) { s } else { best });
        // Newton's method on (p - x) . p' = 0 from the nearest of nine.
        for _ in 0..30 {
            let (to, tangent) = (self.point(s) - x, self.tangent(s));
            let slope = tangent.dot(tangent) + 2.0 * to.dot(self.b2());
            let step = if slope > 0.0 { -to.dot(tangent) / slope } else { -to.dot(tangent).signum() * 0.05 };
            let next = (s + step).clamp(0.0, 1.0);
            if (next - s).abs() < 1e-16 {
                break;
            }
            s = next;
        }
        s
    }
    fn pieces(&self, sagitta: f64) -> usize {
        // A chord over dw leaves the parabola by at most |b2| dw^2 / 4.
        (self.b2().norm() / (4.0 * sagitta)).sqrt().ceil() as usize
    }
    fn flaw(&self) -> Option<String> {
        let legs = (self.nodes[1] - self.nodes[0]).norm() + (self.nodes[2] - self.nodes[1]).norm();
        (self.slowest() <= 1e-6 * legs)
            .then(|| "turns back on itself: its middle node must lie well between its ends".to_owned())
    }
}
