//! One integration point: from the deformation of the increment to `P = det(f) sigma f^-T` and its derivative.
//!
//! F-bar (de Souza Neto et al. 1996) evaluates the law at `fbar = f (det f0 / det f)^(1/3)`, in plane strain at the
//! in-plane block scaled with the power 1/2, with f0 at the cell's centre; gradients and volume stay those of f.

use super::Strain;
use super::piola::{Derivative, VOIGT, first_piola, place};
use crate::material::{Directions, Gradient, Material};
use crate::mesh::Space;
use crate::tensor::Tensor2;
use crate::{Failure, Kind};

/// `P` and its derivatives along the `D` components of f that vary and along `ln det f0`.
pub struct PointStress<const D: usize> {
    /// Components of `P`.
    pub p: [f64; D],
    /// Their derivatives.
    pub tangent: [[f64; D]; D],
    /// Their derivatives along `ln det f0`, in small strain along the trace there; zero without F-bar.
    pub along_center: [f64; D],
    /// `det f`.
    pub det: f64,
    /// Those of the law.
    pub(super) law: Gradient,
}

impl<const D: usize> Default for PointStress<D> {
    fn default() -> Self {
        Self { p: [0.0; D], tangent: [[0.0; D]; D], along_center: [0.0; D], det: 1.0, law: Gradient::default() }
    }
}

/// What a point needs besides its deformation.
pub struct PointLaw<'a> {
    /// The law.
    pub material: &'a dyn Material,
    /// The space.
    pub space: Space,
    /// Kinematics.
    pub strain: Strain,
    /// Length of the increment.
    pub dt: f64,
    /// `det f0` at the centre where F-bar is used; in small strain one and its trace.
    pub center: Option<f64>,
    /// What heat leaves of a unit of deformation to the law,
    pub free: f64,
    /// and what it adds to the diagonal, in small strain.
    pub cooling: f64,
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

    /// Deformation the law sees, without F-bar.
    pub fn seen(&self, f: &Tensor2) -> Tensor2 {
        match self.strain {
            Strain::Finite => *f * self.free,
            Strain::Small => self.small_seen(f),
        }
    }

    /// New state, and in `out` `P` without derivatives.
    pub fn stress<const DIM: usize, const D: usize>(
        &self,
        f: &Tensor2,
        old: &[f64],
        new: &mut [f64],
        out: &mut PointStress<D>,
    ) -> Result<(), Failure> {
        if self.strain == Strain::Small {
            return self.small_stress(f, old, new, out);
        }
        out.det = self.admissible(f)?;
        self.material.update(&(self.bar(f, out.det).0 * self.free), self.dt, old, new)?;
        let p = first_piola(new, &(f.inverse() * out.det));
        out.p = std::array::from_fn(|d| p[place::<D>(d)]);
        Ok(())
    }

    /// `det f`.
    fn admissible(&self, f: &Tensor2) -> Result<f64, Failure> {
        let det = f.det();
        let fine = det > 0.0 && self.center.is_none_or(|c| c > 0.0);
        if fine { Ok(det) } else { Err(Failure::new("a cell is turned inside out").of(Kind::Inverted)) }
    }

    /// New state, and in `out` `P` and its derivatives.
    pub fn stress_with_tangent<const DIM: usize, const D: usize>(
        &self,
        f: &Tensor2,
        old: &[f64],
        new: &mut [f64],
        out: &mut PointStress<D>,
    ) -> Result<(), Failure> {
        if self.strain == Strain::Small {
            return self.small_stress_with_tangent(f, old, new, out);
        }
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
        let p = first_piola(new, &adjugate);
        out.p = std::array::from_fn(|d| p[place::<D>(d)]);
        let derivative = Derivative { law: &out.law, p: &p, inverse: &inverse, adjugate: &adjugate };
        derivative.write::<DIM, D>(&mut out.tangent);
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
