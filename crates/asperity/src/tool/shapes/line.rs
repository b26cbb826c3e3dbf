//! The straight segment between two nodes.

use super::{Bounds, Conic, Crossing, Kind, Ray, Shape};
use crate::tensor::Vec3;

pub(super) static KIND: Kind = Kind {
    key: "line",
    meaning: "straight segment from the first node to the second",
    nodes: 2,
    build: |nodes| Box::new(Line([nodes[0], nodes[1]])),
};

/// `x(s) = a + s (b - a)`.
#[derive(Debug, Clone, Copy)]
pub struct Line(pub [Vec3; 2]);

impl Shape for Line {
    fn kind(&self) -> &'static Kind {
        &KIND
    }
    fn nodes(&self) -> &[Vec3] {
        &self.0
    }
    fn point(&self, s: f64) -> Vec3 {
        if s == 1.0 { self.0[1] } else { self.0[0] + self.tangent(s) * s }
    }
    fn tangent(&self, _s: f64) -> Vec3 {
        self.0[1] - self.0[0]
    }
    fn meet(&self, ray: &Ray) -> [Crossing; 2] {
        [ray.meet_line(self.0[0], self.tangent(0.0)), Crossing { u: f64::NAN, s: f64::NAN }]
    }
    fn conic(&self) -> Conic {
        Conic::straight(self.0[0], self.tangent(0.0))
    }
    fn bounds(&self) -> Bounds {
        Bounds::of(self.0)
    }
    fn length(&self) -> f64 {
        self.tangent(0.0).norm()
    }
    fn curvature(&self, _s: f64) -> f64 {
        0.0
    }
    fn closest(&self, x: Vec3) -> f64 {
        let along = self.tangent(0.0);
        (along.dot(x - self.0[0]) / along.dot(along)).clamp(0.0, 1.0)
    }
    fn pieces(&self, _sagitta: f64) -> usize {
        1
    }
}
