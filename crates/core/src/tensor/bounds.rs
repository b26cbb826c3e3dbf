//! Boxes around points.

use super::Vec3;

/// An axis-parallel box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoundingBox {
    /// Smallest coordinates.
    pub min: Vec3,
    /// Largest coordinates.
    pub max: Vec3,
}

impl BoundingBox {
    /// The box that holds nothing.
    pub const EMPTY: BoundingBox = BoundingBox { min: Vec3([f64::INFINITY; 3]), max: Vec3([f64::NEG_INFINITY; 3]) };

    /// The smallest box around points; coordinates that are not numbers are passed over.
    pub fn of(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| b.union(BoundingBox { min: p, max: p }))
    }
    /// The smallest box around two.
    pub fn union(self, other: Self) -> Self {
        let pick = |a: Vec3, b: Vec3, f: fn(f64, f64) -> f64| Vec3(std::array::from_fn(|i| f(a[i], b[i])));
        Self { min: pick(self.min, other.min, f64::min), max: pick(self.max, other.max, f64::max) }
    }
    /// It and `margin` on all sides.
    pub fn widened(self, margin: f64) -> Self {
        Self { min: self.min - Vec3([margin; 3]), max: self.max + Vec3([margin; 3]) }
    }
    /// From a point to it.
    pub fn distance(&self, x: Vec3) -> f64 {
        Vec3(std::array::from_fn(|i| (self.min[i] - x[i]).max(x[i] - self.max[i]).max(0.0))).norm()
    }
    /// Length of its diagonal; zero for the empty box.
    pub fn size(&self) -> f64 {
        if self.min[0] <= self.max[0] { (self.max - self.min).norm() } else { 0.0 }
    }
    /// Its middle.
    pub fn centre(&self) -> Vec3 {
        self.min * 0.5 + self.max * 0.5
    }
}
