//! Finite and small strain, and what is different in small strain.
//!
//! With small strain gradients and volumes are those of the undeformed body throughout, `F_L = integral of sigma grad N_L
//! dV`, and the strain of an increment is the symmetric part of the gradient of its displacements. What an elastic body
//! answers is then linear in its displacements. F-bar replaces the trace of the strain by the shared one, in plane strain over
//! the two axes of the plane, on which the mean stress then works (B-bar, Hughes 1980); heat subtracts its strain `alpha T`.

use super::Body;
use super::gradient;
use super::piola::{VOIGT, place};
use super::point::{PointLaw, PointStress};
use crate::Failure;
use crate::material::Material;
use crate::mesh::Space;
use crate::tensor::Tensor2;
use std::borrow::Cow;
use std::sync::Arc;

/// How displacements make strain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Strain {
    /// By the deformation of each increment from its beginning, with rotation.
    Finite,
    /// By the symmetric part of the displacement gradient over the undeformed body.
    Small,
}

impl Strain {
    /// A law as it sees these strains.
    ///
    /// # Errors
    /// In words, where it has no small strain.
    pub fn law(self, law: Arc<dyn Material>) -> Result<Arc<dyn Material>, String> {
        match self {
            Self::Finite => Ok(law),
            Self::Small => Ok(Arc::from(law.with_small_strain()?)),
        }
    }

    /// Displacements of the configuration over which an increment from `u` is taken.
    pub(super) fn base(self, u: &[f64]) -> Cow<'_, [f64]> {
        match self {
            Self::Finite => u.into(),
            Self::Small => vec![0.0; u.len()].into(),
        }
    }

    /// Volume over that at the beginning of the increment.
    pub(super) fn dilation(self, f: &Tensor2) -> f64 {
        match self {
            Self::Finite => f.det(),
            Self::Small => f.trace() - 2.0,
        }
    }

    /// What a change of the thermal stretch leaves to the law: a factor of the deformation and a part of its diagonal.
    pub(super) fn of_heat(self, before: f64, now: f64) -> (f64, f64) {
        match self {
            Self::Finite => (before / now, 0.0),
            Self::Small => (1.0, before - now),
        }
    }

    /// A thickness, as a ratio to the nominal one, after a stretch.
    pub(super) fn stretched(self, thickness: f64, stretch: f64) -> f64 {
        match self {
            Self::Finite => thickness * stretch,
            Self::Small => thickness + (stretch - 1.0),
        }
    }
}

impl PointLaw<'_> {
    /// Axes over which F-bar spreads a change of volume.
    pub(super) fn axes(&self) -> usize {
        if self.space == Space::PlaneStrain { 2 } else { 3 }
    }

    /// Deformation that the law sees in small strain.
    pub(super) fn small_seen(&self, f: &Tensor2) -> Tensor2 {
        let spread = |shared: f64| (shared - self.strain.dilation(f)) / self.axes() as f64;
        let (mean, mut seen) = (self.shared.map_or(0.0, spread), *f);
        for i in 0..3 {
            seen[(i, i)] += if i < self.axes() { self.cooling + mean } else { self.cooling };
        }
        seen
    }

    /// New state, and in `out` the stress.
    pub(super) fn small_stress<const D: usize>(
        &self,
        f: &Tensor2,
        old: &[f64],
        new: &mut [f64],
        out: &mut PointStress<D>,
    ) -> Result<(), Failure> {
        self.material.update(&self.small_seen(f), self.lapse, old, new)?;
        self.small_values(new, out);
        Ok(())
    }

    /// New state, and in `out` the stress with its derivatives.
    pub(super) fn small_stress_with_tangent<const D: usize>(
        &self,
        f: &Tensor2,
        old: &[f64],
        new: &mut [f64],
        out: &mut PointStress<D>,
    ) -> Result<(), Failure> {
        let seen = self.small_seen(f);
        self.material.differentiate(&seen, self.lapse, old, (&mut *new, &mut out.law), self.directions())?;
        let mut along = [0.0; 6];
        if self.shared.is_some() {
            let traced = |d: &usize| matches!(place::<D>(*d), (i, j) if i == j && i < self.axes());
            for (row, along) in out.law.iter_mut().zip(&mut along) {
                *along = (0..D).filter(traced).map(|d| row[d]).sum::<f64>() / self.axes() as f64;
                (0..D).filter(traced).for_each(|d| row[d] -= *along);
            }
            self.split(&mut along, out);
        }
        for d in 0..D {
            let (i, j) = place::<D>(d);
            out.mean.stress_along[d] = along[VOIGT[i][j]];
            out.tangent[d].copy_from_slice(&out.law[VOIGT[i][j]][..D]);
        }
        self.small_values(new, out);
        Ok(())
    }

    fn small_values<const D: usize>(&self, new: &[f64], out: &mut PointStress<D>) {
        let stress = self.working_on_f(new, out);
        out.det = 1.0;
        out.p = std::array::from_fn(|d| {
            let (i, j) = place::<D>(d);
            stress[VOIGT[i][j]]
        });
    }
}

impl Body {
    /// Thickness at a point in a state, for its weight; one in space and in the axisymmetric case.
    pub(super) fn thickness(&self, state: &[f64]) -> f64 {
        match (self.space, self.options.strain) {
            (Space::PlaneStress, Strain::Finite) => self.options.thickness * state[self.material.state_len()],
            _ => self.nominal_thickness(),
        }
    }

    /// That before any motion.
    pub(super) fn nominal_thickness(&self) -> f64 {
        match self.space {
            Space::PlaneStrain | Space::PlaneStress => self.options.thickness,
            Space::Axisymmetric | Space::Solid => 1.0,
        }
    }

    /// Of a body in small strain the largest displacement gradient at an integration point: the root of the sum of the
    /// squares of its components, rotation among them. Strains are wrong by a part of that order.
    pub fn largest_gradient(&self, u: &[f64]) -> Option<f64> {
        let square = |g: Tensor2| -> f64 { (0..9).map(|k| g[(k / 3, k % 3)].powi(2)).sum() };
        let all = || self.cells.iter().flat_map(|&cell| self.displacement_gradients(cell, u)).flatten();
        (self.options.strain == Strain::Small).then(|| all().map(square).fold(0.0, f64::max).sqrt())
    }

    /// Gradients of the nodes' displacements at the integration points of a cell, on the undeformed places; the strain around the
    /// axis of axial symmetry is the last on the diagonal. None where the cell is inside out.
    pub(super) fn displacement_gradients<'a>(
        &'a self,
        cell: usize,
        u: &'a [f64],
    ) -> impl Iterator<Item = Option<Tensor2>> + 'a {
        let (view, axes) = (self.mesh.cell(cell), self.dofs.per_node());
        let x: Vec<_> = view.nodes.iter().map(|&node| self.mesh.points[node].0).collect();
        let mut rows = Vec::new();
        self.shapes(view.kind).points.iter().map(move |shapes| {
            rows.clear();
            gradient::at(shapes, &x, self.space, &mut rows)?;
            let length = rows.len() / 3;
            let along = |axis: usize, row: usize| -> f64 {
                let row = &rows[row * length..];
                view.nodes.iter().zip(row).map(|(&node, g)| g * u[self.dofs.node(node) + axis]).sum()
            };
            Some(Tensor2::from_fn(|i, j| match (i < axes, j < axes) {
                (true, true) => along(i, j),
                // The row of `N / r`, zero in the plane.
                (false, false) => along(0, 2),
                _ => 0.0,
            }))
        })
    }
}
