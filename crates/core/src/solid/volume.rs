//! The change of volume that the points of a cell share with F-bar, `theta = sum_a c_a phi_a`, from that of the undeformed
//! body, a field of few terms whose coefficients are sums over samples, `c_a = sum_s phi_a(s) v_s det f_s`:
//!
//! * the mean of the points of its patch, for simplices and wedges of first degree, of the cell for quadrilaterals and bricks of
//!   first degree and tetrahedra of second, four or more of which lie through a body;
//! * the field, linear in the undeformed coordinates, that is nearest to that of the points of the patch by least squares,
//!   for the others of second degree: with one constant they are too soft.
//!
//! Means and least squares are taken over undeformed volumes, with functions that are orthonormal there (Gram and Schmidt),
//! so that nothing hangs on the length of increments (Elguedj, Bazilevs, Calo and Hughes 2008). In small strain the same holds
//! for the trace of an increment's strain.

use super::attempt::OpenBody;
use super::body::{Bar, Body};
use super::operator::{Nodal, Tangent, add_forces, add_outer, deformation, volume_gradient};
use super::patches::WIDEST;
use super::piola::place;
use super::point::PointStress;
use super::{Strain, gradient};
use crate::system::Origin;
use crate::tensor::{Tensor2, Vec3};

/// Most unknowns of a stencil.
const MOST: usize = 3 * WIDEST;
/// Most terms of the field.
pub(super) const TERMS: usize = 4;
/// Part of a function's square that those before it must leave of it.
const INDEPENDENT: f64 = 1e-10;

/// The functions of the terms at a point.
pub(super) type Functions = [f64; TERMS];

/// A point of a cell with F-bar, in the undeformed body.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Place {
    /// Volume it stands for.
    pub volume: f64,
    /// Functions of the shared change of volume.
    pub functions: Functions,
}

/// Value of a field by its coefficients and the functions at a point.
pub(super) fn value(coefficients: &Functions, functions: &Functions) -> f64 {
    coefficients.iter().zip(functions).map(|(c, phi)| c * phi).sum()
}

/// Those of all cells with F-bar.
#[derive(Debug, Default)]
pub(super) struct Places {
    all: Vec<Place>,
    /// Where each cell begins; one more than cells.
    starts: Vec<usize>,
}

impl Places {
    /// Those of a body.
    pub fn of(body: &Body) -> Self {
        let mut places = Self { all: Vec::new(), starts: vec![0] };
        let mut at = Vec::new();
        for slot in 0..body.cells().len() {
            body.place_cell(slot, (&mut places.all, &mut at));
            places.starts.push(places.all.len());
        }
        for slot in 0..body.cells().len() {
            let members = body.patches.members(slot);
            let terms = body.terms(slot);
            if members[0] == slot && terms > 0 {
                let points = |&member: &usize| places.starts[member]..places.starts[member + 1];
                let sampled: Vec<usize> = members.iter().flat_map(points).collect();
                places.orthonormal(&sampled, &at, terms);
            }
        }
        places
    }

    /// A cell's.
    pub fn cell(&self, slot: usize) -> &[Place] {
        &self.all[self.starts[slot]..self.starts[slot + 1]]
    }

    /// One and the coordinates about the middle, each made orthogonal to those before it over the samples and of unit length.
    fn orthonormal(&mut self, samples: &[usize], at: &[Vec3], terms: usize) {
        let volume: f64 = samples.iter().map(|&s| self.all[s].volume).sum();
        let middle = samples.iter().fold(Vec3::zero(), |sum, &s| sum + at[s] * (self.all[s].volume / volume));
        for term in 0..terms {
            let raw = |s: usize| if term == 0 { 1.0 } else { at[s][term - 1] - middle[term - 1] };
            samples.iter().for_each(|&s| self.all[s].functions[term] = raw(s));
            let square = |places: &[Place], a: usize, b: usize| -> f64 {
                let product = |&s: &usize| places[s].volume * places[s].functions[a] * places[s].functions[b];
                samples.iter().map(product).sum()
            };
            let begun = square(&self.all, term, term);
            for before in 0..term {
                let part = square(&self.all, term, before);
                samples.iter().for_each(|&s| self.all[s].functions[term] -= part * self.all[s].functions[before]);
            }
            let left = square(&self.all, term, term);
            let scale = if left > INDEPENDENT * begun { left.sqrt().recip() } else { 0.0 };
            samples.iter().for_each(|&s| self.all[s].functions[term] *= scale);
        }
    }
}

impl Body {
    /// How many terms the shared change of volume of a cell has; none where each point has its own.
    fn terms(&self, slot: usize) -> usize {
        match self.shapes(self.mesh.cell(self.cells[slot]).kind).bar {
            Bar::Own => 0,
            Bar::Mean => 1,
            Bar::Linear => 1 + self.dofs.per_node(),
        }
    }

    /// Coefficients of a cell's shared change of volume at displacements `u`, in finite strain.
    pub(super) fn present_volume(&self, slot: usize, u: &[f64]) -> Option<Functions> {
        if self.terms(slot) == 0 || self.options.strain == Strain::Small {
            return None;
        }
        let (mut coefficients, mut rows) = ([0.0; TERMS], Vec::new());
        for &member in self.patches.members(slot) {
            let view = self.mesh.cell(self.cells[member]);
            let (x, shapes) = (self.present(view.nodes, u), self.shapes(view.kind));
            for (shapes, place) in shapes.points.iter().zip(self.places.cell(member)) {
                rows.clear();
                let volume = gradient::at(shapes, &x[..view.nodes.len()], self.space, &mut rows).unwrap_or(0.0);
                coefficients.iter_mut().zip(place.functions).for_each(|(c, phi)| *c += volume * phi);
            }
        }
        Some(coefficients)
    }

    /// Adds volumes and coordinates of a cell's points. Cells that are inside out have none, and are refused by the attempt.
    fn place_cell(&self, slot: usize, (places, at): (&mut Vec<Place>, &mut Vec<Vec3>)) {
        let view = self.mesh.cell(self.cells[slot]);
        let shapes = self.shapes(view.kind);
        if matches!(shapes.bar, Bar::Own) {
            return;
        }
        let x: Vec<[f64; 3]> = view.nodes.iter().map(|&node| self.mesh.points[node].0).collect();
        let mut rows = Vec::new();
        for shapes in &shapes.points {
            rows.clear();
            let volume = gradient::at(shapes, &x, self.space, &mut rows).unwrap_or(f64::NAN);
            places.push(Place { volume, ..Place::default() });
            at.push(x.iter().zip(&shapes.n).fold(Vec3::zero(), |sum, (x, n)| sum + Vec3(*x) * *n));
        }
    }
}

/// A shared change of volume.
pub(super) struct Shared {
    /// How many terms it has.
    pub terms: usize,
    /// Their coefficients, in small strain those of one and the trace of the increment,
    now: Functions,
    /// and at the beginning of the increment, in small strain those of one.
    before: Functions,
    /// Derivative of each along the unknowns of the stencil.
    pub gradients: [[f64; MOST]; TERMS],
}

impl Shared {
    /// Its values at a point: now over the beginning of the increment, and that.
    pub fn at(&self, functions: &Functions) -> (f64, f64) {
        let before = value(&self.before, functions);
        (value(&self.now, functions) / before, before)
    }
}

/// A sample of a shared change of volume.
struct VolumeSample<'a, const DIM: usize, const N: usize> {
    rows: &'a gradient::Rows<N>,
    /// Present volume it stands for.
    volume: f64,
    functions: Functions,
    f: Tensor2,
}

impl OpenBody<'_> {
    /// The samples of a cell at displacements over the increment.
    fn samples<'a, const DIM: usize, const N: usize>(
        &'a self,
        member: usize,
        du: &'a Nodal<DIM, N>,
    ) -> impl Iterator<Item = VolumeSample<'a, DIM, N>> {
        let places = self.body.places.cell(member);
        self.points(member).zip(places).map(|(point, place)| {
            let (rows, volume, functions) = (point.rows(), point.volume, place.functions);
            VolumeSample { rows, volume, functions, f: deformation(rows, du) }
        })
    }

    /// Displacements of the nodes of a cell of the patch over the increment, and where they stand in the stencil.
    fn member<const DIM: usize, const N: usize>(
        &self,
        (index, member): (usize, usize),
        u: &[f64],
    ) -> (Nodal<DIM, N>, [usize; N]) {
        let (own, others) = (self.nodes(index), self.body.patches.others(index));
        let (mut du, mut places) = ([[0.0; N]; DIM], [0; N]);
        for (k, node) in self.nodes(member).iter().enumerate().take(N) {
            let beside = || others.iter().position(|other| other == node).map(|place| own.len() + place);
            let found = || own.iter().position(|own| own == node).or_else(beside).unwrap_or(0);
            places[k] = if member == index { k } else { found() };
            let accepted = &self.accepted.u[self.body.dofs.node(*node)..];
            (0..DIM).for_each(|i| du[i][k] = u[DIM * places[k] + i] - accepted[i]);
        }
        (du, places)
    }

    /// That of a cell at the trial unknowns of its stencil, with its first derivatives.
    pub(super) fn shared<const DIM: usize, const N: usize>(&self, index: usize, u: &[f64]) -> Option<Shared> {
        let (body, strain) = (self.body, self.body.options.strain);
        let terms = body.terms(index);
        if terms == 0 {
            return None;
        }
        let zero = [0.0; TERMS];
        let mut shared = Shared { terms, now: zero, before: zero, gradients: [[0.0; MOST]; TERMS] };
        for &member in body.patches.members(index) {
            let (du, places) = self.member::<DIM, N>((index, member), u);
            let nodes = &places[..self.nodes(member).len()];
            for VolumeSample { rows, volume, functions, f } in self.samples(member, &du) {
                let ratio = strain.dilation(&f);
                let (along, slope) = match strain {
                    Strain::Finite => (f, ratio),
                    Strain::Small => (Tensor2::identity(), 1.0),
                };
                let along: Nodal<DIM, N> = volume_gradient(rows, &along);
                for (a, function) in functions.iter().enumerate().take(terms) {
                    let weight = volume * function;
                    shared.before[a] += weight;
                    shared.now[a] += weight * ratio;
                    for (k, &place) in nodes.iter().enumerate() {
                        for (i, along) in along.iter().enumerate() {
                            shared.gradients[a][DIM * place + i] += weight * slope * along[k];
                        }
                    }
                }
            }
        }
        Some(shared)
    }

    /// What a step from the unknowns `from` of a cell's stencil changed of the shared change of volume beyond the linear change.
    pub(super) fn curved<const DIM: usize, const N: usize>(
        &self,
        (index, shared): (usize, &Shared),
        (from, u): (&[f64], &[f64]),
    ) -> Functions {
        let mut begun = [0.0; TERMS];
        for &member in self.body.patches.members(index) {
            let (du, _) = self.member::<DIM, N>((index, member), from);
            for VolumeSample { volume, functions, f, .. } in self.samples(member, &du) {
                let ratio = self.body.options.strain.dilation(&f);
                (0..shared.terms).for_each(|a| begun[a] += volume * functions[a] * ratio);
            }
        }
        let step = || u.iter().zip(from).map(|(u, from)| u - from);
        let along = |gradient: &[f64; MOST]| -> f64 { step().zip(gradient).map(|(d, g)| d * g).sum() };
        std::array::from_fn(|a| begun[a] - shared.now[a] + along(&shared.gradients[a]))
    }

    /// Adds the second derivatives of the shared change of volume, those of `det f` at its samples, times the work of the mean
    /// stress on each term, to the tangent of a cell, and to that of its stencil where they touch the rest of its patch.
    pub(super) fn add_curvature<const DIM: usize, const D: usize, const N: usize>(
        &self,
        (index, u): (usize, &[f64]),
        work: &Functions,
        (own, out): (&mut Tangent<DIM, N>, &mut [f64]),
    ) {
        if self.body.options.strain == Strain::Small {
            return;
        }
        for &member in self.body.patches.members(index) {
            let (du, places) = self.member::<DIM, N>((index, member), u);
            let nodes = &places[..self.nodes(member).len()];
            let mut tangent = Tangent::<DIM, N>::zero(nodes.len(), true);
            let tangent = if member == index { &mut *own } else { &mut tangent };
            for VolumeSample { rows, volume, functions, f } in self.samples(member, &du) {
                tangent.add(rows, &second_of_volume::<D>(&f), volume * value(work, &functions));
            }
            if member != index {
                tangent.add_at(nodes, u.len(), out);
            }
        }
    }
}

/// Second derivative of `det f`.
fn second_of_volume<const D: usize>(f: &Tensor2) -> [[f64; D]; D] {
    let (inverse, det) = (f.inverse(), f.det());
    std::array::from_fn(|d| {
        let (i, j) = place::<D>(d);
        std::array::from_fn(|e| {
            let (m, n) = place::<D>(e);
            det * (inverse[(j, i)] * inverse[(n, m)] - inverse[(j, m)] * inverse[(n, i)])
        })
    })
}

/// What the mean stress of a cell's points does on the terms of its shared change of volume.
pub(super) struct Means<const DIM: usize, const N: usize> {
    /// Its work on each term, and that of the stress of the accepted state.
    work: Functions,
    before: Functions,
    /// Derivatives of that along the cell's nodes,
    along_nodes: [Nodal<DIM, N>; TERMS],
    /// and along the terms.
    along_terms: [Functions; TERMS],
    /// Derivatives of the cell's other forces along the terms.
    forces: [Nodal<DIM, N>; TERMS],
}

impl<const DIM: usize, const N: usize> Default for Means<DIM, N> {
    fn default() -> Self {
        let (none, nodal) = ([0.0; TERMS], [[[0.0; N]; DIM]; TERMS]);
        Self { work: none, before: none, along_nodes: nodal, along_terms: [none; TERMS], forces: nodal }
    }
}

impl<const DIM: usize, const N: usize> Means<DIM, N> {
    /// Adds a point with its stress: `begun` is `theta` before the increment.
    #[inline]
    pub fn add<const D: usize>(
        &mut self,
        (rows, place, begun): (&gradient::Rows<N>, &Place, f64),
        (before, s): (f64, &PointStress<D>),
        differentiated: bool,
    ) {
        for (a, function) in place.functions.iter().enumerate().filter(|(_, function)| **function != 0.0) {
            let weight = place.volume * function;
            self.work[a] += weight * s.mean.value;
            self.before[a] += weight * before;
            if differentiated {
                add_forces(rows, &s.mean.tangent, weight, &mut self.along_nodes[a]);
                add_forces(rows, &s.mean.stress_along, weight, &mut self.forces[a]);
                let along = self.along_terms[a].iter_mut().zip(&place.functions);
                along.for_each(|(along, other)| *along += weight * s.mean.along / begun * other);
            }
        }
    }

    /// The work with which the shared change of volume bends in the tangent: that of the accepted state for a first guess, and after
    /// a step the one that it leads to by the linear change of volume. What is left of the volume by the square of a step makes a
    /// large stress, and a tangent that turns with it leads astray (see [`MipStress`](crate::solve)).
    pub fn acting(&self, origin: Origin, curved: impl FnOnce() -> Functions) -> Functions {
        match origin {
            Origin::Unknown => self.work,
            Origin::Accepted => self.before,
            Origin::Step => {
                let curved = curved();
                let of =
                    |a: usize| -> f64 { self.along_terms[a].iter().zip(&curved).map(|(along, c)| along * c).sum() };
                std::array::from_fn(|a| self.work[a] - of(a))
            }
        }
    }

    /// Adds the forces of the mean stress to those of a stencil.
    pub fn write_forces(&self, shared: &Shared, force: &mut [f64]) {
        for (work, gradient) in self.work.iter().zip(&shared.gradients[..shared.terms]) {
            force.iter_mut().zip(gradient).for_each(|(force, gradient)| *force += work * gradient);
        }
    }

    /// Adds all derivatives that the shared change of volume brings but its own second ones.
    pub fn write_tangent(&self, shared: &Shared, length: usize, out: &mut [f64]) {
        let gradients = &shared.gradients[..shared.terms];
        for (a, gradient) in gradients.iter().enumerate() {
            add_outer(&self.forces[a], &gradient[..length], out);
            let mut row = [0.0; MOST];
            for (b, other) in gradients.iter().enumerate() {
                row.iter_mut().zip(other).for_each(|(row, other)| *row += self.along_terms[a][b] * other);
            }
            let nodes = (0..N).flat_map(|node| self.along_nodes[a].iter().map(move |axis| axis[node]));
            row[..length].iter_mut().zip(nodes).for_each(|(row, along)| *row += along);
            for (out, weight) in out.chunks_exact_mut(length).zip(gradient) {
                out.iter_mut().zip(&row).for_each(|(out, row)| *out += weight * row);
            }
        }
    }
}
