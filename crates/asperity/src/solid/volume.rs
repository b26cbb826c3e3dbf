//! The change of volume that the points of a cell share with F-bar: that of the cell's centre (de Souza Neto et al. 1996),
//! or the mean of the points of its patch, `sum det(f) dv_n / sum dv_n` over their volumes at the beginning of the
//! increment. Means of later increments multiply to that from the beginning.

use super::Strain;
use super::attempt::OpenBody;
use super::body::Bar;
use super::operator::{Nodal, deformation, volume_gradient};
use super::patches::WIDEST;
use crate::tensor::Tensor2;

/// Most unknowns of a stencil.
const MOST: usize = 3 * WIDEST;

/// A shared change of volume.
pub(super) struct Shared {
    /// Volume over that at the beginning of the increment; in small strain one and the trace of the strain.
    pub ratio: f64,
    /// Derivative of its logarithm along the unknowns of the stencil, in small strain of the trace; zero if not wanted.
    pub gradient: [f64; MOST],
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
        match body.shapes(body.mesh.cell(body.cells[index]).kind).bar {
            Bar::Own => None,
            Bar::Center(_) => self.of_center::<DIM, N>(index, u, differentiated),
            Bar::Patch => Some(self.of_patch::<DIM, N>(index, u, differentiated)),
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
        let mut shared = Shared { ratio: strain.dilation(&f0), gradient: [0.0; MOST] };
        if differentiated {
            let along: Nodal<DIM, N> = volume_gradient(rows, &along_which(strain, &f0));
            add(&along, 1.0, 0..self.nodes(index).len(), &mut shared.gradient);
        }
        Some(shared)
    }

    fn of_patch<const DIM: usize, const N: usize>(&self, index: usize, u: &[f64], differentiated: bool) -> Shared {
        let (body, strain) = (self.body, self.body.options.strain);
        let (own, others) = (self.nodes(index), body.patches.others(index));
        let (mut now, mut before, mut gradient) = (0.0, 0.0, [0.0; MOST]);
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
            for point in self.points(member) {
                let (rows, volume) = (point.rows(), point.volume);
                let f = deformation(rows, &du);
                let ratio = strain.dilation(&f);
                (now, before) = (now + volume * ratio, before + volume);
                if differentiated {
                    let along: Nodal<DIM, N> = volume_gradient(rows, &along_which(strain, &f));
                    let weight = if strain == Strain::Finite { volume * ratio } else { volume };
                    add(&along, weight, places[..nodes].iter().copied(), &mut gradient);
                }
            }
        }
        let whole = if strain == Strain::Finite { now } else { before };
        gradient.iter_mut().for_each(|along| *along /= whole);
        Shared { ratio: now / before, gradient }
    }
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
