//! A body during one attempt: its cells' gradients at the accepted state, and the forces of each cell.

use super::body::Body;
use super::gradient::{Gradients, MOST, PointGradient, Rows, padded};
use super::heat::Warmth;
use super::incompatible::take_mean;
use super::operator::{Nodal, Tangent, add_forces, deformation};
use super::plane_stress;
use super::point::{PointLaw, PointStress};
use super::volume::{Means, Place, Shared};
use crate::mesh::Space;
use crate::mesh::cells::MAX_NODES;
use crate::system::{Attempt, Branch, History, Local, State, Stencil, Stencils, Term};
use crate::tensor::Tensor2;
use crate::{Failure, FailureKind};
use rayon::prelude::*;

/// Cells whose gradients one thread finds together.
const PART: usize = 1024;

/// A body during one attempt.
pub(super) struct OpenBody<'a> {
    pub body: &'a Body,
    pub accepted: &'a State,
    pub history: &'a History,
    /// Gradients at the points of each cell; [`PART`] cells in each part.
    pub gradients: Vec<Gradients>,
    pub dt: f64,
    /// Temperatures over the increment, where the body has any.
    pub warmth: Option<Warmth<'a>>,
}

impl Attempt for OpenBody<'_> {
    fn scratch(&self, index: usize) -> Vec<f64> {
        vec![0.0; self.history.slot(index).len()]
    }

    fn stencils(&self, _u: &[f64], out: &mut Stencils) -> Result<(), Failure> {
        let dofs = &self.body.dofs;
        for index in 0..self.body.cells.len() {
            let nodes = self.nodes(index).iter().chain(self.body.patches.others(index));
            out.push(nodes.flat_map(|&n| dofs.node(n)..dofs.node(n) + dofs.per_node()), 0);
        }
        Ok(())
    }

    fn evaluate(&self, index: usize, _: &Stencil, new: &mut [f64], local: &mut Local) -> Result<Branch, Failure> {
        let done = match self.body.space {
            Space::PlaneStrain => self.evaluate_padded::<2, 4>(index, new, local),
            Space::PlaneStress | Space::Axisymmetric => self.evaluate_padded::<2, 5>(index, new, local),
            Space::Solid => self.evaluate_padded::<3, 9>(index, new, local),
        };
        done.map_err(|f| f.at(self.body.name_of(index)))?;
        Ok(0)
    }
}

impl Body {
    /// The gradients of all cells at displacements `u`, those with incompatible modes undeformed, in parts of [`PART`] cells.
    pub(super) fn gradients(&self, u: &[f64]) -> Result<Vec<Gradients>, Failure> {
        let parts: Vec<_> = self.cells.par_chunks(PART).map(|cells| self.gradients_of(cells, u)).collect();
        // Of several failures the first, whichever thread met its own first.
        parts.into_iter().collect()
    }

    fn gradients_of(&self, cells: &[usize], u: &[f64]) -> Result<Gradients, Failure> {
        let mut gradients = Gradients::with_capacity(cells.len(), self.most_points(), self.most_nodes());
        cells.iter().try_for_each(|&cell| self.open(cell, u, &mut gradients))?;
        Ok(gradients)
    }

    fn open(&self, cell: usize, u: &[f64], gradients: &mut Gradients) -> Result<(), Failure> {
        let view = self.mesh.cell(cell);
        let shapes = self.shapes(view.kind);
        let x = if shapes.modes > 0 { self.undeformed(view.nodes) } else { self.present(view.nodes, u) };
        let nodes = view.nodes.len();
        if !shapes.points.iter().all(|shapes| gradients.push(shapes, &x[..nodes], self.space)) {
            return Err(Failure::new(self.inverted(cell)).of(FailureKind::Inverted));
        }
        let (rows, volumes) = gradients.present();
        take_mean(rows, volumes, (padded(nodes + shapes.modes), nodes..nodes + shapes.modes));
        gradients.close();
        Ok(())
    }

    /// Places of the nodes of a cell before any motion.
    pub(super) fn undeformed(&self, nodes: &[usize]) -> [[f64; 3]; MAX_NODES] {
        let mut x = [[0.0; 3]; MAX_NODES];
        x.iter_mut().zip(nodes).for_each(|(x, &node)| *x = self.mesh.points[node].0);
        x
    }

    /// Places of the nodes of a cell at displacements `u`.
    pub(super) fn present(&self, nodes: &[usize], u: &[f64]) -> [[f64; 3]; MAX_NODES] {
        let mut x = self.undeformed(nodes);
        for (x, &node) in x.iter_mut().zip(nodes) {
            let first = self.dofs.node(node);
            x.iter_mut().zip(&u[first..first + self.dofs.per_node()]).for_each(|(x, u)| *x += u);
        }
        x
    }
}

impl OpenBody<'_> {
    /// Every padded number of nodes is compiled apart, all lengths known.
    fn evaluate_padded<const DIM: usize, const D: usize>(
        &self,
        index: usize,
        new: &mut [f64],
        local: &mut Local,
    ) -> Result<(), Failure> {
        match padded(self.nodes(index).len() + self.modes(index)) {
            4 => self.evaluate_cell::<DIM, D, 4>(index, new, local),
            8 => self.evaluate_cell::<DIM, D, 8>(index, new, local),
            12 => self.evaluate_cell::<DIM, D, 12>(index, new, local),
            16 => self.evaluate_cell::<DIM, D, 16>(index, new, local),
            20 => self.evaluate_cell::<DIM, D, 20>(index, new, local),
            _ => self.evaluate_cell::<DIM, D, MOST>(index, new, local),
        }
    }

    /// Nodes of a cell.
    pub(super) fn nodes(&self, index: usize) -> &[usize] {
        self.body.mesh.cell(self.body.cells[index]).nodes
    }

    /// How many incompatible modes a cell has.
    fn modes(&self, index: usize) -> usize {
        self.body.shapes(self.body.mesh.cell(self.body.cells[index]).kind).modes
    }

    /// Displacements of a cell's nodes over the increment.
    pub(super) fn increment<const DIM: usize, const N: usize>(&self, index: usize, u: &[f64]) -> Nodal<DIM, N> {
        let mut du = [[0.0; N]; DIM];
        for (k, (&node, u)) in self.nodes(index).iter().zip(u.as_chunks::<DIM>().0).enumerate().take(N) {
            let before = &self.accepted.u[self.body.dofs.node(node)..];
            (0..DIM).for_each(|i| du[i][k] = u[i] - before[i]);
        }
        du
    }

    fn evaluate_cell<const DIM: usize, const D: usize, const N: usize>(
        &self,
        index: usize,
        new: &mut [f64],
        local: &mut Local,
    ) -> Result<(), Failure> {
        match self.modes(index) {
            0 => {}
            modes => return self.evaluate_with_modes::<DIM, D, N>(index, new, local, modes),
        }
        let (shared, length) = (self.shared::<DIM, N>(index, &local.u), local.u.len());
        let du = self.increment::<DIM, N>(index, &local.u);
        let points = self.points(index).map(|point| (point.rows(), point.volume, deformation(point.rows(), &du)));
        let mut tangent = local
            .wants_tangent
            .then(|| Tangent::<DIM, N>::zero(self.nodes(index).len(), self.body.material.is_conservative()));
        let terms = (shared.as_ref(), tangent.as_mut());
        let (force, means) =
            self.add_points::<DIM, D, N>((index, points), new, local, terms, None::<fn(usize, &PointStress<D>, f64)>)?;
        for (node, out) in local.force.as_chunks_mut::<DIM>().0.iter_mut().enumerate().take(self.nodes(index).len()) {
            *out = std::array::from_fn(|i| force[i][node]);
        }
        let both = shared.zip(means);
        if let Some((shared, means)) = &both {
            means.write_forces(shared, &mut local.force);
        }
        let Some(mut tangent) = tangent else { return Ok(()) };
        if let Some((shared, means)) = &both {
            let curved = || self.curved::<DIM, N>((index, shared), (&local.from, &local.u));
            let acting = means.acting(local.origin, curved);
            let out = (&mut tangent, &mut local.tangent[..]);
            self.add_curvature::<DIM, D, N>((index, &local.u), &acting, out);
        }
        tangent.write(length, &mut local.tangent);
        if let Some((shared, means)) = &both {
            means.write_tangent(shared, length, &mut local.tangent);
        }
        Ok(())
    }

    /// The gradients at the points of a cell.
    pub(super) fn points(&self, index: usize) -> impl Iterator<Item = PointGradient<'_>> {
        self.gradients[index / PART].cell(index % PART)
    }

    /// Adds up the points of a cell and returns its forces, with what the mean stress does on a shared change of volume, where
    /// there is one.
    /// Each point comes with its rows, its volume at the beginning of the increment and its deformation; `keep` is told its stress
    /// with derivatives.
    pub(super) fn add_points<'p, const DIM: usize, const D: usize, const N: usize>(
        &self,
        (index, points): (usize, impl Iterator<Item = (&'p Rows<N>, f64, Tensor2)>),
        new: &mut [f64],
        local: &mut Local,
        (shared, tangent): (Option<&Shared>, Option<&mut Tangent<DIM, N>>),
        mut keep: Option<impl FnMut(usize, &PointStress<D>, f64)>,
    ) -> Result<(Nodal<DIM, N>, Option<Means<DIM, N>>), Failure> {
        let len = self.body.point_len();
        let mut sums = self.sums::<DIM, D, N>(tangent);
        sums.means = shared.map(|_| Means::default());
        sums.differentiated |= keep.is_some();
        let heat = shared.and_then(|_| self.shared_warmth(index));
        let lanes = self.history.slot(index).chunks_exact(len).zip(new.chunks_exact_mut(len));
        for (number, ((rows, begun, f), (old, new))) in points.zip(lanes).enumerate() {
            let thickness = self.body.thickness(old);
            let (mut volume, mut place) = (begun * thickness, None);
            if let Some(shared) = shared {
                let mut at = self.body.places.cell(index)[number];
                at.volume *= thickness;
                let (theta, begun) = shared.at(&at.functions);
                sums.law.shared = Some(theta);
                (volume, place) = (at.volume * begun, Some((at, begun)));
            }
            let warmth = self.warmth_at((index, number), heat.as_ref());
            if let Some((temperature, now)) = warmth {
                sums.law.lapse.temperature = Some(temperature);
                (sums.law.free, sums.law.cooling) = self.body.options.strain.of_heat(old[len - 1], now);
            }
            let added = sums.add((rows, volume, &f), place.as_ref(), (old, new));
            let det = added.map_err(|f| at_point(f, number))?;
            if let Some(keep) = &mut keep {
                keep(number, &sums.s, volume);
            }
            self.account((old, new), (volume, det), local);
            if let Some((_, stretch)) = warmth {
                new[len - 1] = stretch;
                let (free, material) = (sums.law.free.ln(), &self.body.material);
                let mean = |value: &dyn Fn(&[f64]) -> f64| 0.5 * (value(old) + value(new) * det) * volume;
                local.energies.supplied += mean(&|state| trace(state)) * (free + sums.law.cooling);
                if material.has_potential() {
                    // The energy is that of a volume free of stress, which heat makes larger.
                    local.energies.supplied -= 3.0 * mean(&|state| material.stored_energy(state)) * free;
                }
            }
        }
        Ok((sums.force, sums.means))
    }

    /// The sums of a cell before its points are added.
    fn sums<'s, const DIM: usize, const D: usize, const N: usize>(
        &'s self,
        tangent: Option<&'s mut Tangent<DIM, N>>,
    ) -> Sums<'s, DIM, D, N> {
        let strain = self.body.options.strain;
        let (material, space, lapse) = (self.body.material.as_ref(), self.body.space, self.dt.into());
        let law = PointLaw { material, space, strain, lapse, shared: None, free: 1.0, cooling: 0.0 };
        let (force, s) = ([[0.0; N]; DIM], PointStress::default());
        let differentiated = tangent.is_some();
        Sums { law, force, means: None, tangent, differentiated, s }
    }

    /// Energy of a point. Where the rate of the energy `e` per present volume is `sigma:D - d`, as of rate laws, that of
    /// `e V` exceeds the power `sigma:D V` less the dissipation by `e tr(D) V`: so much is left over of the work. The mean
    /// of `e` makes that exact for an elastic increment, in which `e` grows by the mean stress on the strain.
    fn account(&self, (old, new): (&[f64], &[f64]), (volume, det): (f64, f64), local: &mut Local) {
        let material = &self.body.material;
        let stored = material.stored_energy(new);
        local.energies.stored += stored * det * volume;
        local.energies.dissipated += material.dissipation(old, new) * det * volume;
        if !material.has_potential() {
            local.energies.residue += 0.5 * (material.stored_energy(old) + stored) * (1.0 - det) * volume;
        }
    }
}

/// Forces and tangent of a cell while its points are added up.
struct Sums<'a, const DIM: usize, const D: usize, const N: usize> {
    law: PointLaw<'a>,
    force: Nodal<DIM, N>,
    /// What the mean stress does on a shared change of volume, where there is one.
    means: Option<Means<DIM, N>>,
    /// Where it is wanted.
    tangent: Option<&'a mut Tangent<DIM, N>>,
    /// Whether the derivatives of the stress are.
    differentiated: bool,
    /// Stress of the present point.
    s: PointStress<D>,
}

impl<const DIM: usize, const D: usize, const N: usize> Sums<'_, DIM, D, N> {
    /// Adds a point, whose material has this volume at the beginning of the increment, and returns the determinant of its
    /// deformation. With F-bar it has a place in the undeformed body and a change of volume since then, and the shared one
    /// is returned.
    fn add(
        &mut self,
        (rows, volume, f): (&Rows<N>, f64, &Tensor2),
        place: Option<&(Place, f64)>,
        (old, new): (&[f64], &mut [f64]),
    ) -> Result<f64, Failure> {
        let (s, law) = (&mut self.s, &self.law);
        match (law.space, self.differentiated) {
            (Space::PlaneStress, true) => plane_stress::stress_with_tangent(law, f, old, new, s)?,
            (Space::PlaneStress, false) => plane_stress::stress(law, f, old, new, s)?,
            (_, true) => law.stress_with_tangent::<DIM, D>(f, old, new, s)?,
            (_, false) => law.stress::<DIM, D>(f, old, new, s)?,
        }
        add_forces(rows, &s.p, volume, &mut self.force);
        if let Some(tangent) = &mut self.tangent {
            tangent.add(rows, &s.tangent, volume);
        }
        if let (Some((place, begun)), Some(means)) = (place, &mut self.means) {
            let axes = self.law.axes();
            let before = old[..axes].iter().sum::<f64>() / axes as f64;
            means.add((rows, place, *begun), (before, s), self.differentiated);
        }
        Ok(s.det)
    }
}

fn trace(state: &[f64]) -> f64 {
    state[0] + state[1] + state[2]
}

/// The failure of a law at an integration point, counted from zero.
fn at_point(failure: Failure, number: usize) -> Failure {
    let kind = if failure.kind == FailureKind::Other { FailureKind::Material } else { failure.kind };
    failure.of(kind).at(format_args!("integration point {}", number + 1))
}
