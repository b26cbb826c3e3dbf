//! Modified Cam-clay (Roscoe and Burland 1968): `f = q^2/M^2 + p (p - pc)`, associated, with pressure `p` positive in
//! compression and elasticity that stiffens with it.
//!
//! Pressure and preconsolidation are exact exponentials over a step, `p = p_n exp(v de_v^e/kappa)` and
//! `pc = pc_n exp(v de_v^p/(lambda - kappa))`, with the specific volume `v` of the beginning; the shear modulus is the
//! secant of the bulk modulus at constant Poisson's ratio, `G = r (p - p_n)/de_v^e`, `r = 3 (1 - 2 nu)/(2 (1 + nu))`, or constant.
//! Two unknowns are left, the plastic compaction and the multiplier of the flow.
//!
//! Schemes of second order are made of steps of backward Euler, of which the exponentials are none: by `update` with such
//! a scheme the pressures are `p = p_n/(1 - v de_v^e/kappa)` and `pc = pc_n/(1 - v de_v^p/(lambda - kappa))`, and `G = r K(p)`
//! is that of the end (see [`PressureCourse`]).

use super::elastic::POISSON;
use super::rate;
use crate::Failure;
use crate::declare::{Entry, Parameter, Range, VariableKind, unit};
use crate::integrate::{Scheme, System, Update, solve};
use crate::material::integrated::Integrated;
use crate::material::{Flow, Lapse, Material, Rate, RateLaw, Variable};
use crate::tensor::{Scalar, Tensor2};

const fn positive(key: &'static str, meaning: &'static str, unit: &'static str) -> Parameter {
    Parameter { key, meaning, unit, range: Range::POSITIVE, default: None }
}

const PARAMETERS: [Parameter; 7] = [
    positive("critical_slope", "slope M of the critical state line, q over p", unit::NONE),
    positive("lambda", "slope of the normal compression line, specific volume over ln p", unit::NONE),
    positive("kappa", "slope of the swelling lines", unit::NONE),
    Parameter {
        key: "specific_volume",
        meaning: "specific volume at the beginning, kept in the slopes",
        unit: unit::NONE,
        range: Range { least: Some((1.0, false)), most: None },
        default: None,
    },
    POISSON,
    positive("initial_pressure", "pressure at the beginning, equal in all directions", unit::STRESS),
    positive("preconsolidation", "largest pressure ever borne", unit::STRESS),
];

pub(super) const ENTRY: Entry<Box<dyn Material>> = Entry {
    name: "modified_cam_clay",
    meaning: "modified Cam-clay with exactly integrated, pressure-dependent elasticity",
    parameters: &PARAMETERS,
    pairs: None,
    build: |v| {
        let poisson = v[4];
        if poisson < 0.0 {
            return Err(format!("`poisson`, {poisson}, must not be negative in a soil"));
        }
        build(v, Stiffness::Ratio(1.5 * (1.0 - 2.0 * poisson) / (1.0 + poisson)))
    },
};

pub(super) const CONSTANT_SHEAR: Entry<Box<dyn Material>> = Entry {
    name: "modified_cam_clay_constant_shear",
    meaning: "modified Cam-clay whose shear modulus does not depend on the pressure",
    parameters: &{
        let mut parameters = PARAMETERS;
        parameters[4] = positive("shear", "shear modulus", unit::STRESS);
        parameters
    },
    pairs: None,
    build: |v| build(v, Stiffness::Constant(v[4])),
};

fn build(v: &[f64], shear: Stiffness) -> Result<Box<dyn Material>, String> {
    let [slope, lambda, kappa, volume, _, pressure, preconsolidation] = std::array::from_fn(|i| v[i]);
    if kappa >= lambda {
        return Err(format!("`kappa`, {kappa}, must be smaller than `lambda`, {lambda}"));
    }
    if pressure > preconsolidation {
        return Err(format!("`preconsolidation`, {preconsolidation}, is below `initial_pressure`, {pressure}"));
    }
    Ok(rate(CamClay {
        slope,
        elastic: kappa / volume,
        plastic: (lambda - kappa) / volume,
        shear,
        pressure,
        preconsolidation,
        course: PressureCourse::Exact,
    }))
}

/// The shear modulus.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stiffness {
    /// Over the bulk modulus, by Poisson's ratio.
    Ratio(f64),
    /// Itself.
    Constant(f64),
}

/// How a step carries a pressure that grows with compaction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PressureCourse {
    /// By its exponential.
    Exact,
    /// By backward Euler, of which schemes of second order are made.
    Implicit,
}

impl PressureCourse {
    /// That of which a scheme is made.
    pub(super) fn of(scheme: Scheme) -> Self {
        if scheme == Scheme::BackwardEuler { Self::Exact } else { Self::Implicit }
    }

    /// A pressure before the compaction `x`, a ratio, over that after it; by backward Euler there is none after `x = 1`.
    pub(super) fn left<S: Scalar>(self, x: S) -> S {
        match self {
            Self::Exact => (-x).exp(),
            Self::Implicit => -x + 1.0,
        }
    }
}

/// The law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CamClay {
    /// Slope M of the critical state line.
    pub slope: f64,
    /// `kappa/v`.
    pub elastic: f64,
    /// `(lambda - kappa)/v`.
    pub plastic: f64,
    /// Shear modulus.
    pub shear: Stiffness,
    /// Pressure at the beginning.
    pub pressure: f64,
    /// Preconsolidation at the beginning.
    pub preconsolidation: f64,
    /// How a step carries both.
    pub course: PressureCourse,
}

/// `(exp(x) - 1)/x`, smooth through zero.
fn growth<S: Scalar>(x: S) -> S {
    let value = x.re();
    if value.abs() < 1e-2 {
        // Seven terms leave less than rounding.
        return (1..=7).rev().fold(S::one(), |sum, n| x * sum / f64::from(n + 1) + 1.0);
    }
    (x.exp() - 1.0) / x
}

/// Where a step begins: pressure, preconsolidation, compaction of the step, and of the deviators of the stress and of
/// the strain increment `s:s`, `s:e`, `e:e`.
#[derive(Clone, Copy)]
struct Step<S> {
    p: S,
    pc: S,
    compaction: S,
    ss: S,
    se: S,
    ee: S,
}

impl<S: Scalar> Step<S> {
    fn of(&[p, pc, compaction, ss, se, ee]: &[S; 6]) -> Self {
        Self { p, pc, compaction, ss, se, ee }
    }

    /// Pressure and twice the shear modulus after the elastic compaction `de`.
    fn elastic(&self, law: &CamClay, de: S) -> (S, S) {
        let x = de / law.elastic;
        let p = self.p * law.grown(x);
        let double_shear = match (law.shear, law.course) {
            (Stiffness::Constant(shear), _) => S::from(2.0 * shear),
            (Stiffness::Ratio(ratio), PressureCourse::Exact) => self.p * growth(x) * (2.0 * ratio / law.elastic),
            (Stiffness::Ratio(ratio), PressureCourse::Implicit) => p * (2.0 * ratio / law.elastic),
        };
        (p, double_shear)
    }

    /// Equivalent stress of the deviator `s + 2 G e`.
    fn deviator(&self, double_shear: S) -> S {
        ((self.ss + self.se * double_shear * 2.0 + self.ee * double_shear * double_shear) * 1.5).sqrt()
    }
}

impl CamClay {
    /// `q` after the multiplier `flow` (a strain), which shortens the deviator.
    fn shortening<S: Scalar>(&self, double_shear: S, flow: S, p0: S) -> S {
        (flow * double_shear * (3.0 / (self.slope * self.slope)) / p0 + 1.0).recip()
    }

    fn hardened<S: Scalar>(&self, pc: S, plastic: S) -> S {
        pc * self.grown(plastic / self.plastic)
    }

    /// A pressure after the compaction `x`, both as ratios.
    fn grown<S: Scalar>(&self, x: S) -> S {
        match self.course {
            PressureCourse::Implicit if x.re() >= 1.0 => S::from(f64::NAN),
            course => course.left(x).recip(),
        }
    }
}

/// Unknowns: plastic compaction and multiplier, both as ratios to `kappa/v`.
impl System<2, 6> for CamClay {
    fn residual<S: Scalar>(&self, &[a, flow]: &[S; 2], data: &[S; 6]) -> [S; 2] {
        let step = Step::of(data);
        let (a, flow) = (a * self.elastic, flow * self.elastic);
        let (p, double_shear) = step.elastic(self, step.compaction - a);
        let pc = self.hardened(step.pc, a);
        let q = step.deviator(double_shear) * self.shortening(double_shear, flow, step.pc);
        let surface = q * q / (self.slope * self.slope) + p * (p - pc);
        [(a - flow * (p * 2.0 - pc) / step.pc) / self.elastic, surface / (step.pc * step.pc)]
    }
}

impl RateLaw for CamClay {
    type Vars<T: Scalar> = [T; 3];
    const VARIABLES: &'static [Variable] = &[
        Variable { name: "preconsolidation", kind: VariableKind::Scalar },
        Variable { name: "plastic_volume_strain", kind: VariableKind::Scalar },
        Variable { name: "plastic_shear_strain", kind: VariableKind::Scalar },
    ];

    fn initial(&self, state: &mut [f64]) {
        state[..3].fill(-self.pressure);
        state[6] = self.preconsolidation;
    }

    fn updated(&self, update: Update) -> Box<dyn Material> {
        Box::new(Rate(Integrated { law: Self { course: PressureCourse::of(update.scheme), ..*self }, update }))
    }

    fn update<T: Scalar>(
        &self,
        de: Tensor2<T>,
        stress: Tensor2<T>,
        &[pc, volume, shear]: &[T; 3],
        _lapse: Lapse,
    ) -> Result<(Tensor2<T>, [T; 3]), Failure> {
        let (p, s, e) = (stress.trace() * (-1.0 / 3.0), stress.deviator(), de.deviator());
        if p.re() <= 0.0 {
            return Err(Failure::new("Cam-clay: the pressure is lost"));
        }
        let data = [p, pc, -de.trace(), s.contract(s), s.contract(e), e.contract(e)];
        let step = Step::of(&data);
        let (p_trial, double_shear) = step.elastic(self, step.compaction);
        let q = step.deviator(double_shear);
        if !p_trial.re().is_finite() {
            return Err(Failure::new("Cam-clay: the increment compacts more than a step can follow"));
        }
        let trial = (q * q * (1.0 / (self.slope * self.slope)) + p_trial * (p_trial - pc)).re();
        let finish = |p: T, double_shear: T, scale: T| {
            Tensor2::from_fn(|i, j| {
                let deviator = (s[(i, j)] + e[(i, j)] * double_shear) * scale;
                if i == j { deviator - p } else { deviator }
            })
        };
        if trial <= 0.0 {
            return Ok((finish(p_trial, double_shear, T::one()), [pc, volume, shear]));
        }
        let [a, flow] = solve(self, [0.0, 0.0], &data, "Cam-clay")?;
        let (a, flow) = (a * self.elastic, flow * self.elastic);
        if flow.re() < 0.0 {
            return Err(Failure::new("Cam-clay: the local iteration finds unloading where there is loading"));
        }
        let (p, double_shear) = step.elastic(self, step.compaction - a);
        let scale = self.shortening(double_shear, flow, pc);
        let q = step.deviator(double_shear) * scale;
        let more = flow * q * (2.0 / (self.slope * self.slope)) / pc;
        Ok((finish(p, double_shear, scale), [self.hardened(pc, a), volume - a, shear + more]))
    }

    fn own_update(&self) -> Option<Update> {
        Some(Update::ADAPTIVE)
    }

    fn flow(&self) -> Flow {
        Flow::Dilatant
    }

    /// Of the volume: the energy of the pressure above that of the beginning; of the shape `q^2/(6 G)`.
    fn stored_energy(&self, stress: &Tensor2, _: &[f64; 3]) -> f64 {
        let (p, s) = (-stress.trace() / 3.0, stress.deviator());
        let shear = match self.shear {
            Stiffness::Ratio(ratio) => ratio * p / self.elastic,
            Stiffness::Constant(shear) => shear,
        };
        self.elastic * (p - self.pressure) + 0.25 * s.contract(s) / shear
    }

    fn dissipation(&self, old: (&Tensor2, &[f64; 3]), new: (&Tensor2, &[f64; 3])) -> f64 {
        let (p, s) = (-new.0.trace() / 3.0, new.0.deviator());
        p * (old.1[1] - new.1[1]) + (1.5 * s.contract(s)).sqrt() * (new.1[2] - old.1[2])
    }
}
