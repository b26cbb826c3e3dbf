//! One integration point: from the deformation of the increment to `P = det(f) sigma f^-T` and its derivative.
//!
//! With the law's derivative `C = dsigma/df`,
//! `dP_ij/df_mn = P_ij f^-1_nm - P_in f^-1_jm + det(f) f^-1_jk C_ik,mn`.
//! F-bar (de Souza Neto et al. 1996) evaluates the law at `fbar = f (det f0 / det f)^(1/3)`, in plane strain at the
//! in-plane block scaled with the power 1/2, with f0 at the cell's centre; gradients and volume stay those of f.

use crate::Failure;
use crate::material::{Directions, Gradient, Material};
use crate::mesh::Space;
use crate::tensor::Tensor2;

/// `P` and its derivatives along the `D` components of f that vary and along `ln det f0`.
pub struct PointStress<const D: usize> {
    /// Components of `P`.
    pub p: [f64; D],
    /// Their derivatives.
    pub tangent: [[f64; D]; D],
    /// Their derivatives along `ln det f0`; zero without F-bar.
    pub along_center: [f64; D],
    /// `det f`.
    pub det: f64,
    /// Those of the law.
    law: Gradient,
}

impl<const D: usize> Default for PointStress<D> {
    fn default() -> Self {
        Self { p: [0.0; D], tangent: [[0.0; D]; D], along_center: [0.0; D], det: 1.0, law: Gradient::default() }
    }
}

/// Row and column of the component of `f` that is number `d` of `D`, as [`Directions`] have them.
const fn place<const D: usize>(d: usize) -> (usize, usize) {
    match D {
        9 => (d / 3, d % 3),
        _ if d < 4 => (d / 2, d % 2),
        _ => (2, 2),
    }
}

/// What a point needs besides its deformation.
pub struct PointLaw<'a> {
    /// The law.
    pub material: &'a dyn Material,
    /// The space.
    pub space: Space,
    /// Length of the increment.
    pub dt: f64,
    /// `det f0` at the centre where F-bar is used.
    pub center: Option<f64>,
    /// What heat leaves of a unit of deformation to the law.
    pub free: f64,
}

impl PointLaw<'_> {
    /// Components of f that vary.
    pub fn directions(&self) -> Directions {
        match self.space {
            Space::PlaneStrain => Directions::Plane,
            Space::PlaneStress | Space::Axisymmetric => Directions::PlaneAndNormal,
            Space::Solid => Directions::Space,
        }
    }

    /// Deformation the law sees but for heat, the power of F-bar, and which components it scales.
    #[inline]
    fn bar(&self, f: &Tensor2, det: f64) -> (Tensor2, f64) {
        let Some(center) = self.center else { return (*f, 0.0) };
        let in_plane = self.space == Space::PlaneStrain;
        let ratio = center / det;
        let (scale, power) = if in_plane { (ratio.sqrt(), 0.5) } else { (ratio.cbrt(), 1.0 / 3.0) };
        let scaled = |i: usize, j: usize| !in_plane || (i < 2 && j < 2);
        (Tensor2::from_fn(|i, j| if scaled(i, j) { f[(i, j)] * scale } else { f[(i, j)] }), power)
    }

    /// New state, and in `out` `P` without derivatives.
    pub fn stress<const DIM: usize, const D: usize>(
        &self,
        f: &Tensor2,
        old: &[f64],
        new: &mut [f64],
        out: &mut PointStress<D>,
    ) -> Result<(), Failure> {
        out.det = self.admissible(f)?;
        self.material.update(&(self.bar(f, out.det).0 * self.free), self.dt, old, new)?;
        let p = first_piola::<DIM>(new, &(f.inverse() * out.det));
        out.p = std::array::from_fn(|d| p[place::<D>(d)]);
        Ok(())
    }

    /// `det f`.
    fn admissible(&self, f: &Tensor2) -> Result<f64, Failure> {
        let det = f.det();
        let fine = det > 0.0 && self.center.is_none_or(|c| c > 0.0);
        if fine { Ok(det) } else { Err(Failure::new("a cell is turned inside out")) }
    }

    /// New state, and in `out` `P` and its derivatives.
    pub fn stress_with_tangent<const DIM: usize, const D: usize>(
        &self,
        f: &Tensor2,
        old: &[f64],
        new: &mut [f64],
        out: &mut PointStress<D>,
    ) -> Result<(), Failure> {
        let det = self.admissible(f)?;
        let (bar, power) = self.bar(f, det);
        self.material.differentiate(&(bar * self.free), self.dt, old, (&mut *new, &mut out.law), self.directions())?;
        if self.free != 1.0 {
            out.law.iter_mut().for_each(|row| row[..D].iter_mut().for_each(|c| *c *= self.free));
        }
        let inverse = f.inverse();
        let adjugate = inverse * det;
        (out.det, out.along_center) = (det, [0.0; D]);
        if power > 0.0 {
            self.unbar((f, &inverse), (&bar, power), (&adjugate, out));
        }
        let p = first_piola::<DIM>(new, &adjugate);
        out.p = std::array::from_fn(|d| p[place::<D>(d)]);
        out.differentiate::<DIM>(&p, &inverse, &adjugate);
        Ok(())
    }

    /// Turns the law's derivative along fbar into the one along f at fixed `det f0`, and finds that of `P` along
    /// `ln det f0`.
    fn unbar<const D: usize>(
        &self,
        (f, inverse): (&Tensor2, &Tensor2),
        (bar, power): (&Tensor2, f64),
        (adjugate, out): (&Tensor2, &mut PointStress<D>),
    ) {
        let in_plane = self.space == Space::PlaneStrain;
        let scaled = |(i, j): (usize, usize)| !in_plane || (i < 2 && j < 2);
        let scale = bar[(0, 0)] / f[(0, 0)];
        let scale = if scale.is_finite() { scale } else { (self.center.unwrap_or(1.0) / f.det()).powf(power) };
        let mut center = [0.0; 6];
        for (row, center) in out.law.iter_mut().zip(&mut center) {
            let of = |d: usize| if scaled(place::<D>(d)) { row[d] * bar[place::<D>(d)] } else { 0.0 };
            let radial: f64 = (0..D).map(of).sum();
            *center = power * radial;
            for (d, value) in row[..D].iter_mut().enumerate() {
                let (m, n) = place::<D>(d);
                *value = if scaled((m, n)) { *value * scale } else { *value } - power * inverse[(n, m)] * radial;
            }
        }
        for (d, along) in out.along_center.iter_mut().enumerate() {
            let (i, j) = place::<D>(d);
            *along = (0..3).map(|k| adjugate[(j, k)] * center[VOIGT[i][k]]).sum();
        }
    }
}

#[inline]
fn stress_of(state: &[f64]) -> Tensor2 {
    Tensor2::from_voigt([state[0], state[1], state[2], state[3], state[4], state[5]])
}

impl<const D: usize> PointStress<D> {
    /// The derivatives of `P` from those of the law; in the plane nothing couples the normal with the axes but volume.
    #[inline]
    fn differentiate<const DIM: usize>(&mut self, p: &Tensor2, inverse: &Tensor2, adjugate: &Tensor2) {
        let ([p, inverse, adjugate], block) = ([p.0, inverse.0, adjugate.0], DIM * DIM);
        for i in 0..DIM {
            for j in 0..DIM {
                let mut row = [0.0; D];
                // det(f) f^-1_jk C_ik,mn: rows of C, weighted.
                for k in 0..DIM {
                    let (weight, c) = (adjugate[j][k], &self.law[VOIGT[i][k]]);
                    row.iter_mut().zip(c).for_each(|(t, c)| *t += weight * c);
                }
                for m in 0..DIM {
                    for n in 0..DIM {
                        row[DIM * m + n] += p[i][j] * inverse[n][m] - p[i][n] * inverse[j][m];
                    }
                }
                if D > block {
                    row[block] += p[i][j] * inverse[2][2];
                }
                self.tangent[DIM * i + j] = row;
            }
        }
        if D > block {
            let row = &mut self.tangent[block];
            row.iter_mut().zip(&self.law[2]).for_each(|(t, c)| *t = adjugate[2][2] * c);
            for m in 0..DIM {
                for n in 0..DIM {
                    row[DIM * m + n] += p[2][2] * inverse[n][m];
                }
            }
        }
    }
}

/// `P = sigma (det(f) f^-1)^T`; in the plane nothing couples the normal with the axes.
#[inline]
fn first_piola<const DIM: usize>(state: &[f64], adjugate: &Tensor2) -> Tensor2 {
    let (sigma, mut p) = (stress_of(state), Tensor2::zero());
    for i in 0..DIM {
        for j in 0..DIM {
            for k in 0..DIM {
                p[(i, j)] += sigma[(i, k)] * adjugate[(j, k)];
            }
        }
    }
    if DIM == 2 {
        p[(2, 2)] = sigma[(2, 2)] * adjugate[(2, 2)];
    }
    p
}

/// Place of each component among XX YY ZZ XY YZ XZ.
const VOIGT: [[usize; 3]; 3] = [[0, 3, 5], [3, 1, 4], [5, 4, 2]];
