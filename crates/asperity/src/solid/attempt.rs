//! A body during one attempt: its cells' gradients at the accepted state, and the forces of each cell.

use super::body::Body;
use super::gradient::{self, PointGradient, Shapes};
use super::operator::{FEW_DOFS, MAX_DOFS, add_center, add_forces, add_tangent};
use super::plane_stress;
use super::point::{PointLaw, PointStress};
use crate::Failure;
use crate::mesh::Space;
use crate::mesh::cells::MAX_NODES;
use crate::system::{Attempt, Branch, History, Local, State, Stencil, Stencils, Term};

/// Gradients of one cell during one attempt.
pub(super) struct CellGradients {
    points: Vec<PointGradient>,
    center: Option<PointGradient>,
}

/// A body during one attempt.
pub(super) struct OpenBody<'a> {
    pub body: &'a Body,
    pub accepted: &'a State,
    pub history: &'a History,
    pub cells: Vec<CellGradients>,
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
            Space::PlaneStrain | Space::PlaneStress => self.evaluate_cell::<2, 4>(index, new, local),
            Space::Axisymmetric => self.evaluate_cell::<2, 5>(index, new, local),
            Space::Solid => self.evaluate_cell::<3, 9>(index, new, local),
        };
        done.map_err(|f| Failure::new(format!("{}: {}", self.body.name_of(index), f.reason)))?;
        Ok(0)
    }
}

impl Body {
    pub(super) fn open(&self, cell: usize, u: &[f64]) -> Result<CellGradients, Failure> {
        let view = self.mesh.cell(cell);
        let mut x = [[0.0; 3]; MAX_NODES];
        for (x, &node) in x.iter_mut().zip(view.nodes) {
            *x = self.mesh.points[node].0;
            let first = self.dofs.node(node);
            x.iter_mut().zip(&u[first..first + self.dofs.per_node()]).for_each(|(x, u)| *x += u);
        }
        let x = &x[..view.nodes.len()];
        let at = |shapes: &Shapes| gradient::at(shapes, x, self.space).ok_or_else(|| Failure::new(self.inverted(cell)));
        let shapes = self.shapes(view.kind);
        let points = shapes.points.iter().map(at).collect::<Result<_, _>>()?;
        let center = shapes.center.as_ref().map(at).transpose()?;
        Ok(CellGradients { points, center })
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
        let (body, cell) = (self.body, &self.cells[index]);
        let mut du = [0.0; MAX_DOFS];
        let du = &mut du[..local.u.len()];
        self.increment(index, &local.u, du);
        let center = cell.center.as_ref().map(|c| (c, c.deformation(du, DIM)));
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
        let mut center_gradient = [0.0; MAX_DOFS];
        if let (Some((c, f0)), true) = (&center, local.wants_tangent) {
            c.volume_gradient(f0, DIM, &mut center_gradient[..du.len()]);
        }
        let mut s = PointStress::default();
        let lanes = self.history.slot(index).chunks_exact(len).zip(new.chunks_exact_mut(len));
        for (number, (point, (old, new))) in cell.points.iter().zip(lanes).enumerate() {
            let here = |f: Failure| Failure::new(format!("integration point {}: {}", number + 1, f.reason));
            let f = point.deformation(du, DIM);
            let volume = point.volume * self.thickness(old);
            let det = if local.wants_tangent {
                if body.space == Space::PlaneStress {
                    plane_stress::stress_with_tangent(&law, &f, old, new, &mut s).map_err(here)?;
                } else {
                    law.stress_with_tangent(&f, old, new, &mut s).map_err(here)?;
                }
                add_forces::<DIM>(point, &s.p, volume, &mut local.force);
                if du.len() <= FEW_DOFS {
                    add_tangent::<DIM, D, FEW_DOFS>(point, &s.tangent, volume, &mut local.tangent);
                } else {
                    add_tangent::<DIM, D, MAX_DOFS>(point, &s.tangent, volume, &mut local.tangent);
                }
                if cell.center.is_some() {
                    add_center::<DIM>(point, &s.along_center, volume, &center_gradient, &mut local.tangent);
                }
                s.det
            } else {
                let (p, det) = if body.space == Space::PlaneStress {
                    plane_stress::stress(&law, &f, old, new).map_err(here)?
                } else {
                    (law.stress(&f, old, new).map_err(here)?, f.det())
                };
                add_forces::<DIM>(point, &p, volume, &mut local.force);
                det
            };
            local.stored += body.material.stored_energy(new) * det * volume;
            local.dissipated += body.material.dissipation(old, new) * det * volume;
            if let Some(stretch) = self.stretch {
                new[len - 1] = stretch;
                local.supplied -= 0.5 * (trace(old) + trace(new) * det) * volume * growth.ln();
            }
        }
        Ok(())
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

fn trace(state: &[f64]) -> f64 {
    state[0] + state[1] + state[2]
}
