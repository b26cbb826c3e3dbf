//! Gurson's porous plasticity after Tvergaard and Needleman (1984): with the flow stress `s(em)` of the matrix,
//! `(q/s)^2 + 2 q1 f* cosh(3/2 q2 p/s) - 1 - q3 f*^2 = 0`, `q3 = q1^2` unless said; voids grow with the plastic volume,
//! `df = (1 - f) dev + A(em) dem`, nucleate by a normal distribution of the matrix strain under tension, and coalesce:
//! beyond `fc` the effective porosity `f*` rises faster, to `1/q1` at `ff`.
//!
//! Implicit step after Aravas (1987): unknowns are the plastic volume strain `ev`, the plastic shear strain `eq` and the
//! matrix strain; with `p = p_trial - K ev`, `q = q_trial - 3 G eq` they satisfy the flow rule, the surface and the
//! equality of works `(1 - f) s dem = p ev + q eq`.
//!
//! Under pressure voids close, ever more slowly: a porosity below 1e-9, which bears more than thirteen times the flow stress,
//! is taken for none, and the solid is its matrix from then on, of von Mises, until tension nucleates voids.

use super::elastic::Elastic;
use super::hardening::{FlowStress, Hardening, Kind};
use super::invariants::Invariants;
use super::rate;
use crate::Failure;
use crate::declare::{Entry, Parameter, Range, VariableKind, unit};
use crate::integrate::{System, Update, root, solve};
use crate::material::{self, Lapse, Material, RateLaw, Variable};
use crate::tensor::{Scalar, Tensor2};

const fn number(key: &'static str, meaning: &'static str, range: Range, default: Option<f64>) -> Parameter {
    Parameter { key, meaning, unit: unit::NONE, range, default }
}

const FRACTION: Range = Range { least: Some((0.0, true)), most: Some((1.0, false)) };

const POROSITY: Parameter = number("porosity", "porosity at the beginning", Range::between(0.0, 0.5), None);
const Q1: Parameter = number("q1", "Tvergaard's factor of the porosity", Range::from_to(0.5, 3.0), Some(1.5));
const Q2: Parameter = number("q2", "Tvergaard's factor of the mean stress", Range::from_to(0.5, 2.0), Some(1.0));
const Q3: Parameter = number("q3", "Tvergaard's factor of the squared porosity", Range::from_to(0.0, 9.0), Some(2.25));
const NUCLEATED: Parameter = number("nucleated", "porosity of the voids that may nucleate", FRACTION, Some(0.0));
const MEAN: Parameter = number("nucleation_strain", "mean matrix strain of nucleation", Range::NOT_NEGATIVE, Some(0.3));
const SPREAD: Parameter = number("nucleation_spread", "standard deviation of that strain", Range::POSITIVE, Some(0.1));
const CRITICAL: Parameter =
    number("critical_porosity", "porosity at which voids begin to coalesce", FRACTION, Some(0.15));
const FAILURE: Parameter = number("failure_porosity", "porosity at which nothing is left", FRACTION, Some(0.25));

const VOIDS: &[Parameter] = &[POROSITY, Q1, Q2, Q3, NUCLEATED, MEAN, SPREAD, CRITICAL, FAILURE];

pub(super) const COMBINED: Entry<Box<dyn Material>> = Entry {
    name: "gurson",
    meaning: "porous plasticity of Gurson, Tvergaard and Needleman",
    parameters: &Kind::Combined.between::<17>(VOIDS),
    pairs: None,
    build: |v| build(v, Kind::Combined),
};

pub(super) const SWIFT: Entry<Box<dyn Material>> = Entry {
    name: "gurson_swift",
    meaning: "the same with Swift's power law for the matrix",
    parameters: &Kind::Swift.between::<14>(VOIDS),
    pairs: None,
    build: |v| build(v, Kind::Swift),
};

pub(super) const TABLE: Entry<Box<dyn Material>> = Entry {
    name: "gurson_table",
    meaning: "the same with a measured flow curve of the matrix",
    parameters: &Kind::Table.between::<12>(VOIDS),
    pairs: Kind::Table.pairs(),
    build: |v| build(v, Kind::Table),
};

pub(super) const JOHNSON_COOK: Entry<Box<dyn Material>> = Entry {
    name: "gurson_johnson_cook",
    meaning: "the same with Ludwik's power law for the matrix, by rate and temperature (Johnson and Cook)",
    parameters: &Kind::JohnsonCook.between::<19>(VOIDS),
    pairs: None,
    build: |v| build(v, Kind::JohnsonCook),
};

/// From the elastic constants, the flow curve of the matrix and the numbers of the voids.
fn build(v: &[f64], kind: Kind) -> Result<Box<dyn Material>, String> {
    let elastic = Elastic::new(v[0], v[1]);
    let (matrix, voids) = kind.take(v, VOIDS.len())?;
    matrix.check(3.0 * elastic.shear)?;
    let [porosity, q1, q2, q3, nucleated, strain, spread, critical, failure] = std::array::from_fn(|i| voids[i]);
    if critical >= failure {
        return Err(format!("`critical_porosity`, {critical}, must be smaller than `failure_porosity`, {failure}"));
    }
    if porosity >= critical {
        return Err(format!("`porosity`, {porosity}, must be smaller than `critical_porosity`, {critical}"));
    }
    if q1 * critical >= 1.0 || q3 > q1 * q1 {
        return Err("`q1` times `critical_porosity` must be below 1, and `q3` at most `q1` squared".into());
    }
    let nucleation = Nucleation { porosity: nucleated, strain, spread };
    Ok(rate(Gurson { elastic, matrix, porosity, q: [q1, q2, q3], nucleation, critical, failure }))
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

/// Porosity that is none.
const CLOSED: f64 = 1e-9;

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

    /// The flow stress of the matrix in a state: that of the curve, and of the surface through the stress where it depends on more than
    /// the strain and that stress is beyond the curve's.
    fn matrix_stress(&self, stress: &Tensor2, &[f, em, _]: &[f64; 3]) -> f64 {
        let (at, star) = (Invariants::of(stress), self.effective(f));
        let curve = self.matrix.at_rest(em);
        let beyond = |s: f64| self.surface(at.p / s, at.q / s, star)[0] > 0.0;
        if !self.matrix.varies() {
            return curve;
        }
        let (mut low, mut high) = (curve, 2.0 * curve);
        while !beyond(low) && low > 1e-6 * curve {
            (low, high) = (0.5 * low, low);
        }
        while beyond(high) && high < 1e6 * curve {
            (low, high) = (high, 2.0 * high);
        }
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            *(if beyond(middle) { &mut low } else { &mut high }) = middle;
        }
        low
    }

    /// The surface and its slopes along `p/s` and `q/s`.
    fn surface<S: Scalar>(&self, p: S, q: S, star: S) -> [S; 3] {
        let [q1, q2, q3] = self.q;
        if star.re() == 0.0 {
            // Without voids the hyperbolic cosine has no part in it, nor the range of numbers.
            return [q * q - 1.0, S::zero(), q * 2.0];
        }
        let x = p * (1.5 * q2);
        [q * q + star * x.cosh() * (2.0 * q1) - 1.0 - star * star * q3, star * x.sinh() * (3.0 * q1 * q2), q * 2.0]
    }
}

impl Gurson {
    /// The volume strain that returns a pressure, `p < 0`, to its limit as the voids close; none where no void is left.
    fn closing(&self, [p, s]: [f64; 2], f: f64) -> Option<f64> {
        let strain = |left: f64| (left - f) / (1.0 - left);
        let beyond = |left: f64| -p + self.elastic.bulk() * strain(left) > self.hydrostatic_limit(s, left);
        if f <= CLOSED || beyond(CLOSED) {
            return None;
        }
        let (mut low, mut high) = (CLOSED.ln(), f.ln());
        if !beyond(f) {
            return Some(0.0);
        }
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            *(if beyond(middle.exp()) { &mut high } else { &mut low }) = middle;
        }
        Some(strain(high.exp()))
    }

    /// What is left of a trial stress when all voids have closed.
    fn close<T: Scalar>(
        &self,
        at: &Invariants<T>,
        [f, em, volume]: [T; 3],
        flow: FlowStress,
    ) -> Result<(Tensor2<T>, [T; 3]), Failure> {
        let p = at.p + f * self.elastic.bulk();
        let dm = -f * p / flow.slow(em);
        let (stress, vars) = (at.with(p, at.q), [T::zero(), em + dm, volume - f]);
        let within = at.q.re() <= flow.slow(vars[1]).re();
        if within { Ok((stress, vars)) } else { self.dense(&Invariants { p, ..*at }, vars, flow) }
    }

    /// The matrix without voids: the shear strain that returns to its flow stress.
    fn dense<T: Scalar>(
        &self,
        at: &Invariants<T>,
        [f, em, volume]: [T; 3],
        flow: FlowStress,
    ) -> Result<(Tensor2<T>, [T; 3]), Failure> {
        let stiffness = 3.0 * self.elastic.shear;
        let most = at.q.re() / stiffness;
        let equation = Dense { law: self, flow, scale: at.q.re() };
        let eq = root(&equation, [0.0, most], &[at.q, em], "Gurson's matrix")?;
        Ok((at.with(at.p, at.q - eq * stiffness), [f, em + eq, volume]))
    }
}

/// The shear strain of a solid without voids; data are `q` of the trial stress and the matrix strain at the beginning.
struct Dense<'a> {
    law: &'a Gurson,
    flow: FlowStress<'a>,
    scale: f64,
}

impl System<1, 2> for Dense<'_> {
    fn residual<S: Scalar>(&self, &[eq]: &[S; 1], &[q, em]: &[S; 2]) -> [S; 1] {
        [(q - eq * (3.0 * self.law.elastic.shear) - self.flow.after(em, eq)) / self.scale]
    }
}

/// Unknowns `ev`, `eq` and the matrix strain as ratios to the strain `scale`; data are `p` and `q` of the trial stress,
/// the porosity and the matrix strain at the beginning.
struct Flow<'a> {
    law: &'a Gurson,
    flow: FlowStress<'a>,
    scale: f64,
    tension: bool,
}

impl System<3, 4> for Flow<'_> {
    fn residual<S: Scalar>(&self, x: &[S; 3], &[p, q, f, em]: &[S; 4]) -> [S; 3] {
        let (law, [ev, eq, dm]) = (self.law, x.map(|x| x * self.scale));
        let s = self.flow.after(em, dm);
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
        lapse: Lapse,
    ) -> Result<(Tensor2<T>, [T; 3]), Failure> {
        let matrix = self.matrix.over(lapse)?;
        let trial = stress + self.elastic.stress(&de);
        let at = Invariants::of(&trial);
        let (p, q, s) = (at.p.re(), at.q.re(), matrix.slow(em.re()));
        let within = self.surface(p / s, q / s, self.effective(f.re()))[0] <= 0.0;
        if within || matrix.rests() {
            return Ok((trial, [f, em, volume]));
        }
        if f.re() == 0.0 && !(p > 0.0 && self.nucleation.porosity > 0.0) {
            return self.dense(&at, [f, em, volume], matrix);
        }
        let (shear, bulk) = (self.elastic.shear, self.elastic.bulk());
        let flow = Flow { law: self, flow: matrix, scale: s / shear, tension: p > 0.0 };
        // From near the surface: far outside of it the hyperbolic cosine is beyond any number.
        let limit = self.hydrostatic_limit(s, f.re());
        let Some(ev) = (if p > 0.0 { Some((p - limit).max(0.0) / bulk) } else { self.closing([p, s], f.re()) }) else {
            return self.close(&at, [f, em, volume], matrix);
        };
        let eq = (q - s).max(0.0) / (3.0 * shear);
        let start = [ev, eq, eq].map(|x| x / flow.scale);
        let [ev, eq, dm] = solve(&flow, start, &[at.p, at.q, f, em], "Gurson")?.map(|x| x * flow.scale);
        let grown = self.grown(f, ev, (em, dm), flow.tension);
        if dm.re() < 0.0 || eq.re() < 0.0 || !(grown.re() > -CLOSED && grown.re() < 1.0) {
            return Err(Failure::new("Gurson: the local iteration finds another branch"));
        }
        let grown = if grown.re() < CLOSED { T::zero() } else { grown };
        let (p, vars) = (at.p - ev * bulk, [grown, em + dm, volume + ev]);
        if q == 0.0 {
            // Without shear the part of it that the flow would leave follows from the flow rule, for the tangent.
            let s = matrix.after(em, dm);
            let [_, along_p, _] = self.surface(p / s, T::zero(), self.effective(grown));
            let left = if along_p.re() == 0.0 { T::one() } else { (ev / (s * along_p) * (6.0 * shear) + 1.0).recip() };
            return Ok((at.scaled(p, left), vars));
        }
        Ok((at.with(p, at.q - eq * (3.0 * shear)), vars))
    }

    fn serves(&self, update: Update) -> Result<(), String> {
        self.matrix.serves(update)
    }

    fn flow(&self) -> material::Flow {
        material::Flow::Isochoric
    }

    fn own_update(&self) -> Option<Update> {
        Some(Update::TWO_STEP)
    }

    fn stored_energy(&self, stress: &Tensor2, _: &[f64; 3]) -> f64 {
        self.elastic.energy(stress)
    }

    /// The work of the matrix.
    fn dissipation(&self, old: (&Tensor2, &[f64; 3]), new: (&Tensor2, &[f64; 3])) -> f64 {
        (1.0 - new.1[0]) * self.matrix_stress(new.0, new.1) * (new.1[1] - old.1[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law() -> Gurson {
        Gurson {
            elastic: Elastic::new(200e3, 0.3),
            matrix: Hardening::linear(300.0, 0.0),
            porosity: 0.01,
            q: [1.5, 1.0, 2.25],
            nucleation: Nucleation { porosity: 0.0, strain: 0.3, spread: 0.1 },
            critical: 0.15,
            failure: 0.25,
        }
    }

    /// Pressed together until no void is left, in increments of any length: elastic in its volume from there, and sheared
    /// its matrix.
    #[test]
    fn voids_that_close_leave_the_matrix() {
        let law = law();
        for increments in [30, 300, 3000] {
            let (mut stress, mut vars) = (Tensor2::zero(), [law.porosity, 0.0, 0.0]);
            let de = Tensor2::identity() * (-0.1 / f64::from(increments));
            for _ in 0..increments {
                (stress, vars) = law.update(de, stress, &vars, 1.0.into()).unwrap();
            }
            assert_eq!(vars[0], 0.0, "{increments}");
            // All that was void has gone: the rest of the strain is elastic.
            let pressure = law.elastic.bulk() * (0.3 + vars[2]);
            assert!((stress.trace() / -3.0 / pressure - 1.0).abs() < 1e-9 && (vars[2] + 0.01).abs() < 2e-4, "{vars:?}");
            let mut shear = Tensor2::zero();
            (shear[(0, 1)], shear[(1, 0)]) = (0.01, 0.01);
            for _ in 0..20 {
                (stress, vars) = law.update(shear, stress, &vars, 1.0.into()).unwrap();
            }
            assert!((Invariants::of(&stress).q / 300.0 - 1.0).abs() < 1e-12);
            // Drawn, what has no voids bears any mean stress.
            let (drawn, _) = law.update(Tensor2::identity() * 0.5, stress, &vars, 1.0.into()).unwrap();
            assert!((Invariants::of(&drawn).q / 300.0 - 1.0).abs() < 1e-12 && drawn.trace() > 0.0);
        }
    }
}
