//! Where a rigid tool stands: a translation of its reference point and a rotation about it.
//!
//! `place(X) = X + d + (R - I)(X - X_ref)`, with `R - I` written in `sin a` and `1 - cos a = 2 sin^2(a / 2)`: a tool
//! that has not moved is in its place bit for bit, and since the angle is an unknown and never a sum of matrices, a
//! rotation stays orthogonal however many increments make it.

use crate::tensor::{Scalar, Vec3};

/// Translation and rotation in the plane, as the unknowns of the tool's reference node give them.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PlanePose<T = f64> {
    /// Displacement of the reference point, a length.
    pub translation: Vec3<T>,
    /// Rotation about it, counter-clockwise, in radians.
    pub angle: T,
    /// `sin a` and `cos a - 1`.
    turn: [T; 2],
}

impl<T: Scalar> PlanePose<T> {
    /// From the unknowns `ux, uy, angle`.
    pub fn new(ux: T, uy: T, angle: T) -> Self {
        let half = (angle * 0.5).sin();
        Self { translation: Vec3::new(ux, uy, T::zero()), angle, turn: [angle.sin(), half * half * -2.0] }
    }
    /// Present position of the point that stood at `point`, with the reference point at `reference` then.
    pub fn place(&self, reference: Vec3, point: Vec3) -> Vec3<T> {
        let arm = (point - reference).lift();
        point.lift() + self.translation + change(self.turn, arm)
    }
    /// The vector turned with the tool.
    pub fn rotate(&self, v: Vec3) -> Vec3<T> {
        v.lift() + change(self.turn, v.lift())
    }
}

impl PlanePose {
    /// Where the point that is now at `placed` stood: the inverse of [`place`](Self::place).
    pub fn withdraw(&self, reference: Vec3, placed: Vec3) -> Vec3 {
        let back = placed - self.translation;
        back + change(self.back(), back - reference)
    }
    /// The vector turned back into the tool's own frame.
    pub fn rotate_back(&self, v: Vec3) -> Vec3 {
        v + change(self.back(), v)
    }
    fn back(&self) -> [f64; 2] {
        [-self.turn[0], self.turn[1]]
    }
    /// Derivatives of the position of a material point, now at `placed`, with respect to `ux`, `uy` and the angle.
    pub fn rates(&self, reference: Vec3, placed: Vec3) -> [Vec3; 3] {
        let arm = placed - (reference + self.translation);
        [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0), arm.left()]
    }
}

/// `(R - I) v`, of `sin a` and `cos a - 1`.
fn change<T: Scalar>([sin, less]: [T; 2], v: Vec3<T>) -> Vec3<T> {
    Vec3::new(less * v[0] - sin * v[1], sin * v[0] + less * v[1], T::zero())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tensor::Dual;

    const REFERENCE: Vec3 = Vec3([3.0, -2.0, 0.0]);
    const POINT: Vec3 = Vec3([0.1, 0.7, 0.0]);

    #[test]
    fn a_tool_at_rest_is_in_its_place_bit_for_bit() {
        assert_eq!(PlanePose::default().place(REFERENCE, POINT), POINT);
        assert_eq!(PlanePose::default().withdraw(REFERENCE, POINT), POINT);
    }

    #[test]
    fn withdraw_undoes_place_and_distances_stay() {
        let pose = PlanePose::new(0.4, -7.0, 2.5);
        let placed = pose.place(REFERENCE, POINT);
        assert!((pose.withdraw(REFERENCE, placed) - POINT).norm() < 1e-14);
        let now = (placed - REFERENCE - pose.translation).norm();
        assert!((now - (POINT - REFERENCE).norm()).abs() < 1e-15 * now);
        assert!((pose.rotate_back(pose.rotate(POINT)) - POINT).norm() < 1e-15);
    }

    #[test]
    fn a_quarter_turn_is_counter_clockwise() {
        let turned = PlanePose::new(0.0, 0.0, std::f64::consts::FRAC_PI_2)
            .place(REFERENCE, REFERENCE + Vec3::new(1.0, 0.0, 0.0));
        assert!((turned - REFERENCE - Vec3::new(0.0, 1.0, 0.0)).norm() < 1e-15);
    }

    #[test]
    fn rates_are_the_dual_derivatives_of_place() {
        let (ux, uy, angle) = (0.3, -0.2, 0.9);
        let dual = PlanePose::new(Dual::<3>::variable(ux, 0), Dual::variable(uy, 1), Dual::variable(angle, 2));
        let (placed, pose) = (dual.place(REFERENCE, POINT), PlanePose::new(ux, uy, angle));
        let rates = pose.rates(REFERENCE, placed.re());
        for (j, rate) in rates.iter().enumerate() {
            for i in 0..2 {
                assert!((placed[i].du[j] - rate[i]).abs() < 1e-14);
            }
        }
    }
}
