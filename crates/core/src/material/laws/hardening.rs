//! Isotropic hardening: the flow stress over the equivalent plastic strain, its rate and the temperature.
//!
//! A law that hardens takes any [`Kind`] of curve: it declares the parameters of the curve between its own
//! ([`Kind::between`]) and gets the curve from their values ([`Kind::take`]).

use super::elastic::{POISSON, YOUNG};
use crate::declare::{Pairs, Parameter, Range, unit};
use crate::integrate::{Scheme, Update};
use crate::material::Lapse;
use crate::tensor::Scalar;
use crate::{Failure, FailureKind};

const fn number(key: &'static str, meaning: &'static str, range: Range, default: Option<f64>) -> Parameter {
    Parameter { key, meaning, unit: unit::NONE, range, default }
}

const fn stress(key: &'static str, meaning: &'static str, range: Range, default: Option<f64>) -> Parameter {
    Parameter { key, meaning, unit: unit::STRESS, range, default }
}

pub(super) const YIELD: Parameter = stress("yield_stress", "first yield stress in tension", Range::POSITIVE, None);

const SATURATION_MEANING: &str = "saturating part Q of the hardening (Voce); negative for softening";

const COMBINED: [Parameter; 6] = [
    YIELD,
    stress(
        "hardening",
        "linear part H of the hardening: yield_stress + H p + Q (1 - exp(-b p))",
        Range::NOT_NEGATIVE,
        Some(0.0),
    ),
    stress("saturation", SATURATION_MEANING, Range::ANY, Some(0.0)),
    number("saturation_rate", "rate b of the saturating part", Range::NOT_NEGATIVE, Some(0.0)),
    stress("saturation_2", "a second saturating part", Range::ANY, Some(0.0)),
    number("saturation_rate_2", "rate of the second saturating part", Range::NOT_NEGATIVE, Some(0.0)),
];

const SWIFT: [Parameter; 3] = [
    stress("strength", "strength K of the power law K (offset + p)^exponent (Swift)", Range::POSITIVE, None),
    number("offset", "strain offset of the power law", Range::POSITIVE, None),
    number("exponent", "exponent of the power law", Range::from_to(0.0, 1.0), None),
];

const TABLE: [Parameter; 1] =
    [stress("end_slope", "slope of the flow stress beyond the last point of `curve`", Range::NOT_NEGATIVE, Some(0.0))];

const JOHNSON_COOK: [Parameter; 8] = [
    stress(
        "yield_stress",
        "first yield stress A of (A + B p^n)(1 + C ln(rate/reference_rate))(1 - T^m)",
        Range::POSITIVE,
        None,
    ),
    stress("strength", "strength B of the power law (Ludwik)", Range::NOT_NEGATIVE, None),
    number("exponent", "exponent n of the plastic strain", Range::above_to(0.0, 1.0), None),
    number("rate_sensitivity", "sensitivity C to the logarithm of the rate", Range::NOT_NEGATIVE, Some(0.0)),
    Parameter {
        key: "reference_rate",
        meaning: "rate of plastic strain up to which the flow stress does not depend on it",
        unit: unit::RATE,
        range: Range::POSITIVE,
        default: Some(1.0),
    },
    number(
        "homologous_temperature",
        "temperature T above that of the room, over that of melting above that of the room, where it is one and the same always",
        Range { least: Some((0.0, true)), most: Some((1.0, false)) },
        Some(0.0),
    ),
    Parameter {
        key: "melting_temperature",
        meaning: "temperature of melting above that of the room, at which the body is free of stress: T follows the temperature of the \
                  body",
        unit: unit::TEMPERATURE,
        range: Range::NOT_NEGATIVE,
        default: Some(0.0),
    },
    number("softening_exponent", "exponent m of the temperature", Range::POSITIVE, Some(1.0)),
];

/// The points of a measured curve.
pub(super) const CURVE: Pairs = Pairs {
    key: "curve",
    meaning: "points [equivalent plastic strain, flow stress], joined by straight lines",
    least: 1,
    most: 10_000,
};

/// Lists of parameters, one after the other.
pub(super) const fn join<const N: usize>(lists: &[&[Parameter]]) -> [Parameter; N] {
    let mut all = [YIELD; N];
    let (mut at, mut list) = (0, 0);
    while list < lists.len() {
        let mut i = 0;
        while i < lists[list].len() {
            all[at] = lists[list][i];
            (at, i) = (at + 1, i + 1);
        }
        list += 1;
    }
    assert!(at == N, "as many parameters as there are");
    all
}

/// The kinds of curves that a deck may choose by the name of the law.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Combined,
    Swift,
    Table,
    JohnsonCook,
}

impl Kind {
    const fn parameters(self) -> &'static [Parameter] {
        match self {
            Self::Combined => &COMBINED,
            Self::Swift => &SWIFT,
            Self::Table => &TABLE,
            Self::JohnsonCook => &JOHNSON_COOK,
        }
    }

    /// The elastic constants, the parameters of the curve and those of the law, `N` in all.
    pub const fn between<const N: usize>(self, own: &[Parameter]) -> [Parameter; N] {
        join(&[&[YOUNG, POISSON], self.parameters(), own])
    }

    /// The pairs that the curve takes.
    pub const fn pairs(self) -> Option<Pairs> {
        if matches!(self, Self::Table) { Some(CURVE) } else { None }
    }

    /// From values of parameters as they are declared by [`between`](Self::between), followed by pairs: the curve, and the
    /// values of the `own` parameters of the law.
    ///
    /// # Errors
    /// In words, where the numbers are no curve.
    pub fn take(self, values: &[f64], own: usize) -> Result<(Hardening, &[f64]), String> {
        let (curve, rest) = values[2..].split_at(self.parameters().len());
        let (own, pairs) = rest.split_at(own);
        let hardening = match self {
            Self::Combined => Hardening::combined(curve)?,
            Self::Swift => Hardening::Swift { strength: curve[0], offset: curve[1], exponent: curve[2] },
            Self::Table => Hardening::table(pairs, curve[0])?,
            Self::JohnsonCook => Hardening::johnson_cook(curve)?,
        };
        Ok((hardening, own))
    }
}

/// Flow stress over the equivalent plastic strain `p`.
#[derive(Debug, Clone, PartialEq)]
pub enum Hardening {
    /// `first + linear p + sum_i Q_i (1 - exp(-b_i p))`: linear and Voce.
    Combined {
        /// First yield stress.
        first: f64,
        /// Linear modulus.
        linear: f64,
        /// Saturating parts `Q` and their rates `b`.
        voce: [[f64; 2]; 2],
    },
    /// `strength (offset + p)^exponent`.
    Swift {
        /// Strength.
        strength: f64,
        /// Strain offset.
        offset: f64,
        /// Exponent.
        exponent: f64,
    },
    /// Points of a curve.
    Table {
        /// Plastic strain and flow stress.
        points: Vec<[f64; 2]>,
        /// Slope beyond the last.
        slope: f64,
    },
    /// `(first + strength p^exponent)(1 + sensitivity ln(rate/reference))(1 - T^softening)`, without the middle below `reference`.
    JohnsonCook {
        /// First yield stress A.
        first: f64,
        /// Strength B.
        strength: f64,
        /// Exponent n.
        exponent: f64,
        /// Sensitivity C to the rate.
        sensitivity: f64,
        /// Reference rate.
        reference: f64,
        /// Homologous temperature T where it is always the same,
        homologous: f64,
        /// and the temperature of melting over which it is that of the body; zero where it does not follow that.
        melting: f64,
        /// Exponent m of the temperature.
        softening: f64,
    },
}

impl Hardening {
    /// `first + linear p`.
    pub fn linear(first: f64, linear: f64) -> Self {
        Self::Combined { first, linear, voce: [[0.0; 2]; 2] }
    }

    fn combined(v: &[f64]) -> Result<Self, String> {
        let voce = [[v[2], v[3]], [v[4], v[5]]];
        for ([stress, rate], number) in voce.iter().zip(["", "_2"]) {
            if (*stress == 0.0) != (*rate == 0.0) {
                return Err(format!("`saturation{number}` and `saturation_rate{number}` need each other"));
            }
        }
        Ok(Self::Combined { first: v[0], linear: v[1], voce })
    }

    fn johnson_cook(v: &[f64]) -> Result<Self, String> {
        let [first, strength, exponent, sensitivity, reference, homologous, melting, softening] =
            std::array::from_fn(|i| v[i]);
        if homologous > 0.0 && melting > 0.0 {
            return Err("`homologous_temperature` and `melting_temperature` are two ways to say one thing".into());
        }
        Ok(Self::JohnsonCook { first, strength, exponent, sensitivity, reference, homologous, melting, softening })
    }

    /// A curve from its points, one after the other, and the slope beyond the last.
    ///
    /// # Errors
    /// In words, where the points are no curve.
    pub fn table(values: &[f64], slope: f64) -> Result<Self, String> {
        let points: Vec<[f64; 2]> = values.as_chunks().0.to_vec();
        match points.first() {
            Some([0.0, _]) => {}
            _ => return Err("`curve` must begin at the plastic strain 0".into()),
        }
        if let Some(two) = points.windows(2).find(|two| two[0][0] >= two[1][0]) {
            return Err(format!("the strains of `curve` must rise, but {} follows {}", two[1][0], two[0][0]));
        }
        match points.iter().find(|point| point[1] <= 0.0) {
            Some([_, stress]) => Err(format!("the stresses of `curve` must be positive, not {stress}")),
            None => Ok(Self::Table { points, slope }),
        }
    }

    /// The flow stress over an increment.
    ///
    /// # Errors
    /// A [`Failure`] where the temperature melts the solid.
    #[inline]
    pub fn over(&self, lapse: Lapse) -> Result<FlowStress<'_>, Failure> {
        let warmth = match *self {
            Self::JohnsonCook { homologous, melting, softening, .. } => {
                let follows = lapse.temperature.filter(|_| melting > 0.0);
                let t = follows.map_or(homologous, |[_, at]| (at / melting).max(0.0));
                if t >= 1.0 || t.is_nan() {
                    return Err(Failure::new("the temperature is that of melting").of(FailureKind::Material));
                }
                if t > 0.0 { 1.0 - t.powf(softening) } else { 1.0 }
            }
            _ => 1.0,
        };
        Ok(FlowStress { curve: self, dt: lapse.dt, warmth })
    }

    /// The flow stress of the slowest flow without the temperature of a body.
    pub fn at_rest(&self, p: f64) -> f64 {
        self.over(0.0.into()).map_or(f64::NAN, |flow| flow.slow(p))
    }

    /// Whether the flow stress is not that of the plastic strain alone.
    pub fn varies(&self) -> bool {
        self.has_rate() || matches!(self, Self::JohnsonCook { melting, .. } if *melting > 0.0)
    }

    /// Whether the flow stress depends on the rate of flow.
    pub fn has_rate(&self) -> bool {
        matches!(self, Self::JohnsonCook { sensitivity, .. } if *sensitivity > 0.0)
    }

    /// Whether a scheme serves the curve: the midpoint rule has no rate at the end of a step, and rings.
    ///
    /// # Errors
    /// In words, why not.
    pub fn serves(&self, update: Update) -> Result<(), String> {
        match update.scheme {
            Scheme::Midpoint(theta) if self.has_rate() && theta < 1.0 => {
                Err("the midpoint scheme does not serve a flow \
                 stress that depends on the rate: say scheme = \"two-step\" or \"backward-euler\""
                    .into())
            }
            _ => Ok(()),
        }
    }

    /// The steepest fall of the curve, as a negative slope; zero where it never falls.
    pub fn steepest_fall(&self) -> f64 {
        let slope = |two: &[[f64; 2]]| (two[1][1] - two[0][1]) / (two[1][0] - two[0][0]);
        match self {
            Self::Combined { linear, voce, .. } => {
                (linear + voce.iter().map(|[stress, rate]| (stress * rate).min(0.0)).sum::<f64>()).min(0.0)
            }
            Self::Swift { .. } | Self::JohnsonCook { .. } => 0.0,
            Self::Table { points, .. } => points.windows(2).map(slope).fold(0.0, f64::min),
        }
    }

    /// What is wrong with the curve of a solid whose stress falls by `stiffness` times the plastic strain.
    ///
    /// # Errors
    /// In words.
    pub fn check(&self, stiffness: f64) -> Result<(), String> {
        if let Self::Combined { first, voce, .. } = self {
            let left = first + voce.iter().map(|[stress, _]| stress.min(0.0)).sum::<f64>();
            if left <= 0.0 {
                return Err(format!("the flow stress `yield_stress` + `saturation` = {left} must be positive"));
            }
        }
        let fall = self.steepest_fall();
        if fall <= -stiffness {
            return Err(format!(
                "the flow stress falls with the slope {fall}, steeper than the elastic stress can follow, -{stiffness}"
            ));
        }
        Ok(())
    }
}

/// The flow stress over an increment, at the temperature of its end.
#[derive(Debug, Clone, Copy)]
pub struct FlowStress<'a> {
    curve: &'a Hardening,
    /// Length of the increment.
    dt: f64,
    /// What the temperature leaves of it, `1 - T^m`.
    warmth: f64,
}

impl FlowStress<'_> {
    /// At `p`, of the slowest flow.
    #[inline]
    pub fn slow<T: Scalar>(&self, p: T) -> T {
        match self.curve {
            Hardening::Combined { first, linear, voce } => {
                let saturating = |sum: T, &[stress, rate]: &[f64; 2]| match stress {
                    0.0 => sum,
                    _ => sum - ((p * -rate).exp() - 1.0) * stress,
                };
                voce.iter().fold(p * *linear + *first, saturating)
            }
            Hardening::Swift { strength, offset, exponent } => (p + *offset).powf(*exponent) * *strength,
            Hardening::Table { points, slope } => on_line(points, *slope, p),
            Hardening::JohnsonCook { first, strength, exponent, .. } => {
                // The root of no strain has no slope.
                let grown = if p.re() > 0.0 { p.powf(*exponent) * *strength } else { T::zero() };
                (grown + *first) * self.warmth
            }
        }
    }

    /// After the plastic strain `dp` from `p` in the time of the increment.
    #[inline]
    pub fn after<T: Scalar>(&self, p: T, dp: T) -> T {
        let slow = self.slow(p + dp);
        match self.curve {
            Hardening::JohnsonCook { sensitivity, reference, .. }
                if *sensitivity > 0.0 && dp.re() > reference * self.dt =>
            {
                slow * ((dp * (1.0 / (reference * self.dt))).ln() * *sensitivity + 1.0)
            }
            _ => slow,
        }
    }

    /// Whether nothing can flow: a flow stress that depends on the rate, without time.
    pub fn rests(&self) -> bool {
        self.dt == 0.0 && self.curve.has_rate()
    }
}

fn on_line<T: Scalar>(points: &[[f64; 2]], end: f64, p: T) -> T {
    let after = points.partition_point(|point| point[0] <= p.re()).max(1);
    let [p0, stress] = points[after - 1];
    let slope = points.get(after).map_or(end, |[p1, next]| (next - stress) / (p1 - p0));
    (p - p0) * slope + stress
}
