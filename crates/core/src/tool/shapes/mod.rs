//! Segments of a rigid tool's profile in the plane: each is a smooth curve through its nodes, one file.
//!
//! A segment stands in the tool's own frame and never moves: a ray is carried into that frame instead. It is
//! parametrised by `s` in `[0, 1]` in the direction of travel. A ray meets the *carrier* of a segment (the whole line,
//! parabola or circle) in at most two points; those with `s` in `[0, 1]` are the crossings of the segment itself.
//! Segments know neither their neighbours nor on which side the material lies.
//!
//! To add a shape: its file here, its `mod` line and its line in [`ALL`].

mod arc;
mod line;
mod parabola;

pub use line::LineSegment;
pub use parabola::Parabola;

use crate::declare::nearest;
use crate::tensor::{BoundingBox, Vec3};
use std::fmt::Debug;

/// Every shape of segment that a profile may be made of.
pub static ALL: &[&ShapeKind] = &[&line::KIND, &parabola::KIND, &arc::KIND];

/// A registered shape.
#[derive(Debug)]
pub struct ShapeKind {
    /// The word a deck uses: `arc`.
    pub key: &'static str,
    /// What it is, in one line.
    pub meaning: &'static str,
    /// Number of its nodes, written along the profile: first end, middle where there is one, last end.
    pub nodes: usize,
    build: fn(&[Vec3]) -> Box<dyn ProfileShape>,
}

impl ShapeKind {
    /// The segment through `nodes`. Degenerate nodes are accepted here and found by [`ProfileTool::check`](super::ProfileTool::check).
    ///
    /// # Errors
    /// In words, when the number of nodes is wrong.
    pub fn build(&self, nodes: &[Vec3]) -> Result<Box<dyn ProfileShape>, String> {
        if nodes.len() != self.nodes {
            return Err(format!("a segment `{}` has {} nodes, not {}", self.key, self.nodes, nodes.len()));
        }
        Ok((self.build)(nodes))
    }
}

/// Looks a shape up by the word a deck uses.
///
/// # Errors
/// In words, with the nearest known shape, when there is none of that name.
pub fn find(key: &str) -> Result<&'static ShapeKind, String> {
    let keys = || ALL.iter().map(|kind| kind.key);
    ALL.iter().copied().find(|kind| kind.key == key).ok_or_else(|| match nearest(key, keys()) {
        Some(near) => format!("there is no segment `{key}`; did you mean `{near}`?"),
        None => format!("there is no segment `{key}`; there are {}", keys().collect::<Vec<_>>().join(", ")),
    })
}

/// A straight line that is followed both ways from its origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProfileRay {
    /// Where `u = 0`.
    pub origin: Vec3,
    /// Its direction, of unit length.
    pub direction: Vec3,
}

impl ProfileRay {
    /// The point at signed distance `u`.
    pub fn point(&self, u: f64) -> Vec3 {
        self.origin + self.direction * u
    }
}

/// Where a ray meets a segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RayCrossing {
    /// Signed distance from the ray's origin along its direction.
    pub u: f64,
    /// Coordinate along the segment.
    pub s: f64,
}

/// `c0 x^2 + c1 x y + c2 y^2 + c3 x + c4 y + c5` with `(x, y)` seen from an origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conic {
    /// Where `x = y = 0`.
    pub origin: Vec3,
    /// The coefficients.
    pub c: [f64; 6],
}

impl Conic {
    /// The straight line through a point along a direction.
    pub(super) fn straight(origin: Vec3, direction: Vec3) -> Self {
        let n = direction.left().unit();
        Self { origin, c: [0.0, 0.0, 0.0, n[0], n[1], 0.0] }
    }
    /// Value and gradient at a point.
    pub fn at(&self, point: Vec3) -> (f64, Vec3) {
        let ([a, b, c, d, e, f], q) = (self.c, point - self.origin);
        let gradient = Vec3::new(2.0 * a * q[0] + b * q[1] + d, b * q[0] + 2.0 * c * q[1] + e, 0.0);
        (0.5 * (gradient.dot(q) + d * q[0] + e * q[1]) + f, gradient)
    }
}

/// A smooth segment of a profile, in the tool's own frame.
pub trait ProfileShape: Debug + Send + Sync {
    /// What it is.
    fn kind(&self) -> &'static ShapeKind;
    /// Its nodes, in the order in which they are written.
    fn nodes(&self) -> &[Vec3];
    /// The point at `s`; the end nodes themselves, bit for bit, at 0 and 1.
    fn point(&self, s: f64) -> Vec3;
    /// `dx/ds`, a length.
    fn tangent(&self, s: f64) -> Vec3;
    /// Where a ray meets the carrier, whatever `s`; places that do not exist are not finite.
    fn meet(&self, ray: &ProfileRay) -> [RayCrossing; 2];
    /// The carrier as the zero line of a polynomial of second degree.
    fn conic(&self) -> Conic;
    /// The smallest box around the segment, to rounding.
    fn bounds(&self) -> BoundingBox;
    /// Arc length.
    fn length(&self) -> f64;
    /// Signed curvature at `s`, positive where the segment turns to the left.
    fn curvature(&self, s: f64) -> f64;
    /// Coordinate of the point of the segment that is closest to `x`, in `[0, 1]`.
    fn closest(&self, x: Vec3) -> f64;
    /// Number of equal parts in `s` whose chords are nowhere farther than `sagitta` from the segment.
    fn pieces(&self, sagitta: f64) -> usize;
    /// What makes the nodes unfit for this shape, if anything: the rest of a sentence that begins with the segment.
    fn flaw(&self) -> Option<String> {
        None
    }
    /// Points along the segment, both ends included, whose chords are nowhere farther than `sagitta` from it.
    fn flatten(&self, sagitta: f64) -> Vec<Vec3> {
        let n = self.pieces(sagitta).clamp(1, MOST_PIECES);
        (0..=n).map(|i| self.point(i as f64 / n as f64)).collect()
    }
}

/// A picture never needs more chords on one segment.
const MOST_PIECES: usize = 4096;

/// The part of the plane's vector product that points out of it: positive when `b` lies to the left of `a`.
pub(super) fn turn(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// The angle to the left from one vector of the plane to another.
pub(super) fn angle(a: Vec3, b: Vec3) -> f64 {
    turn(a, b).atan2(a.dot(b))
}
