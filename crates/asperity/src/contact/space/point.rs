//! One contact point in space: a pure function of where the point, its tangents and the target's material are.
//!
//! The faces of a cell look outward, so that with `g_1`, `g_2` the tangents of the face the inward normal is
//! `e_R = g_2 x g_1 / J`. The two tangents of the triad lie evenly about the face's axes: with `a` and `b` the sum and
//! the difference of the unit vectors along `g_2` and `g_1`, which are at right angles, `e_S, e_T = (a/|a| +- b/|b|)/
//! sqrt 2`. The triad turns with the face, so that a shear stress kept by its components is objective.
//! Penetration `u = n_B.(x_B - x_A) / (n_B.e_R)`, where the target is replaced by its tangent plane at the hit, exact to
//! first order; slip `(e_S, e_T).(x_Bn - x_A)`, with `B_n` the target's material point touched at the last accepted
//! state, which is objective under any common rigid motion. The traction on the solid is `p e_R + tau_S e_S + tau_T e_T`.

use crate::Failure;
use crate::contact::point::{acting, in_contact};
use crate::interface::Linearised;
use crate::system::Coordinates;
use crate::tensor::{Scalar, Vec3};
use std::f64::consts::FRAC_1_SQRT_2;

/// What a contact point depends on.
#[derive(Debug, Clone, Copy)]
pub struct Place<T> {
    /// Position of the point.
    pub a: Vec3<T>,
    /// Tangents `dx/dxi` of the surface there.
    pub tangents: [Vec3<T>; 2],
    /// Position of the target's material point at the hit.
    pub b: Vec3<T>,
    /// Present position of the material point touched at the last accepted state, if there was one.
    pub touched: Option<Vec3<T>>,
}

impl Place<f64> {
    /// Slip of the increment along both tangents; none without a material point that was touched.
    pub fn slip(&self) -> [f64; 2] {
        let along = Triad::new(self.tangents).along;
        self.touched.map_or([0.0; 2], |touched| along.map(|e| e.dot(touched - self.a)))
    }
}

/// What is constant while it is differentiated.
#[derive(Debug, Clone, Copy)]
pub struct Constants {
    /// Outward normal of the target at the hit.
    pub normal: Vec3,
    /// What multipliers add to the penetration that the law sees.
    pub closure: f64,
    /// Penetration that the law saw at the last accepted state; negative for a gap.
    pub before: f64,
    /// Penetration at which the law closes the point: what dilation or a bond leaves of a gap.
    pub touch: f64,
    /// Penetration down to which it stays closed with the slip of the increment.
    pub opens: f64,
    /// How much farther a point counts as closed: touching to rounding is open.
    pub least: f64,
    /// Quadrature weight.
    pub weight: f64,
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
    /// Slip of the increment along the two tangents.
    pub slip: [T; 2],
    /// Pressure, and shear stresses along the two tangents.
    pub stress: [T; 3],
    /// Answer of the law.
    pub response: Linearised,
}

/// A right-handed set of unit vectors, and the area that the tangents span.
#[derive(Debug, Clone, Copy)]
pub struct Triad<T> {
    /// Into the solid.
    pub inward: Vec3<T>,
    /// Along the face.
    pub along: [Vec3<T>; 2],
    /// Area for a unit of the face's coordinates.
    pub area: T,
}

impl<T: Scalar> Triad<T> {
    /// From the tangents of a face that looks outward.
    pub fn new([g1, g2]: [Vec3<T>; 2]) -> Self {
        let n = g2.cross(g1);
        let (area, first, second) = (n.norm(), g2.unit(), g1.unit());
        let (a, b) = ((first + second).unit(), (first - second).unit());
        let half = T::from(FRAC_1_SQRT_2);
        Self { inward: n * area.recip(), along: [(a + b) * half, (a - b) * half], area }
    }
}

/// Penetration (negative: gap), and the result if the point is closed.
pub fn evaluate<T: Scalar>(
    place: &Place<T>,
    constants: &Constants,
    law: impl FnOnce([f64; 3]) -> Result<Linearised, Failure>,
) -> Result<(T, Option<Closed<T>>), Failure> {
    let triad = Triad::new(place.tangents);
    let normal = constants.normal.lift::<T>();
    let penetration = normal.dot(place.b - place.a) / normal.dot(triad.inward);
    let seen = penetration + constants.closure;
    if seen.re() <= constants.opens + constants.least {
        return Ok((penetration, None));
    }
    // Counted from there, so that the pressure does not jump: a jump, however small, can keep Newton from its end.
    let (penetration, seen) = (penetration - constants.least, seen - constants.least);
    let slip = place.touched.map_or([T::zero(); 2], |touched| {
        let part = in_contact(seen - constants.touch, constants.before - constants.touch);
        triad.along.map(|e| e.dot(touched - place.a) * part)
    });
    let motion = [seen, slip[0], slip[1]];
    let response = law(motion.map(T::re))?;
    let stress = response.chained(motion);
    let force = |[p, s, t]: [T; 3]| {
        (triad.inward * p + triad.along[0] * s + triad.along[1] * t) * (triad.area * constants.weight)
    };
    let (force, linear) = (force(stress).re(), force(acting(stress, constants.acting)));
    Ok((penetration, Some(Closed { force, linear, hit: place.a + triad.inward * penetration, slip, stress, response })))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_triad_is_right_handed_and_even_about_the_axes() {
        let (g1, g2) = (Vec3::new(2.0, 0.1, 0.3), Vec3::new(0.7, 1.5, -0.2));
        let t = Triad::new([g1, g2]);
        assert!((t.along[0].cross(t.along[1]) - t.inward).norm() < 1e-15);
        assert!((t.inward + g1.cross(g2).unit()).norm() < 1e-15 && (t.area - g1.cross(g2).norm()).abs() < 1e-15);
        assert!(t.along[0].dot(t.along[1]).abs() < 1e-15);
        // As far from one axis as from the other.
        assert!((t.along[0].dot(g2.unit()) - t.along[1].dot(g1.unit())).abs() < 1e-15);
        let square = Triad::new([Vec3::new(3.0, 0.0, 0.0), Vec3::new(0.0, 0.5, 0.0)]);
        assert!((square.along[0] - Vec3::new(0.0, 1.0, 0.0)).norm() < 1e-15);
        assert!((square.along[1] - Vec3::new(1.0, 0.0, 0.0)).norm() < 1e-15);
    }
}
