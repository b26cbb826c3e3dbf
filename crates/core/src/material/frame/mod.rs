//! The frame in which a rate law sees an increment: strain, rotation and old stress, with their derivatives.
//!
//! The derivatives are written by hand because every point of every iteration passes here; duals through
//! [`hughes_winget`] are their oracle in the tests.

mod in_plane;
mod in_space;
mod still;

pub use in_plane::InPlane;
pub use in_space::InSpace;
use in_space::Turned;
pub use still::Still;

use super::Gradient;
use crate::tensor::{Dual, Scalar, Tensor2, Vec3};

/// Strain increment of a deformation `f`, turned to its end, and rotation.
pub fn hughes_winget<T: Scalar>(f: &Tensor2<T>) -> (Tensor2<T>, Tensor2<T>) {
    let g = about_midpoint(f);
    let spin = g.skew() * T::from(0.5);
    let half = cayley(&(spin * halving(&spin).0));
    ((half * g.sym() * half.transpose()).sym(), cayley(&spin))
}

/// Gradient of the displacement increment about the midpoint configuration.
pub(super) fn about_midpoint<T: Scalar>(f: &Tensor2<T>) -> Tensor2<T> {
    let identity = Tensor2::<T>::identity();
    (*f - identity) * (*f + identity).inverse() * T::from(2.0)
}

/// The rotation about the same axis by half the angle.
pub(super) fn half<T: Scalar>(rotation: &Tensor2<T>) -> Tensor2<T> {
    let identity = Tensor2::<T>::identity();
    let spin = ((*rotation - identity) * (*rotation + identity).inverse()).skew();
    cayley(&(spin * halving(&spin).0))
}

/// The rotation `(I - A)^-1 (I + A)` of a skew `A`, by twice the angle whose tangent is the length of its axis `a`:
/// `((1 - a.a) I + 2 a a + 2 A) / (1 + a.a)`.
pub(super) fn cayley<T: Scalar>(skew: &Tensor2<T>) -> Tensor2<T> {
    let axis = Vec3([skew[(2, 1)], skew[(0, 2)], skew[(1, 0)]]);
    let square = axis.dot(axis);
    let scale = (square + 1.0).recip();
    Tensor2::from_fn(|i, j| {
        let twice = (axis[i] * axis[j] + skew[(i, j)]) * 2.0;
        (if i == j { twice - square + 1.0 } else { twice }) * scale
    })
}

/// The factor `c = 1/(1 + s)` by which the axis is shortened for half the angle, and `s = sqrt(1 + A:A/2)`.
fn halving<T: Scalar>(skew: &Tensor2<T>) -> (T, T) {
    let s = (skew.contract(*skew) * 0.5 + 1.0).sqrt();
    ((s + 1.0).recip(), s)
}

/// What a law is given: the strain increment, the rotation and the rotated old stress; or what they change by.
pub struct Frame<T> {
    /// Strain increment.
    pub de: Tensor2<T>,
    /// Rotation.
    pub q: Tensor2<T>,
    /// Old stress, turned.
    pub stress: Tensor2<T>,
}

impl Frame<f64> {
    /// The frame of a deformation.
    pub fn of(f: &Tensor2, old: &Tensor2) -> Self {
        let flat = |t: &Tensor2| [(0, 2), (1, 2), (2, 0), (2, 1)].iter().all(|&place| t[place] == 0.0);
        if flat(f) && flat(old) { InPlane::new(f, old).values() } else { Turned::new(f, old).values() }
    }
}

/// The frame of one deformation, from which its derivatives follow.
pub trait Turning {
    /// The frame.
    fn values(&self) -> Frame<f64>;

    /// What it changes by along one component of the deformation.
    fn slope(&self, place: (usize, usize)) -> Frame<f64>;

    /// The frame with its derivatives along the components `places`.
    fn duals<const N: usize>(&self, places: &[(usize, usize)]) -> Frame<Dual<N>> {
        let at = self.values();
        let mut frame = Frame { de: at.de.lift(), q: at.q.lift(), stress: at.stress.lift() };
        for (d, &place) in places.iter().enumerate() {
            let slope = self.slope(place);
            set_slope(&mut frame.de, d, &slope.de);
            set_slope(&mut frame.q, d, &slope.q);
            set_slope(&mut frame.stress, d, &slope.stress);
        }
        frame
    }

    /// Derivatives of the rotated stress and the elastic stress `lambda tr(de) I + 2 G de` together.
    #[inline]
    fn elastic_gradient(&self, [lambda, shear]: [f64; 2], places: &[(usize, usize)], gradient: &mut Gradient) {
        for (d, &place) in places.iter().enumerate() {
            let Frame { de, stress, .. } = self.slope(place);
            let mean = lambda * de.trace();
            let along = stress.to_voigt().into_iter().zip(de.to_voigt());
            for (v, (row, (stress, de))) in gradient.iter_mut().zip(along).enumerate() {
                let elastic = 2.0 * shear * de;
                row[d] = stress + if v < 3 { elastic + mean } else { elastic };
            }
        }
    }
}

fn set_slope<const N: usize>(t: &mut Tensor2<Dual<N>>, direction: usize, slope: &Tensor2) {
    for (row, slopes) in t.0.iter_mut().zip(&slope.0) {
        row.iter_mut().zip(slopes).for_each(|(x, slope)| x.du[direction] = *slope);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Directions;
    use crate::material::law::seeded;

    /// A deformation with all nine components away from the identity, and a stress.
    fn sample() -> (Tensor2, Tensor2) {
        let f = Tensor2([[1.13, 0.21, -0.07], [-0.16, 0.88, 0.05], [0.11, -0.09, 1.06]]);
        (f, Tensor2::from_voigt([3.0, -2.0, 1.5, 0.7, -0.4, 1.1]))
    }

    #[test]
    fn derivatives_of_the_frame_are_those_of_duals() {
        let (f, old) = sample();
        compare(&InSpace::new(&f, &old), &f, &old, Directions::Space.components());
        let in_plane = |t: &Tensor2| Tensor2::from_fn(|i, j| if (i == 2) == (j == 2) { t[(i, j)] } else { 0.0 });
        for directions in [Directions::Plane, Directions::PlaneAndNormal] {
            let (f, old) = (in_plane(&f), in_plane(&old));
            compare(&InPlane::new(&f, &old), &f, &old, directions.components());
            compare(&InSpace::new(&f, &old), &f, &old, directions.components());
        }
    }

    #[test]
    fn an_elastic_step_has_the_derivative_of_duals() {
        let (f, old) = sample();
        let (turning, places) = (InSpace::new(&f, &old), Directions::Space.components());
        let frame = turning.duals::<9>(places);
        let elastic = frame.de * Dual::from(2.0 * 5.0) + Tensor2::identity() * (frame.de.trace() * 7.0);
        let by_duals = (frame.stress + elastic).to_voigt();
        let mut gradient = Gradient::default();
        turning.elastic_gradient([7.0, 5.0], places, &mut gradient);
        for (row, dual) in gradient.iter().zip(by_duals) {
            row.iter().zip(dual.du).for_each(|(a, b)| assert!((a - b).abs() < 1e-13 * b.abs().max(1.0), "{a}, {b}"));
        }
    }

    fn compare(turning: &impl Turning, f: &Tensor2, old: &Tensor2, places: &[(usize, usize)]) {
        let (de, q) = hughes_winget(&seeded::<9>(f, places));
        let stress = q * old.lift() * q.transpose();
        let frame = turning.duals::<9>(places);
        for (by_hand, by_duals) in [(frame.de, de), (frame.q, q), (frame.stress, stress)] {
            for place in Directions::Space.components() {
                let (a, b) = (by_hand[*place], by_duals[*place]);
                assert!((a.re - b.re).abs() < 1e-14, "{place:?}: {} against {}", a.re, b.re);
                a.du.iter().zip(b.du).for_each(|(x, y)| assert!((x - y).abs() < 1e-13, "{place:?}: {x} against {y}"));
            }
        }
    }
}
