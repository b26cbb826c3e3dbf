//! What hyperelastic laws in the first two invariants share, volume and shape apart: with `c = b J^(-2/3)`, `I1 = tr c`,
//! `I2 = (I1^2 - c:c)/2` and an energy `W(I1, I2)`, `J sigma = 2 dev((W1 + I1 W2) c - W2 c c) + K/2 (J^2 - 1) I`.

use super::neo_hookean::pressure;
use crate::declare::{Parameter, Range, unit};
use crate::tensor::{Scalar, Tensor2};

/// A coefficient of an energy.
pub(super) const fn coefficient(
    key: &'static str,
    meaning: &'static str,
    range: Range,
    default: Option<f64>,
) -> Parameter {
    Parameter { key, meaning, unit: unit::STRESS, range, default }
}

/// The invariants of the shape of `b`.
pub(super) fn invariants<T: Scalar>(b: &Tensor2<T>) -> [T; 2] {
    let shape = b.det().powf(-1.0 / 3.0);
    let first = b.trace() * shape;
    [first, (first * first - b.contract(*b) * shape * shape) * 0.5]
}

/// Cauchy stress, from the slopes of the energy along both invariants.
pub(super) fn stress<T: Scalar>(b: &Tensor2<T>, bulk: f64, slopes: impl Fn([T; 2]) -> [T; 2]) -> Tensor2<T> {
    let (j, [first, second]) = (b.det().sqrt(), invariants(b));
    let [along_first, along_second] = slopes([first, second]);
    let c = *b * j.powf(-2.0 / 3.0);
    let shape = c * (along_first + first * along_second) - c * c * along_second;
    shape.deviator() * (j.recip() * 2.0) + Tensor2::identity() * pressure(bulk, j)
}
