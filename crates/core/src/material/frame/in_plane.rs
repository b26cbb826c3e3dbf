//! The frame of a deformation without shear out of the plane.

use super::{Frame, Turning};
use crate::tensor::Tensor2;

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
    #[inline]
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
