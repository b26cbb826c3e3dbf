//! One contact point in the plane: a pure function of where the point, its tangent and the target's material are.
//!
//! With `e_S` the unit tangent of the surface (the solid on its left) and `e_R` its left normal, which points into the
//! solid: penetration `u = n_B.(x_B - x_A) / (n_B.e_R)`, where the target is replaced by its tangent plane at the hit,
//! exact to first order; slip `e_S.(x_Bn - x_A)`, with `B_n` the target's material point touched at the last accepted
//! state, which is objective under any common rigid motion. The traction on the solid is `p e_R + tau e_S`.

use crate::Failure;
use crate::interface::Linearised;
use crate::system::Coordinates;
use crate::tensor::{Scalar, Vec3};

/// What a contact point depends on.
#[derive(Debug, Clone, Copy)]
pub struct Place<T> {
    /// Position of the point.
    pub a: Vec3<T>,
    /// Tangent `dx/dxi` of the surface there.
    pub tangent: Vec3<T>,
    /// Position of the target's material point at the hit.
    pub b: Vec3<T>,
    /// Present position of the material point touched at the last accepted state, if there was one.
    pub touched: Option<Vec3<T>>,
}

impl Place<f64> {
    /// Slip of the increment; none without a material point that was touched.
    pub fn slip(&self) -> f64 {
        let (along, _, _) = triad(self.tangent);
        self.touched.map_or(0.0, |touched| along.dot(touched - self.a))
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
    /// Quadrature weight times thickness.
    pub weight: f64,
    /// Stresses with which the tangent turns and moves; none for those of the trial state.
    pub acting: Option<Coordinates>,
    /// Whether the weight is per radian and the circumference has to be added.
    pub axisymmetric: bool,
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
    pub slip: T,
    /// Pressure, and shear stress along the tangent; the third is zero.
    pub stress: [T; 3],
    /// Answer of the law.
    pub response: Linearised,
}

/// Unit tangent, inward normal, and length of the tangent.
pub fn triad<T: Scalar>(tangent: Vec3<T>) -> (Vec3<T>, Vec3<T>, T) {
    let length = tangent.norm();
    let along = tangent * length.recip();
    (along, along.left(), length)
}

/// Penetration (negative: gap), and the result if the point is closed.
pub fn evaluate<T: Scalar>(
    place: &Place<T>,
    constants: &Constants,
    law: impl FnOnce([f64; 3]) -> Result<Linearised, Failure>,
) -> Result<(T, Option<Closed<T>>), Failure> {
    let (along, inward, length) = triad(place.tangent);
    let normal = constants.normal.lift::<T>();
    let penetration = normal.dot(place.b - place.a) / normal.dot(inward);
    let seen = penetration + constants.closure;
    if seen.re() <= constants.opens + constants.least {
        return Ok((penetration, None));
    }
    // Counted from there, so that the pressure does not jump: a jump, however small, can keep Newton from its end.
    let (penetration, seen) = (penetration - constants.least, seen - constants.least);
    let slip = match place.touched {
        None => T::zero(),
        Some(touched) => {
            along.dot(touched - place.a) * in_contact(seen - constants.touch, constants.before - constants.touch)
        }
    };
    let motion = [seen, slip, T::zero()];
    let response = law(motion.map(T::re))?;
    let stress = response.chained(motion);
    let mut area = length * constants.weight;
    if constants.axisymmetric {
        area = area * place.a[0] * std::f64::consts::TAU;
    }
    let force = |[p, s, _]: [T; 3]| (inward * p + along * s) * area;
    let (force, linear) = (force(stress).re(), force(acting(stress, constants.acting)));
    Ok((penetration, Some(Closed { force, linear, hit: place.a + inward * penetration, slip, stress, response })))
}

/// Stresses of other values, where some are given, with the same derivatives.
pub fn acting<T: Scalar>(stress: [T; 3], given: Option<Coordinates>) -> [T; 3] {
    given.map_or(stress, |given| std::array::from_fn(|i| stress[i].chain(given[i], 1.0)))
}

/// The part of the increment during which a point that began open is in contact, at constant speed of approach.
pub fn in_contact<T: Scalar>(penetration: T, before: f64) -> T {
    if before < 0.0 && penetration.re() > 0.0 { penetration / (penetration - before) } else { T::one() }
}
