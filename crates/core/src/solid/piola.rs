//! The stress `P = det(f) sigma f^-T` over areas at the beginning of the increment and its derivative.
//!
//! With the law's derivative `C = dsigma/df`,
//! `dP_ij/df_mn = P_ij f^-1_nm - P_in f^-1_jm + det(f) f^-1_jk C_ik,mn`.

use super::lanes::add_multiple;
use crate::material::Gradient;
use crate::tensor::{Tensor2, Vec3};
use pulp::{Arch, Simd, WithSimd};

/// Place of each component among XX YY ZZ XY YZ XZ.
pub const VOIGT: [[usize; 3]; 3] = [[0, 3, 5], [3, 1, 4], [5, 4, 2]];

/// Row and column of the component of `f` that is number `d` of `D`, as [`Directions`](crate::material::Directions)
/// have them.
pub const fn place<const D: usize>(d: usize) -> (usize, usize) {
    match D {
        9 => (d / 3, d % 3),
        _ if d < 4 => (d / 2, d % 2),
        _ => (2, 2),
    }
}

/// `P` of the stress in a state; `adjugate` is `det(f) f^-1`.
#[inline]
pub fn first_piola(state: &[f64], adjugate: &Tensor2) -> Tensor2 {
    Tensor2::from_voigt(std::array::from_fn(|i| state[i])) * adjugate.transpose()
}

/// What the derivative of `P` follows from.
pub struct Derivative<'a> {
    /// That of the law.
    pub law: &'a Gradient,
    /// The stress itself.
    pub p: &'a Tensor2,
    /// `f^-1`.
    pub inverse: &'a Tensor2,
    /// `det(f) f^-1`.
    pub adjugate: &'a Tensor2,
}

impl Derivative<'_> {
    /// Writes the derivatives of `P`; in the plane nothing couples the normal with the axes but volume.
    #[inline]
    pub fn write<const DIM: usize, const D: usize>(self, out: &mut [[f64; D]; D]) {
        Arch::new().dispatch(Write::<DIM, D> { of: self, out });
    }
}

struct Write<'a, const DIM: usize, const D: usize> {
    of: Derivative<'a>,
    out: &'a mut [[f64; D]; D],
}

impl<const DIM: usize, const D: usize> WithSimd for Write<'_, DIM, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { of: Derivative { law, p, inverse, adjugate }, out } = self;
        for i in 0..DIM {
            for j in 0..DIM {
                let mut row = [0.0; D];
                // det(f) f^-1_jk C_ik,mn: rows of C, weighted.
                for k in 0..DIM {
                    add_row(simd, adjugate[(j, k)], &law[VOIGT[i][k]], &mut row);
                }
                if D > DIM * DIM {
                    row[DIM * DIM] += p[(i, j)] * inverse[(2, 2)];
                }
                out[DIM * i + j] = row;
            }
            add_turn::<DIM, D>(i, p, inverse, out);
        }
        if D > DIM * DIM {
            let mut row = [0.0; D];
            add_row(simd, adjugate[(2, 2)], &law[2], &mut row);
            (0..DIM * DIM).for_each(|d| row[d] += p[(2, 2)] * inverse[(d % DIM, d / DIM)]);
            out[DIM * DIM] = row;
        }
    }
}

/// `row += weight c`.
#[inline(always)]
fn add_row<S: Simd, const D: usize>(simd: S, weight: f64, c: &[f64; 9], row: &mut [f64; D]) {
    if let Some(c) = c.first_chunk() {
        add_multiple(simd, weight, c, row);
    }
}

/// Adds `P_ij f^-1_nm - P_in f^-1_jm`, which changes sign with j and n: a vector product.
#[inline(always)]
fn add_turn<const DIM: usize, const D: usize>(i: usize, p: &Tensor2, inverse: &Tensor2, out: &mut [[f64; D]; D]) {
    for m in 0..DIM {
        let turn = Vec3(p.0[i]).cross(Vec3(inverse.transpose().0[m]));
        for (j, n, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
            if j < DIM && n < DIM {
                out[DIM * i + j][DIM * m + n] += turn[k];
                out[DIM * i + n][DIM * m + j] -= turn[k];
            }
        }
    }
}
