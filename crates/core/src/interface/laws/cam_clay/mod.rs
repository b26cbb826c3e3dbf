//! An interface like Cam-clay: associated flow on the ellipse `f = tau.tau + M^2 (p + p_t)(p - p_c)`.
//!
//! With the centre `h = (p_c - p_t) / 2` and the semi-axis `r = (p_c + p_t) / 2` the interface dilates below `h`, closes
//! above it, and slips without either at `p = h`, `|tau| = M r`. The surface printed by Charlier & Habraken (1990),
//! `tau^2 - phi p (p + a)`, is an open hyperbola; with one sign turned it is this one, `M^2 = phi`, `p_c = a`,
//! `p_t = 0`.
//!
//! At the tip `p = -p_t` that flow dilates without limit, and no stress of an open point is beside it. A cone `|tau| = k (p + p_t)` cuts
//! it off, below a hundredth of the ellipse, along which the flow is the one that the ellipse has where they meet: what is
//! slipped apart loses its stress steadily and then opens.
//!
//! With `chi` the ellipse hardens by closure and softens by dilation, `p_c = p_c0 exp(w / chi)`, down to a part of its first
//! size. A point opens where the trial pressure reaches `-p_t`, which is then lost; what has closed or dilated is kept but
//! for the part `reset_dilation`.

mod ellipse;
#[cfg(test)]
mod random;

use super::dilatant::RESET;
use super::law;
use super::trial::{STEEPEST, Trial};
use crate::Failure;
use crate::declare::{Entry, Parameter, Range, Variable, VariableKind, unit};
use crate::interface::{Interface, InterfaceLaw, Motion, Past, Response, Status};
use crate::tensor::Scalar;
use ellipse::Shape;

const fn needed(key: &'static str, meaning: &'static str, unit: &'static str) -> Parameter {
    Parameter { key, meaning, unit, range: Range::POSITIVE, default: None }
}

const TENSION: Parameter = Parameter {
    key: "tension",
    meaning: "tensile strength p_t of the bond",
    unit: unit::STRESS,
    range: Range::NOT_NEGATIVE,
    default: Some(0.0),
};

const HARDENING: Parameter = Parameter {
    key: "hardening",
    meaning: "closure chi that multiplies the preconsolidation by e; 0 for none",
    unit: unit::LENGTH,
    range: Range::NOT_NEGATIVE,
    default: Some(0.0),
};

const LEAST: Parameter = Parameter {
    key: "least",
    meaning: "part of the first preconsolidation below which it does not soften",
    unit: unit::NONE,
    range: Range::above_to(0.0, 1.0),
    default: Some(0.05),
};

pub(super) const ENTRY: Entry<Box<dyn Interface>> = Entry {
    name: "cam_clay",
    meaning: "associated ellipse in pressure and shear: dilates at small pressure, closes at large",
    parameters: &[
        needed("critical_slope", "ratio M of shear to pressure in the critical state", unit::NONE),
        needed("preconsolidation", "pressure p_c at which the ellipse ends", unit::STRESS),
        TENSION,
        HARDENING,
        LEAST,
        RESET,
    ],
    pairs: None,
    build: |v| {
        let [slope, preconsolidation, tension, hardening, least, reset] = std::array::from_fn(|i| v[i]);
        Ok(law(CamClayInterface { slope, preconsolidation, tension, hardening, least, reset }))
    },
};

pub(super) const PRINTED: Entry<Box<dyn Interface>> = Entry {
    name: "cam_clay_phi_a",
    meaning: "the same ellipse by the constants of Charlier and Habraken, with the sign repaired",
    parameters: &[
        needed("phi", "square of the ratio of shear to pressure in the critical state", unit::NONE),
        needed("a", "pressure at which the ellipse ends", unit::STRESS),
    ],
    pairs: None,
    build: |v| Ok(law(CamClayInterface::perfect(v[0].sqrt(), v[1], 0.0))),
};

/// The law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CamClayInterface {
    /// Ratio `M` of shear to pressure in the critical state.
    pub slope: f64,
    /// First preconsolidation `p_c0`.
    pub preconsolidation: f64,
    /// Tensile strength `p_t`.
    pub tension: f64,
    /// Closure that multiplies the preconsolidation by e; zero for a fixed ellipse.
    pub hardening: f64,
    /// Least preconsolidation over the first.
    pub least: f64,
    /// Part of the closure that an opening point forgets.
    pub reset: f64,
}

/// Places of the variables.
const BROKEN: usize = 0;
const CLOSURE: usize = 1;

impl CamClayInterface {
    /// Shear over pressure, and dilation over slip, on the cone that cuts the tip of the ellipse off: the flow is that of the ellipse
    /// where they meet, whatever its size.
    fn steepest(&self) -> [f64; 2] {
        [STEEPEST * self.slope, 0.5 * (STEEPEST - 1.0 / STEEPEST) * self.slope]
    }

    /// An ellipse of a fixed size.
    pub fn perfect(slope: f64, preconsolidation: f64, tension: f64) -> Self {
        Self { slope, preconsolidation, tension, hardening: 0.0, least: 1.0, reset: 0.0 }
    }
}

impl InterfaceLaw for CamClayInterface {
    const VARIABLES: &'static [Variable] = &[
        Variable { name: "bond_broken", kind: VariableKind::Scalar },
        Variable { name: "closure", kind: VariableKind::Scalar },
    ];

    fn respond<T: Scalar>(&self, motion: &Motion<T>, past: &Past<T>, vars: &mut [T]) -> Result<Response<T>, Failure> {
        let trial = Trial::new(motion, past);
        let before = past.vars[CLOSURE];
        let pressure = (motion.penetration - before) * past.penalty;
        let tension = if past.vars[BROKEN].re() > 0.0 { 0.0 } else { self.tension };
        let (ratio, penalty) = (past.tangential_penalty / past.penalty, past.penalty);
        let shape = Shape { law: self, ratio, penalty, tension };
        let last = shape.preconsolidation(shape.grown(before.re()));
        let at = [trial.size, pressure];
        let here = shape.end(0.0, last, at.map(T::re));
        if here.size <= here.wanted && !shape.is_steep(at.map(T::re)) {
            return Ok(trial.stick(pressure));
        }
        let [shear, pressure] = shape.steep(at, before).map_or_else(|| shape.returned(at, before), Ok)?;
        let closure = (at[1] - pressure) / penalty;
        vars[CLOSURE] = before + closure;
        let response = trial.slide(pressure, shear);
        let dissipated = response.dissipated + pressure.re() * closure.re();
        Ok(Response { closure: closure.re(), dissipated, status: Status::Slip, ..response })
    }

    fn release(&self, old: &[f64], new: &mut [f64]) {
        new[BROKEN] = 1.0;
        new[CLOSURE] = (1.0 - self.reset) * old[CLOSURE];
    }

    fn touch(&self, past: &Past) -> f64 {
        let strength = if past.vars[BROKEN] > 0.0 { 0.0 } else { self.tension };
        past.vars[CLOSURE] - strength / past.penalty
    }

    /// Where all that the shear stress lets slip has dilated.
    fn opens(&self, past: &Past, slip: [f64; 2]) -> f64 {
        let trial = [0, 1].map(|i| past.shear[i] + past.tangential_penalty * slip[i]);
        self.touch(past) - self.steepest()[1] * trial[0].hypot(trial[1]) / past.tangential_penalty
    }
}

#[cfg(test)]
mod tests {
    use super::random::Random;
    use super::*;
    use crate::interface::Law;

    fn past(vars: &[f64]) -> Past<'_> {
        let (penalty, tangential_penalty) = (1e3, 700.0);
        Past { penalty, tangential_penalty, penetration: 0.0, pressure: 0.0, shear: [0.0; 2], vars, dt: 1.0 }
    }

    /// Held at a penetration, slip leads to the critical state: `tau = M p` and no more closure; from the dry side by
    /// dilation, from the wet one by closure.
    #[test]
    fn slip_leads_to_the_critical_state() {
        let law = CamClayInterface::perfect(0.8, 100.0, 0.0);
        for penetration in [0.02, 0.09] {
            let (mut vars, mut shear, mut last) = ([0.0; 2], [0.0; 2], 0.0);
            for _ in 0..400 {
                let old = vars;
                let motion = Motion { penetration, slip: [0.003, 0.004] };
                let response = law.respond(&motion, &Past { shear, ..past(&old) }, &mut vars).unwrap();
                (shear, last) = (response.shear, response.pressure);
                assert!(response.dissipated >= 0.0);
            }
            assert!((last - 50.0).abs() < 1e-6 && (f64::hypot(shear[0], shear[1]) - 40.0).abs() < 1e-6, "{last}");
            assert!((vars[CLOSURE] - (penetration - 0.05)).abs() < 1e-8);
        }
    }

    /// What is slipped apart loses its stress without a jump, whatever it slips, and the cone at the tip goes over into the ellipse.
    #[test]
    fn a_point_opens_without_a_jump() {
        let (vars, slip) = ([0.0; 2], [0.03, 0.04]);
        for law in [
            CamClayInterface::perfect(0.8, 20.0, 0.0),
            CamClayInterface { hardening: 0.05, least: 0.1, ..CamClayInterface::perfect(1.5, 20.0, 0.0) },
        ] {
            let at = |penetration: f64| {
                let motion = Motion { penetration, slip };
                let response = law.respond(&motion, &past(&vars), &mut vars.clone()).unwrap();
                [response.pressure, response.shear[0].hypot(response.shear[1])]
            };
            let opens = law.opens(&past(&vars), slip);
            assert!(at(opens + 1e-9).iter().all(|stress| stress.abs() < 1e-3), "{law:?} {:?}", at(opens + 1e-9));
            let (steps, mut before) = (4000, at(opens + 1e-9));
            for i in 1..=steps {
                let now = at(opens * (1.0 - f64::from(i) / f64::from(steps)));
                let jump = [0, 1].map(|k| (now[k] - before[k]).abs()).iter().fold(0.0_f64, |a, b| a.max(*b));
                assert!(jump < 0.5, "{law:?} {i}: {before:?} {now:?}");
                before = now;
            }
        }
    }

    #[test]
    fn the_constants_of_the_paper_make_the_same_ellipse() {
        let law = (PRINTED.build)(&[0.64, 100.0]).unwrap();
        let other = CamClayInterface::perfect(0.8, 100.0, 0.0);
        let vars = [0.0; 2];
        let a = law.respond([0.03, 0.1, 0.0], &past(&vars), &mut vars.clone()).unwrap();
        let b = Law(other).respond([0.03, 0.1, 0.0], &past(&vars), &mut vars.clone()).unwrap();
        assert_eq!(a, b);
        let ([shear, _], pressure) = (a.shear(), a.pressure());
        let f = shear * shear + 0.64 * pressure * (pressure - 100.0);
        assert!(f.abs() < 1e-9, "{f}");
    }

    /// On the surface that belongs to its closure, normal to it.
    #[test]
    fn a_hardening_ellipse_is_consistent() {
        let law = CamClayInterface { hardening: 0.05, least: 0.1, ..CamClayInterface::perfect(0.8, 100.0, 5.0) };
        for (penetration, slip) in [(0.02, 0.1), (0.09, 0.1), (0.3, 0.0), (0.2, 1.0), (-0.001, 0.4)] {
            let old = [0.0; 2];
            let mut vars = old;
            let response = law.respond(&Motion { penetration, slip: [0.0, slip] }, &past(&old), &mut vars).unwrap();
            let last = 100.0 * (vars[CLOSURE] / 0.05).exp().max(0.1);
            let (p, tau) = (response.pressure, response.shear[1]);
            let f = tau * tau + 0.64 * (p + 5.0) * (p - last);
            assert!(f.abs() < 1e-6 * last * last, "{f} at {p}, {tau}, {last}");
            // Closure over slip is that of the normal.
            let normal = [0.64 * (2.0 * p + 5.0 - last), 2.0 * tau];
            assert!((vars[CLOSURE] * normal[1] - response.slipped * normal[0]).abs() < 1e-8, "{p} {tau}");
            assert!(response.dissipated >= 0.0);
        }
    }

    /// Whatever the increment, the return converges: far outside the ellipse, on both sides of the critical state, at
    /// its least size and away from it.
    #[test]
    fn hardening_returns_converge() {
        let mut random = Random(2);
        for _ in 0..20_000 {
            let (hardening, least) = (random.decades(2.0), 0.05 + 0.95 * random.next());
            let tension = if random.next() < 0.5 { 0.0 } else { random.next() };
            let law =
                CamClayInterface { hardening, least, ..CamClayInterface::perfect(random.decades(0.5), 1.0, tension) };
            let (old, penalty) = ([0.0, (random.next() - 0.5) * hardening], random.decades(2.0));
            let past = Past { penalty, tangential_penalty: penalty * random.decades(1.0), ..past(&old) };
            let motion = Motion {
                penetration: law.touch(&past) + random.decades(3.0) / penalty,
                slip: [random.decades(3.0) / penalty, random.decades(3.0) / penalty],
            };
            let mut vars = old;
            let failed = |failure: Failure| panic!("{failure}: {law:?} {past:?} {motion:?}");
            let response = law.respond(&motion, &past, &mut vars).unwrap_or_else(failed);
            assert!(response.dissipated >= -1e-12, "{law:?} {past:?} {motion:?} {response:?}");
        }
    }
}
