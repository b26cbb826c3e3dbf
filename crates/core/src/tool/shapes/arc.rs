//! The circle arc through three nodes, from the first over the second to the third.
//!
//! With `c` the chord and `t`, `n` its unit direction and left normal, the arc turns by
//! `theta = 2 angle(m - a, b - m)` (the exterior angle at any point of an arc is half of what it turns) and has the
//! curvature `k = 2 sin(theta / 2) / c`, both positive for a left turn. All is written about the apex, where the
//! tangent is `t`, and in `k`, never in the radius: `x = apex + (t sin phi + n (1 - cos phi)) / k`,
//! `phi = (s - 1/2) theta`. A point of the circle has `k |q|^2 / 2 = q . n`, `q = x - apex`. An arc of nearly straight
//! nodes thus passes into the line without loss, and `theta = 0` is the line.

use super::{Conic, ProfileRay, ProfileShape, RayCrossing, ShapeKind, angle};
use crate::tensor::{BoundingBox, Vec3, quadratic};
use std::f64::consts::PI;

pub(super) static KIND: ShapeKind = ShapeKind {
    key: "arc",
    meaning: "circle arc through three nodes: end, any point between, end",
    nodes: 3,
    build: |nodes| Box::new(Arc::new([nodes[0], nodes[1], nodes[2]])),
};

/// A middle node nearer to an end than this part of the chord says nothing of the circle.
const SHORTEST: f64 = 1e-6;
/// Above this turn the ends say too little of the circle.
const LARGEST_TURN: f64 = 350.0 * PI / 180.0;

#[derive(Debug)]
struct Arc {
    nodes: [Vec3; 3],
    /// Unit direction of the chord.
    t: Vec3,
    chord: f64,
    theta: f64,
    apex: Vec3,
}

impl Arc {
    fn new(nodes: [Vec3; 3]) -> Self {
        let [from, middle, to] = nodes;
        let (first, second) = (middle - from, to - middle);
        let theta = 2.0 * angle(first, second);
        let chord = (to - from).norm();
        let t = (to - from) * (1.0 / chord);
        let apex = (from + to) * 0.5 - t.left() * (0.5 * chord * (0.25 * theta).tan());
        Self { nodes, t, chord, theta, apex }
    }
    fn turning(&self) -> f64 {
        2.0 * (0.5 * self.theta).sin() / self.chord
    }
    /// Direction of travel where the arc has turned by `phi` from its apex.
    fn direction(&self, phi: f64) -> Vec3 {
        self.t * phi.cos() + self.t.left() * phi.sin()
    }
    /// The point there, seen from the apex.
    fn offset(&self, s: f64) -> Vec3 {
        let phi = (s - 0.5) * self.theta;
        if self.theta == 0.0 {
            return self.t * ((s - 0.5) * self.chord);
        }
        let (along, scale) = (phi.sin(), 0.5 * self.chord / (0.5 * self.theta).sin());
        let aside = 2.0 * (0.5 * phi).sin().powi(2);
        (self.t * along + self.t.left() * aside) * scale
    }
    /// Coordinate of a point of the circle, seen from the apex.
    fn coordinate(&self, q: Vec3) -> f64 {
        if self.theta == 0.0 {
            return 0.5 + q.dot(self.t) / self.chord;
        }
        let k = self.turning();
        0.5 + (k * q.dot(self.t)).atan2(1.0 - k * q.dot(self.t.left())) / self.theta
    }
}

impl ProfileShape for Arc {
    fn kind(&self) -> &'static ShapeKind {
        &KIND
    }
    fn nodes(&self) -> &[Vec3] {
        &self.nodes
    }
    fn point(&self, s: f64) -> Vec3 {
        match s {
            0.0 => self.nodes[0],
            1.0 => self.nodes[2],
            _ => self.apex + self.offset(s),
        }
    }
    fn tangent(&self, s: f64) -> Vec3 {
        self.direction((s - 0.5) * self.theta) * self.length()
    }
    fn meet(&self, ray: &ProfileRay) -> [RayCrossing; 2] {
        // From the ray's point nearest to the apex, so that a far origin costs no digits.
        let (e, n, k) = (ray.direction, self.t.left(), self.turning());
        let shift = (self.apex - ray.origin).dot(e);
        let q0 = ray.point(shift) - self.apex;
        let roots = quadratic(0.5 * k, k * q0.dot(e) - e.dot(n), 0.5 * k * q0.dot(q0) - q0.dot(n));
        roots.map(|u| RayCrossing { u: shift + u, s: self.coordinate(q0 + e * u) })
    }
    fn conic(&self) -> Conic {
        let (k, n) = (0.5 * self.turning(), self.t.left());
        Conic { origin: self.apex, c: [k, 0.0, k, -n[0], -n[1], 0.0] }
    }
    fn bounds(&self) -> BoundingBox {
        let axes = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]].map(|[x, y]| Vec3::new(x, y, 0.0));
        let turned = axes.map(|axis| angle(self.t, axis));
        let inside = turned.into_iter().filter(|phi| phi.abs() < 0.5 * self.theta.abs());
        BoundingBox::of(inside.map(|phi| self.point(0.5 + phi / self.theta)).chain([self.nodes[0], self.nodes[2]]))
    }
    fn length(&self) -> f64 {
        let half = 0.5 * self.theta;
        if half == 0.0 { self.chord } else { self.chord * (half / half.sin()) }
    }
    fn curvature(&self, _s: f64) -> f64 {
        self.turning()
    }
    fn closest(&self, x: Vec3) -> f64 {
        let s = self.coordinate(x - self.apex);
        if (0.0..=1.0).contains(&s) {
            return s;
        }
        let [from, to] = [self.nodes[0], self.nodes[2]].map(|end| (x - end).norm());
        if to < from { 1.0 } else { 0.0 }
    }
    fn pieces(&self, sagitta: f64) -> usize {
        // A chord over the angle a has the sagitta (1 - cos(a / 2)) / |k|.
        let half_step = (1.0 - (sagitta * self.turning().abs()).min(1.0)).acos();
        (0.5 * self.theta.abs() / half_step).ceil() as usize
    }
    fn flaw(&self) -> Option<String> {
        let [from, middle, to] = self.nodes;
        if (middle - from).norm().min((to - middle).norm()) <= SHORTEST * self.chord {
            return Some("has its middle node at one of its ends, which says nothing of its circle".into());
        }
        (self.theta.abs() > LARGEST_TURN).then(|| {
            let degrees = self.theta.abs().to_degrees();
            format!("turns by {degrees:.1} degrees; its middle node must lie between its ends, and an arc beyond 350 degrees must be split")
        })
    }
}
