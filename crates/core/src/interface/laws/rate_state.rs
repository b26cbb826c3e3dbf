//! Friction that depends on slip rate and state (Dieterich, Ruina), regularised at rest:
//! `tau_y = a p asinh(V / (2 V_0) exp((mu_0 + b ln(V_0 theta / D_c)) / a)) + eta V`.
//!
//! The state follows one of two laws, each integrated exactly at constant velocity over the increment, `x = V dt / D_c`:
//! *ageing* `theta' = 1 - V theta / D_c`, so that `theta` tends to `D_c / V` by `exp(-x)`; *slip*
//! `theta' = -(V theta / D_c) ln(V theta / D_c)`, so that the logarithm fades by `exp(-x)`. The slip velocity solves
//! `|tau_trial| - K_t V dt = tau_y(V)` in `ln V`; there is no stick, slow slip only.
//!
//! Over an increment in which the velocity changes as it does in stick-slip one such step is of first order only, and its
//! jumps come a tenth too soon. Unless `update` says otherwise an increment is therefore one step of the two-step scheme.
//! Schemes of second order are made of steps of backward Euler in `ln theta`, which what is exact at constant velocity is
//! not: by those the state follows that (see [`StateCourse`]).
//!
//! The solution is unique where slip in the increment stays below `a p / (b p / D_c - K_t)`, or everywhere if `K_t` is
//! above `b p / D_c`; a faster solution is refused, so that the increment is cut.

use super::implicit::no_midpoint;
use super::trial::Trial;
use crate::Failure;
use crate::declare::{Entry, Parameter, Range, Variable, VariableKind, unit};
use crate::integrate::{Scheme, System, Update, root};
use crate::interface::integrated::Integrated;
use crate::interface::{Interface, InterfaceLaw, Law, Motion, Past, Response, Status};
use crate::tensor::Scalar;

const fn number(key: &'static str, meaning: &'static str, unit: &'static str, range: Range) -> Parameter {
    Parameter { key, meaning, unit, range, default: None }
}

const PARAMETERS: &[Parameter] = &[
    number("friction", "coefficient of friction mu_0 at steady reference velocity", unit::NONE, Range::NOT_NEGATIVE),
    number("direct", "direct effect a of the velocity", unit::NONE, Range::POSITIVE),
    number("evolution", "effect b of the state", unit::NONE, Range::NOT_NEGATIVE),
    number("distance", "slip D_c over which the state is renewed", unit::LENGTH, Range::POSITIVE),
    number("velocity", "reference velocity V_0", unit::VELOCITY, Range::POSITIVE),
    Parameter {
        default: Some(1.0),
        ..number("state", "initial state over that of steady reference velocity", unit::NONE, Range::POSITIVE)
    },
    Parameter {
        default: Some(0.0),
        ..number("damping", "shear stress for one unit of velocity", unit::VISCOSITY, Range::NOT_NEGATIVE)
    },
];

pub(super) const AGEING: Entry<Box<dyn Interface>> = Entry {
    name: "rate_and_state",
    meaning: "friction that depends on velocity and on a state that ages (Dieterich)",
    parameters: PARAMETERS,
    pairs: None,
    build: |v| RateState::of(v, Evolution::Ageing).updated(TWO_STEP),
};

pub(super) const SLIP: Entry<Box<dyn Interface>> = Entry {
    name: "rate_and_state_slip",
    meaning: "friction that depends on velocity and on a state that changes by slip only (Ruina)",
    parameters: PARAMETERS,
    pairs: None,
    build: |v| RateState::of(v, Evolution::Slip).updated(TWO_STEP),
};

/// How an increment is integrated unless the user says.
const TWO_STEP: Update = Update { scheme: Scheme::TwoStep, substeps: 1, tolerance: None };

/// How the state changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Evolution {
    /// It grows at rest.
    Ageing,
    /// Only slip changes it.
    Slip,
}

/// How the state is carried over a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StateCourse {
    /// Exactly at a constant velocity.
    Exact,
    /// By backward Euler in the logarithm of the state.
    Implicit,
}

/// The law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RateState {
    /// Coefficient of friction at steady reference velocity.
    pub friction: f64,
    /// Direct effect `a`.
    pub direct: f64,
    /// Effect `b` of the state.
    pub evolution: f64,
    /// Slip that renews the state.
    pub distance: f64,
    /// Reference velocity.
    pub velocity: f64,
    /// Initial state, over that of steady reference velocity.
    pub state: f64,
    /// Radiation damping.
    pub damping: f64,
    /// How the state changes.
    pub law: Evolution,
    /// How a step carries it.
    pub course: StateCourse,
}

/// The equation in `ln(V / V_0)`; data are the size of the trial stress, the pressure and `ln(V_0 theta / D_c)`.
struct Velocity<'a> {
    law: &'a RateState,
    stiffness: f64,
    dt: f64,
    scale: f64,
}

impl System<1, 3> for Velocity<'_> {
    fn residual<S: Scalar>(&self, &[rate]: &[S; 1], &[trial, pressure, before]: &[S; 3]) -> [S; 1] {
        let state = self.law.state_after(rate, before, self.dt);
        let slip = self.law.speed(rate) * self.dt;
        [(trial - slip * self.stiffness - self.law.stress(pressure, rate, state)) / self.scale]
    }
}

/// `ln(V / V_0)` of a point that does not move.
const REST: f64 = -600.0;

/// `asinh(exp(z))`, also where the exponential is no number.
fn asinh_exp<T: Scalar>(z: T) -> T {
    if z.re() < 18.0 {
        return z.exp().asinh();
    }
    let small = (-2.0 * z.re()).exp();
    z.chain(z.re() + std::f64::consts::LN_2 + 0.25 * small, 1.0 - 0.5 * small)
}

/// `(1 - exp(-x)) / x`.
fn mean_fade<T: Scalar>(x: T) -> T {
    let r = x.re();
    if r.abs() < 1e-4 {
        return x.chain(1.0 - r * (0.5 - r / 6.0), -0.5 + r / 3.0);
    }
    let value = -(-r).exp_m1() / r;
    x.chain(value, ((-r).exp() - value) / r)
}

/// The root `u` of `u - c exp(-u) = d`: with `w = c exp(-u)` it is that of `w + ln w = ln c - d`, by Newton's method, which
/// climbs to it, and once more for the derivatives.
fn aged_implicitly<T: Scalar>(d: T, c: f64) -> T {
    let level = c.ln() - d.re();
    if level < -700.0 {
        return d;
    }
    let mut w = if level > 1.0 { level - level.ln() } else { level.exp() / (1.0 + level.exp()) };
    for _ in 0..40 {
        let next = w * (1.0 + level - w.ln()) / (1.0 + w);
        let change = (next - w).abs();
        w = next;
        if change <= 2.0 * f64::EPSILON * w {
            break;
        }
    }
    // The form that does not subtract what is nearly equal.
    let value = if w > 1.0 { c.ln() - w.ln() } else { d.re() + w };
    d.chain(value, 1.0 / (1.0 + w))
}

impl RateState {
    fn of(v: &[f64], law: Evolution) -> Self {
        let [friction, direct, evolution, distance, velocity, state, damping] = std::array::from_fn(|i| v[i]);
        Self { friction, direct, evolution, distance, velocity, state, damping, law, course: StateCourse::Exact }
    }

    fn speed<T: Scalar>(&self, rate: T) -> T {
        rate.exp() * self.velocity
    }

    /// Shear stress at `rate = ln(V / V_0)` and `state = ln(V_0 theta / D_c)`.
    pub fn stress<T: Scalar>(&self, pressure: T, rate: T, state: T) -> T {
        let level = (state * self.evolution + self.friction) / self.direct;
        let friction = asinh_exp(rate - std::f64::consts::LN_2 + level) * self.direct;
        pressure * friction + self.speed(rate) * self.damping
    }

    /// The logarithm of the state after `dt` at a constant velocity.
    pub fn state_after<T: Scalar>(&self, rate: T, before: T, dt: f64) -> T {
        let (x, aged) = (self.speed(rate) * (dt / self.distance), self.velocity * dt / self.distance);
        match (self.law, self.course) {
            (Evolution::Ageing, StateCourse::Exact) => (before.exp() * (-x).exp() + mean_fade(x) * aged).ln(),
            (Evolution::Slip, StateCourse::Exact) => (rate + before) * (-x).exp() - rate,
            (Evolution::Ageing, StateCourse::Implicit) => aged_implicitly(before - x, aged),
            (Evolution::Slip, StateCourse::Implicit) => (before - x * rate) / (x + 1.0),
        }
    }

    /// The slip of an increment up to which the solution is unique; infinite where it always is. `most` is more slip
    /// than there can be.
    fn unique(&self, [pressure, stiffness]: [f64; 2], most: f64, before: f64, dt: f64) -> f64 {
        let lead = match self.law {
            Evolution::Ageing => 0.0,
            Evolution::Slip => ((most / (dt * self.velocity)).ln() + before).max(0.0),
        };
        let fall = pressure * self.evolution * (1.0 + lead) / self.distance - stiffness;
        if fall > 0.0 { self.direct * pressure / fall } else { f64::INFINITY }
    }

    /// Two values of `ln(V / V_0)` between which the residual changes its sign.
    fn bracket(&self, equation: &Velocity, data: &[f64; 3], before: f64) -> Result<[f64; 2], Failure> {
        let value = |rate: f64| equation.residual(&[rate], data)[0];
        let most = data[0] / equation.stiffness * (1.0 + 1e-9);
        let unique = self.unique([data[1], equation.stiffness], most, before, equation.dt);
        let high = (most.min(unique) / (equation.dt * self.velocity)).ln();
        if value(high) > 0.0 {
            let slow = format!("slip beyond {unique:.3e} in one increment is not unique");
            let why = "its tangential penalty is below b p / D_c";
            return Err(Failure::new(format!("rate-and-state friction: {slow}, since {why}; a shorter one is needed")));
        }
        let low = (0..12).map(|k| high - f64::from(1 << k)).find(|&low| value(low) > 0.0);
        Ok([low.ok_or_else(|| Failure::new("rate-and-state friction: no velocity is slow enough"))?, high])
    }
}

impl InterfaceLaw for RateState {
    const VARIABLES: &'static [Variable] = &[
        Variable { name: "log_state", kind: VariableKind::Scalar },
        Variable { name: "slip_velocity", kind: VariableKind::Scalar },
    ];

    fn initial(&self, vars: &mut [f64]) {
        vars[0] = self.state.ln();
    }

    fn updated(&self, update: Update) -> Result<Box<dyn Interface>, String> {
        no_midpoint(update)?;
        let course = if update.scheme == Scheme::BackwardEuler { StateCourse::Exact } else { StateCourse::Implicit };
        Ok(Box::new(Law(Integrated { law: Self { course, ..*self }, update })))
    }

    fn respond<T: Scalar>(&self, motion: &Motion<T>, past: &Past<T>, vars: &mut [T]) -> Result<Response<T>, Failure> {
        let (trial, pressure) = (Trial::new(motion, past), motion.penetration * past.penalty);
        let (before, dt) = (past.vars[0], past.dt);
        if pressure.re() <= 0.0 || trial.size.re() == 0.0 {
            (vars[0], vars[1]) = (self.state_after(T::from(REST), before, dt), T::zero());
            return Ok(trial.slide(pressure, T::zero()));
        }
        let equation = Velocity { law: self, stiffness: past.tangential_penalty, dt, scale: trial.size.re() };
        let data = [trial.size, pressure, before];
        let bracket = self.bracket(&equation, &data.map(T::re), before.re())?;
        let rate = root(&equation, bracket, &data, "rate-and-state friction")?;
        vars[0] = self.state_after(rate, before, dt);
        vars[1] = self.speed(rate);
        let limit = self.stress(pressure, rate, vars[0]);
        let slipped = vars[1].re() * dt;
        let response = trial.slide(pressure, limit);
        Ok(Response { slipped, dissipated: limit.re() * slipped, status: Status::Slip, ..response })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: RateState = RateState {
        friction: 0.6,
        direct: 0.01,
        evolution: 0.015,
        distance: 1e-5,
        velocity: 1e-6,
        state: 1.0,
        damping: 0.0,
        law: Evolution::Ageing,
        course: StateCourse::Exact,
    };

    #[test]
    fn implicit_ageing_solves_its_equation() {
        use crate::tensor::Dual;
        for d in [-1e6, -800.0, -30.0, -1.0, 0.0, 2.0, 40.0, 800.0] {
            for c in [1e-30, 1e-6, 0.3, 1.0, 50.0, 1e9] {
                let u = aged_implicitly(Dual::<1>::variable(d, 0), c);
                // `u = d + w`, `w = c exp(-u)`, in logarithms where it is large.
                let w = u.re - d;
                let miss = if w > 1.0 { w.ln() - (c.ln() - u.re) } else { w - c * (-u.re).exp() };
                assert!(miss.abs() < 1e-12 * (1.0 + d.abs()), "{d} {c}: {miss}");
                assert!((u.du[0] * (1.0 + w) - 1.0).abs() < 1e-9 * (1.0 + d.abs()), "{d} {c}");
            }
        }
    }

    #[test]
    fn helpers_are_smooth_where_their_formulas_change() {
        for z in [17.999_999, 18.000_001] {
            assert!((asinh_exp(z) - f64::asinh(f64::exp(z))).abs() < 1e-13);
        }
        for x in [0.999_999e-4_f64, 1.000_001e-4] {
            assert!((mean_fade(x) + (-x).exp_m1() / x).abs() < 1e-12);
        }
        assert_eq!(mean_fade(0.0), 1.0);
    }

    /// A jump of the velocity to ten times, at constant velocity: the direct effect, then both laws against their
    /// closed forms, in steps of any length.
    #[test]
    fn velocity_step_of_a_rigid_slider() {
        let ten = 10.0_f64.ln();
        for (law, after) in [
            (Evolution::Ageing, (|d: f64| 0.6 + 0.0230259 + 0.015 * (0.1 + 0.9 * (-d).exp()).ln()) as fn(f64) -> f64),
            (Evolution::Slip, |d: f64| 0.5884871 + 0.0345388 * (-d).exp()),
        ] {
            let law = RateState { law, ..LAW };
            assert!((law.stress(1.0, ten, 0.0) - 0.6230259).abs() < 1e-7);
            let (mut state, dt) = (0.0, 0.37);
            for step in 1..=40 {
                state = law.state_after(ten, state, dt);
                let slip = 1e-5 * dt * f64::from(step);
                assert!((law.stress(1.0, ten, state) - after(slip / 1e-5)).abs() < 1e-6, "{law:?} {step}");
            }
            assert!((law.stress(1.0, ten, state) - 0.5884871).abs() < 1e-6);
        }
        let at_one = |law| law_at(law, 1.0);
        assert!((at_one(Evolution::Slip) - 0.601193).abs() < 1e-6);
        assert!((at_one(Evolution::Ageing) - 0.610404).abs() < 1e-6);
    }

    fn law_at(law: Evolution, slip: f64) -> f64 {
        let (law, ten) = (RateState { law, ..LAW }, 10.0_f64.ln());
        law.stress(1.0, ten, law.state_after(ten, 0.0, slip))
    }

    #[test]
    fn an_increment_that_is_too_long_says_why() {
        let vars = [0.0, 1e-6];
        let past = Past {
            penalty: 1e10,
            tangential_penalty: 5e9,
            penetration: 1e-3,
            pressure: 1e7,
            shear: [6e6, 0.0],
            vars: &vars,
            dt: 1.0,
        };
        let motion = Motion { penetration: 1e-3, slip: [1e-3, 0.0] };
        let failure = LAW.respond(&motion, &past, &mut vars.clone()).unwrap_err();
        assert!(failure.reason.contains("not unique"), "{failure}");
    }
}
