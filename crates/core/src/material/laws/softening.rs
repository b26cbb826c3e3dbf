//! Strength of soils that changes with the plastic shear strain `k`: each number `x` of a surface goes from its first value to
//! its last as `x_end + (x - x_end) exp(-k/k_0)`, down or up.

use super::drucker_prager::{COHESION, DILATANCY, FRICTION, check_angles};
use crate::declare::{Parameter, Range, unit};
use crate::tensor::Scalar;

/// The keys of a strength that changes, after those of the elasticity.
pub(super) const PARAMETERS: [Parameter; 7] = [
    COHESION,
    FRICTION,
    DILATANCY,
    Parameter { key: "end_cohesion", meaning: "cohesion after much shear", ..COHESION },
    Parameter { key: "end_friction", meaning: "angle of friction after much shear", ..FRICTION },
    Parameter { key: "end_dilatancy", meaning: "angle of dilatancy after much shear", ..DILATANCY },
    Parameter {
        key: "change_strain",
        meaning: "plastic shear strain after which 37 per cent (1/e) of the changes are still to come",
        unit: unit::NONE,
        range: Range::POSITIVE,
        default: None,
    },
];

/// From the strain at the beginning of a step to one above that after at most `more`, in spite of rounding.
pub(super) fn bracket(before: f64, more: f64) -> [f64; 2] {
    [before, before + more * (1.0 + 1e-9) + 16.0 * f64::EPSILON * (1.0 + before)]
}

/// Numbers of a surface over the plastic shear strain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Changing<const N: usize> {
    first: [f64; N],
    last: [f64; N],
    /// Strain of the change; infinite where nothing changes.
    strain: f64,
}

impl<const N: usize> Changing<N> {
    /// Numbers that stay.
    pub fn constant(numbers: [f64; N]) -> Self {
        Self { first: numbers, last: numbers, strain: f64::INFINITY }
    }

    /// From the values of [`PARAMETERS`]: what `of` makes of cohesion and the angles of friction and dilatancy in radians.
    pub(super) fn declared(v: &[f64], of: impl Fn(f64, [f64; 2]) -> [f64; N]) -> Result<Self, String> {
        check_angles(v[1], v[2])?;
        check_angles(v[4], v[5]).map_err(|why| why.replace("`dil", "`end_dil").replace("`fri", "`end_fri"))?;
        if (v[1] == 0.0) != (v[4] == 0.0) {
            return Err("`friction` and `end_friction` must both be zero or neither".into());
        }
        let numbers = |at: usize| of(v[at], [v[at + 1].to_radians(), v[at + 2].to_radians()]);
        Ok(Self { first: numbers(0), last: numbers(3), strain: v[6] })
    }

    /// Whether the numbers change.
    pub fn changes(&self) -> bool {
        self.strain.is_finite()
    }

    /// Those of the beginning.
    pub fn first(&self) -> [f64; N] {
        self.first
    }

    /// The numbers at a plastic shear strain.
    pub fn at<S: Scalar>(&self, strain: S) -> [S; N] {
        let left = (strain * (-1.0 / self.strain)).exp();
        std::array::from_fn(|i| left * (self.first[i] - self.last[i]) + self.last[i])
    }
}
