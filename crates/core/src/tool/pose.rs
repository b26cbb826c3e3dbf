//! Where a rigid tool stands: a translation of its reference point and a rotation about it.
//!
//! The rotation is a vector `w`: the tool is turned by `|w|` about `w`, in radians, and
//! `R = I + a [w] + b [w]^2` with `a = sin t / t`, `b = (1 - cos t) / t^2`, `t = |w|` (Rodrigues); in the plane it is the angle along
//! `e_z`. Both are smooth in
//! `t^2`, so nothing happens at rest or at half a turn: an amplitude that leads one component through many turns about
//! its axis leads the tool through them. The unknowns are the whole rotation and never a product of increments, so that
//! a rotation stays orthogonal however many increments make it, and a tool that has not moved is in its place bit for bit. Their
//! rates are `T e_i x arm` with
//! `T = I + b [w] + c [w]^2`, `c = (t - sin t) / t^3`. At a whole turn, and there only, `T` has no inverse: a tool that
//! is *free* to turn about two or three axes must stay below it; about one axis it need not.

use super::shapes::ProfileRay;
use crate::tensor::{Dual, Scalar, Tensor2, Vec3};

/// Translation and rotation, as the unknowns of the tool's reference node give them.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Pose<T = f64> {
    /// Displacement of the reference point, a length.
    pub translation: Vec3<T>,
    /// Rotation vector, in radians.
    pub rotation: Vec3<T>,
    /// `R - I`: nothing of a tool at rest is rounded.
    change: Tensor2<T>,
}

impl<T: Scalar> Pose<T> {
    /// From the unknowns of a reference node: two translations and the angle counter-clockwise in the plane, three and the rotation
    /// vector in space.
    pub fn new(unknowns: &[T]) -> Self {
        let none = T::zero();
        let [x, y, z, a, b, c] = match *unknowns {
            [x, y, angle] => [x, y, none, none, none, angle],
            _ => std::array::from_fn(|i| unknowns[i]),
        };
        Self { translation: Vec3([x, y, z]), ..Self::turned(Vec3([a, b, c])) }
    }
    /// Turned alone.
    pub fn turned(rotation: Vec3<T>) -> Self {
        let (w, t2) = (rotation.0, rotation.dot(rotation));
        let (sine, versine, zero) = (sine(t2), versine(t2), T::zero());
        let skew = [[zero, -w[2], w[1]], [w[2], zero, -w[0]], [-w[1], w[0], zero]];
        let square = |i: usize, j: usize| if i == j { w[i] * w[i] - t2 } else { w[i] * w[j] };
        let change = Tensor2::from_fn(|i, j| skew[i][j] * sine + square(i, j) * versine);
        Self { translation: Vec3::zero(), rotation, change }
    }
    /// Present position of the point that stood at `point`, with the reference point at `reference` then.
    pub fn place(&self, reference: Vec3, point: Vec3) -> Vec3<T> {
        point.lift() + self.translation + self.change * (point - reference).lift()
    }
    /// The vector turned with the tool.
    pub fn rotate(&self, v: Vec3) -> Vec3<T> {
        v.lift() + self.change * v.lift()
    }
    /// `T v`: the axis and rate at which the tool turns when its rotation vector changes at the rate `v`.
    pub fn spin(&self, v: Vec3<T>) -> Vec3<T> {
        self.series(v, T::one())
    }
    /// `T^t m`: the forces on the three unknowns of the rotation that do the work of a moment `m`.
    pub fn conjugate(&self, m: Vec3<T>) -> Vec3<T> {
        self.series(m, -T::one())
    }
    fn series(&self, v: Vec3<T>, sign: T) -> Vec3<T> {
        let (w, t2) = (self.rotation, self.rotation.dot(self.rotation));
        let once = w.cross(v);
        v + once * (versine(t2) * sign) + w.cross(once) * third(t2)
    }
}

impl Pose {
    /// Where the point that is now at `placed` stood: the inverse of [`place`](Self::place).
    pub fn withdraw(&self, reference: Vec3, placed: Vec3) -> Vec3 {
        let back = placed - self.translation;
        back + self.change.transpose() * (back - reference)
    }
    /// The vector turned back into the tool's own frame.
    pub fn rotate_back(&self, v: Vec3) -> Vec3 {
        v + self.change.transpose() * v
    }
    /// A ray in that frame.
    pub(super) fn own_frame(&self, reference: Vec3, ray: &ProfileRay) -> ProfileRay {
        ProfileRay { origin: self.withdraw(reference, ray.origin), direction: self.rotate_back(ray.direction) }
    }
    /// [`spin`](Self::spin) along each axis.
    pub fn spins(&self) -> [Vec3; 3] {
        [0, 1, 2].map(|i| self.spin(Vec3::axis(i)))
    }
    /// Derivatives of these along the component `along` of the rotation vector.
    pub fn spin_rates(&self, along: usize) -> [Vec3; 3] {
        let w = self.rotation;
        let rotation =
            Vec3(std::array::from_fn(|i| if i == along { Dual::<1>::variable(w[i], 0) } else { Dual::from(w[i]) }));
        let turned = Pose::turned(rotation);
        [0, 1, 2].map(|i| Vec3(turned.spin(Vec3::axis(i).lift()).0.map(|spin| spin.du[0])))
    }
    /// Derivatives of the position of a material point, now at `placed`, with respect to the six unknowns, with the
    /// [`spins`](Self::spins).
    pub fn rates(&self, spins: &[Vec3; 3], reference: Vec3, placed: Vec3) -> [Vec3; 6] {
        let arm = placed - (reference + self.translation);
        std::array::from_fn(|i| if i < 3 { Vec3::axis(i) } else { spins[i - 3].cross(arm) })
    }
    /// The moment whose work is that of the forces `q` on the three unknowns of the rotation; not finite at a whole
    /// turn unless the forces are along the axis.
    pub fn moment(&self, q: Vec3) -> Vec3 {
        let t = self.rotation.norm();
        if t == 0.0 {
            return q;
        }
        // T^-t = I + [w]/2 + (1 - (t/2) cot(t/2)) [w]^2 / t^2, written along and across the axis.
        let n = self.rotation * t.recip();
        let (along, half) = (n * n.dot(q), 0.5 * t);
        let across = q - along;
        if across.norm() <= 1e-15 * q.norm() {
            return along;
        }
        along + across * (half / half.tan()) + n.cross(across) * half
    }
}

/// Below this square of the angle the functions are summed as series, whose next terms are beyond rounding.
const SMALL: f64 = 0.1;

/// `1 - x / a (1 - x / b (1 - ...))`.
fn nested(x: f64, divisors: [f64; 5]) -> f64 {
    divisors.iter().rev().fold(1.0, |sum, divisor| 1.0 - x / divisor * sum)
}

/// `sin t / t` of `t^2`.
fn sine<T: Scalar>(t2: T) -> T {
    let x = t2.re();
    if x < SMALL {
        let value = 1.0 - x / 6.0 * nested(x, [20.0, 42.0, 72.0, 110.0, 156.0]);
        let slope = -1.0 / 6.0 * nested(x, [10.0, 28.0, 54.0, 88.0, 130.0]);
        return t2.chain(value, slope);
    }
    let t = x.sqrt();
    t2.chain(t.sin() / t, (t.cos() - t.sin() / t) / (2.0 * x))
}

/// `(1 - cos t) / t^2` of `t^2`.
fn versine<T: Scalar>(t2: T) -> T {
    let half = sine(t2 * 0.25);
    half * half * 0.5
}

/// `(t - sin t) / t^3` of `t^2`.
fn third<T: Scalar>(t2: T) -> T {
    let x = t2.re();
    if x < SMALL {
        let value = 1.0 / 6.0 * nested(x, [20.0, 42.0, 72.0, 110.0, 156.0]);
        let slope = -1.0 / 120.0 * nested(x, [21.0, 48.0, 82.5, 124.8, 175.0]);
        return t2.chain(value, slope);
    }
    let t = x.sqrt();
    let value = (t - t.sin()) / (x * t);
    t2.chain(value, ((1.0 - t.cos()) / x - 3.0 * value) / (2.0 * x))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    const REFERENCE: Vec3 = Vec3([3.0, -2.0, 0.4]);
    const POINT: Vec3 = Vec3([0.1, 0.7, -1.3]);

    /// From rest over tiny, half and whole turns to many.
    fn poses() -> Vec<[f64; 6]> {
        let axis = Vec3::new(0.48, -0.6, 0.64);
        let angles = [0.0, 1e-9, 1e-4, 0.3162, 0.3163, 0.8, 3.0, PI, 3.3, 5.0, 7.0, 40.0];
        angles.iter().map(|&t| [0.4, -7.0, 2.0, t * axis[0], t * axis[1], t * axis[2]]).collect()
    }

    #[test]
    fn a_tool_at_rest_is_in_its_place_bit_for_bit() {
        assert_eq!(Pose::default().place(REFERENCE, POINT), POINT);
        assert_eq!(Pose::default().withdraw(REFERENCE, POINT), POINT);
    }

    #[test]
    fn withdraw_undoes_place_and_distances_stay() {
        for unknowns in poses() {
            let pose = Pose::new(&unknowns);
            let placed = pose.place(REFERENCE, POINT);
            assert!((pose.withdraw(REFERENCE, placed) - POINT).norm() < 1e-14, "{unknowns:?}");
            let now = (placed - REFERENCE - pose.translation).norm();
            assert!((now - (POINT - REFERENCE).norm()).abs() < 2e-15 * now);
            assert!((pose.rotate_back(pose.rotate(POINT)) - POINT).norm() < 2e-15);
        }
    }

    #[test]
    fn a_rotation_about_an_axis_is_that_of_the_plane_through_many_turns() {
        for angle in [0.3, PI, 4.0, 2.0 * PI, 100.0] {
            let pose = Pose::new(&[0.0, 0.0, 0.0, 0.0, 0.0, angle]);
            assert_eq!(pose, Pose::new(&[0.0, 0.0, angle]));
            let turned = pose.rotate(Vec3::new(1.0, 0.0, 5.0));
            assert!((turned - Vec3::new(angle.cos(), angle.sin(), 5.0)).norm() < 3e-14, "{angle} {turned:?}");
        }
    }

    #[test]
    fn rates_are_the_dual_derivatives_of_place() {
        for unknowns in poses() {
            let dual = Pose::new(&std::array::from_fn::<_, 6, _>(|i| Dual::<6>::variable(unknowns[i], i)));
            let placed = dual.place(REFERENCE, POINT);
            let rates = Pose::new(&unknowns).rates(&Pose::new(&unknowns).spins(), REFERENCE, placed.re());
            for (j, rate) in rates.iter().enumerate() {
                for i in 0..3 {
                    assert!((placed[i].du[j] - rate[i]).abs() < 2e-14, "{unknowns:?} {i} {j}");
                }
            }
        }
    }

    /// The series and the closed forms, and their slopes, where they take over.
    #[test]
    fn functions_of_the_angle_are_smooth() {
        for f in [sine::<Dual<1>>, versine, third] {
            for x in [SMALL, 4.0 * SMALL] {
                let (below, above) = (f(Dual::variable(x * (1.0 - 1e-9), 0)), f(Dual::variable(x * (1.0 + 1e-9), 0)));
                assert!((above.re - below.re - 2e-9 * x * below.du[0]).abs() < 1e-14);
                assert!((above.du[0] - below.du[0]).abs() < 1e-10, "{} {}", above.du[0], below.du[0]);
            }
        }
    }

    #[test]
    fn a_moment_does_the_work_of_its_conjugate() {
        let (m, rate) = (Vec3::new(2.0, -0.3, 0.7), Vec3::new(0.1, 0.5, -0.2));
        for unknowns in poses() {
            let pose = Pose::new(&unknowns);
            let q = pose.conjugate(m);
            assert!((q.dot(rate) - m.dot(pose.spin(rate))).abs() < 1e-14, "{unknowns:?}");
            assert!((pose.moment(q) - m).norm() < 1e-12 * (1.0 + pose.rotation.norm()), "{unknowns:?}");
        }
    }
}
