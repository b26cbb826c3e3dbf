//! Coulomb's dry friction as non-associated plasticity without dilatancy (Charlier & Habraken 1990):
//! `f = |tau| - phi p`, flow along `tau`, pressure `p = K_p u`.
//!
//! The increment is integrated in closed form: see [`cone`](super::cone).

use super::cone::{ConeScheme, Path};
use super::law;
use crate::Failure;
use crate::declare::{Entry, Parameter, Range, Variable, unit};
use crate::integrate::{Scheme, Update};
use crate::interface::integrated::Integrated;
use crate::interface::{Interface, InterfaceLaw, Law, Motion, Past, Response, Status};
use crate::tensor::Scalar;

pub(super) const FRICTION: Parameter = Parameter {
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
    build: |v| Ok(law(Coulomb { friction: v[0], scheme: ConeScheme::Exact })),
};

/// The law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coulomb {
    /// Coefficient of friction.
    pub friction: f64,
    /// How slip that turns is integrated.
    pub scheme: ConeScheme,
}

impl Coulomb {
    /// The law, integrated in closed form.
    pub fn new(friction: f64) -> Self {
        Self { friction, scheme: ConeScheme::Exact }
    }
}

impl InterfaceLaw for Coulomb {
    const VARIABLES: &'static [Variable] = &[];

    fn respond<T: Scalar>(&self, motion: &Motion<T>, past: &Past<T>, _: &mut [T]) -> Result<Response<T>, Failure> {
        let pressure = motion.penetration * past.penalty;
        let limit = pressure * self.friction;
        let step = motion.slip.map(|slip| slip * past.tangential_penalty);
        let end = Path { start: past.shear, limit: (past.pressure * self.friction, limit), step }.end(self.scheme);
        let size = end.shear[0].re().hypot(end.shear[1].re());
        let violation = if end.slip.is_some() && limit.re() > 0.0 { (size / limit.re() - 1.0).max(0.0) } else { 0.0 };
        Ok(Response {
            pressure,
            shear: end.shear,
            status: if end.slip.is_some() { Status::Slip } else { Status::Stick },
            slipped: end.slip.unwrap_or(0.0) / past.tangential_penalty,
            closure: 0.0,
            dissipated: end.work / past.tangential_penalty,
            violation,
        })
    }

    fn sliding_stress(&self, pressure: f64) -> Option<f64> {
        Some(self.friction * pressure)
    }

    /// The schemes of the cone itself; with a tolerance, and by two implicit stages, as any other law.
    fn updated(&self, update: Update) -> Result<Box<dyn Interface>, String> {
        let scheme = match update.scheme {
            Scheme::BackwardEuler => ConeScheme::BackwardEuler(update.substeps),
            Scheme::Midpoint(theta) => ConeScheme::Midpoint(update.substeps, theta),
            Scheme::TwoStep | Scheme::Adaptive(_) => ConeScheme::Exact,
        };
        if update.tolerance.is_none() && scheme != ConeScheme::Exact {
            return Ok(law(Self { scheme, ..*self }));
        }
        let one = Self { scheme: ConeScheme::BackwardEuler(1), ..*self };
        Ok(Box::new(Law(Integrated { law: one, update })))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tensor::Dual;

    fn past<T: Scalar>(shear: [f64; 2]) -> Past<'static, T> {
        let (penetration, pressure, shear) = (T::zero(), T::zero(), shear.map(T::from));
        Past { penalty: 1e3, tangential_penalty: 500.0, penetration, pressure, shear, vars: &[], dt: 1.0 }
    }

    #[test]
    fn sticks_below_the_limit_and_slips_on_it() {
        let law = Coulomb::new(0.3);
        let at = |slip: f64| law.respond(&Motion { penetration: 0.1, slip: [slip, 0.0] }, &past([0.0; 2]), &mut []);
        let stick = at(0.05).unwrap();
        assert_eq!((stick.status, stick.shear[0], stick.dissipated), (Status::Stick, 25.0, 0.0));
        let slip = at(-0.1).unwrap();
        assert_eq!((slip.status, slip.shear[0]), (Status::Slip, -30.0));
        // Trial 50, limit 30: 20 / 500 of slip while the limit grows from 0 to 30.
        assert!((slip.slipped - 0.04).abs() < 1e-14 && (slip.dissipated - 0.6).abs() < 1e-13);
    }

    /// The consistent tangent of the radial return: `C = [[K_p, 0, 0], [phi K_p m, b K_t (I - m m^T)]]`.
    #[test]
    fn tangent_of_slip_is_the_closed_form() {
        let law = Coulomb { friction: 0.3, scheme: ConeScheme::BackwardEuler(1) };
        let shear = [3.0, -4.0];
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
