//! What the gradients of a cell make of a stress and its derivatives: nodal forces and the cell's tangent. `D` components
//! of the gradient vary: those of `DIM` axes by rows, and the hoop's behind them where the circumference counts.

use super::gradient::PointGradient;
use crate::mesh::cells::MAX_NODES;
use pulp::{Arch, NullaryFnOnce};

/// Most unknowns of a cell.
pub const MAX_DOFS: usize = 3 * MAX_NODES;

/// `F_Li += P_ij dN_L/dx_j dv`, and the hoop part on the radial component.
#[inline]
pub fn add_forces<const DIM: usize, const D: usize>(
    point: &PointGradient,
    p: &[f64; D],
    volume: f64,
    force: &mut [f64],
) {
    let p = p.map(|p| p * volume);
    for (force, grad) in force.as_chunks_mut::<DIM>().0.iter_mut().zip(point.nodes) {
        for i in 0..DIM {
            for j in 0..DIM {
                force[i] += p[i * DIM + j] * grad[j];
            }
        }
        if D == DIM * DIM + 1 {
            force[0] += p[DIM * DIM] * grad[3];
        }
    }
}

/// `K += B^T A B dv` with `B` the map from nodal displacements to the components of the gradient.
#[inline]
pub fn add_tangent<const DIM: usize, const D: usize>(
    point: &PointGradient,
    a: &[[f64; D]; D],
    volume: f64,
    tangent: &mut [f64],
) {
    Arch::new().dispatch(Product::<DIM, D> { point, a, volume, tangent });
}

/// Not a closure, since only what is inlined into [`Arch::dispatch`] is compiled for the processor at hand.
struct Product<'a, const DIM: usize, const D: usize> {
    point: &'a PointGradient<'a>,
    a: &'a [[f64; D]; D],
    volume: f64,
    tangent: &'a mut [f64],
}

impl<const DIM: usize, const D: usize> NullaryFnOnce for Product<'_, DIM, D> {
    type Output = ();
    #[inline(always)]
    fn call(self) {
        let Self { point, a, volume, tangent } = self;
        match point.nodes.len() {
            3 => add_product::<DIM, D, 3>(point, a, volume, tangent),
            4 => add_product::<DIM, D, 4>(point, a, volume, tangent),
            6 => add_product::<DIM, D, 6>(point, a, volume, tangent),
            8 => add_product::<DIM, D, 8>(point, a, volume, tangent),
            9 => add_product::<DIM, D, 9>(point, a, volume, tangent),
            10 => add_product::<DIM, D, 10>(point, a, volume, tangent),
            20 => add_product::<DIM, D, 20>(point, a, volume, tangent),
            _ => add_product::<DIM, D, MAX_NODES>(point, a, volume, tangent),
        }
    }
}

/// The same for a cell of at most `MOST` nodes: where it has as many, all lengths are known when this is compiled.
#[inline(always)]
fn add_product<const DIM: usize, const D: usize, const MOST: usize>(
    point: &PointGradient,
    a: &[[f64; D]; D],
    volume: f64,
    tangent: &mut [f64],
) {
    let nodes = &point.nodes[..point.nodes.len().min(MOST)];
    let n = DIM * nodes.len();
    let mut grads = [[0.0; MOST]; 4];
    for (node, grad) in nodes.iter().enumerate() {
        (0..4).for_each(|k| grads[k][node] = grad[k]);
    }
    let mut ab = [[[0.0; DIM]; MOST]; D];
    for (ab, a) in ab.iter_mut().zip(a) {
        let a = a.map(|a| a * volume);
        // By axes first, over all nodes at once.
        let mut axes = [[0.0; MOST]; DIM];
        for (m, axis) in axes.iter_mut().enumerate() {
            for (k, grads) in grads[..DIM].iter().enumerate() {
                (0..MOST).for_each(|node| axis[node] += a[m * DIM + k] * grads[node]);
            }
            if m == 0 && D == DIM * DIM + 1 {
                (0..MOST).for_each(|node| axis[node] += a[DIM * DIM] * grads[3][node]);
            }
        }
        for (node, ab) in ab.iter_mut().enumerate() {
            (0..DIM).for_each(|m| ab[m] = axes[m][node]);
        }
    }
    let mut rows = tangent.chunks_exact_mut(n);
    for grad in nodes {
        for (i, row) in rows.by_ref().take(DIM).enumerate() {
            let part = |j: usize| ab[i * DIM + j].as_flattened()[..n].iter();
            if DIM == 3 {
                let parts = part(0).zip(part(1)).zip(part(2));
                row.iter_mut()
                    .zip(parts)
                    .for_each(|(k, ((x, y), z))| *k = *k + grad[0] * x + grad[1] * y + grad[2] * z);
            } else {
                row.iter_mut().zip(part(0).zip(part(1))).for_each(|(k, (x, y))| *k = *k + grad[0] * x + grad[1] * y);
            }
            if i == 0 && D == DIM * DIM + 1 {
                let hoop = &ab[DIM * DIM].as_flattened()[..n];
                row.iter_mut().zip(hoop).for_each(|(k, ab)| *k += grad[3] * ab);
            }
        }
    }
}

/// The rank-one part of F-bar: forces along `ln det f0`, times its gradient.
pub fn add_center<const DIM: usize, const D: usize>(
    point: &PointGradient,
    along: &[f64; D],
    volume: f64,
    gradient: &[f64],
    tangent: &mut [f64],
) {
    let n = DIM * point.nodes.len();
    let mut force = [0.0; MAX_DOFS];
    add_forces::<DIM, D>(point, along, volume, &mut force[..n]);
    for (row, f) in tangent.chunks_exact_mut(n).zip(force) {
        row.iter_mut().zip(gradient).for_each(|(k, g)| *k += f * g);
    }
}
