//! Friction coefficients that go from one value to another, `mu = mu_1 + (mu_0 - mu_1) exp(-x / x_c)`:
//!
//! - `static_kinetic`: `x` is the slip since the point last stuck;
//! - `slip_dependent`: `x` is all slip so far, and friction may rise (hardening, wear) or fall;
//! - `work_dependent`: `x` is all work of friction so far per area;
//! - `velocity_dependent`: `x` is the slip velocity.

use super::implicit::{self, Limit, Sliding};
use super::law;
use crate::Failure;
use crate::declare::{Entry, Parameter, Range, Variable, VariableKind, unit};
use crate::interface::{Interface, InterfaceLaw, Motion, Past, Response, Status};
use crate::tensor::Scalar;

const fn friction(key: &'static str, meaning: &'static str) -> Parameter {
    Parameter { key, meaning, unit: unit::NONE, range: Range::NOT_NEGATIVE, default: None }
}

const fn scale(key: &'static str, meaning: &'static str, unit: &'static str) -> Parameter {
    Parameter { key, meaning, unit, range: Range::POSITIVE, default: None }
}

const STATIC: Parameter = friction("static", "coefficient of friction at rest");
const KINETIC: Parameter = friction("kinetic", "coefficient of friction in motion");
const INITIAL: Parameter = friction("initial", "coefficient of friction at the beginning");
const FINAL: Parameter = friction("final", "coefficient of friction that it tends to");

pub(super) const STATIC_KINETIC: Entry<Box<dyn Interface>> = Entry {
    name: "static_kinetic",
    meaning: "friction that falls from its static to its kinetic value with the slip since it last stuck",
    parameters: &[STATIC, KINETIC, scale("slip", "slip over which the difference falls to 1/e", unit::LENGTH)],
    pairs: None,
    build: |v| falling(v).map(|mu| law(StaticKinetic(mu))),
};

pub(super) const VELOCITY: Entry<Box<dyn Interface>> = Entry {
    name: "velocity_dependent",
    meaning: "friction that goes from its static to its kinetic value with the slip velocity",
    parameters: &[STATIC, KINETIC, scale("velocity", "velocity at which the difference is 1/e", unit::VELOCITY)],
    pairs: None,
    build: |v| Ok(law(VelocityDependent(Decay::of(v)))),
};

pub(super) const SLIP: Entry<Box<dyn Interface>> = Entry {
    name: "slip_dependent",
    meaning: "friction that hardens or wears off with all slip so far",
    parameters: &[INITIAL, FINAL, scale("slip", "slip over which the difference falls to 1/e", unit::LENGTH)],
    pairs: None,
    build: |v| Ok(law(SlipDependent(Decay::of(v)))),
};

pub(super) const WORK: Entry<Box<dyn Interface>> = Entry {
    name: "work_dependent",
    meaning: "friction that hardens or wears off with all work of friction so far",
    parameters: &[INITIAL, FINAL, scale("work", "work per area over which the difference falls to 1/e", unit::WORK)],
    pairs: None,
    build: |v| Ok(law(WorkDependent(Decay::of(v)))),
};

/// A coefficient that goes from one value to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Decay {
    /// The value at zero.
    pub first: f64,
    /// The value that it tends to.
    pub last: f64,
    /// Where the difference is 1/e.
    pub scale: f64,
}

fn falling(v: &[f64]) -> Result<Decay, String> {
    let (first, last) = (v[0], v[1]);
    if last > first {
        return Err(format!("`kinetic` must be at most `static`, {first}, not {last}"));
    }
    Ok(Decay::of(v))
}

impl Decay {
    fn of(v: &[f64]) -> Self {
        Self { first: v[0], last: v[1], scale: v[2] }
    }
    /// The coefficient.
    pub fn at<T: Scalar>(&self, x: T) -> T {
        (x * (-1.0 / self.scale)).exp() * (self.first - self.last) + self.last
    }
    /// Its steepest fall.
    fn fall(&self) -> f64 {
        (self.first - self.last).max(0.0) / self.scale
    }
}

/// See `static_kinetic`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticKinetic(pub Decay);
/// See `velocity_dependent`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VelocityDependent(pub Decay);
/// See `slip_dependent`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlipDependent(pub Decay);
/// See `work_dependent`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WorkDependent(pub Decay);

impl Limit for Decay {
    const NAME: &'static str = "friction that depends on slip";
    fn limit<T: Scalar>(&self, at: &Sliding<T>) -> T {
        at.pressure * self.at(at.memory + at.slip)
    }
    fn fall(&self, pressure: f64, _: f64, _: f64) -> f64 {
        pressure * Decay::fall(self)
    }
}

impl Limit for VelocityDependent {
    const NAME: &'static str = "friction that depends on velocity";
    fn limit<T: Scalar>(&self, at: &Sliding<T>) -> T {
        at.pressure * self.0.at(at.slip / at.dt)
    }
    fn fall(&self, pressure: f64, _: f64, dt: f64) -> f64 {
        pressure * self.0.fall() / dt
    }
}

impl Limit for WorkDependent {
    const NAME: &'static str = "friction that depends on its work";
    fn limit<T: Scalar>(&self, at: &Sliding<T>) -> T {
        at.pressure * self.0.at(at.memory + at.shear * at.slip)
    }
    fn fall(&self, pressure: f64, trial: f64, _: f64) -> f64 {
        pressure * self.0.fall() * trial
    }
}

const fn variable(name: &'static str) -> Variable {
    Variable { name, kind: VariableKind::Scalar }
}

impl InterfaceLaw for StaticKinetic {
    const VARIABLES: &'static [Variable] = &[variable("slip_since_stick")];

    fn respond<T: Scalar>(&self, motion: &Motion<T>, past: &Past<T>, vars: &mut [T]) -> Result<Response<T>, Failure> {
        let (response, slip) = implicit::respond(&self.0, motion, past, past.vars[0])?;
        vars[0] = if response.status == Status::Stick { T::zero() } else { past.vars[0] + slip };
        Ok(response)
    }
}

impl InterfaceLaw for VelocityDependent {
    const VARIABLES: &'static [Variable] = &[];

    fn respond<T: Scalar>(&self, motion: &Motion<T>, past: &Past<T>, _: &mut [T]) -> Result<Response<T>, Failure> {
        Ok(implicit::respond(self, motion, past, T::zero())?.0)
    }
}

impl InterfaceLaw for SlipDependent {
    const VARIABLES: &'static [Variable] = &[variable("worn_slip")];

    fn respond<T: Scalar>(&self, motion: &Motion<T>, past: &Past<T>, vars: &mut [T]) -> Result<Response<T>, Failure> {
        let (response, slip) = implicit::respond(&self.0, motion, past, past.vars[0])?;
        vars[0] = past.vars[0] + slip;
        Ok(response)
    }
    /// Worn is worn.
    fn release(&self, old: &[f64], new: &mut [f64]) {
        new.copy_from_slice(old);
    }
}

impl InterfaceLaw for WorkDependent {
    const VARIABLES: &'static [Variable] = &[variable("friction_work")];

    fn respond<T: Scalar>(&self, motion: &Motion<T>, past: &Past<T>, vars: &mut [T]) -> Result<Response<T>, Failure> {
        let (response, slip) = implicit::respond(self, motion, past, past.vars[0])?;
        let size = (response.shear[0] * response.shear[0] + response.shear[1] * response.shear[1]).sqrt();
        vars[0] = past.vars[0] + size * slip;
        Ok(response)
    }
    /// Worn is worn.
    fn release(&self, old: &[f64], new: &mut [f64]) {
        new.copy_from_slice(old);
    }
}
