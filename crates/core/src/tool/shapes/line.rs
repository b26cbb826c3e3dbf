//! The straight segment between two nodes.

use super::{Conic, ProfileRay, ProfileShape, RayCrossing, ShapeKind, turn};
use crate::tensor::{BoundingBox, Vec3};

pub(super) static KIND: ShapeKind = ShapeKind {
    key: "line",
    meaning: "straight segment from the first node to the second",
    nodes: 2,
    build: |nodes| Box::new(LineSegment([nodes[0], nodes[1]])),
};

/// `x(s) = a + s (b - a)`.
#[derive(Debug, Clone, Copy)]
pub struct LineSegment(pub [Vec3; 2]);

impl ProfileShape for LineSegment {
    fn kind(&self) -> &'static ShapeKind {
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
    fn meet(&self, ray: &ProfileRay) -> [RayCrossing; 2] {
        // Not finite where the two are parallel.
        let (to, tangent) = (self.0[0] - ray.origin, self.tangent(0.0));
        let span = turn(ray.direction, tangent);
        let crossing = RayCrossing { u: turn(to, tangent) / span, s: turn(to, ray.direction) / span };
        [crossing, RayCrossing { u: f64::NAN, s: f64::NAN }]
    }
    fn conic(&self) -> Conic {
        Conic::straight(self.0[0], self.tangent(0.0))
    }
    fn bounds(&self) -> BoundingBox {
        BoundingBox::of(self.0)
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
