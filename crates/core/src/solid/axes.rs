//! Axes of a solid that differ from place to place: those of a cylinder, which tubes, rods and wound or grown bodies have.

use crate::tensor::Vec3;

/// The first axis is radial, the second goes around, the third along the cylinder; then they are turned about one of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CylinderAxes {
    /// A point of the axis.
    pub origin: Vec3,
    /// The direction of the axis, a unit vector.
    pub along: Vec3,
    /// The axis, from 0 to 2, about which they are turned, and the angle.
    pub turn: (usize, f64),
}

impl CylinderAxes {
    /// The first and the third axis at a place. On the axis of the cylinder no direction is radial, and one is taken.
    pub fn at(&self, x: Vec3) -> [Vec3; 2] {
        let from = x - self.origin;
        let radial = from - self.along * self.along.dot(from);
        let first = if radial.norm() > 1e-10 * from.norm() { radial.unit() } else { self.across() };
        let mut axes = [first, self.along.cross(first), self.along];
        let (about, (sin, cos)) = (self.turn.0, self.turn.1.sin_cos());
        let (next, last) = ((about + 1) % 3, (about + 2) % 3);
        let (a, b) = (axes[next], axes[last]);
        (axes[next], axes[last]) = (a * cos + b * sin, b * cos - a * sin);
        [axes[0], axes[2]]
    }

    fn across(&self) -> Vec3 {
        self.along.cross(Vec3::axis(self.along.least_axis())).unit()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: Vec3, b: [f64; 3]) -> bool {
        (a - Vec3(b)).norm() < 1e-14
    }

    #[test]
    fn radial_around_and_along() {
        let still = CylinderAxes { origin: Vec3::new(1.0, 0.0, 0.0), along: Vec3::new(0.0, 0.0, 1.0), turn: (0, 0.0) };
        let [first, third] = still.at(Vec3::new(1.0, 2.0, 5.0));
        assert!(near(first, [0.0, 1.0, 0.0]) && near(third, [0.0, 0.0, 1.0]));
        let wound = CylinderAxes { turn: (0, 30f64.to_radians()), ..still };
        let [first, third] = wound.at(Vec3::new(1.0, 2.0, 5.0));
        // About the radius: what goes along leans against what goes around, -x here.
        assert!(near(first, [0.0, 1.0, 0.0]) && near(third, [0.5, 0.0, 0.75f64.sqrt()]), "{third:?}");
        let [first, _] = still.at(Vec3::new(1.0, 0.0, 5.0));
        assert!((first.norm() - 1.0).abs() < 1e-14 && first[2].abs() < 1e-14);
    }
}
