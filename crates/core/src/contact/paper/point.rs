//! One Gauss point: a pure function of where the point, its tangents and the target's material are.
//!
//! The faces of a cell look outward, so that with `g_1`, `g_2` the tangents of the face the inward normal is
//! `e_R = g_2 x g_1 / J`. In space the two tangents of the triad lie evenly about the face's axes: with `a` and `b` the sum and
//! the difference of the unit vectors along `g_2` and `g_1`, which are at right angles, `e_S, e_T = (a/|a| +- b/|b|)/
//! sqrt 2`; in the plane they are the tangent, the solid on its left, and `e_z`. The triad turns with the face, so that a shear stress
//! kept by its components is objective.
//! Penetration `u = n_B.(x_B - x_A) / (n_B.e_R)`, where the target is replaced by its tangent plane at the hit, exact to
//! first order; slip `(e_S, e_T).(x_Bn - x_A)`, with `B_n` the target's material point touched at the last accepted
//! state, which is objective under any common rigid motion. The traction on the solid is `p e_R + tau_S e_S + tau_T e_T`.

use crate::Failure;
use crate::contact::increment::in_contact;
use crate::interface::Linearised;
use crate::system::Coordinates;
use crate::tensor::{Scalar, Vec3};
use std::f64::consts::{FRAC_1_SQRT_2, TAU};

/// What a point depends on.
#[derive(Debug, Clone, Copy)]
pub struct PointPlace<T> {
    /// Position of the point.
    pub a: Vec3<T>,
    /// Tangents of the face there.
    pub tangents: [Vec3<T>; 2],
    /// Position of the target's material point at the hit.
    pub b: Vec3<T>,
    /// Present position of the material point touched at the last accepted state, if there was one.
    pub touched: Option<Vec3<T>>,
}

/// What is constant while it is differentiated.
#[derive(Debug, Clone, Copy)]
pub struct PointConstants {
    /// Outward normal of the target at the hit.
    pub normal: Vec3,
    /// What overlap and wear add to the penetration that the law sees.
    pub closure: f64,
    /// Penetration that the law saw at the last accepted state; negative for a gap.
    pub before: f64,
    /// Penetration at which the law closes the point: what dilation or a bond leaves of a gap.
    pub touch: f64,
    /// Penetration down to which it stays closed with the slip of the increment.
    pub opens: f64,
    /// How much farther a point counts as closed: touching to rounding is open.
    pub least: f64,
    /// Quadrature weight times thickness.
    pub weight: f64,
    /// Whether the plane revolves, and a point stands for a circumference.
    pub revolves: bool,
    /// Whether the model is plane.
    pub plane: bool,
    /// Stresses with which the tangent turns and moves; none for those of the trial state.
    pub acting: Option<Coordinates>,
}

/// The result at a closed point.
#[derive(Debug, Clone, Copy)]
pub struct Closed<T> {
    /// Force on the solid.
    pub force: Vec3,
    /// The force whose derivatives are the tangent: that of the stresses which act in it.
    pub linear: Vec3<T>,
    /// Where the target is touched.
    pub hit: Vec3<T>,
    /// Slip of the increment.
    pub slip: [T; 2],
    /// Answer of the law.
    pub response: Linearised,
}

/// Inward normal, two unit tangents, and the area of the parallelogram of the face's own tangents.
#[derive(Debug, Clone, Copy)]
pub struct Triad<T> {
    /// Inward unit normal.
    pub inward: Vec3<T>,
    /// Unit tangents.
    pub along: [Vec3<T>; 2],
    /// Area.
    pub area: T,
}

impl<T: Scalar> Triad<T> {
    /// Of a face's own tangents.
    pub fn new([g1, g2]: [Vec3<T>; 2], plane: bool) -> Self {
        let n = g2.cross(g1);
        let (area, first, second) = (n.norm(), g2.unit(), g1.unit());
        let inward = n * area.recip();
        if plane {
            return Self { inward, along: [second, first], area };
        }
        let (a, b) = ((first + second).unit(), (first - second).unit());
        let half = T::from(FRAC_1_SQRT_2);
        Self { inward, along: [(a + b) * half, (a - b) * half], area }
    }
}

impl<T: Scalar> PointPlace<T> {
    /// Slips of the increment; none without a material point that was touched.
    pub fn slip(&self, triad: &Triad<T>) -> [T; 2] {
        self.touched.map_or([T::zero(); 2], |touched| triad.along.map(|e| e.dot(touched - self.a)))
    }

    /// Penetration, for the target's normal at the hit.
    pub fn penetration(&self, triad: &Triad<T>, normal: Vec3) -> T {
        let normal = normal.lift::<T>();
        normal.dot(self.b - self.a) / normal.dot(triad.inward)
    }
}

/// The result if the point is closed.
///
/// # Errors
/// As the law.
pub fn evaluate<T: Scalar>(
    place: &PointPlace<T>,
    constants: &PointConstants,
    law: impl FnOnce([f64; 3]) -> Result<Linearised, Failure>,
) -> Result<Option<Closed<T>>, Failure> {
    let triad = Triad::new(place.tangents, constants.plane);
    let penetration = place.penetration(&triad, constants.normal);
    let seen = penetration + constants.closure;
    if seen.re() <= constants.opens + constants.least {
        return Ok(None);
    }
    // Counted from there, so that the pressure does not jump: a jump, however small, can keep Newton from its end.
    let (penetration, seen) = (penetration - constants.least, seen - constants.least);
    let part = in_contact(seen - constants.touch, constants.before - constants.touch);
    let slip = place.slip(&triad).map(|slip| slip * part);
    let motion = [seen, slip[0], slip[1]];
    let response = law(motion.map(T::re))?;
    let stress = response.chained(motion);
    let area = triad.area * constants.weight;
    let area = if constants.revolves { area * place.a[0] * TAU } else { area };
    let force = |[p, s, t]: [T; 3]| (triad.inward * p + triad.along[0] * s + triad.along[1] * t) * area;
    let (force, linear) = (force(stress).re(), force(acting(stress, constants.acting)));
    Ok(Some(Closed { force, linear, hit: place.a + triad.inward * penetration, slip, response }))
}

/// Stresses of other values, where some are given, with the same derivatives.
fn acting<T: Scalar>(stress: [T; 3], given: Option<Coordinates>) -> [T; 3] {
    given.map_or(stress, |given| std::array::from_fn(|i| stress[i].chain(given[i], 1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_triad_is_right_handed_and_even_about_the_axes() {
        let (g1, g2) = (Vec3::new(2.0, 0.1, 0.3), Vec3::new(0.7, 1.5, -0.2));
        let t = Triad::new([g1, g2], false);
        assert!((t.along[0].cross(t.along[1]) - t.inward).norm() < 1e-15);
        assert!((t.inward + g1.cross(g2).unit()).norm() < 1e-15 && (t.area - g1.cross(g2).norm()).abs() < 1e-15);
        assert!(t.along[0].dot(t.along[1]).abs() < 1e-15);
        // As far from one axis as from the other.
        assert!((t.along[0].dot(g2.unit()) - t.along[1].dot(g1.unit())).abs() < 1e-15);
        let square = Triad::new([Vec3::new(3.0, 0.0, 0.0), Vec3::new(0.0, 0.5, 0.0)], false);
        assert!((square.along[0] - Vec3::new(0.0, 1.0, 0.0)).norm() < 1e-15);
        assert!((square.along[1] - Vec3::new(1.0, 0.0, 0.0)).norm() < 1e-15);
    }

    /// The solid lies on the left of an edge.
    #[test]
    fn the_plane_is_space_with_another_tangent() {
        let edge = Vec3::new(0.6, 0.8, 0.0);
        let t = Triad::new([edge * 2.0, Vec3::new(0.0, 0.0, 1.0)], true);
        assert!((t.inward - edge.left()).norm() < 1e-15 && (t.along[0] - edge).norm() < 1e-15 && t.area == 2.0);
    }
}
