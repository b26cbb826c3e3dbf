//! Coulomb's cone with cohesion, a bond and dilation that wears off (after Nova): `f = |tau| - phi p - c`, flow along
//! `|tau| - psi p` with `psi = psi_0 exp(-s / s_c)` and the irreversible slip `s`.
//!
//! Dilation is integrated exactly along the slip, `-w = psi_0 s_c (1 - exp(-s / s_c))`, whatever the increments, so that
//! its total is `psi_0 s_c`; with `p = K_p (u - w)` the slip `dl` of an increment solves
//! `|tau_trial| - K_t dl = phi (p_trial + K_p dw) + c`. A bonded point carries tension up to `t_c <= c / phi`; where the
//! trial pressure reaches `-t_c` the point opens, and bond and cohesion are lost for good; the shear strength, no more than
//! `10 (p + t_c)`, is gone by then. The dilation of an open point is kept, except for the part `reset_dilation`. No more
//! than `psi_0 <= phi`: beyond it energy would come from nowhere.

use super::coulomb::FRICTION;
use super::law;
use super::trial::{STEEPEST, Trial};
use crate::Failure;
use crate::declare::{Entry, Parameter, Range, Variable, VariableKind, unit};
use crate::integrate::{System, root};
use crate::interface::{Interface, InterfaceLaw, Motion, Past, Response};
use crate::tensor::Scalar;

const COHESION: Parameter = Parameter {
    key: "cohesion",
    meaning: "shear strength without pressure, as long as the bond holds",
    unit: unit::STRESS,
    range: Range::NOT_NEGATIVE,
    default: Some(0.0),
};

const TENSION: Parameter = Parameter {
    key: "tension",
    meaning: "tensile strength of the bond, at most cohesion over friction",
    unit: unit::STRESS,
    range: Range::NOT_NEGATIVE,
    default: Some(0.0),
};

const DILATANCY: Parameter = Parameter {
    key: "dilatancy",
    meaning: "opening for one unit of slip at the beginning, at most the friction",
    unit: unit::NONE,
    range: Range::NOT_NEGATIVE,
    default: None,
};

const DILATION_SLIP: Parameter = Parameter {
    key: "dilation_slip",
    meaning: "slip over which the dilatancy falls to 1/e; its total is dilatancy times this",
    unit: unit::LENGTH,
    range: Range::POSITIVE,
    default: None,
};

pub(super) const RESET: Parameter = Parameter {
    key: "reset_dilation",
    meaning: "part of what has dilated or closed that a point forgets when it opens",
    unit: unit::NONE,
    range: Range::from_to(0.0, 1.0),
    default: Some(0.0),
};

pub(super) const COHESIVE: Entry<Box<dyn Interface>> = Entry {
    name: "cohesive",
    meaning: "dry friction with cohesion and tensile strength, both lost for good where the bond breaks",
    parameters: &[FRICTION, Parameter { default: None, ..COHESION }, TENSION],
    pairs: None,
    build: |v| Dilatant::checked([v[0], v[1], v[2]], [0.0, 1.0, 0.0]).map(law),
};

pub(super) const DILATANT: Entry<Box<dyn Interface>> = Entry {
    name: "dilatant",
    meaning: "friction that opens the interface as it slips, by less and less",
    parameters: &[FRICTION, DILATANCY, DILATION_SLIP, COHESION, TENSION, RESET],
    pairs: None,
    build: |v| Dilatant::checked([v[0], v[3], v[4]], [v[1], v[2], v[5]]).map(law),
};

/// The law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dilatant {
    /// Coefficient of friction.
    pub friction: f64,
    /// Cohesion of the bond.
    pub cohesion: f64,
    /// Its tensile strength.
    pub tension: f64,
    /// Dilatancy at the beginning.
    pub dilatancy: f64,
    /// Slip over which it falls to 1/e.
    pub dilation_slip: f64,
    /// Part of the dilation that an opening point forgets.
    pub reset: f64,
}

/// Places of the variables.
const BROKEN: usize = 0;
const SLIP: usize = 1;
const DILATION: usize = 2;

/// The equation in the slip of the increment; its data are the sizes of the trial stress and the old slip.
struct Return<'a> {
    law: &'a Dilatant,
    stiffness: [f64; 2],
    strength: [f64; 2],
    scale: f64,
}

impl System<1, 3> for Return<'_> {
    fn residual<S: Scalar>(&self, &[slip]: &[S; 1], &[shear, pressure, before]: &[S; 3]) -> [S; 1] {
        let pressure = pressure + self.law.opening(before, slip) * self.stiffness[0];
        [(shear - slip * self.stiffness[1] - self.law.limit(pressure, self.strength)) / self.scale]
    }
}

impl Dilatant {
    fn checked(
        [friction, cohesion, tension]: [f64; 3],
        [dilatancy, dilation_slip, reset]: [f64; 3],
    ) -> Result<Self, String> {
        if dilatancy > friction {
            return Err(format!("`dilatancy` must be at most the friction, {friction}: beyond it energy is given out"));
        }
        if tension * friction > cohesion {
            return Err(format!("`tension` must be at most cohesion over friction, {}", cohesion / friction));
        }
        Ok(Self { friction, cohesion, tension, dilatancy, dilation_slip, reset })
    }

    /// Cohesion and tensile strength, as long as the bond holds.
    fn strength<T: Scalar>(&self, past: &Past<T>) -> [f64; 2] {
        if past.vars[BROKEN].re() > 0.0 { [0.0; 2] } else { [self.cohesion, self.tension] }
    }

    /// The shear strength under a pressure, which is gone where the bond breaks.
    fn limit<T: Scalar>(&self, pressure: T, [cohesion, tension]: [f64; 2]) -> T {
        (pressure * self.friction + cohesion).min((pressure + tension) * self.friction.max(STEEPEST))
    }

    /// Opening by the slip `slip` after the slip `before`.
    fn opening<T: Scalar>(&self, before: T, slip: T) -> T {
        let fade = |s: T| (s * (-1.0 / self.dilation_slip)).exp();
        fade(before) * (-fade(slip) + 1.0) * (self.dilatancy * self.dilation_slip)
    }
}

impl InterfaceLaw for Dilatant {
    const VARIABLES: &'static [Variable] = &[
        Variable { name: "bond_broken", kind: VariableKind::Scalar },
        Variable { name: "dilating_slip", kind: VariableKind::Scalar },
        Variable { name: "dilation", kind: VariableKind::Scalar },
    ];

    fn respond<T: Scalar>(&self, motion: &Motion<T>, past: &Past<T>, vars: &mut [T]) -> Result<Response<T>, Failure> {
        let trial = Trial::new(motion, past);
        // From the slip alone: a scheme that combines states keeps no other relation between the two.
        let dilation = self.opening(T::zero(), past.vars[SLIP]);
        let pressure = (motion.penetration + dilation) * past.penalty;
        let (strength, before) = (self.strength(past), past.vars[SLIP]);
        let limit = self.limit(pressure, strength);
        let most = trial.size.re() / past.tangential_penalty;
        let dilated = self.limit(pressure.re() + past.penalty * self.opening(before.re(), most), strength);
        if trial.size.re() <= limit.re() || dilated <= 0.0 {
            return Ok(trial.within(pressure, limit));
        }
        let stiffness = [past.penalty, past.tangential_penalty];
        let scale = trial.size.re() + limit.re().abs();
        let equation = Return { law: self, stiffness, strength, scale };
        let slip = root(&equation, [0.0, most], &[trial.size, pressure, before], "dilatant friction")?;
        let opening = self.opening(before, slip);
        let pressure = pressure + opening * past.penalty;
        vars[SLIP] = before + slip;
        vars[DILATION] = dilation + opening;
        let response = trial.slide(pressure, self.limit(pressure, strength));
        let given_back = pressure.re() * opening.re();
        Ok(Response { closure: -opening.re(), dissipated: response.dissipated - given_back, ..response })
    }

    fn release(&self, old: &[f64], new: &mut [f64]) {
        new[BROKEN] = 1.0;
        new[SLIP] = (1.0 - self.reset) * old[SLIP];
        new[DILATION] = self.opening(0.0, new[SLIP]);
    }

    fn touch(&self, past: &Past) -> f64 {
        -past.vars[DILATION] - self.strength(past)[1] / past.penalty
    }

    fn keeps(&self, past: &Past) -> f64 {
        let [cohesion, tension] = self.strength(past);
        let lost = (cohesion - self.friction * tension) / (STEEPEST - self.friction).max(1.0);
        self.touch(past) + lost.clamp(1e-3 * tension, tension) / past.penalty
    }

    /// At the tensile strength there is no shear strength left: where all of the slip has dilated.
    fn opens(&self, past: &Past, slip: [f64; 2]) -> f64 {
        let trial = [0, 1].map(|i| past.shear[i] + past.tangential_penalty * slip[i]);
        self.touch(past) - self.opening(past.vars[SLIP], trial[0].hypot(trial[1]) / past.tangential_penalty)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interface::Status;

    const LAW: Dilatant =
        Dilatant { friction: 0.6, cohesion: 2.0, tension: 1.0, dilatancy: 0.3, dilation_slip: 0.02, reset: 0.0 };

    fn past(vars: &[f64]) -> Past<'_> {
        let (penalty, tangential_penalty) = (1e3, 700.0);
        Past { penalty, tangential_penalty, penetration: 0.01, pressure: 10.0, shear: [0.0; 2], vars, dt: 1.0 }
    }

    /// Penetration held: the stress moves up the line `tau = phi p + c`, and the pressure by the dilation.
    #[test]
    fn a_held_interface_moves_along_the_line_to_its_total_dilation() {
        for steps in [1, 7, 100] {
            let (mut vars, mut shear) = ([0.0; 3], [0.0; 2]);
            for _ in 0..steps {
                let motion = Motion { penetration: 0.01, slip: [1.0 / f64::from(steps), 0.0] };
                let old = vars;
                let response = LAW.respond(&motion, &Past { shear, ..past(&old) }, &mut vars).unwrap();
                shear = response.shear;
                let pressure = 10.0 + 1e3 * 0.3 * 0.02 * (1.0 - (-vars[SLIP] / 0.02).exp());
                assert!((response.pressure - pressure).abs() < 1e-10);
                let limit = 0.6 * pressure + 2.0;
                assert!(response.status == Status::Stick || (shear[0] - limit).abs() < 1e-10 * limit, "{steps}");
                assert!(response.dissipated >= 0.0);
            }
            assert!((vars[DILATION] - 0.3 * 0.02).abs() < 1e-12, "{}", vars[DILATION]);
        }
    }

    /// Slip pushes a point apart by more than it was pressed together, and its pressure still falls to its strength
    /// without a jump.
    #[test]
    fn a_point_stays_closed_while_it_dilates() {
        let (vars, slip) = ([1.0, 0.01, 0.3 * 0.02 * (1.0 - (-0.5_f64).exp())], [0.05, 0.02]);
        let past = past(&vars);
        let (touch, opens) = (LAW.touch(&past), LAW.opens(&past, slip));
        assert!(opens < touch - 2e-3, "{opens} {touch}");
        for above in [1e-12, 1e-4, 1e-3] {
            let motion = Motion { penetration: opens + above, slip };
            let response = LAW.respond(&motion, &past, &mut vars.clone()).unwrap();
            assert!(
                (response.pressure / (1e3 * above) - 1.0).abs() < 0.5 && response.dissipated >= 0.0,
                "{response:?}"
            );
        }
    }

    /// The shear strength falls with the pressure, to nothing without a jump where the bond breaks.
    #[test]
    fn shear_is_gone_as_the_bond_breaks() {
        for dilatancy in [0.0, 0.3] {
            let (law, old) = (Dilatant { dilatancy, ..LAW }, [0.0; 3]);
            let (past, slip) = (past(&old), [0.03, 0.04]);
            let opens = law.opens(&past, slip);
            for above in [1e-9, 1e-6, 1e-4] {
                let motion = Motion { penetration: opens + above, slip };
                let response = law.respond(&motion, &past, &mut [0.0; 3]).unwrap();
                let (over, shear) = (response.pressure + law.tension, response.shear[0].hypot(response.shear[1]));
                assert!(0.0 < over && over <= 1.001e3 * above, "{dilatancy} {response:?}");
                assert!((shear / (STEEPEST * over) - 1.0).abs() < 1e-6, "{dilatancy} {response:?}");
            }
        }
    }

    #[test]
    fn a_broken_bond_stays_broken_and_dilation_stays() {
        let dilation = 0.3 * 0.02 * (1.0 - (-1.0_f64).exp());
        let old = [0.0, 0.02, dilation];
        assert!((LAW.touch(&past(&old)) + dilation + 0.001).abs() < 1e-15);
        let motion = Motion { penetration: -dilation - 5e-4, slip: [0.0; 2] };
        let held = LAW.respond(&motion, &past(&old), &mut old.clone()).unwrap();
        assert_eq!(held.status, Status::Stick);
        assert!((held.pressure + 0.5).abs() < 1e-12);
        let mut new = [0.0; 3];
        LAW.release(&old, &mut new);
        assert_eq!((new[BROKEN], new[SLIP]), (1.0, 0.02));
        assert!((LAW.touch(&past(&new)) + dilation).abs() < 1e-15);
        // Without cohesion now: |tau| = phi p.
        let motion = Motion { penetration: 0.01, slip: [1e-4, 1.0] };
        let slid = LAW.respond(&motion, &past(&new), &mut new.clone()).unwrap();
        assert!((f64::hypot(slid.shear[0], slid.shear[1]) / slid.pressure - 0.6).abs() < 1e-12);
        Dilatant { reset: 1.0, ..LAW }.release(&old, &mut new);
        assert_eq!(new, [1.0, 0.0, 0.0]);
    }
}
