//! Hill's plasticity (1948) of sheets, orthotropic in the rolling direction 1, the transverse direction 2 and the normal 3:
//! `q^2 = F (s22 - s33)^2 + G (s33 - s11)^2 + H (s11 - s22)^2 + 2 L s23^2 + 2 M s31^2 + 2 N s12^2`, `f = q - sy(p)`,
//! associated flow `dep = dp dq/dsigma`, isotropic elasticity. The axes turn with the solid, by the polar rotation unless
//! another rate is said.
//!
//! From the ratios `r` of the strains of width and thickness of strips at 0, 45 and 90 degrees to the rolling direction, with
//! the flow curve that of a strip along it: `G = 1/(1 + r0)`, `H = r0 G`, `F = H/r90`, `N = (F + G)(r45 + 1/2)`, `L = M = 3/2`.
//!
//! Backward Euler: with `x = 2 G_s dp/q` and the shear modulus `G_s` the stress is `(1 + x P)^-1` of the trial one, where
//! `dq/dsigma = P sigma/q`; one equation `q(x) = sy(p_n + x q(x)/2 G_s)` is left, which falls in `x`.

use super::axes::{axes, basis, component, local};
use super::elastic::Elastic;
use super::hardening::{FlowStress, Hardening, Kind};
use super::rate;
use crate::Failure;
use crate::declare::{Entry, Parameter, Range, VariableKind};
use crate::integrate::{System, Update, root};
use crate::material::{Flow, Lapse, Material, RateLaw, ScalarsAndVectors, Spin, Variable};
use crate::tensor::{Scalar, Tensor2, Vec3};

const fn number(key: &'static str, meaning: &'static str, range: Range, default: Option<f64>) -> Parameter {
    Parameter { range, ..component(key, meaning, default) }
}

const ROLLING: [Parameter; 3] = [
    component(
        "rolling_x",
        "rolling direction along x, of any length; what of it is across the sheet counts not",
        Some(1.0),
    ),
    component("rolling_y", "rolling direction along y", Some(0.0)),
    component("rolling_z", "rolling direction along z", Some(0.0)),
];
const NORMAL: [Parameter; 3] = [
    component("normal_x", "normal of the sheet along x, of any length", Some(0.0)),
    component("normal_y", "normal of the sheet along y", Some(0.0)),
    component("normal_z", "normal of the sheet along z", Some(1.0)),
];

const RATIOS: [Parameter; 9] = super::hardening::join(&[
    &[
        number(
            "r0",
            "strain of width over that of thickness in tension along the rolling direction",
            Range::POSITIVE,
            None,
        ),
        number("r45", "the same at 45 degrees to it", Range::POSITIVE, None),
        number("r90", "the same across it", Range::POSITIVE, None),
    ],
    &ROLLING,
    &NORMAL,
]);

const COEFFICIENTS: [Parameter; 12] = super::hardening::join(&[
    &[
        number("f", "coefficient F of (s22 - s33)^2", Range::ANY, None),
        number("g", "coefficient G of (s33 - s11)^2", Range::ANY, None),
        number("h", "coefficient H of (s11 - s22)^2", Range::ANY, None),
        number("l", "coefficient L of 2 s23^2", Range::POSITIVE, Some(1.5)),
        number("m", "coefficient M of 2 s31^2", Range::POSITIVE, Some(1.5)),
        number("n", "coefficient N of 2 s12^2", Range::POSITIVE, Some(1.5)),
    ],
    &ROLLING,
    &NORMAL,
]);

pub(super) const COMBINED: Entry<Box<dyn Material>> = Entry {
    name: "hill",
    meaning: "Hill's orthotropic plasticity by ratios r, with linear and saturating (Voce) hardening",
    parameters: &Kind::Combined.between::<17>(&RATIOS),
    pairs: None,
    build: |v| by_ratios(v, Kind::Combined),
};

pub(super) const SWIFT: Entry<Box<dyn Material>> = Entry {
    name: "hill_swift",
    meaning: "the same with Swift's power law",
    parameters: &Kind::Swift.between::<14>(&RATIOS),
    pairs: None,
    build: |v| by_ratios(v, Kind::Swift),
};

pub(super) const TABLE: Entry<Box<dyn Material>> = Entry {
    name: "hill_table",
    meaning: "the same with a measured flow curve",
    parameters: &Kind::Table.between::<12>(&RATIOS),
    pairs: Kind::Table.pairs(),
    build: |v| by_ratios(v, Kind::Table),
};

pub(super) const JOHNSON_COOK: Entry<Box<dyn Material>> = Entry {
    name: "hill_johnson_cook",
    meaning: "the same with Ludwik's power law, by rate and temperature (Johnson and Cook)",
    parameters: &Kind::JohnsonCook.between::<19>(&RATIOS),
    pairs: None,
    build: |v| by_ratios(v, Kind::JohnsonCook),
};

pub(super) const GENERAL: Entry<Box<dyn Material>> = Entry {
    name: "hill_coefficients",
    meaning: "Hill's orthotropic plasticity by his six coefficients, with linear and saturating (Voce) hardening",
    parameters: &Kind::Combined.between::<20>(&COEFFICIENTS),
    pairs: None,
    build: |v| {
        let (hardening, own) = Kind::Combined.take(v, COEFFICIENTS.len())?;
        let [f, g, h] = [own[0], own[1], own[2]];
        if !(f + g > 0.0 && f * g + f * h + g * h > 0.0) {
            return Err("`f`, `g` and `h` make no closed surface: f + g and f g + g h + h f must be positive".into());
        }
        build(v, hardening, std::array::from_fn(|i| own[i]), &own[6..])
    },
};

fn by_ratios(v: &[f64], kind: Kind) -> Result<Box<dyn Material>, String> {
    let (hardening, own) = kind.take(v, RATIOS.len())?;
    let [r0, r45, r90] = [own[0], own[1], own[2]];
    let (g, h) = (1.0 / (1.0 + r0), r0 / (1.0 + r0));
    let f = h / r90;
    build(v, hardening, [f, g, h, 1.5, 1.5, (f + g) * (r45 + 0.5)], &own[3..])
}

fn build(v: &[f64], hardening: Hardening, coefficients: [f64; 6], along: &[f64]) -> Result<Box<dyn Material>, String> {
    let elastic = Elastic::new(v[0], v[1]);
    hardening.check(3.0 * elastic.shear)?;
    let axes = basis(along, ["rolling", "normal"])?;
    Ok(rate(Hill { elastic, hardening, coefficients, axes }))
}

/// The law.
#[derive(Debug, Clone, PartialEq)]
pub struct Hill {
    /// Elasticity.
    pub elastic: Elastic,
    /// Flow stress.
    pub hardening: Hardening,
    /// F, G, H, L, M, N.
    pub coefficients: [f64; 6],
    /// Rolling direction and normal at the beginning, unit vectors.
    pub axes: [Vec3; 2],
}

/// The equation of a step in `x`; data are the six components of the deviator of the trial stress in the axes, in the order
/// 11 22 33 12 23 13, and `p` at the beginning.
struct Return<'a> {
    law: &'a Hill,
    flow: FlowStress<'a>,
    scale: f64,
}

impl System<1, 7> for Return<'_> {
    fn residual<S: Scalar>(&self, &[x]: &[S; 1], &[a, b, c, d, e, f, p]: &[S; 7]) -> [S; 1] {
        let law = self.law;
        let q = law.equivalent(&law.returned(x, &[a, b, c, d, e, f]));
        [(q - self.flow.after(p, law.strain(x, q))) / self.scale]
    }
}

impl Hill {
    fn equivalent<S: Scalar>(&self, s: &[S; 6]) -> S {
        let [f, g, h, l, m, n] = self.coefficients;
        let square = |x: S, a: f64| x * x * a;
        let normal = square(s[1] - s[2], f) + square(s[2] - s[0], g) + square(s[0] - s[1], h);
        (normal + square(s[3], 2.0 * n) + square(s[4], 2.0 * l) + square(s[5], 2.0 * m)).sqrt()
    }

    /// Plastic strain of a return by `x` to the equivalent stress `q`.
    fn strain<S: Scalar>(&self, x: S, q: S) -> S {
        x * q * (0.5 / self.elastic.shear)
    }

    /// `(1 + x P)^-1 s` of a deviator.
    fn returned<S: Scalar>(&self, x: S, s: &[S; 6]) -> [S; 6] {
        let [f, g, h, l, m, n] = self.coefficients;
        let (a, b) = (x * (2.0 * g + h) + 1.0, x * (g - h));
        let (c, d) = (x * (f - h), x * (2.0 * f + h) + 1.0);
        let det = a * d - b * c;
        let first = (s[0] * d - s[1] * b) / det;
        let second = (s[1] * a - s[0] * c) / det;
        let shear = |s: S, a: f64| s / (x * a + 1.0);
        [first, second, -first - second, shear(s[3], n), shear(s[4], l), shear(s[5], m)]
    }
}

type State<T> = ScalarsAndVectors<T, 1, 2>;

impl RateLaw for Hill {
    type Vars<T: Scalar> = State<T>;
    const VARIABLES: &'static [Variable] = &[
        Variable { name: "equivalent_plastic_strain", kind: VariableKind::Scalar },
        Variable { name: "rolling_direction", kind: VariableKind::Vector },
        Variable { name: "sheet_normal", kind: VariableKind::Vector },
    ];
    const AXES: Option<usize> = Some(7);

    fn initial(&self, state: &mut [f64]) {
        state[7..10].copy_from_slice(&self.axes[0].0);
        state[10..13].copy_from_slice(&self.axes[1].0);
    }

    fn update<T: Scalar>(
        &self,
        de: Tensor2<T>,
        stress: Tensor2<T>,
        vars: &State<T>,
        lapse: Lapse,
    ) -> Result<(Tensor2<T>, State<T>), Failure> {
        let flow = self.hardening.over(lapse)?;
        let trial = stress + self.elastic.stress(&de);
        let (axes, p) = (axes(&vars.vectors), vars.scalars[0]);
        let at = local(&trial.deviator(), &axes);
        let [a, b, c, d, e, f] = at;
        let data = [a, b, c, d, e, f, p];
        let (mut high, plain) = (1.0, data.map(T::re));
        let equation = Return { law: self, flow, scale: self.equivalent(&at.map(T::re)).max(f64::MIN_POSITIVE) };
        let bears = equation.residual(&[0.0], &plain)[0] <= 0.0;
        if bears || flow.rests() {
            return Ok((trial, *vars));
        }
        while equation.residual(&[high], &plain)[0] > 0.0 && high < 1e12 {
            high *= 8.0;
        }
        let x = root(&equation, [0.0, high], &data, "Hill")?;
        let back = self.returned(x, &at);
        let lost = Tensor2::from_voigt(std::array::from_fn(|i| at[i] - back[i]));
        let strain = p + self.strain(x, self.equivalent(&back));
        Ok((trial - (axes * lost * axes.transpose()).sym(), State { scalars: [strain], ..*vars }))
    }

    fn serves(&self, update: Update) -> Result<(), String> {
        self.hardening.serves(update)
    }

    fn own_spin(&self) -> Option<Spin> {
        Some(Spin::Polar)
    }

    fn elastic_step(&self, de: &Tensor2, stress: &Tensor2, vars: &State<f64>, lapse: Lapse) -> Option<[f64; 2]> {
        let trial = *stress + self.elastic.stress(de);
        let q = self.equivalent(&self.returned(0.0, &local(&trial.deviator(), &axes(&vars.vectors))));
        (q <= self.hardening.over(lapse).ok()?.slow(vars.scalars[0]))
            .then_some([self.elastic.lambda, self.elastic.shear])
    }

    fn flow(&self) -> Flow {
        Flow::Isochoric
    }

    fn stored_energy(&self, stress: &Tensor2, _: &State<f64>) -> f64 {
        self.elastic.energy(stress)
    }

    fn dissipation(&self, old: (&Tensor2, &State<f64>), new: (&Tensor2, &State<f64>)) -> f64 {
        self.equivalent(&local(&new.0.deviator(), &axes(&new.1.vectors))) * (new.1.scalars[0] - old.1.scalars[0])
    }
}
