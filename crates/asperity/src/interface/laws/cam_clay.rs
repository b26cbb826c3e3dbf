//! An interface like Cam-clay: associated flow on the ellipse `f = tau.tau + M^2 (p + p_t)(p - p_c)`.
//!
//! With the centre `h = (p_c - p_t) / 2` and the semi-axis `r = (p_c + p_t) / 2` the interface dilates below `h`, closes
//! above it, and slips without either at `p = h`, `|tau| = M r`. The surface printed by Charlier & Habraken (1990),
//! `tau^2 - phi p (p + a)`, is an open hyperbola; with one sign turned it is this one, `M^2 = phi`, `p_c = a`,
//! `p_t = 0`.
//!
//! The return with the dimensionless multiplier `g` is `tau = tau_trial / (1 + k g)`, `p = h + (p_trial - h) / (1 + M^2 g)`,
//! `k = K_t / K_p`, and `S(g) = sqrt(|tau|^2 + M^2 (p - h)^2) = M r`. Newton's method on `1 / S - 1 / (M r)` climbs to
//! the root from below (the secular equation). With `chi` the ellipse hardens by closure and softens by dilation,
//! `p_c = p_c0 exp(w / chi)`, down to a part of its first size: two unknowns. A point opens where the trial pressure
//! reaches `-p_t`, which is then lost; what has closed or dilated is kept but for the part `reset_dilation`.

use super::dilatant::RESET;
use super::law;
use super::trial::Trial;
use crate::Failure;
use crate::declare::{Entry, Parameter, Range, Variable, VariableKind, unit};
use crate::integrate::{System, solve};
use crate::interface::{Interface, InterfaceLaw, Motion, Past, Response, Status};
use crate::tensor::Scalar;

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
        Ok(law(CamClay { slope, preconsolidation, tension, hardening, least, reset }))
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
    build: |v| Ok(law(CamClay::perfect(v[0].sqrt(), v[1], 0.0))),
};

/// The law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CamClay {
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

/// Shape of a return: the ratio of the penalties, the tensile strength, and a growth that is large in it.
#[derive(Debug, Clone, Copy)]
struct Shape<'a> {
    law: &'a CamClay,
    ratio: f64,
    penalty: f64,
    tension: f64,
    scale: f64,
}

/// Where a return ends for a multiplier and a preconsolidation.
struct End<S> {
    shear: S,
    pressure: S,
    /// `S(g)` and `M r`.
    size: S,
    wanted: S,
}

impl Shape<'_> {
    fn end<S: Scalar>(&self, g: S, last: S, [shear, pressure]: [S; 2]) -> End<S> {
        let slope = self.law.slope;
        let (centre, axis) = ((last - self.tension) * 0.5, (last + self.tension) * 0.5);
        let shear = shear / (g * self.ratio + 1.0);
        let away = (pressure - centre) / (g * (slope * slope) + 1.0);
        let size = (shear * shear + away * away * (slope * slope)).sqrt();
        End { shear, pressure: centre + away, size, wanted: axis * slope }
    }

    /// Logarithm of the preconsolidation over the first one, after the closure `w` since the beginning.
    fn grown<S: Scalar>(&self, w: S) -> S {
        let grown = if self.law.hardening > 0.0 { w / self.law.hardening } else { S::zero() };
        grown.max(S::from(self.law.least.ln()))
    }

    fn preconsolidation<S: Scalar>(&self, grown: S) -> S {
        grown.exp() * self.law.preconsolidation
    }

    /// The multiplier for a fixed ellipse, and the number of iterations.
    fn secular(&self, last: f64, [shear, pressure]: [f64; 2]) -> Option<(f64, usize)> {
        let squared = self.law.slope * self.law.slope;
        let (k, m) = (self.ratio, squared);
        let (mut g, mut before) = (0.0, f64::INFINITY);
        for iteration in 0..60 {
            let end = self.end(g, last, [shear, pressure]);
            let miss = end.size / end.wanted - 1.0;
            if miss <= 1e-14 || miss >= before {
                return Some((g, iteration));
            }
            before = miss;
            let away = end.pressure - (last - self.tension) * 0.5;
            let slope = (k * end.shear * end.shear / (1.0 + k * g) + m * m * away * away / (1.0 + m * g)) / end.size;
            g += miss * end.size / slope;
            if !g.is_finite() {
                return None;
            }
        }
        None
    }

    /// The growth that belongs to a multiplier: the root of a rising function.
    fn consistent(&self, g: f64, trial: [f64; 2], before: f64) -> f64 {
        let miss = |grown: f64| {
            let end = self.end(g, self.preconsolidation(grown), trial);
            grown - self.grown(before + (trial[1] - end.pressure) / self.penalty)
        };
        let (mut low, mut high, mut step) = (self.grown(f64::NEG_INFINITY), self.grown(before), 1.0);
        while miss(high) < 0.0 && step < 1e3 {
            (low, high, step) = (high, high + step, 2.0 * step);
        }
        halved(low, high, |grown| miss(grown) < 0.0)
    }

    /// Multiplier and growth of an ellipse that hardens.
    fn bracketed(&self, trial: [f64; 2], before: f64) -> [f64; 2] {
        let outside = |g: f64| {
            let end = self.end(g, self.preconsolidation(self.consistent(g, trial, before)), trial);
            end.size > end.wanted
        };
        let (mut low, mut high) = (0.0, 1e-3);
        while outside(high) && high < 1e30 {
            (low, high) = (high, 4.0 * high);
        }
        let g = halved(low, high, outside);
        [g, self.consistent(g, trial, before)]
    }
}

/// Where a condition that holds at `low` ceases to.
fn halved(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        *(if holds(middle) { &mut low } else { &mut high }) = middle;
    }
    0.5 * (low + high)
}

/// In the multiplier; data are the sizes of the trial stress and the preconsolidation.
impl System<1, 3> for Shape<'_> {
    fn residual<S: Scalar>(&self, &[g]: &[S; 1], &[shear, pressure, last]: &[S; 3]) -> [S; 1] {
        let end = self.end(g, last, [shear, pressure]);
        [end.size / end.wanted - 1.0]
    }
}

/// In the multiplier and the growth; data are the sizes of the trial stress and the old closure.
impl System<2, 3> for Shape<'_> {
    fn residual<S: Scalar>(&self, &[g, grown]: &[S; 2], &[shear, pressure, before]: &[S; 3]) -> [S; 2] {
        let end = self.end(g, self.preconsolidation(grown), [shear, pressure]);
        let closure = before + (pressure - end.pressure) / self.penalty;
        [end.size / end.wanted - 1.0, (grown - self.grown(closure)) / self.scale]
    }
}

impl CamClay {
    /// An ellipse of a fixed size.
    pub fn perfect(slope: f64, preconsolidation: f64, tension: f64) -> Self {
        Self { slope, preconsolidation, tension, hardening: 0.0, least: 1.0, reset: 0.0 }
    }

    /// Shear and pressure on the surface.
    fn returned<T: Scalar>(&self, shape: &Shape, trial: [T; 2], before: T) -> Result<[T; 2], Failure> {
        const WHAT: &str = "Cam-clay of the interface";
        let plain = trial.map(T::re);
        let failed = || Failure::new(format!("{WHAT}: the return does not converge"));
        let end = if self.hardening > 0.0 {
            let (data, grown) = ([trial[0], trial[1], before], shape.grown(before.re()));
            let (first, _) = shape.secular(shape.preconsolidation(grown), plain).ok_or_else(failed)?;
            let from = |start| solve::<_, _, 2, 3>(shape, start, &data, WHAT).ok().filter(|[g, _]| g.re() > 0.0);
            let found = from([first, grown]).or_else(|| from(shape.bracketed(plain, before.re())));
            let [g, grown] = found.ok_or_else(failed)?;
            shape.end(g, shape.preconsolidation(grown), trial)
        } else {
            let last = self.preconsolidation;
            let (g, _) = shape.secular(last, plain).ok_or_else(failed)?;
            let [g] = solve::<_, _, 1, 3>(shape, [g], &[trial[0], trial[1], T::from(last)], WHAT)?;
            shape.end(g, T::from(last), trial)
        };
        Ok([end.shear, end.pressure])
    }
}

impl InterfaceLaw for CamClay {
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
        let mut shape = Shape { law: self, ratio, penalty, tension, scale: 1.0 };
        let last = shape.preconsolidation(shape.grown(before.re()));
        let at = [trial.size, pressure];
        let here = shape.end(0.0, last, at.map(T::re));
        if here.size <= here.wanted {
            return Ok(trial.stick(pressure));
        }
        shape.scale = 1.0 + at[1].re().abs() / (penalty * self.hardening.max(f64::MIN_POSITIVE));
        let [shear, pressure] = self.returned(&shape, at, before)?;
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

    /// At the tip of the ellipse a unit of slip would dilate without limit; more than `M` of it is taken for a gap.
    fn opens(&self, past: &Past, slip: [f64; 2]) -> f64 {
        let trial = [0, 1].map(|i| past.shear[i] + past.tangential_penalty * slip[i]);
        self.touch(past) - self.slope * trial[0].hypot(trial[1]) / past.tangential_penalty
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Random numbers in (0, 1) (splitmix64).
    struct Random(u64);

    impl Random {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
            let mut z = self.0;
            z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
        }
        /// Between 10^-a and 10^a.
        fn decades(&mut self, a: f64) -> f64 {
            10_f64.powf(a * (2.0 * self.next() - 1.0))
        }
    }

    /// Returns of trial stresses up to 10^6 times the ellipse, ratios of penalties over six decades.
    fn returns(count: usize) -> (usize, f64) {
        let (mut random, mut most, mut sum, mut outside) = (Random(1), 0, 0, 0);
        while outside < count {
            let law = CamClay::perfect(random.decades(0.7), 1.0, random.next());
            let shape = Shape { law: &law, ratio: random.decades(3.0), penalty: 1.0, tension: law.tension, scale: 1.0 };
            let trial = [random.decades(6.0), random.decades(6.0) * (2.0 * random.next() - 1.0)];
            let here = shape.end(0.0, 1.0, trial);
            if here.size <= here.wanted {
                continue;
            }
            outside += 1;
            let (g, iterations) = shape.secular(1.0, trial).unwrap();
            let end = shape.end(g, 1.0, trial);
            assert!((end.size / end.wanted - 1.0).abs() < 1e-12, "{trial:?} {law:?}");
            (most, sum) = (most.max(iterations), sum + iterations);
        }
        (most, sum as f64 / count as f64)
    }

    #[test]
    fn returns_take_few_iterations() {
        let (most, mean) = returns(20_000);
        assert!(most <= 12 && mean < 4.0, "{most} at most, {mean} in the mean");
    }

    /// `cargo test --release -p asperity --lib two_hundred_thousand_returns -- --ignored --nocapture`
    #[test]
    #[ignore = "long"]
    fn two_hundred_thousand_returns() {
        let (most, mean) = returns(200_000);
        eprintln!("{most} iterations at most, {mean:.2} in the mean");
        assert!(most <= 12);
    }

    fn past(vars: &[f64]) -> Past<'_> {
        let (penalty, tangential_penalty) = (1e3, 700.0);
        Past { penalty, tangential_penalty, penetration: 0.0, pressure: 0.0, shear: [0.0; 2], vars, dt: 1.0 }
    }

    /// Held at a penetration, slip leads to the critical state: `tau = M p` and no more closure; from the dry side by
    /// dilation, from the wet one by closure.
    #[test]
    fn slip_leads_to_the_critical_state() {
        let law = CamClay::perfect(0.8, 100.0, 0.0);
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

    #[test]
    fn the_constants_of_the_paper_make_the_same_ellipse() {
        let law = (PRINTED.build)(&[0.64, 100.0]).unwrap();
        let other = CamClay::perfect(0.8, 100.0, 0.0);
        let motion = Motion { penetration: 0.03, slip: [0.1, 0.0] };
        let vars = [0.0; 2];
        let a = law.respond(&motion, &past(&vars), &mut vars.clone()).unwrap();
        let b = other.respond(&motion, &past(&vars), &mut vars.clone()).unwrap();
        assert_eq!(a, b);
        let f = a.shear[0] * a.shear[0] + 0.64 * a.pressure * (a.pressure - 100.0);
        assert!(f.abs() < 1e-9, "{f}");
    }

    /// On the surface that belongs to its closure, normal to it.
    #[test]
    fn a_hardening_ellipse_is_consistent() {
        let law = CamClay { hardening: 0.05, least: 0.1, ..CamClay::perfect(0.8, 100.0, 5.0) };
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
            let law = CamClay { hardening, least, ..CamClay::perfect(random.decades(0.5), 1.0, tension) };
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
