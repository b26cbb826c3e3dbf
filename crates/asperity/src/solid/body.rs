//! A body as a term of equilibrium: one stencil a cell.

use super::gradient::{self, PointGradient};
use super::plane_stress;
use super::point::PointLaw;
use crate::material::Material;
use crate::mesh::cells::{Cell, MAX_NODES, Rule};
use crate::mesh::{Mesh, Space};
use crate::system::{Attempt, Branch, Dofs, History, Instant, Local, State, Stencil, Stencils, Term};
use crate::{Error, Failure};
use std::sync::Arc;

/// How the deformation of a point is formed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Formulation {
    /// The point's own deformation.
    Standard,
    /// The volume change of the cell's centre (F-bar): no volumetric locking of first-degree cells.
    FBar,
}

/// Which quadrature is used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Integration {
    /// Exact for the stiffness of an undistorted cell.
    Full,
    /// One order lower.
    Reduced,
}

/// How a body is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyOptions {
    /// Formulation.
    pub formulation: Formulation,
    /// Quadrature.
    pub integration: Integration,
    /// Thickness in the plane cases; ignored otherwise.
    pub thickness: f64,
}

impl Default for BodyOptions {
    fn default() -> Self {
        Self { formulation: Formulation::Standard, integration: Integration::Full, thickness: 1.0 }
    }
}

/// A set of cells made of one material.
pub struct Body {
    name: String,
    pub(super) mesh: Arc<Mesh>,
    pub(super) dofs: Dofs,
    pub(super) space: Space,
    pub(super) cells: Vec<usize>,
    material: Arc<dyn Material>,
    pub(super) options: BodyOptions,
}

impl Body {
    /// A body of the given cells.
    ///
    /// # Errors
    /// An input error where a cell's kind and the options do not go together.
    pub fn new(
        name: &str,
        (mesh, dofs, space): (Arc<Mesh>, Dofs, Space),
        cells: Vec<usize>,
        material: Arc<dyn Material>,
        options: BodyOptions,
    ) -> Result<Self, Error> {
        for &cell in &cells {
            refuse(name, mesh.cell(cell).kind, space, &options)?;
        }
        Ok(Self { name: name.into(), mesh, dofs, space, cells, material, options })
    }

    /// The cells of the body, in the order of the history slots.
    pub fn cells(&self) -> &[usize] {
        &self.cells
    }
    /// The law.
    pub fn material(&self) -> &Arc<dyn Material> {
        &self.material
    }
    /// Quadrature of a cell of the body.
    pub fn rule(&self, kind: &'static Cell) -> &'static Rule {
        match self.options.integration {
            Integration::Full => kind.full,
            Integration::Reduced => kind.reduced.unwrap_or(kind.full),
        }
    }
    /// Values of the state of one integration point.
    pub fn point_len(&self) -> usize {
        self.material.state_len() + usize::from(self.space == Space::PlaneStress)
    }

    fn open(&self, cell: usize, u: &[f64]) -> Result<CellGradients, Failure> {
        let view = self.mesh.cell(cell);
        let mut x = [[0.0; 3]; MAX_NODES];
        for (x, &node) in x.iter_mut().zip(view.nodes) {
            *x = self.mesh.points[node].0;
            let first = self.dofs.node(node);
            x.iter_mut().zip(&u[first..first + self.dofs.per_node()]).for_each(|(x, u)| *x += u);
        }
        let x = &x[..view.nodes.len()];
        let rule = self.rule(view.kind);
        let at = |xi, weight| {
            gradient::at(view.kind, xi, weight, x, self.space).ok_or_else(|| Failure::new(self.inverted(cell)))
        };
        let points = rule.points.iter().zip(rule.weights).map(|(&xi, &w)| at(xi, w)).collect::<Result<_, _>>()?;
        let center = match self.options.formulation {
            Formulation::Standard => None,
            Formulation::FBar => Some(at(view.kind.center(), 1.0)?),
        };
        Ok(CellGradients { points, center })
    }

    fn inverted(&self, cell: usize) -> String {
        format!("cell {cell} of body '{}' is turned inside out", self.name)
    }
}

/// Pairs of options that mean nothing are refused by name.
fn refuse(body: &str, kind: &Cell, space: Space, options: &BodyOptions) -> Result<(), Error> {
    let BodyOptions { formulation, integration, .. } = options;
    let because = match (formulation, integration) {
        _ if kind.dimension != space.dimension() => {
            format!("cells {} cannot fill a {} model", kind.name, space.name())
        }
        (_, Integration::Reduced) if kind.reduced.is_none() => {
            format!("cells {} have no reduced integration; use integration = \"full\"", kind.name)
        }
        (Formulation::FBar, _) if kind.degree > 1 => {
            format!("f-bar is for cells of first degree, not {}; use integration = \"reduced\"", kind.name)
        }
        (Formulation::FBar, Integration::Reduced) => {
            "f-bar with reduced integration is plain reduced integration; choose one".to_string()
        }
        (Formulation::FBar, _) if kind.full.points.len() == 1 => {
            format!("f-bar changes nothing on {}, which has a single point", kind.name)
        }
        (Formulation::FBar, _) if space == Space::PlaneStress => {
            "f-bar means nothing in plane stress, where nothing locks; use formulation = \"standard\"".to_string()
        }
        _ => return Ok(()),
    };
    Err(Error::input(format!("body '{body}': {because}")))
}

/// Gradients of one cell during one attempt.
struct CellGradients {
    points: Vec<PointGradient>,
    center: Option<PointGradient>,
}

/// A body during one attempt.
struct OpenBody<'a> {
    body: &'a Body,
    accepted: &'a State,
    history: &'a History,
    cells: Vec<CellGradients>,
    dt: f64,
}

impl Term for Body {
    fn name(&self) -> &str {
        &self.name
    }

    fn initial(&self) -> History {
        let points = |&cell: &usize| self.rule(self.mesh.cell(cell).kind).points.len();
        let mut history = History::new(self.cells.iter().map(|cell| points(cell) * self.point_len()));
        for state in history.data.chunks_exact_mut(self.point_len()) {
            self.material.initialise(&mut state[..self.material.state_len()]);
            if self.space == Space::PlaneStress {
                state[self.material.state_len()] = 1.0;
            }
        }
        history
    }

    fn attempt<'a>(
        &'a self,
        accepted: &'a State,
        history: &'a History,
        at: Instant,
    ) -> Result<Box<dyn Attempt + 'a>, Failure> {
        let cells = self.cells.iter().map(|&cell| self.open(cell, &accepted.u)).collect::<Result<_, _>>()?;
        Ok(Box::new(OpenBody { body: self, accepted, history, cells, dt: at.dt }))
    }

    fn name_of(&self, stencil: usize) -> String {
        format!("cell {} of body '{}'", self.cells[stencil], self.name)
    }

    fn describe_motion(&self, motion: &[f64]) -> Option<String> {
        let largest = motion.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let mut nodes: Vec<usize> = self.cells.iter().flat_map(|&c| self.mesh.cell(c).nodes.iter().copied()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let (dim, count) = (self.dofs.per_node(), nodes.len() as f64);
        let along = |axis: usize| nodes.iter().map(move |&n| motion[self.dofs.node(n) + axis]);
        let size = (0..dim).flat_map(along).map(|x| x * x).sum::<f64>().sqrt() / count.sqrt();
        // Another body moves, and this one only goes along a little.
        if size < 0.05 * largest {
            return None;
        }
        let mean = |axis: usize| along(axis).sum::<f64>().abs() / count;
        let free: Vec<&str> = (0..dim).filter(|&a| mean(a) > 0.5 * size).map(|a| self.space.axes()[a]).collect();
        Some(match free.as_slice() {
            [] => format!("body '{}' is free to turn", self.name),
            axes => format!("body '{}' is free along {}", self.name, axes.join(" and ")),
        })
    }
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

/// Most unknowns of a cell.
const MAX_DOFS: usize = 3 * MAX_NODES;
/// Unknowns of most cells, for which less memory is cleared.
const FEW_DOFS: usize = 24;

impl OpenBody<'_> {
    fn increment(&self, index: usize, u: &[f64]) -> [f64; MAX_DOFS] {
        let (dofs, dim) = (&self.body.dofs, self.body.dofs.per_node());
        let mut du = [0.0; MAX_DOFS];
        for (k, &node) in self.body.mesh.cell(self.body.cells[index]).nodes.iter().enumerate() {
            let first = dofs.node(node);
            for c in 0..dim {
                du[k * dim + c] = u[k * dim + c] - self.accepted.u[first + c];
            }
        }
        du
    }

    fn evaluate_cell<const DIM: usize, const D: usize>(
        &self,
        index: usize,
        new: &mut [f64],
        local: &mut Local,
    ) -> Result<(), Failure> {
        let (body, cell) = (self.body, &self.cells[index]);
        let du = &self.increment(index, &local.u)[..local.u.len()];
        let center = cell.center.as_ref().map(|c| (c, c.deformation(du, DIM)));
        let law = PointLaw {
            material: body.material.as_ref(),
            space: body.space,
            dt: self.dt,
            center: center.as_ref().map(|(_, f0)| f0.det()),
        };
        let mut center_gradient = [0.0; MAX_DOFS];
        if let (Some((c, f0)), true) = (&center, local.wants_tangent) {
            c.volume_gradient(f0, DIM, &mut center_gradient[..du.len()]);
        }
        let len = body.point_len();
        let lanes = self.history.slot(index).chunks_exact(len).zip(new.chunks_exact_mut(len));
        for (number, (point, (old, new))) in cell.points.iter().zip(lanes).enumerate() {
            let here = |f: Failure| Failure::new(format!("integration point {}: {}", number + 1, f.reason));
            let f = point.deformation(du, DIM);
            let volume = point.volume * self.thickness(old);
            let det = if local.wants_tangent {
                let s = if body.space == Space::PlaneStress {
                    plane_stress::stress_with_tangent(&law, &f, old, new).map_err(here)?
                } else {
                    law.stress_with_tangent(&f, old, new).map_err(here)?
                };
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

/// `F_Li += P_ij dN_L/dx_j dv`, and the hoop part on the radial component.
#[inline]
fn add_forces<const DIM: usize>(point: &PointGradient, p: &[f64; 9], volume: f64, force: &mut [f64]) {
    for ((force, grad), hoop) in force.chunks_exact_mut(DIM).zip(&point.grad).zip(&point.hoop) {
        for i in 0..DIM {
            let mut sum = 0.0;
            for j in 0..DIM {
                sum += p[i * DIM + j] * grad[j];
            }
            force[i] += volume * sum;
        }
        if DIM == 2 {
            force[0] += volume * p[4] * hoop;
        }
    }
}

/// `K += B^T A B dv` with `B` the map from nodal displacements, at most `M`, to the components of the gradient.
#[inline]
fn add_tangent<const DIM: usize, const D: usize, const M: usize>(
    point: &PointGradient,
    a: &[[f64; 9]; 9],
    volume: f64,
    tangent: &mut [f64],
) {
    let n = DIM * point.grad.len();
    let mut ab = [[0.0; M]; D];
    for (row, a) in ab.iter_mut().zip(a) {
        for ((out, grad), hoop) in row.chunks_exact_mut(DIM).zip(&point.grad).zip(&point.hoop) {
            for m in 0..DIM {
                for k in 0..DIM {
                    out[m] += a[m * DIM + k] * grad[k];
                }
                out[m] *= volume;
            }
            if D == DIM * DIM + 1 {
                out[0] += volume * a[DIM * DIM] * hoop;
            }
        }
    }
    for (l, (grad, hoop)) in point.grad.iter().zip(&point.hoop).enumerate() {
        for i in 0..DIM {
            let row = &mut tangent[(l * DIM + i) * n..][..n];
            for j in 0..DIM {
                let (g, ab) = (grad[j], &ab[i * DIM + j]);
                row.iter_mut().zip(ab).for_each(|(k, ab)| *k += g * ab);
            }
            if i == 0 && D == DIM * DIM + 1 {
                row.iter_mut().zip(&ab[DIM * DIM]).for_each(|(k, ab)| *k += hoop * ab);
            }
        }
    }
}

/// The rank-one part of F-bar: forces along `ln det f0`, times its gradient.
fn add_center<const DIM: usize>(
    point: &PointGradient,
    along: &[f64; 9],
    volume: f64,
    gradient: &[f64],
    tangent: &mut [f64],
) {
    let n = DIM * point.grad.len();
    let mut force = [0.0; MAX_DOFS];
    add_forces::<DIM>(point, along, volume, &mut force[..n]);
    for (row, f) in tangent.chunks_exact_mut(n).zip(force) {
        row.iter_mut().zip(gradient).for_each(|(k, g)| *k += f * g);
    }
}
