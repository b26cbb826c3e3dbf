//! What the gradients of a cell make of a stress and its derivatives: nodal forces and the cell's tangent.

use super::gradient::PointGradient;
use crate::mesh::cells::MAX_NODES;

/// Most unknowns of a cell.
pub const MAX_DOFS: usize = 3 * MAX_NODES;
/// Unknowns of most cells, for which less memory is cleared.
pub const FEW_DOFS: usize = 24;

/// `F_Li += P_ij dN_L/dx_j dv`, and the hoop part on the radial component.
#[inline]
pub fn add_forces<const DIM: usize>(point: &PointGradient, p: &[f64; 9], volume: f64, force: &mut [f64]) {
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
pub fn add_tangent<const DIM: usize, const D: usize, const M: usize>(
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
pub fn add_center<const DIM: usize>(
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
