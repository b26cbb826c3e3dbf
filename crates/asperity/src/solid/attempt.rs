//! A body during one attempt: its cells' gradients at the accepted state, and the forces of each cell.

use super::body::{Body, Formulation};
use super::gradient::{Gradients, PointGradient};
use super::operator::{MAX_DOFS, add_center, add_forces, add_tangent};
use super::plane_stress;
use super::point::{PointLaw, PointStress};
use crate::Failure;
use crate::mesh::Space;
use crate::mesh::cells::MAX_NODES;
use crate::system::{Attempt, Branch, History, Local, State, Stencil, Stencils, Term};

/// A body during one attempt.
pub(super) struct OpenBody<'a> {
    pub body: &'a Body,
    pub accepted: &'a State,
    pub history: &'a History,
    /// Gradients at the points of each cell and, with F-bar, at its centre behind them.
    pub gradients: Gradients,
    pub dt: f64,
    /// Thermal stretch at the end of the increment, where the body has a temperature.
    pub stretch: Option<f64>,
}

impl Attempt for OpenBody<'_> {
    fn scratch(&self, index: usize) -> Vec<f64> {
        vec![0.0; self.history.slot(index).len()]
    }

    fn stencils(&self, _u: &[f64], out: &mut Stencils) -> Result<(), Failure> {
        let dofs = &self.body.dofs;
        for &cell in &self.body.cells {
            let nodes = self.body.mesh.cell(cell).nodes;
            out.push(nodes.iter().flat_map(|&n| dofs.node(n)..dofs.node(n) + dofs.per_node()), 0);
        }
        Ok(())
    }

    fn evaluate(&self, index: usize, _: &Stencil, new: &mut [f64], local: &mut Local) -> Result<Branch, Failure> {
        let done = match self.body.space {
            Space::PlaneStrain => self.evaluate_cell::<2, 4>(index, new, local),
            Space::PlaneStress | Space::Axisymmetric => self.evaluate_cell::<2, 5>(index, new, local),
            Space::Solid => self.evaluate_cell::<3, 9>(index, new, local),
        };
        done.map_err(|f| Failure::new(format!("{}: {}", self.body.name_of(index), f.reason)))?;
        Ok(0)
    }
}

impl Body {
    /// The gradients of all cells at displacements `u`.
    pub(super) fn gradients(&self, u: &[f64]) -> Result<Gradients, Failure> {
        let mut gradients = Gradients::with_capacity(self.cells.len(), self.most_points(), self.most_nodes());
        for &cell in &self.cells {
            self.open(cell, u, &mut gradients)?;
        }
        Ok(gradients)
    }

    fn open(&self, cell: usize, u: &[f64], gradients: &mut Gradients) -> Result<(), Failure> {
        let view = self.mesh.cell(cell);
        let mut x = [[0.0; 3]; MAX_NODES];
        for (x, &node) in x.iter_mut().zip(view.nodes) {
            *x = self.mesh.points[node].0;
            let first = self.dofs.node(node);
            x.iter_mut().zip(&u[first..first + self.dofs.per_node()]).for_each(|(x, u)| *x += u);
        }
        let x = &x[..view.nodes.len()];
        let shapes = self.shapes(view.kind);
        for shapes in shapes.points.iter().chain(&shapes.center) {
            if !gradients.push(shapes, x, self.space) {
                return Err(Failure::new(self.inverted(cell)));
            }
        }
        gradients.close();
        Ok(())
    }
}

impl OpenBody<'_> {
    /// Displacements of a cell's nodes over the increment.
    fn increment(&self, index: usize, u: &[f64], du: &mut [f64]) {
        let (dofs, dim) = (&self.body.dofs, self.body.dofs.per_node());
        for (k, &node) in self.body.mesh.cell(self.body.cells[index]).nodes.iter().enumerate() {
            let first = dofs.node(node);
            for c in 0..dim {
                du[k * dim + c] = u[k * dim + c] - self.accepted.u[first + c];
            }
        }
    }

    fn evaluate_cell<const DIM: usize, const D: usize>(
        &self,
        index: usize,
        new: &mut [f64],
        local: &mut Local,
    ) -> Result<(), Failure> {
        let body = self.body;
        let mut du = [0.0; MAX_DOFS];
        let du = &mut du[..local.u.len()];
        self.increment(index, &local.u, du);
        let mut points = self.gradients.cell(index);
        let barred = body.options.formulation == Formulation::FBar;
        let center = if barred { points.next_back() } else { None };
        let center = center.map(|c| (c, c.deformation::<DIM>(du)));
        let len = body.point_len();
        // A body has one temperature, and with it one stretch.
        let growth = self.stretch.map_or(1.0, |stretch| stretch / self.history.slot(index)[len - 1]);
        let law = PointLaw {
            material: body.material.as_ref(),
            space: body.space,
            dt: self.dt,
            center: center.as_ref().map(|(_, f0)| f0.det()),
            free: growth.recip(),
        };
        let mut sums = Sums { du, center_gradient: [0.0; MAX_DOFS], local, s: PointStress::<D>::default() };
        if let (Some((c, f0)), true) = (&center, sums.local.wants_tangent) {
            c.volume_gradient::<DIM>(f0, &mut sums.center_gradient[..sums.du.len()]);
        }
        let lanes = self.history.slot(index).chunks_exact(len).zip(new.chunks_exact_mut(len));
        for (number, (point, (old, new))) in points.zip(lanes).enumerate() {
            let volume = point.volume * self.thickness(old);
            let det = sums
                .add::<DIM>(&law, (&point, volume), (old, new))
                .map_err(|f| Failure::new(format!("integration point {}: {}", number + 1, f.reason)))?;
            let local = &mut *sums.local;
            self.account((old, new), (volume, det), local);
            if let Some(stretch) = self.stretch {
                new[len - 1] = stretch;
                local.supplied -= 0.5 * (trace(old) + trace(new) * det) * volume * growth.ln();
            }
        }
        Ok(())
    }

    /// Energy of a point. Where the rate of the energy `e` per present volume is `sigma:D - d`, as of rate laws, that of
    /// `e V` exceeds the power `sigma:D V` less the dissipation by `e tr(D) V`: so much is left over of the work. The mean
    /// of `e` makes that exact for an elastic increment, in which `e` grows by the mean stress on the strain.
    fn account(&self, (old, new): (&[f64], &[f64]), (volume, det): (f64, f64), local: &mut Local) {
        let material = &self.body.material;
        let stored = material.stored_energy(new);
        local.stored += stored * det * volume;
        local.dissipated += material.dissipation(old, new) * det * volume;
        if !material.is_conservative() {
            local.residue += 0.5 * (material.stored_energy(old) + stored) * (1.0 - det) * volume;
        }
    }

    /// Thickness at the beginning of the increment; one in space and in the axisymmetric case.
    fn thickness(&self, old: &[f64]) -> f64 {
        match self.body.space {
            Space::PlaneStrain => self.body.options.thickness,
            Space::PlaneStress => self.body.options.thickness * old[self.body.material.state_len()],
            Space::Axisymmetric | Space::Solid => 1.0,
        }
    }
}

/// Forces and tangent of a cell while its points are added up.
struct Sums<'a, const D: usize> {
    /// Displacements of the nodes over the increment.
    du: &'a [f64],
    /// Derivative of `ln det f0` along them, with F-bar.
    center_gradient: [f64; MAX_DOFS],
    local: &'a mut Local,
    /// Stress of the present point.
    s: PointStress<D>,
}

impl<const D: usize> Sums<'_, D> {
    /// Adds a point of this volume and returns the determinant of its deformation.
    fn add<const DIM: usize>(
        &mut self,
        law: &PointLaw,
        (point, volume): (&PointGradient, f64),
        (old, new): (&[f64], &mut [f64]),
    ) -> Result<f64, Failure> {
        let (f, s, local) = (point.deformation::<DIM>(self.du), &mut self.s, &mut *self.local);
        match (law.space, local.wants_tangent) {
            (Space::PlaneStress, true) => plane_stress::stress_with_tangent(law, &f, old, new, s)?,
            (Space::PlaneStress, false) => plane_stress::stress(law, &f, old, new, s)?,
            (_, true) => law.stress_with_tangent::<DIM, D>(&f, old, new, s)?,
            (_, false) => law.stress::<DIM, D>(&f, old, new, s)?,
        }
        add_forces::<DIM, D>(point, &s.p, volume, &mut local.force);
        if local.wants_tangent {
            add_tangent::<DIM, D>(point, &s.tangent, volume, &mut local.tangent);
            if law.center.is_some() {
                add_center::<DIM, D>(point, &s.along_center, volume, &self.center_gradient, &mut local.tangent);
            }
        }
        Ok(s.det)
    }
}

fn trace(state: &[f64]) -> f64 {
    state[0] + state[1] + state[2]
}
