//! The frame in which a rate law sees an increment: strain, rotation and old stress, with their derivatives.

use super::Gradient;
use crate::tensor::{Dual, Scalar, Tensor2};

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

/// The rotation `(I - A)^-1 (I + A)` of a skew `A`, by twice the angle whose tangent is the length of its axis.
fn cayley<T: Scalar>(skew: &Tensor2<T>) -> Tensor2<T> {
    let identity = Tensor2::<T>::identity();
    (identity - *skew).inverse() * (identity + *skew)
}

/// The factor `c = 1/(1 + s)` by which the axis is shortened for half the angle, and `s = sqrt(1 + A:A/2)`.
fn halving<T: Scalar>(skew: &Tensor2<T>) -> (T, T) {
    let s = (skew.contract(*skew) * 0.5 + 1.0).sqrt();
    ((s + 1.0).recip(), s)
}

/// What a law is given: the strain increment, the rotation and the rotated old stress.
pub struct Frame<T> {
    /// Strain increment.
    pub de: Tensor2<T>,
    /// Rotation.
    pub q: Tensor2<T>,
    /// Old stress, turned.
    pub stress: Tensor2<T>,
}

impl<const N: usize> Frame<Dual<N>> {
    /// The frame of a deformation with its derivatives along the components `places` of `f`. They are written by hand
    /// because every point of every iteration passes here; duals through [`hughes_winget`] are their oracle in the tests.
    pub fn new(f: &Tensor2, old: &Tensor2, places: &[(usize, usize)]) -> Self {
        let in_plane = places.iter().all(|&(i, j)| (i == 2) == (j == 2));
        if in_plane { Self::plane(f, old, places) } else { Self::space(f, old, places) }
    }

    /// Derivatives of the rotated stress and the elastic stress `lambda tr(de) I + 2 G de` together.
    pub fn elastic_gradient(&self, [lambda, shear]: [f64; 2]) -> Gradient {
        let (stress, de) = (self.stress.to_voigt(), self.de.to_voigt());
        let mut gradient = [[0.0; 9]; 6];
        for (v, row) in gradient.iter_mut().enumerate() {
            for (d, slope) in row.iter_mut().enumerate().take(N) {
                let mean = if v < 3 { lambda * (de[0].du[d] + de[1].du[d] + de[2].du[d]) } else { 0.0 };
                *slope = stress[v].du[d] + 2.0 * shear * de[v].du[d] + mean;
            }
        }
        gradient
    }

    /// In the plane a rotation is an angle, `tan(angle / 2) = t = (G_xy - G_yx) / 4`. A tensor turned by it keeps its trace,
    /// its deviator turns by twice as much: that of the strain, which makes half of the rotation, by the angle itself.
    fn plane(f: &Tensor2, old: &Tensor2, places: &[(usize, usize)]) -> Self {
        let a = (*f + Tensor2::identity()).inverse();
        let g = (*f - Tensor2::identity()) * a * 2.0;
        let t = 0.25 * (g[(0, 1)] - g[(1, 0)]);
        let (cos, sin) = ((1.0 - t * t) / (1.0 + t * t), 2.0 * t / (1.0 + t * t));
        let twice = (cos * cos - sin * sin, 2.0 * cos * sin);
        let (strain, stress) = (InPlane::of(&g).turned((cos, sin)), InPlane::of(old).turned(twice));
        let mut frame = Self {
            de: strain.tensor().lift(),
            q: Tensor2([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]]).lift(),
            stress: stress.tensor().lift(),
        };
        for (d, &(m, n)) in places.iter().enumerate() {
            let dg = |i: usize, j: usize| 4.0 * a[(i, m)] * a[(n, j)];
            let angle = 0.5 * (dg(0, 1) - dg(1, 0)) / (1.0 + t * t);
            let stretch = InPlane::of(&Tensor2::from_fn(dg)).turned((cos, sin));
            set_slope(&mut frame.de, d, &stretch.plus(&strain.turning(angle)).tensor());
            set_slope(&mut frame.stress, d, &stress.turning(2.0 * angle).tensor());
            let dq = [[-sin * angle, cos * angle, 0.0], [-cos * angle, -sin * angle, 0.0], [0.0; 3]];
            set_slope(&mut frame.q, d, &Tensor2(dq));
        }
        frame
    }

    /// With `A = (f + I)^-1`, `B = (I - W/2)^-1` and `C` the same of the half rotation: `dG = 4 A df A`, `dQ = B dW B`,
    /// `dH = C d(c W) C`.
    fn space(f: &Tensor2, old: &Tensor2, places: &[(usize, usize)]) -> Self {
        let identity = Tensor2::identity();
        let a = (*f + identity).inverse();
        let g = (*f - identity) * a * 2.0;
        let spin = g.skew() * 0.5;
        let (c, s) = halving(&spin);
        let (q, half) = (cayley(&spin), cayley(&(spin * c)));
        let (b, b_half) = ((q + identity) * 0.5, (half + identity) * 0.5);
        let (turn, turn_half) = (*old * q.transpose(), g.sym() * half.transpose());
        let de = (half * turn_half).sym();
        let mut frame = Self { de: de.lift(), q: q.lift(), stress: (q * turn).lift() };
        for (d, &(m, n)) in places.iter().enumerate() {
            let dg = Tensor2::from_fn(|i, j| 4.0 * a[(i, m)] * a[(n, j)]);
            let dw = dg.skew();
            let dq = b * dw * b;
            let dc = -0.25 * c * c * spin.contract(dw) / s;
            let dh = b_half * (dw * c + spin * (2.0 * dc)) * b_half;
            let (by_turn, strain) = (dh * turn_half, half * dg.sym() * half.transpose());
            let stress = dq * turn;
            set_slope(&mut frame.de, d, &(strain + by_turn + by_turn.transpose()));
            set_slope(&mut frame.q, d, &dq);
            set_slope(&mut frame.stress, d, &(stress + stress.transpose()));
        }
        frame
    }
}

fn set_slope<const N: usize>(t: &mut Tensor2<Dual<N>>, direction: usize, slope: &Tensor2) {
    for (row, slopes) in t.0.iter_mut().zip(&slope.0) {
        row.iter_mut().zip(slopes).for_each(|(x, slope)| x.du[direction] = *slope);
    }
}

/// The symmetric part of a tensor without shear out of the plane.
#[derive(Clone, Copy)]
struct InPlane {
    mean: f64,
    difference: f64,
    shear: f64,
    normal: f64,
}

impl InPlane {
    fn of(t: &Tensor2) -> Self {
        Self {
            mean: 0.5 * (t[(0, 0)] + t[(1, 1)]),
            difference: 0.5 * (t[(0, 0)] - t[(1, 1)]),
            shear: 0.5 * (t[(0, 1)] + t[(1, 0)]),
            normal: t[(2, 2)],
        }
    }
    /// Turned by half the angle with this cosine and sine.
    fn turned(&self, (cos, sin): (f64, f64)) -> Self {
        let (difference, shear) = (self.difference, self.shear);
        Self { difference: difference * cos + shear * sin, shear: shear * cos - difference * sin, ..*self }
    }
    /// Its rate when it is turned further by half of `angle`.
    fn turning(&self, angle: f64) -> Self {
        Self { mean: 0.0, difference: angle * self.shear, shear: -angle * self.difference, normal: 0.0 }
    }
    fn plus(&self, other: &Self) -> Self {
        Self {
            mean: self.mean + other.mean,
            difference: self.difference + other.difference,
            shear: self.shear + other.shear,
            normal: self.normal + other.normal,
        }
    }
    fn tensor(&self) -> Tensor2 {
        let (xx, yy, xy) = (self.mean + self.difference, self.mean - self.difference, self.shear);
        Tensor2([[xx, xy, 0.0], [xy, yy, 0.0], [0.0, 0.0, self.normal]])
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
        compare(&f, &old, Directions::Space.components());
        let in_plane = |t: &Tensor2| Tensor2::from_fn(|i, j| if (i == 2) == (j == 2) { t[(i, j)] } else { 0.0 });
        for directions in [Directions::Plane, Directions::PlaneAndNormal] {
            compare(&in_plane(&f), &in_plane(&old), directions.components());
        }
    }

    #[test]
    fn an_elastic_step_has_the_derivative_of_duals() {
        let (f, old) = sample();
        let frame = Frame::<Dual<9>>::new(&f, &old, Directions::Space.components());
        let elastic = frame.de * Dual::from(2.0 * 5.0) + Tensor2::identity() * (frame.de.trace() * 7.0);
        let by_duals = (frame.stress + elastic).to_voigt();
        for (row, dual) in frame.elastic_gradient([7.0, 5.0]).iter().zip(by_duals) {
            row.iter().zip(dual.du).for_each(|(a, b)| assert!((a - b).abs() < 1e-13 * b.abs().max(1.0), "{a}, {b}"));
        }
    }

    fn compare(f: &Tensor2, old: &Tensor2, places: &[(usize, usize)]) {
        let (de, q) = hughes_winget(&seeded::<9>(f, places));
        let stress = q * old.lift() * q.transpose();
        let frame = Frame::<Dual<9>>::new(f, old, places);
        for (by_hand, by_duals) in [(frame.de, de), (frame.q, q), (frame.stress, stress)] {
            for place in Directions::Space.components() {
                let (a, b) = (by_hand[*place], by_duals[*place]);
                assert!((a.re - b.re).abs() < 1e-14, "{place:?}: {} against {}", a.re, b.re);
                a.du.iter().zip(b.du).for_each(|(x, y)| assert!((x - y).abs() < 1e-13, "{place:?}: {x} against {y}"));
            }
        }
    }
}
