//! Gurson's porous plasticity after Tvergaard and Needleman (1984): with the flow stress `s(em)` of the matrix,
//! `(q/s)^2 + 2 q1 f* cosh(3/2 q2 p/s) - 1 - q3 f*^2 = 0`, `q3 = q1^2` unless said; voids grow with the plastic volume,
//! `df = (1 - f) dev + A(em) dem`, nucleate by a normal distribution of the matrix strain under tension, and coalesce:
//! beyond `fc` the effective porosity `f*` rises faster, to `1/q1` at `ff`.
//!
//! Implicit step after Aravas (1987): unknowns are the plastic volume strain `ev`, the plastic shear strain `eq` and the
//! matrix strain; with `p = p_trial - K ev`, `q = q_trial - 3 G eq` they satisfy the flow rule, the surface and the
//! equality of works `(1 - f) s dem = p ev + q eq`.

use super::elastic::{Elastic, POISSON, YOUNG};
use super::hardening::{Hardening, LINEAR, SATURATION, SATURATION_RATE, YIELD};
use super::invariants::Invariants;
use super::rate;
use crate::Failure;
use crate::declare::{Entry, Parameter, Range, VariableKind, unit};
use crate::integrate::{System, solve};
use crate::material::{Material, RateLaw, Variable};
use crate::tensor::{Scalar, Tensor2};

const fn number(key: &'static str, meaning: &'static str, range: Range, default: Option<f64>) -> Parameter {
    Parameter { key, meaning, unit: unit::NONE, range, default }
}

const FRACTION: Range = Range { least: Some((0.0, true)), most: Some((1.0, false)) };

pub(super) const ENTRY: Entry<Box<dyn Material>> = Entry {
    name: "gurson",
    meaning: "porous plasticity of Gurson, Tvergaard and Needleman",
    parameters: &[
        YOUNG,
        POISSON,
        YIELD,
        LINEAR,
        SATURATION,
        SATURATION_RATE,
        number("porosity", "porosity at the beginning", Range::between(0.0, 0.5), None),
        number("q1", "Tvergaard's factor of the porosity", Range::from_to(0.5, 3.0), Some(1.5)),
        number("q2", "Tvergaard's factor of the mean stress", Range::from_to(0.5, 2.0), Some(1.0)),
        number("q3", "Tvergaard's factor of the squared porosity", Range::from_to(0.0, 9.0), Some(2.25)),
        number("nucleated", "porosity of the voids that may nucleate", FRACTION, Some(0.0)),
        number("nucleation_strain", "mean matrix strain of nucleation", Range::NOT_NEGATIVE, Some(0.3)),
        number("nucleation_spread", "standard deviation of that strain", Range::POSITIVE, Some(0.1)),
        number("critical_porosity", "porosity at which voids begin to coalesce", FRACTION, Some(0.15)),
        number("failure_porosity", "porosity at which nothing is left", FRACTION, Some(0.25)),
    ],
    pairs: None,
    build,
};

fn build(v: &[f64]) -> Result<Box<dyn Material>, String> {
    let elastic = Elastic::new(v[0], v[1]);
    let matrix = Hardening::Combined { first: v[2], linear: v[3], saturation: v[4], rate: v[5] };
    matrix.check(3.0 * elastic.shear)?;
    let [critical, failure] = [v[13], v[14]];
    if critical >= failure {
        return Err(format!("`critical_porosity`, {critical}, must be smaller than `failure_porosity`, {failure}"));
    }
    if v[6] >= critical {
        return Err(format!("`porosity`, {}, must be smaller than `critical_porosity`, {critical}", v[6]));
    }
    if v[7] * critical >= 1.0 || v[9] > v[7] * v[7] {
        return Err("`q1` times `critical_porosity` must be below 1, and `q3` at most `q1` squared".into());
    }
    let nucleation = Nucleation { porosity: v[10], strain: v[11], spread: v[12] };
    Ok(rate(Gurson { elastic, matrix, porosity: v[6], q: [v[7], v[8], v[9]], nucleation, critical, failure }))
}

/// Voids that nucleate by a normal distribution of the matrix strain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nucleation {
    /// Their porosity.
    pub porosity: f64,
    /// Mean strain.
    pub strain: f64,
    /// Standard deviation.
    pub spread: f64,
}

/// The law.
#[derive(Debug, Clone, PartialEq)]
pub struct Gurson {
    /// Elasticity.
    pub elastic: Elastic,
    /// Flow stress of the matrix.
    pub matrix: Hardening,
    /// Porosity at the beginning.
    pub porosity: f64,
    /// Factors q1, q2, q3.
    pub q: [f64; 3],
    /// Nucleation.
    pub nucleation: Nucleation,
    /// Porosity where coalescence begins.
    pub critical: f64,
    /// Porosity where nothing is left.
    pub failure: f64,
}

/// The effective porosity stays below this part of the largest, so that a dead point keeps a surface.
const ALIVE: f64 = 0.98;

impl Gurson {
    /// `f*`.
    fn effective<S: Scalar>(&self, f: S) -> S {
        let most = 1.0 / self.q[0];
        let slope = (most - self.critical) / (self.failure - self.critical);
        let star = if f.re() <= self.critical { f } else { (f - self.critical) * slope + self.critical };
        star.min(S::from(ALIVE * most))
    }

    /// Porosity after the plastic volume strain `ev` and the matrix strain `dm` from `em`; nucleation needs tension.
    fn grown<S: Scalar>(&self, f: S, ev: S, (em, dm): (S, S), tension: bool) -> S {
        let Nucleation { porosity, strain, spread } = self.nucleation;
        let density = |x: S| {
            let y = (x - strain) / spread;
            (y * y * -0.5).exp() * (porosity / (spread * std::f64::consts::TAU.sqrt()))
        };
        let born = if tension && porosity > 0.0 { density(em + dm) * dm } else { S::zero() };
        (f + ev + born) / (ev + 1.0)
    }

    /// Largest mean stress at the matrix stress `s`.
    fn hydrostatic_limit(&self, s: f64, f: f64) -> f64 {
        let [q1, q2, q3] = self.q;
        let star = self.effective(f);
        s * 2.0 / (3.0 * q2) * ((1.0 + q3 * star * star) / (2.0 * q1 * star)).max(1.0).acosh()
    }

    /// The surface and its slopes along `p/s` and `q/s`.
    fn surface<S: Scalar>(&self, p: S, q: S, star: S) -> [S; 3] {
        let [q1, q2, q3] = self.q;
        let x = p * (1.5 * q2);
        [q * q + star * x.cosh() * (2.0 * q1) - 1.0 - star * star * q3, star * x.sinh() * (3.0 * q1 * q2), q * 2.0]
    }
}

/// Unknowns `ev`, `eq` and the matrix strain as ratios to the strain `scale`; data are `p` and `q` of the trial stress,
/// the porosity and the matrix strain at the beginning.
struct Flow<'a> {
    law: &'a Gurson,
    scale: f64,
    tension: bool,
}

impl System<3, 4> for Flow<'_> {
    fn residual<S: Scalar>(&self, x: &[S; 3], &[p, q, f, em]: &[S; 4]) -> [S; 3] {
        let (law, [ev, eq, dm]) = (self.law, x.map(|x| x * self.scale));
        let s = law.matrix.stress(em + dm);
        let f = law.grown(f, ev, (em, dm), self.tension);
        let (p, q) = ((p - ev * law.elastic.bulk()) / s, (q - eq * (3.0 * law.elastic.shear)) / s);
        let [surface, along_p, along_q] = law.surface(p, q, law.effective(f));
        let work = (S::one() - f) * dm - p * ev - q * eq;
        [(ev * along_q - eq * along_p) / self.scale, surface, work / self.scale]
    }
}

impl RateLaw for Gurson {
    type Vars<T: Scalar> = [T; 3];
    const VARIABLES: &'static [Variable] = &[
        Variable { name: "porosity", kind: VariableKind::Scalar },
        Variable { name: "matrix_plastic_strain", kind: VariableKind::Scalar },
        Variable { name: "plastic_volume_strain", kind: VariableKind::Scalar },
    ];

    fn initial(&self, state: &mut [f64]) {
        state[6] = self.porosity;
    }

    fn update<T: Scalar>(
        &self,
        de: Tensor2<T>,
        stress: Tensor2<T>,
        &[f, em, volume]: &[T; 3],
        _dt: f64,
    ) -> Result<(Tensor2<T>, [T; 3]), Failure> {
        let trial = stress + self.elastic.stress(&de);
        let at = Invariants::of(&trial);
        let (p, q, s) = (at.p.re(), at.q.re(), self.matrix.stress(em.re()));
        if self.surface(p / s, q / s, self.effective(f.re()))[0] <= 0.0 {
            return Ok((trial, [f, em, volume]));
        }
        let (shear, bulk) = (self.elastic.shear, self.elastic.bulk());
        let flow = Flow { law: self, scale: s / shear, tension: p > 0.0 };
        // From near the surface: far outside of it the hyperbolic cosine is beyond any number.
        let limit = self.hydrostatic_limit(s, f.re());
        let ev = p.signum() * (p.abs() - limit).max(0.0) / bulk;
        let eq = (q - s).max(0.0) / (3.0 * shear);
        let start = [ev, eq, eq].map(|x| x / flow.scale);
        let [ev, eq, dm] = solve(&flow, start, &[at.p, at.q, f, em], "Gurson")?.map(|x| x * flow.scale);
        let grown = self.grown(f, ev, (em, dm), flow.tension);
        if dm.re() < 0.0 || eq.re() < 0.0 || !(grown.re() > 0.0 && grown.re() < 1.0) {
            return Err(Failure::new("Gurson: the local iteration finds another branch"));
        }
        Ok((at.with(at.p - ev * bulk, at.q - eq * (3.0 * shear)), [grown, em + dm, volume + ev]))
    }

    fn stored_energy(&self, stress: &Tensor2, _: &[f64; 3]) -> f64 {
        self.elastic.energy(stress)
    }

    /// The work of the matrix.
    fn dissipation(&self, old: (&Tensor2, &[f64; 3]), new: (&Tensor2, &[f64; 3])) -> f64 {
        (1.0 - new.1[0]) * self.matrix.stress(new.1[1]) * (new.1[1] - old.1[1])
    }
}
