//! Friction coefficients that go from one value to another, `mu = mu_1 + (mu_0 - mu_1) exp(-x / x_c)`:
//!
//! - `static_kinetic`: `x` is the slip since the point last stuck, if only on the way through an increment: where the
//!   elastic path of an increment first leads inside the limit, as on reversal, the point has stuck;
//! - `slip_dependent`: `x` is all slip so far, and friction may rise (hardening, wear) or fall;
//! - `work_dependent`: `x` is all work of friction so far per area;
//! - `velocity_dependent`: `x` is the slip velocity. Friction that falls with it follows it with a delay,
//!   `x' = (V - x) / t`: without one the slip of a short increment is not unique, since friction would fall at once by
//!   more than the tangential penalty follows. Unless said `t = 2 p mu_fall / K_t`, the time in which the steepest fall of
//!   friction lets the elastic slip go twice: it vanishes with growing penalty, as elastic slip does. Friction that rises
//!   needs no delay.

use super::implicit::{self, Limit, Sliding, no_midpoint};
use super::law;
use crate::Failure;
use crate::declare::{Entry, Parameter, Range, Variable, VariableKind, unit};
use crate::integrate::Update;
use crate::interface::integrated::Integrated;
use crate::interface::{Interface, InterfaceLaw, Law, Motion, Past, Response, Status};
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

const DELAY: Parameter = Parameter {
    key: "delay",
    meaning: "time in which friction follows the velocity; where friction falls, at least what the tangential penalty needs for a unique slip",
    unit: unit::TIME,
    range: Range::NOT_NEGATIVE,
    default: Some(0.0),
};

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
    parameters: &[STATIC, KINETIC, scale("velocity", "velocity at which the difference is 1/e", unit::VELOCITY), DELAY],
    pairs: None,
    build: |v| Ok(law(VelocityDependent { friction: Decay::of(v), delay: v[3] })),
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
pub struct VelocityDependent {
    /// The coefficient over the velocity.
    pub friction: Decay,
    /// Least time in which it follows the velocity.
    pub delay: f64,
}
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

/// Friction at one pressure that follows the velocity in part.
struct Following {
    friction: Decay,
    delay: f64,
    /// The delay for one unit of pressure, where it is what the penalty needs.
    needed: f64,
}

impl VelocityDependent {
    fn following(&self, stiffness: f64) -> Following {
        let needed = SAFETY * Decay::fall(&self.friction) / stiffness;
        Following { friction: self.friction, delay: self.delay, needed }
    }
}

impl Following {
    /// The velocity that friction sees after an increment that begins with `memory`.
    fn seen<T: Scalar>(&self, at: &Sliding<T>) -> T {
        if at.dt == 0.0 {
            return at.memory;
        }
        let delay = (at.pressure * self.needed).max(T::from(self.delay));
        (at.memory * delay + at.slip) / (delay + at.dt)
    }
}

impl Limit for Following {
    const NAME: &'static str = "friction that depends on velocity";
    fn limit<T: Scalar>(&self, at: &Sliding<T>) -> T {
        at.pressure * self.friction.at(self.seen(at))
    }
    fn fall(&self, pressure: f64, _: f64, dt: f64) -> f64 {
        pressure * self.friction.fall() / (self.delay.max(pressure * self.needed) + dt)
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

/// How many times the shortest delay with a unique slip.
const SAFETY: f64 = 2.0;

const fn variable(name: &'static str) -> Variable {
    Variable { name, kind: VariableKind::Scalar }
}

/// Whether the elastic path of an increment first leads inside the limit `mu p`, so that the point sticks at least on the
/// way: the shear stress grows more slowly than its limit.
fn sticks_first<T: Scalar>(friction: f64, motion: &Motion<T>, past: &Past<T>) -> bool {
    let (shear, slip) = (past.shear.map(T::re), motion.slip.map(T::re));
    let size = shear[0].hypot(shear[1]);
    let rise = motion.penetration.re() * past.penalty - past.pressure.re();
    let along = if size > 0.0 { (shear[0] * slip[0] + shear[1] * slip[1]) / size } else { slip[0].hypot(slip[1]) };
    past.tangential_penalty * along < friction * rise
}

impl InterfaceLaw for StaticKinetic {
    const VARIABLES: &'static [Variable] = &[variable("slip_since_stick")];

    fn respond<T: Scalar>(&self, motion: &Motion<T>, past: &Past<T>, vars: &mut [T]) -> Result<Response<T>, Failure> {
        // A scheme may have led beyond the beginning of the slip.
        let before = past.vars[0].max(T::zero());
        let (still, rested) = (past.dt == 0.0, sticks_first(self.0.at(before.re()), motion, past));
        let before = if rested && !still { T::zero() } else { before };
        let (response, slip) = implicit::respond(&self.0, motion, past, before)?;
        // Without time nothing has come to rest.
        let rests = response.status == Status::Stick && !still;
        vars[0] = if rests { T::zero() } else { before + slip };
        Ok(response)
    }
}

impl InterfaceLaw for VelocityDependent {
    const VARIABLES: &'static [Variable] = &[variable("friction_velocity")];

    fn respond<T: Scalar>(&self, motion: &Motion<T>, past: &Past<T>, vars: &mut [T]) -> Result<Response<T>, Failure> {
        let following = self.following(past.tangential_penalty);
        let (response, slip) = implicit::respond(&following, motion, past, past.vars[0])?;
        let (pressure, memory) = (response.pressure, past.vars[0]);
        vars[0] = following.seen(&Sliding { pressure, shear: slip, slip, memory, dt: past.dt });
        Ok(response)
    }

    /// The midpoint rule would carry the velocity on from the middle of an increment, to twice what it is after rest.
    fn updated(&self, update: Update) -> Result<Box<dyn Interface>, String> {
        no_midpoint(update)?;
        Ok(Box::new(Law(Integrated { law: *self, update })))
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
