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

/// `P` and its derivatives along the `directions` of f and along `ln det f0`.
#[derive(Default)]
pub struct PointStress {
    /// Components of `P` in the order of the directions.
    pub p: [f64; 9],
    /// Their derivatives.
    pub tangent: [[f64; 9]; 9],
    /// Their derivatives along `ln det f0`; zero without F-bar.
    pub along_center: [f64; 9],
    /// `det f`.
    pub det: f64,
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
    fn bar(&self, f: &Tensor2) -> (Tensor2, f64) {
        let Some(center) = self.center else { return (*f, 0.0) };
        let in_plane = self.space == Space::PlaneStrain;
        let ratio = center / f.det();
        let (scale, power) = if in_plane { (ratio.sqrt(), 0.5) } else { (ratio.cbrt(), 1.0 / 3.0) };
        let scaled = |i: usize, j: usize| !in_plane || (i < 2 && j < 2);
        (Tensor2::from_fn(|i, j| if scaled(i, j) { f[(i, j)] * scale } else { f[(i, j)] }), power)
    }

    /// New state and `P` without derivatives.
    pub fn stress(&self, f: &Tensor2, old: &[f64], new: &mut [f64]) -> Result<[f64; 9], Failure> {
        self.admissible(f)?;
        self.material.update(&(self.bar(f).0 * self.free), self.dt, old, new)?;
        let p = first_piola(f, new);
        Ok(self.components(&p))
    }

    fn admissible(&self, f: &Tensor2) -> Result<(), Failure> {
        let fine = f.det() > 0.0 && self.center.is_none_or(|c| c > 0.0);
        if fine { Ok(()) } else { Err(Failure::new("a cell is turned inside out")) }
    }

    /// The components of a tensor along the directions.
    fn components(&self, tensor: &Tensor2) -> [f64; 9] {
        let mut out = [0.0; 9];
        for (out, &place) in out.iter_mut().zip(self.directions().components()) {
            *out = tensor[place];
        }
        out
    }

    /// New state, and in `out` `P` and its derivatives.
    pub fn stress_with_tangent(
        &self,
        f: &Tensor2,
        old: &[f64],
        new: &mut [f64],
        out: &mut PointStress,
    ) -> Result<(), Failure> {
        self.admissible(f)?;
        let (bar, power) = self.bar(f);
        let mut c = self.material.update_with_gradient(&(bar * self.free), self.dt, old, new, self.directions())?;
        let (inverse, det) = (f.inverse(), f.det());
        c.iter_mut().flatten().for_each(|c| *c *= self.free);
        let center = if power > 0.0 { self.unbar(&mut c, f, &bar, power) } else { [0.0; 6] };
        let p = first_piola(f, new);
        let places = self.directions().components();
        (out.p, out.det) = (self.components(&p), det);
        for (a, &(i, j)) in places.iter().enumerate() {
            (out.tangent[a], out.along_center[a]) = ([0.0; 9], 0.0);
            // det(f) f^-1_jk C_ik,mn: three rows of C, weighted.
            for k in 0..3 {
                let (weight, v) = (det * inverse[(j, k)], voigt(i, k));
                out.along_center[a] += weight * center[v];
                out.tangent[a].iter_mut().zip(&c[v]).for_each(|(t, c)| *t += weight * c);
            }
            for (b, &(m, n)) in places.iter().enumerate() {
                out.tangent[a][b] += p[(i, j)] * inverse[(n, m)] - p[(i, n)] * inverse[(j, m)];
            }
        }
        Ok(())
    }

    /// Turns the derivative along fbar into the one along f at fixed `det f0`, and returns the derivative of the
    /// stress along `ln det f0`.
    fn unbar(&self, c: &mut Gradient, f: &Tensor2, bar: &Tensor2, power: f64) -> [f64; 6] {
        let places = self.directions().components();
        let in_plane = self.space == Space::PlaneStrain;
        let scaled = |(i, j): (usize, usize)| !in_plane || (i < 2 && j < 2);
        let (scale, inverse) = (bar[(0, 0)] / f[(0, 0)], f.inverse());
        let scale = if scale.is_finite() { scale } else { (self.center.unwrap_or(1.0) / f.det()).powf(power) };
        let mut center = [0.0; 6];
        for (row, center) in c.iter_mut().zip(&mut center) {
            let radial: f64 =
                places.iter().zip(row.iter()).filter(|(p, _)| scaled(**p)).map(|(&p, c)| c * bar[p]).sum();
            *center = power * radial;
            for (value, &(m, n)) in row.iter_mut().zip(places) {
                *value = if scaled((m, n)) { *value * scale } else { *value } - power * inverse[(n, m)] * radial;
            }
        }
        center
    }
}

/// `det(f) sigma f^-T`.
fn first_piola(f: &Tensor2, state: &[f64]) -> Tensor2 {
    let sigma = Tensor2::from_voigt([state[0], state[1], state[2], state[3], state[4], state[5]]);
    sigma * f.inverse().transpose() * f.det()
}

/// Place of component (i, j) among XX YY ZZ XY YZ XZ.
fn voigt(i: usize, j: usize) -> usize {
    const PLACE: [[usize; 3]; 3] = [[0, 3, 5], [3, 1, 4], [5, 4, 2]];
    PLACE[i][j]
}
