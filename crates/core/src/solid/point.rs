//! One integration point: from the deformation of the increment to `P = det(f) sigma f^-T` and its derivative.
//!
//! F-bar (de Souza Neto et al. 1996) evaluates the law at `fbar = f (theta / det f)^(1/3)`, in plane strain at the in-plane
//! block scaled with the power 1/2, with `theta` the shared change of volume. Its forces are those that work on `fbar`
//! (Simo, Taylor and Pister 1985): the deviator on f, `P = theta dev(sigma) f^-T`, the mean stress on `theta`. So a law with a
//! potential keeps it, and its symmetric tangent; with `P` of the whole stress on f cells near a rough edge give way.

use super::Strain;
use super::piola::{Derivative, VOIGT, first_piola, place};
use crate::material::{Directions, Gradient, Lapse, Material};
use crate::mesh::Space;
use crate::tensor::Tensor2;
use crate::{Failure, FailureKind};

/// `P` and its derivatives along the `D` components of f that vary and along the shared change of volume `theta`.
pub struct PointStress<const D: usize> {
    /// Components of `P`.
    pub p: [f64; D],
    /// Their derivatives.
    pub tangent: [[f64; D]; D],
    /// The mean stress, which works on `theta`, with F-bar.
    pub mean: Mean<D>,
    /// `det f`, with F-bar `theta`: volume of the material over that at the beginning of the increment.
    pub det: f64,
    /// Those of the law.
    pub(super) law: Gradient,
}

/// The mean of the normal stresses over the axes that F-bar scales.
pub struct Mean<const D: usize> {
    /// Its value.
    pub value: f64,
    /// Its derivatives along f,
    pub tangent: [f64; D],
    /// and along `theta`.
    pub along: f64,
    /// Derivatives of `P` along `theta`.
    pub stress_along: [f64; D],
}

impl<const D: usize> Default for PointStress<D> {
    fn default() -> Self {
        let mean = Mean { value: 0.0, tangent: [0.0; D], along: 0.0, stress_along: [0.0; D] };
        Self { p: [0.0; D], tangent: [[0.0; D]; D], mean, det: 1.0, law: Gradient::default() }
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
    /// Length of the increment, and the temperature over it.
    pub lapse: Lapse,
    /// `theta` where F-bar is used; in small strain one and the shared trace.
    pub shared: Option<f64>,
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
        let Some(shared) = self.shared else { return (*f, 0.0) };
        let in_plane = self.space == Space::PlaneStrain;
        let ratio = shared / det;
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
        self.material.update(&(self.bar(f, out.det).0 * self.free), self.lapse, old, new)?;
        let stress = self.working_on_f(new, out);
        let volume = self.shared.unwrap_or(out.det);
        let p = first_piola(&stress, &(f.inverse() * volume));
        out.p = std::array::from_fn(|d| p[place::<D>(d)]);
        out.det = volume;
        Ok(())
    }

    /// The part of the stress in a state that works on f: all of it, with F-bar the deviator.
    pub(super) fn working_on_f<const D: usize>(&self, state: &[f64], out: &mut PointStress<D>) -> [f64; 6] {
        let mut stress = std::array::from_fn(|i| state[i]);
        if self.shared.is_some() {
            let normal = &mut stress[..self.axes()];
            out.mean.value = normal.iter().sum::<f64>() / normal.len() as f64;
            normal.iter_mut().for_each(|stress| *stress -= out.mean.value);
        }
        stress
    }

    /// `det f`.
    fn admissible(&self, f: &Tensor2) -> Result<f64, Failure> {
        let det = f.det();
        let fine = det > 0.0 && self.shared.is_none_or(|theta| theta > 0.0);
        if fine { Ok(det) } else { Err(Failure::new("a cell is turned inside out").of(FailureKind::Inverted)) }
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
        self.material.differentiate(
            &(bar * self.free),
            self.lapse,
            old,
            (&mut *new, &mut out.law),
            self.directions(),
        )?;
        if self.free != 1.0 {
            out.law.iter_mut().for_each(|row| row[..D].iter_mut().for_each(|c| *c *= self.free));
        }
        let inverse = f.inverse();
        let mut along = [0.0; 6];
        if power > 0.0 {
            along = self.unbar::<D>((f, &inverse), (&bar, power), &mut out.law);
            self.split(&mut along, out);
        }
        let (stress, volume) = (self.working_on_f(new, out), self.shared.unwrap_or(det));
        let adjugate = inverse * volume;
        let p = first_piola(&stress, &adjugate);
        out.p = std::array::from_fn(|d| p[place::<D>(d)]);
        out.det = volume;
        let derivative = Derivative { law: &out.law, p: &p, inverse: &inverse, adjugate: &adjugate };
        derivative.write::<DIM, D>(&mut out.tangent);
        if power > 0.0 {
            // At fixed theta the volume does not follow f.
            let places = std::array::from_fn::<_, D, _>(place::<D>);
            for (row, p) in out.tangent.iter_mut().zip(&out.p) {
                row.iter_mut().zip(places).for_each(|(value, (m, n))| *value -= p * inverse[(n, m)]);
            }
            for ((p, along_theta), (i, j)) in out.p.iter().zip(&mut out.mean.stress_along).zip(places) {
                let follows: f64 = (0..3).map(|k| adjugate[(j, k)] * along[VOIGT[i][k]]).sum();
                *along_theta = (p + follows) / volume;
            }
            out.mean.along /= volume;
        }
        Ok(())
    }

    /// Turns the law's derivative along fbar into the one along f at fixed `theta`, and returns that along `ln theta`.
    fn unbar<const D: usize>(
        &self,
        (f, inverse): (&Tensor2, &Tensor2),
        (bar, power): (&Tensor2, f64),
        law: &mut Gradient,
    ) -> [f64; 6] {
        let in_plane = self.space == Space::PlaneStrain;
        let scaled = |(i, j): (usize, usize)| !in_plane || (i < 2 && j < 2);
        let scale = bar[(0, 0)] / f[(0, 0)];
        let scale = if scale.is_finite() { scale } else { (self.shared.unwrap_or(1.0) / f.det()).powf(power) };
        let mut along = [0.0; 6];
        for (row, along) in law.iter_mut().zip(&mut along) {
            let of = |d: usize| if scaled(place::<D>(d)) { row[d] * bar[place::<D>(d)] } else { 0.0 };
            let radial: f64 = (0..D).map(of).sum();
            *along = power * radial;
            for (d, value) in row[..D].iter_mut().enumerate() {
                let (m, n) = place::<D>(d);
                *value = if scaled((m, n)) { *value * scale } else { *value } - power * inverse[(n, m)] * radial;
            }
        }
        along
    }

    /// Takes the mean stress and its derivatives out of those of the stress, `along` that along the shared change of volume.
    pub(super) fn split<const D: usize>(&self, along: &mut [f64; 6], out: &mut PointStress<D>) {
        let axes = self.axes();
        let mean = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / axes as f64;
        out.mean.tangent = std::array::from_fn(|d| mean(&mut out.law[..axes].iter().map(|row| row[d])));
        out.mean.along = mean(&mut along[..axes].iter().copied());
        for (row, along) in out.law[..axes].iter_mut().zip(along) {
            row.iter_mut().zip(&out.mean.tangent).for_each(|(value, mean)| *value -= mean);
            *along -= out.mean.along;
        }
    }
}
