//! Regularised friction of Oden and Pires (1983), `tau = mu p tanh(|d| / e) d / |d|` with the slip `d` of the increment:
//! smooth, without a stick branch and without memory. With a `radius` the contact puts the mean of the pressure around the
//! point in the place of `p`; the law itself knows one point only.
//!
//! Below `e` the point creeps in proportion to the friction stress, so the answer depends on the length of the
//! increments; `e` should be small beside the slip of an increment where the point slides.

use super::coulomb::FRICTION;
use super::{law, nothing_to_integrate};
use crate::Failure;
use crate::declare::{Entry, Parameter, Range, Variable, unit};
use crate::integrate::Update;
use crate::interface::{Interface, InterfaceLaw, Motion, Past, Response, Status};
use crate::tensor::Scalar;

const LENGTH: Parameter = Parameter {
    key: "length",
    meaning: "slip of an increment at which friction is three quarters of the whole",
    unit: unit::LENGTH,
    range: Range::POSITIVE,
    default: None,
};

const RADIUS: Parameter = Parameter {
    key: "radius",
    meaning: "distance on the surface over which friction takes the mean of the pressure, with a tool in the plane; zero for that of the point",
    unit: unit::LENGTH,
    range: Range::NOT_NEGATIVE,
    default: Some(0.0),
};

pub(super) const ENTRY: Entry<Box<dyn Interface>> = Entry {
    name: "oden_pires",
    meaning: "regularised friction of Oden and Pires: a smooth function of the slip of the increment",
    parameters: &[FRICTION, LENGTH, RADIUS],
    pairs: None,
    build: |v| Ok(law(OdenPires { friction: v[0], length: v[1], radius: v[2] })),
};

/// The law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OdenPires {
    /// Coefficient of friction.
    pub friction: f64,
    /// Slip of an increment at which friction is `tanh 1` of the whole.
    pub length: f64,
    /// Distance over which the pressure is a mean.
    pub radius: f64,
}

/// `tanh(x) / x` from `x^2`.
fn ratio<T: Scalar>(square: T) -> T {
    if square.re() < 1e-6 {
        return square * square * (2.0 / 15.0) - square / 3.0 + 1.0;
    }
    let x = square.sqrt();
    x.tanh() / x
}

impl InterfaceLaw for OdenPires {
    const VARIABLES: &'static [Variable] = &[];

    fn radius(&self) -> f64 {
        self.radius
    }

    fn updated(&self, _: Update) -> Result<Box<dyn Interface>, String> {
        nothing_to_integrate("regularised friction is a function of the slip of the increment")
    }

    fn respond<T: Scalar>(&self, motion: &Motion<T>, past: &Past<T>, _: &mut [T]) -> Result<Response<T>, Failure> {
        let pressure = motion.penetration * past.penalty;
        let x = motion.slip.map(|d| d / self.length);
        let square = x[0] * x[0] + x[1] * x[1];
        let factor = pressure.max(T::zero()) * self.friction * ratio(square);
        let shear = x.map(|x| x * factor);
        let slipped = self.length * square.re().sqrt();
        let status = if square.re() < 1.0 { Status::Stick } else { Status::Slip };
        let dissipated = shear[0].re().hypot(shear[1].re()) * slipped;
        Ok(Response { pressure, shear, status, slipped, closure: 0.0, dissipated, violation: 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn friction_follows_the_slip_of_the_increment() {
        let law = OdenPires { friction: 0.2, length: 1e-3, radius: 0.0 };
        let past = Past {
            penalty: 1e3,
            tangential_penalty: 1e3,
            penetration: 0.1,
            pressure: 100.0,
            shear: [7.0, 3.0],
            vars: &[],
            dt: 1.0,
        };
        for slip in [1e-9, 1e-4, 1e-3, 1e-2] {
            let motion = Motion { penetration: 0.1, slip: [0.6 * slip, -0.8 * slip] };
            let shear = law.respond(&motion, &past, &mut []).unwrap().shear;
            let size = 20.0 * f64::tanh(slip / 1e-3);
            assert!((shear[0] - 0.6 * size).abs() < 1e-12 * size && (shear[1] + 0.8 * size).abs() < 1e-12 * size);
        }
    }
}
