//! The frame in which a rate law sees an increment: strain, rotation and old stress, with their derivatives.
//!
//! The derivatives are written by hand because every point of every iteration passes here; duals through
//! [`hughes_winget`] are their oracle in the tests.

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
        if flat(f) && flat(old) { InPlane::new(f, old).values() } else { InSpace::new(f, old).values() }
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

/// A frame that turns in the plane by an angle, `tan(angle / 2) = t = (G_xy - G_yx) / 4`. A tensor turned by it keeps its
/// trace, its deviator turns by twice as much: that of the strain, which makes half of the rotation, by the angle itself.
pub struct InPlane {
    /// `(f + I)^-1`, in the plane and along the normal.
    a: [[f64; 2]; 2],
    normal: f64,
    /// Derivative of the angle along `G_xy`.
    angle: f64,
    /// Cosine and sine of the angle.
    turn: (f64, f64),
    strain: Flat,
    stress: Flat,
}

impl InPlane {
    /// Of a deformation and an old stress without shear out of the plane.
    pub fn new(f: &Tensor2, old: &Tensor2) -> Self {
        let (xx, xy, yx, yy) = (f[(0, 0)] + 1.0, f[(0, 1)], f[(1, 0)], f[(1, 1)] + 1.0);
        let (scale, normal) = ((xx * yy - xy * yx).recip(), (f[(2, 2)] + 1.0).recip());
        let a = [[yy * scale, -xy * scale], [-yx * scale, xx * scale]];
        let d = [[f[(0, 0)] - 1.0, xy], [yx, f[(1, 1)] - 1.0]];
        let g = |i: usize, j: usize| 2.0 * (d[i][0] * a[0][j] + d[i][1] * a[1][j]);
        let (gxy, gyx) = (g(0, 1), g(1, 0));
        let t = 0.25 * (gxy - gyx);
        let angle = (1.0 + t * t).recip();
        let (cos, sin) = ((1.0 - t * t) * angle, 2.0 * t * angle);
        let strain = Flat::of([[g(0, 0), gxy], [gyx, g(1, 1)]], 2.0 * (f[(2, 2)] - 1.0) * normal);
        let old = Flat::of([[old[(0, 0)], old[(0, 1)]], [old[(1, 0)], old[(1, 1)]]], old[(2, 2)]);
        let twice = (cos * cos - sin * sin, 2.0 * cos * sin);
        Self { a, normal, angle, turn: (cos, sin), strain: strain.turned((cos, sin)), stress: old.turned(twice) }
    }
}

impl Turning for InPlane {
    #[inline]
    fn values(&self) -> Frame<f64> {
        let (cos, sin) = self.turn;
        let q = Tensor2([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]]);
        Frame { de: self.strain.tensor(), q, stress: self.stress.tensor() }
    }

    /// With `A = (f + I)^-1`, `dG = 4 A df A`.
    #[inline(always)]
    fn slope(&self, (m, n): (usize, usize)) -> Frame<f64> {
        if m == 2 {
            let stretch = Flat { normal: 4.0 * self.normal * self.normal, ..Flat::default() };
            return Frame { de: stretch.tensor(), q: Tensor2::zero(), stress: Tensor2::zero() };
        }
        let (left, right) = ([4.0 * self.a[0][m], 4.0 * self.a[1][m]], self.a[n]);
        let dg = [[left[0] * right[0], left[0] * right[1]], [left[1] * right[0], left[1] * right[1]]];
        let angle = 0.5 * (dg[0][1] - dg[1][0]) * self.angle;
        let (cos, sin) = (self.turn.0 * angle, self.turn.1 * angle);
        let stretch = Flat::of(dg, 0.0).turned(self.turn);
        Frame {
            de: stretch.plus(&self.strain.turning(angle)).tensor(),
            q: Tensor2([[-sin, cos, 0.0], [-cos, -sin, 0.0], [0.0; 3]]),
            stress: self.stress.turning(2.0 * angle).tensor(),
        }
    }
}

/// A frame that turns in space. With `A = (f + I)^-1`, `B = (I - W/2)^-1` and `C` the same of the half rotation:
/// `dG = 4 A df A`, `dQ = B dW B`, `dH = C d(c W) C`.
pub struct InSpace {
    a: Tensor2,
    spin: Tensor2,
    /// `c` of the half rotation, and `s`.
    halving: (f64, f64),
    q: Tensor2,
    half: Tensor2,
    b: Tensor2,
    b_half: Tensor2,
    /// What is left to turn from the left: the old stress, and the strain for half of the rotation.
    turn: Tensor2,
    turn_half: Tensor2,
}

impl InSpace {
    /// Of a deformation and an old stress.
    pub fn new(f: &Tensor2, old: &Tensor2) -> Self {
        let identity = Tensor2::identity();
        let a = (*f + identity).inverse();
        let g = (*f - identity) * a * 2.0;
        let spin = g.skew() * 0.5;
        let halving = halving(&spin);
        let (q, half) = (cayley(&spin), cayley(&(spin * halving.0)));
        let (b, b_half) = ((q + identity) * 0.5, (half + identity) * 0.5);
        let (turn, turn_half) = (*old * q.transpose(), g.sym() * half.transpose());
        Self { a, spin, halving, q, half, b, b_half, turn, turn_half }
    }
}

impl Turning for InSpace {
    fn values(&self) -> Frame<f64> {
        Frame { de: (self.half * self.turn_half).sym(), q: self.q, stress: self.q * self.turn }
    }

    fn slope(&self, (m, n): (usize, usize)) -> Frame<f64> {
        let (a, (c, s)) = (&self.a, self.halving);
        let dg = Tensor2::from_fn(|i, j| 4.0 * a[(i, m)] * a[(n, j)]);
        let dw = dg.skew();
        let dc = -0.25 * c * c * self.spin.contract(dw) / s;
        let dh = self.b_half * (dw * c + self.spin * (2.0 * dc)) * self.b_half;
        let (by_turn, strain) = (dh * self.turn_half, self.half * dg.sym() * self.half.transpose());
        let dq = self.b * dw * self.b;
        let stress = dq * self.turn;
        Frame { de: strain + by_turn + by_turn.transpose(), q: dq, stress: stress + stress.transpose() }
    }
}

fn set_slope<const N: usize>(t: &mut Tensor2<Dual<N>>, direction: usize, slope: &Tensor2) {
    for (row, slopes) in t.0.iter_mut().zip(&slope.0) {
        row.iter_mut().zip(slopes).for_each(|(x, slope)| x.du[direction] = *slope);
    }
}

/// The symmetric part of a tensor without shear out of the plane.
#[derive(Clone, Copy, Default)]
struct Flat {
    mean: f64,
    difference: f64,
    shear: f64,
    normal: f64,
}

impl Flat {
    #[inline]
    fn of([[xx, xy], [yx, yy]]: [[f64; 2]; 2], normal: f64) -> Self {
        Self { mean: 0.5 * (xx + yy), difference: 0.5 * (xx - yy), shear: 0.5 * (xy + yx), normal }
    }
    /// Turned by half the angle with this cosine and sine.
    #[inline]
    fn turned(&self, (cos, sin): (f64, f64)) -> Self {
        let (difference, shear) = (self.difference, self.shear);
        Self { difference: difference * cos + shear * sin, shear: shear * cos - difference * sin, ..*self }
    }
    /// Its rate when it is turned further by half of `angle`.
    #[inline]
    fn turning(&self, angle: f64) -> Self {
        Self { mean: 0.0, difference: angle * self.shear, shear: -angle * self.difference, normal: 0.0 }
    }
    #[inline]
    fn plus(&self, other: &Self) -> Self {
        Self {
            mean: self.mean + other.mean,
            difference: self.difference + other.difference,
            shear: self.shear + other.shear,
            normal: self.normal + other.normal,
        }
    }
    #[inline]
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
