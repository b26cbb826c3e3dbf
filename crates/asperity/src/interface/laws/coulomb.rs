//! Coulomb's dry friction as non-associated plasticity without dilatancy (Charlier & Habraken 1990):
//! `f = |tau| - phi p`, flow along `tau`, pressure `p = K_p u`.
//!
//! In the plane the yield surface is a pair of lines, so the return of the trial stress is the exact integral over the
//! increment: a point sticks up to one crossing and slips from there to the end.

use super::law;
use crate::Failure;
use crate::declare::{Entry, Parameter, Range, Variable, unit};
use crate::interface::{Interface, InterfaceLaw, Motion, Past, Response, Status};
use crate::tensor::Scalar;

const FRICTION: Parameter = Parameter {
    key: "friction",
    meaning: "coefficient of friction",
    unit: unit::NONE,
    range: Range::NOT_NEGATIVE,
    default: None,
};

pub(super) const ENTRY: Entry<Box<dyn Interface>> = Entry {
    name: "coulomb",
    meaning: "dry friction: shear at most friction times pressure",
    parameters: &[FRICTION],
    pairs: None,
    build: |v| Ok(law(Coulomb { friction: v[0] })),
};

/// The law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coulomb {
    /// Coefficient of friction.
    pub friction: f64,
}

impl InterfaceLaw for Coulomb {
    const VARIABLES: &'static [Variable] = &[];

    fn respond<T: Scalar>(&self, motion: &Motion<T>, past: &Past, _: &mut [f64]) -> Result<Response<T>, Failure> {
        let pressure = motion.penetration * past.penalty;
        let trial = [0, 1].map(|i| motion.slip[i] * past.tangential_penalty + past.shear[i]);
        let (size, limit) = ((trial[0] * trial[0] + trial[1] * trial[1]).sqrt(), pressure * self.friction);
        // A point that is only expected to close may ask with a penetration below zero.
        if size.re() <= limit.re().max(0.0) {
            let (shear, status) = (trial, Status::Stick);
            return Ok(Response { pressure, shear, status, slipped: 0.0, dissipated: 0.0, violation: 0.0 });
        }
        let shear = trial.map(|t| t / size * limit);
        let slipped = (size.re() - limit.re()) / past.tangential_penalty;
        let violation = shear[0].re().hypot(shear[1].re()) - limit.re();
        Ok(Response {
            pressure,
            shear,
            status: Status::Slip,
            slipped,
            dissipated: limit.re() * slipped,
            violation: if limit.re() > 0.0 { violation.max(0.0) / limit.re() } else { 0.0 },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tensor::Dual;

    fn past(shear: [f64; 2]) -> Past<'static> {
        Past { penalty: 1e3, tangential_penalty: 500.0, shear, vars: &[], dt: 1.0 }
    }

    #[test]
    fn sticks_below_the_limit_and_slips_on_it() {
        let law = Coulomb { friction: 0.3 };
        let at = |slip: f64| law.respond(&Motion { penetration: 0.1, slip: [slip, 0.0] }, &past([0.0; 2]), &mut []);
        let stick = at(0.05).unwrap();
        assert_eq!((stick.status, stick.shear[0], stick.dissipated), (Status::Stick, 25.0, 0.0));
        let slip = at(-0.1).unwrap();
        assert_eq!((slip.status, slip.shear[0]), (Status::Slip, -30.0));
        // Trial 50, limit 30: 20 / 500 of slip at 30.
        assert!((slip.slipped - 0.04).abs() < 1e-15 && (slip.dissipated - 1.2).abs() < 1e-13);
    }

    /// The consistent tangent of theory 2.1: `C = [[K_p, 0, 0], [phi K_p m, b K_t (I - m m^T)]]`.
    #[test]
    fn tangent_of_slip_is_the_closed_form() {
        let (law, shear) = (Coulomb { friction: 0.3 }, [3.0, -4.0]);
        let motion = Motion { penetration: Dual::<8>::variable(0.1, 0), slip: [1, 2].map(|i| Dual::variable(0.1, i)) };
        let response = law.respond(&motion, &past(shear), &mut []).unwrap();
        let trial = [53.0, 46.0];
        let size = f64::hypot(53.0, 46.0);
        let (m, b) = (trial.map(|t| t / size), 30.0 / size);
        for i in 0..2 {
            assert!((response.shear[i].du[0] - 0.3 * 1e3 * m[i]).abs() < 1e-10);
            for j in 0..2 {
                let expected = b * 500.0 * (f64::from(i == j) - m[i] * m[j]);
                assert!((response.shear[i].du[1 + j] - expected).abs() < 1e-10);
            }
        }
    }
}
