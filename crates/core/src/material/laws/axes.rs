//! Axes of a solid that is not alike in all directions: the first and the third, from which the second follows.

use crate::declare::{Parameter, Range, unit};
use crate::tensor::{Scalar, Tensor2, Vec3};

/// A component of a direction.
pub(super) const fn component(key: &'static str, meaning: &'static str, default: Option<f64>) -> Parameter {
    Parameter { key, meaning, unit: unit::NONE, range: Range::ANY, default }
}

/// The first axis.
pub(super) const FIRST: [Parameter; 3] = [
    component("first_x", "first axis along x, of any length; what of it is along the third counts not", Some(1.0)),
    component("first_y", "first axis along y", Some(0.0)),
    component("first_z", "first axis along z", Some(0.0)),
];

/// The third axis.
pub(super) const THIRD: [Parameter; 3] = [
    component("third_x", "third axis along x, of any length", Some(0.0)),
    component("third_y", "third axis along y", Some(0.0)),
    component("third_z", "third axis along z", Some(1.0)),
];

/// First and third axis as unit vectors from their components; `names` are those of the keys.
///
/// # Errors
/// In words, where they make no axes.
pub(super) fn basis(along: &[f64], names: [&str; 2]) -> Result<[Vec3; 2], String> {
    let [first, third] = [0, 3].map(|at| Vec3::new(along[at], along[at + 1], along[at + 2]));
    let keys = |name: &str| format!("`{name}_x`, `{name}_y` and `{name}_z`");
    if third.norm() == 0.0 {
        return Err(format!("{} are zero: there is no such direction", keys(names[1])));
    }
    let third = third.unit();
    let across = first - third * third.dot(first);
    if across.norm() <= 1e-6 * first.norm() {
        return Err(format!("{} say no direction across {}: say these too", keys(names[0]), keys(names[1])));
    }
    Ok([across.unit(), third])
}

/// The axes as columns, from the first and the third.
pub(super) fn axes<T: Scalar>(&[first, third]: &[Vec3<T>; 2]) -> Tensor2<T> {
    let columns = [first, third.cross(first), third];
    Tensor2::from_fn(|i, j| columns[j][i])
}

/// Components of a tensor in the axes.
pub(super) fn local<T: Scalar>(tensor: &Tensor2<T>, axes: &Tensor2<T>) -> [T; 6] {
    (axes.transpose() * *tensor * *axes).to_voigt()
}
