//! Axes of a body whose law is not alike in all directions.

use super::solid_tool::{direction, point};
use crate::form::{Form, number, table, whole};
use crate::source::Spot;
use asperity_core::declare::{Range, unit};
use asperity_core::solid::CylinderAxes;
use asperity_core::tensor::Vec3;

table! {
    /// Axes of a cylinder, in place of those that the law says: the first is radial, the second goes around, the third along it.
    pub struct AxesKeys {
        /// A point of the axis of the cylinder.
        origin: Vec<f64> = point().or("[0.0, 0.0, 0.0]"),
        /// Where the axis of the cylinder goes, of any length.
        along: Spot<Vec<f64>> = direction().spot().required(),
        /// The one of the three about which the two others are turned, by the right-hand rule.
        about: usize = whole(1..=3).or("1"),
        /// By how much.
        angle: f64 = number(unit::DEGREES, Range::ANY).or("0.0"),
    }
}

impl AxesKeys {
    /// The axes, from an origin; none where the axis has no direction.
    pub fn axes(&self, from: Vec3) -> Option<CylinderAxes> {
        let vector = |of: &[f64]| Vec3(std::array::from_fn(|i| of[i]));
        let along = vector(&self.along);
        let turn = (self.about - 1, self.angle.to_radians());
        (along.norm() > 0.0).then(|| CylinderAxes { origin: vector(&self.origin) - from, along: along.unit(), turn })
    }
}
