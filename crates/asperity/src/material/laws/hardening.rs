//! Isotropic hardening: the flow stress over the equivalent plastic strain.

use crate::declare::{Pairs, Parameter, Range, unit};
use crate::tensor::Scalar;

pub(super) const YIELD: Parameter = Parameter {
    key: "yield_stress",
    meaning: "first yield stress in tension",
    unit: unit::STRESS,
    range: Range::POSITIVE,
    default: None,
};

pub(super) const LINEAR: Parameter = Parameter {
    key: "hardening",
    meaning: "linear part H of the hardening: yield_stress + H p + Q (1 - exp(-b p))",
    unit: unit::STRESS,
    range: Range::NOT_NEGATIVE,
    default: Some(0.0),
};

pub(super) const SATURATION: Parameter = Parameter {
    key: "saturation",
    meaning: "saturating part Q of the hardening (Voce); negative for softening",
    unit: unit::STRESS,
    range: Range::ANY,
    default: Some(0.0),
};

pub(super) const SATURATION_RATE: Parameter = Parameter {
    key: "saturation_rate",
    meaning: "rate b of the saturating part",
    unit: unit::NONE,
    range: Range::NOT_NEGATIVE,
    default: Some(0.0),
};

pub(super) const STRENGTH: Parameter = Parameter {
    key: "strength",
    meaning: "strength K of the power law K (offset + p)^exponent (Swift)",
    unit: unit::STRESS,
    range: Range::POSITIVE,
    default: None,
};

pub(super) const OFFSET: Parameter = Parameter {
    key: "offset",
    meaning: "strain offset of the power law",
    unit: unit::NONE,
    range: Range::POSITIVE,
    default: None,
};

pub(super) const EXPONENT: Parameter = Parameter {
    key: "exponent",
    meaning: "exponent of the power law",
    unit: unit::NONE,
    range: Range::from_to(0.0, 1.0),
    default: None,
};

pub(super) const CURVE: Pairs = Pairs {
    key: "curve",
    meaning: "points [equivalent plastic strain, flow stress], joined by straight lines; constant after the last",
    least: 1,
    most: 10_000,
};

/// Flow stress over the equivalent plastic strain `p`.
#[derive(Debug, Clone, PartialEq)]
pub enum Hardening {
    /// `first + linear p + saturation (1 - exp(-rate p))`: linear and Voce.
    Combined {
        /// First yield stress.
        first: f64,
        /// Linear modulus.
        linear: f64,
        /// Saturating part.
        saturation: f64,
        /// Its rate.
        rate: f64,
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
    Table(Vec<[f64; 2]>),
}

impl Hardening {
    /// A curve from its points, one after the other.
    ///
    /// # Errors
    /// In words, where the points are no curve.
    pub fn table(values: &[f64]) -> Result<Self, String> {
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
            None => Ok(Self::Table(points)),
        }
    }

    /// Flow stress at `p`.
    #[inline]
    pub fn stress<T: Scalar>(&self, p: T) -> T {
        match self {
            Self::Combined { first, linear, saturation, rate } => {
                p * *linear - ((p * -*rate).exp() - 1.0) * *saturation + *first
            }
            Self::Swift { strength, offset, exponent } => (p + *offset).powf(*exponent) * *strength,
            Self::Table(points) => on_line(points, p),
        }
    }

    /// The steepest fall of the curve, as a negative slope; zero where it never falls.
    pub fn steepest_fall(&self) -> f64 {
        let slope = |two: &[[f64; 2]]| (two[1][1] - two[0][1]) / (two[1][0] - two[0][0]);
        match self {
            Self::Combined { linear, saturation, rate, .. } => (linear + saturation * rate).min(0.0),
            Self::Swift { .. } => 0.0,
            Self::Table(points) => points.windows(2).map(slope).fold(0.0, f64::min),
        }
    }

    /// What is wrong with the curve of a solid whose stress falls by `stiffness` times the plastic strain.
    ///
    /// # Errors
    /// In words.
    pub fn check(&self, stiffness: f64) -> Result<(), String> {
        if let Self::Combined { first, saturation, .. } = self
            && first + saturation <= 0.0
        {
            return Err(format!(
                "the flow stress `yield_stress` + `saturation` = {} must be positive",
                first + saturation
            ));
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

fn on_line<T: Scalar>(points: &[[f64; 2]], p: T) -> T {
    let after = points.partition_point(|point| point[0] <= p.re()).max(1);
    let [p0, stress] = points[after - 1];
    match points.get(after) {
        Some([p1, next]) => (p - p0) * ((next - stress) / (p1 - p0)) + stress,
        None => T::from(stress),
    }
}
