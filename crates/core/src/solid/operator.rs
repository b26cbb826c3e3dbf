//! What the gradients of a cell make of displacements, of a stress and of its derivatives: deformation, nodal forces and
//! the cell's tangent.
//!
//! All is kept by axes: component `i` of node `L` at `[i][L]`. `D` components of the gradient vary: those of `DIM` axes by
//! rows, and the hoop's behind them where the circumference counts. A displacement along axis `i` moves one component
//! for each row of the [`PointGradient`](super::gradient::PointGradient) that counts: see [`component`].

use super::gradient::Rows;
use super::lanes::{add_dyads, add_multiple, dot};
use crate::tensor::Tensor2;
use pulp::{Arch, Simd, WithSimd};

/// A value for each axis of each node.
pub type Nodal<const DIM: usize, const N: usize> = [[f64; N]; DIM];

/// How many rows of the gradient a displacement along axis `i` enters by.
const fn rows<const DIM: usize, const D: usize>(i: usize) -> usize {
    if DIM == 3 || (D == DIM * DIM + 1 && i == 0) { 3 } else { 2 }
}

/// Component that a displacement along axis `i` moves by row `j` of the gradient.
const fn component<const DIM: usize>(i: usize, j: usize) -> usize {
    if j < DIM { DIM * i + j } else { DIM * DIM }
}

/// Deformation `I + grad(du)`.
#[inline]
pub fn deformation<const DIM: usize, const N: usize>(g: &Rows<N>, du: &Nodal<DIM, N>) -> Tensor2 {
    Arch::new().dispatch(Deformation { g, du })
}

/// Not a closure, since only what is inlined into [`Arch::dispatch`] is compiled for the processor at hand.
struct Deformation<'a, const DIM: usize, const N: usize> {
    g: &'a Rows<N>,
    du: &'a Nodal<DIM, N>,
}

impl<const DIM: usize, const N: usize> WithSimd for Deformation<'_, DIM, N> {
    type Output = Tensor2;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Tensor2 {
        let (Self { g, du }, mut f) = (self, Tensor2::identity());
        for i in 0..DIM {
            (0..DIM).for_each(|j| f[(i, j)] += dot(simd, &du[i], &g[j]));
        }
        if DIM == 2 {
            f[(2, 2)] += dot(simd, &du[0], &g[2]);
        }
        f
    }
}

/// Derivative of `ln det` of the deformation `f` along each nodal displacement.
pub fn volume_gradient<const DIM: usize, const N: usize>(g: &Rows<N>, f: &Tensor2) -> Nodal<DIM, N> {
    let (inverse, mut out) = (f.inverse(), [[0.0; N]; DIM]);
    for (m, out) in out.iter_mut().enumerate() {
        for (n, g) in g[..DIM].iter().enumerate() {
            out.iter_mut().zip(g).for_each(|(out, g)| *out += inverse[(n, m)] * g);
        }
    }
    if DIM == 2 {
        out[0].iter_mut().zip(&g[2]).for_each(|(out, g)| *out += inverse[(2, 2)] * g);
    }
    out
}

/// `F_Li += P_ij dN_L/dx_j dv`, and the hoop part on the radial component.
#[inline]
pub fn add_forces<const DIM: usize, const D: usize, const N: usize>(
    g: &Rows<N>,
    p: &[f64; D],
    volume: f64,
    force: &mut Nodal<DIM, N>,
) {
    Arch::new().dispatch(Forces { g, p, volume, force });
}

struct Forces<'a, const DIM: usize, const D: usize, const N: usize> {
    g: &'a Rows<N>,
    p: &'a [f64; D],
    volume: f64,
    force: &'a mut Nodal<DIM, N>,
}

impl<const DIM: usize, const D: usize, const N: usize> WithSimd for Forces<'_, DIM, D, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        add_forces_by(simd, self.g, (self.p, self.volume), self.force);
    }
}

/// [`add_forces`] in vectors of the processor at hand.
#[inline(always)]
pub fn add_forces_by<S: Simd, const DIM: usize, const D: usize, const N: usize>(
    simd: S,
    g: &Rows<N>,
    (p, volume): (&[f64; D], f64),
    force: &mut Nodal<DIM, N>,
) {
    for (i, force) in force.iter_mut().enumerate() {
        for (j, g) in g[..rows::<DIM, D>(i)].iter().enumerate() {
            add_multiple(simd, p[component::<DIM>(i, j)] * volume, g, force);
        }
    }
}

/// The tangent of a cell while its points are added up.
pub struct Tangent<const DIM: usize, const N: usize> {
    /// Derivative of force `[i][L]` along displacement `[m][M]` at `[i][m][L][M]`.
    blocks: [[[[f64; N]; N]; DIM]; DIM],
    /// Nodes of the cell.
    nodes: usize,
    /// Whether it is symmetric, so that only the blocks of `m >= i` are worked out.
    symmetric: bool,
}

impl<const DIM: usize, const N: usize> Tangent<DIM, N> {
    /// Zero.
    pub fn zero(nodes: usize, symmetric: bool) -> Self {
        Self { blocks: [[[[0.0; N]; N]; DIM]; DIM], nodes: nodes.min(N), symmetric }
    }

    /// `K += B^T A B dv` with `B` the map from nodal displacements to the components of the gradient.
    #[inline]
    pub fn add<const D: usize>(&mut self, g: &Rows<N>, a: &[[f64; D]; D], volume: f64) {
        Arch::new().dispatch(Product { g, a, volume, tangent: self });
    }

    /// Adds it by rows, node by node, to the first rows and columns of a matrix with rows of this length.
    pub fn write(&self, length: usize, out: &mut [f64]) {
        let mut rows = out.chunks_exact_mut(length);
        for node in 0..self.nodes {
            for (i, row) in rows.by_ref().take(DIM).enumerate() {
                for (other, row) in row.as_chunks_mut::<DIM>().0.iter_mut().enumerate().take(self.nodes) {
                    row.iter_mut().enumerate().for_each(|(m, entry)| *entry += self.entry((i, node), (m, other)));
                }
            }
        }
    }

    /// Derivative of the force along axis `i` on a node along the displacement along axis `m` of another.
    fn entry(&self, (i, node): (usize, usize), (m, other): (usize, usize)) -> f64 {
        let below = self.symmetric && m < i;
        if below { self.blocks[m][i][other][node] } else { self.blocks[i][m][node][other] }
    }

    /// Adds it to a matrix with rows of this length, its nodes at these places there.
    pub fn add_at(&self, places: &[usize], length: usize, out: &mut [f64]) {
        for (node, place) in places.iter().enumerate() {
            for i in 0..DIM {
                let row = &mut out[(DIM * place + i) * length..][..length];
                for (other, place) in places.iter().enumerate() {
                    (0..DIM).for_each(|m| row[DIM * place + m] += self.entry((i, node), (m, other)));
                }
            }
        }
    }
}

/// Adds, by rows, what is nodal in a cell times a gradient along all unknowns of a stencil.
pub fn add_outer<const DIM: usize, const N: usize>(force: &Nodal<DIM, N>, gradient: &[f64], out: &mut [f64]) {
    let rows = out.chunks_exact_mut(gradient.len());
    for (row, f) in rows.zip((0..N).flat_map(|node| force.iter().map(move |axis| axis[node]))) {
        row.iter_mut().zip(gradient).for_each(|(k, g)| *k += f * g);
    }
}

struct Product<'a, const DIM: usize, const D: usize, const N: usize> {
    g: &'a Rows<N>,
    a: &'a [[f64; D]; D],
    volume: f64,
    tangent: &'a mut Tangent<DIM, N>,
}

impl<const DIM: usize, const D: usize, const N: usize> WithSimd for Product<'_, DIM, D, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { g, a, volume, tangent } = self;
        let mut weighted = [[0.0; N]; 3];
        weighted.iter_mut().zip(g).for_each(|(weighted, g)| add_multiple(simd, volume, g, weighted));
        for i in 0..DIM {
            let first = if tangent.symmetric { i } else { 0 };
            for m in first..DIM {
                let mut ab = [[0.0; N]; 3];
                for (j, ab) in ab[..rows::<DIM, D>(i)].iter_mut().enumerate() {
                    for (n, g) in weighted[..rows::<DIM, D>(m)].iter().enumerate() {
                        add_multiple(simd, a[component::<DIM>(i, j)][component::<DIM>(m, n)], g, ab);
                    }
                }
                let block = &mut tangent.blocks[i][m][..tangent.nodes];
                match rows::<DIM, D>(i) {
                    3 => add_dyads::<S, N, 3>(simd, g, &ab, block),
                    _ => add_dyads::<S, N, 2>(simd, g, &ab, block),
                }
            }
        }
    }
}
