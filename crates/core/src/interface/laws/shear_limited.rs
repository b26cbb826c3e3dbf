//! Friction that a soft solid cannot carry beyond a part `m` of its shear strength `k`: with `x = mu p / (m k)`,
//!
//! - Orowan: `tau_y = min(mu p, m k)`;
//! - smooth: `tau_y = m k tanh x`;
//! - Shaw: `tau_y = mu p / (1 + x^n)^(1/n)`;
//! - constant shear factor: Orowan's with the steepest friction, `tau_y = min(10 p, m k)`, so that it is gone as the contact opens.
//!
//! The limit depends on the pressure only, so the radial return is in closed form; on one line of slip it is exact.

use super::coulomb::FRICTION;
use super::law;
use super::trial::{STEEPEST, Trial};
use crate::Failure;
use crate::declare::{Entry, Parameter, Range, Variable, unit};
use crate::interface::{Interface, InterfaceLaw, Motion, Past, Response};
use crate::tensor::Scalar;

const STRENGTH: Parameter = Parameter {
    key: "shear_strength",
    meaning: "shear yield stress k of the softer solid",
    unit: unit::STRESS,
    range: Range::POSITIVE,
    default: None,
};

const FACTOR: Parameter = Parameter {
    key: "factor",
    meaning: "part m of the shear strength that the interface carries",
    unit: unit::NONE,
    range: Range::above_to(0.0, 1.0),
    default: Some(1.0),
};

const POWER: Parameter = Parameter {
    key: "power",
    meaning: "power n of the transition; the larger, the sharper",
    unit: unit::NONE,
    range: Range::from_to(1.0, 100.0),
    default: Some(2.0),
};

pub(super) const OROWAN: Entry<Box<dyn Interface>> = Entry {
    name: "orowan",
    meaning: "dry friction up to a part of the shear strength (Orowan)",
    parameters: &[FRICTION, STRENGTH, FACTOR],
    pairs: None,
    build: |v| Ok(law(ShearLimited { friction: v[0], most: v[1] * v[2], transition: Transition::Sharp })),
};

pub(super) const SMOOTH: Entry<Box<dyn Interface>> = Entry {
    name: "orowan_smooth",
    meaning: "dry friction up to a part of the shear strength, by a hyperbolic tangent",
    parameters: &[FRICTION, STRENGTH, FACTOR],
    pairs: None,
    build: |v| Ok(law(ShearLimited { friction: v[0], most: v[1] * v[2], transition: Transition::Smooth })),
};

pub(super) const SHAW: Entry<Box<dyn Interface>> = Entry {
    name: "shaw",
    meaning: "dry friction up to a part of the shear strength (Shaw)",
    parameters: &[FRICTION, STRENGTH, FACTOR, POWER],
    pairs: None,
    build: |v| Ok(law(ShearLimited { friction: v[0], most: v[1] * v[2], transition: Transition::Shaw(v[3]) })),
};

pub(super) const FACTOR_ONLY: Entry<Box<dyn Interface>> = Entry {
    name: "shear_factor",
    meaning: "a constant part of the shear strength, up to ten times the pressure",
    parameters: &[STRENGTH, FACTOR],
    pairs: None,
    build: |v| Ok(law(ShearLimited { friction: STEEPEST, most: v[0] * v[1], transition: Transition::Sharp })),
};

/// How friction reaches its largest value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Transition {
    /// Orowan's corner.
    Sharp,
    /// A hyperbolic tangent.
    Smooth,
    /// Shaw's formula with its power.
    Shaw(f64),
}

/// The law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShearLimited {
    /// Coefficient of friction at small pressure.
    pub friction: f64,
    /// Largest shear stress `m k`.
    pub most: f64,
    /// How it is reached.
    pub transition: Transition,
}

impl ShearLimited {
    /// Largest shear stress at a pressure.
    pub fn limit<T: Scalar>(&self, pressure: T) -> T {
        let (dry, most) = (pressure * self.friction, T::from(self.most));
        // A trial may come with a pressure below zero.
        let closed = dry.re() > 0.0;
        match self.transition {
            _ if !closed => dry,
            Transition::Sharp => dry.min(most),
            Transition::Smooth => (dry / most).tanh() * most,
            Transition::Shaw(n) => dry / ((dry / most).powf(n) + 1.0).powf(1.0 / n),
        }
    }
}

impl InterfaceLaw for ShearLimited {
    const VARIABLES: &'static [Variable] = &[];

    fn respond<T: Scalar>(&self, motion: &Motion<T>, past: &Past<T>, _: &mut [T]) -> Result<Response<T>, Failure> {
        let pressure = motion.penetration * past.penalty;
        Ok(Trial::new(motion, past).within(pressure, self.limit(pressure)))
    }

    fn sliding_stress(&self, pressure: f64) -> Option<f64> {
        Some(self.limit(pressure))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Friction 0.3, strength 100: the values at pressures of 200 and 500.
    #[test]
    fn limits_at_two_pressures() {
        for (transition, friction, values) in [
            (Transition::Sharp, 0.3, [60.0, 100.0]),
            (Transition::Smooth, 0.3, [53.7050, 90.5148]),
            (Transition::Shaw(2.0), 0.3, [51.4496, 83.2050]),
            (Transition::Sharp, STEEPEST, [100.0, 100.0]),
        ] {
            let law = ShearLimited { friction, most: 100.0, transition };
            for (pressure, value) in [200.0, 500.0].into_iter().zip(values) {
                assert!((law.limit(pressure) - value).abs() < 1e-4, "{transition:?}: {}", law.limit(pressure));
            }
        }
    }
}
