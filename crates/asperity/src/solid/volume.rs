//! The change of volume that the points of a cell share with F-bar, `sum_a c_a phi_a`, a field of few terms:
//!
//! * that of the cell's centre, for quadrilaterals and bricks of first degree (de Souza Neto et al. 1996);
//! * the mean of the points of its patch, `sum det(f) dv_n / sum dv_n` over their volumes at the beginning of the increment,
//!   for simplices and wedges of first degree, and for tetrahedra of second;
//! * the field, linear in the undeformed coordinates, that is nearest to that of the points of the patch by least squares
//!   over the same volumes, for the others of second degree: with one constant they are too soft.
//!
//! Those of later increments multiply to that from the beginning.

use super::Strain;
use super::attempt::OpenBody;
use super::body::Bar;
use super::operator::{Nodal, deformation, volume_gradient};
use super::patches::WIDEST;
use crate::tensor::{Tensor2, Vec3};

/// Most unknowns of a stencil.
const MOST: usize = 3 * WIDEST;
/// Most terms of the field.
pub(super) const TERMS: usize = 4;

/// The functions of the terms at a point.
pub(super) type Functions = [f64; TERMS];

/// Those of a constant.
const CONSTANT: Functions = [1.0, 0.0, 0.0, 0.0];

/// A shared change of volume.
pub(super) struct Shared {
    /// How many terms it has.
    pub terms: usize,
    /// Their factors: of volume over that at the beginning of the increment; in small strain of one and the trace.
    factors: Functions,
    /// Centre and scale of the coordinates in which it is linear.
    frame: Option<(Vec3, f64)>,
    /// Derivative of each along the unknowns of the stencil; zero if not wanted.
    pub gradients: [[f64; MOST]; TERMS],
}

impl Shared {
    fn new(terms: usize) -> Self {
        Self { terms, frame: None, factors: [0.0; TERMS], gradients: [[0.0; MOST]; TERMS] }
    }

    /// Its value at a point.
    pub fn at(&self, functions: &Functions) -> f64 {
        self.factors.iter().zip(functions).map(|(factor, function)| factor * function).sum()
    }
}

impl OpenBody<'_> {
    /// That of a cell at the trial unknowns of its stencil.
    pub(super) fn shared<const DIM: usize, const N: usize>(
        &self,
        index: usize,
        u: &[f64],
        differentiated: bool,
    ) -> Option<Shared> {
        let body = self.body;
        match &body.shapes(body.mesh.cell(body.cells[index]).kind).bar {
            Bar::Own => None,
            Bar::Center(_) => self.of_center::<DIM, N>(index, u, differentiated),
            Bar::Patch => self.of_patch::<DIM, N>(index, u, (1, differentiated)),
            Bar::Linear => self.of_patch::<DIM, N>(index, u, (DIM + 1, differentiated)),
        }
    }

    fn of_center<const DIM: usize, const N: usize>(
        &self,
        index: usize,
        u: &[f64],
        differentiated: bool,
    ) -> Option<Shared> {
        let rows = self.points(index).next_back()?.rows();
        let f0 = deformation(rows, &self.increment::<DIM, N>(index, u));
        let strain = self.body.options.strain;
        let mut shared = Shared::new(1);
        shared.factors[0] = strain.dilation(&f0);
        if differentiated {
            let along: Nodal<DIM, N> = volume_gradient(rows, &along_which(strain, &f0));
            let weight = if strain == Strain::Finite { shared.factors[0] } else { 1.0 };
            add(&along, weight, 0..self.nodes(index).len(), &mut shared.gradients[0]);
        }
        Some(shared)
    }

    /// The field of a cell's patch: constant, or linear in the undeformed coordinates.
    fn of_patch<const DIM: usize, const N: usize>(
        &self,
        index: usize,
        u: &[f64],
        (terms, differentiated): (usize, bool),
    ) -> Option<Shared> {
        let (body, strain) = (self.body, self.body.options.strain);
        let (own, others) = (self.nodes(index), body.patches.others(index));
        let (mut shared, mut normal) = (Shared::new(terms), [[0.0; TERMS]; TERMS]);
        shared.frame = self.frame(index, terms);
        // Sums of the volumes at the points with the functions there, and the derivatives of those sums.
        let (mut sums, mut slopes) = ([0.0; TERMS], [[0.0; MOST]; TERMS]);
        for &member in body.patches.members(index) {
            // Where the nodes of the member stand in the stencil.
            let (mut du, mut places) = ([[0.0; N]; DIM], [0; N]);
            for (k, node) in self.nodes(member).iter().enumerate().take(N) {
                let beside = || others.iter().position(|other| other == node).map(|place| own.len() + place);
                places[k] = own.iter().position(|own| own == node).or_else(beside).unwrap_or(0);
                let accepted = &self.accepted.u[body.dofs.node(*node)..];
                (0..DIM).for_each(|i| du[i][k] = u[DIM * places[k] + i] - accepted[i]);
            }
            let nodes = self.nodes(member).len();
            for (number, point) in self.points(member).enumerate() {
                let (rows, volume, functions) = (point.rows(), point.volume, self.functions(member, number, &shared));
                for (row, f) in normal.iter_mut().zip(functions) {
                    row.iter_mut().zip(functions).for_each(|(entry, g)| *entry += volume * f * g);
                }
                let f = deformation(rows, &du);
                let ratio = strain.dilation(&f);
                sums.iter_mut().zip(functions).for_each(|(sum, function)| *sum += volume * ratio * function);
                if differentiated {
                    let along: Nodal<DIM, N> = volume_gradient(rows, &along_which(strain, &f));
                    let weight = if strain == Strain::Finite { volume * ratio } else { volume };
                    for (slopes, function) in slopes[..terms].iter_mut().zip(functions) {
                        add(&along, weight * function, places[..nodes].iter().copied(), slopes);
                    }
                }
            }
        }
        for (term, row) in inverse(normal, terms)?.iter().enumerate().take(terms) {
            for (entry, (sum, slopes)) in row.iter().zip(sums.iter().zip(&slopes)).take(terms) {
                shared.factors[term] += entry * sum;
                shared.gradients[term].iter_mut().zip(slopes).for_each(|(gradient, slope)| *gradient += entry * slope);
            }
        }
        Some(shared)
    }

    /// Centre and extent of the undeformed patch of a cell.
    fn frame(&self, index: usize, terms: usize) -> Option<(Vec3, f64)> {
        if terms == 1 {
            return None;
        }
        let nodes = || self.nodes(index).iter().chain(self.body.patches.others(index)).copied();
        // Members see the same patch from their own cell: the sum must not depend on whose nodes come first.
        let (mut low, mut high) = (Vec3([f64::INFINITY; 3]), Vec3([f64::NEG_INFINITY; 3]));
        for node in nodes() {
            let x = self.body.mesh.points[node];
            (0..3).for_each(|a| (low[a], high[a]) = (low[a].min(x[a]), high[a].max(x[a])));
        }
        Some(((low + high) * 0.5, 2.0 / (high - low).norm()))
    }

    /// The functions of a shared change of volume at a point of a cell: one, then the undeformed coordinates in the frame.
    pub(super) fn functions(&self, index: usize, number: usize, shared: &Shared) -> Functions {
        let Some((center, scale)) = shared.frame else { return CONSTANT };
        let view = self.body.mesh.cell(self.body.cells[index]);
        let shapes = &self.body.shapes(view.kind).points[number];
        let place =
            view.nodes.iter().zip(&shapes.n).fold(Vec3::zero(), |x, (&node, n)| x + self.body.mesh.points[node] * *n);
        let [x, y, z] = ((place - center) * scale).0;
        [1.0, x, y, z]
    }
}

/// The inverse of the first rows and columns of a symmetric positive matrix, by Gauss and Jordan.
fn inverse(mut a: [Functions; TERMS], size: usize) -> Option<[Functions; TERMS]> {
    let mut inverse = [[0.0; TERMS]; TERMS];
    (0..size).for_each(|i| inverse[i][i] = 1.0);
    for pivot in 0..size {
        let scale = a[pivot][pivot];
        if scale.is_nan() || scale <= 0.0 {
            return None;
        }
        a[pivot].iter_mut().chain(&mut inverse[pivot]).for_each(|entry| *entry /= scale);
        for row in (0..size).filter(|&row| row != pivot) {
            let factor = a[row][pivot];
            for column in 0..size {
                a[row][column] -= factor * a[pivot][column];
                inverse[row][column] -= factor * inverse[pivot][column];
            }
        }
    }
    Some(inverse)
}

/// The deformation at which the derivative of the change of volume is taken.
fn along_which(strain: Strain, f: &Tensor2) -> Tensor2 {
    if strain == Strain::Finite { *f } else { Tensor2::identity() }
}

/// Adds a derivative along the displacements of nodes to that along the stencil's.
fn add<const DIM: usize, const N: usize>(
    along: &Nodal<DIM, N>,
    weight: f64,
    places: impl Iterator<Item = usize>,
    out: &mut [f64; MOST],
) {
    for (k, place) in places.enumerate() {
        (0..DIM).for_each(|i| out[DIM * place + i] += weight * along[i][k]);
    }
}
