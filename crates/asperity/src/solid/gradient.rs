//! Gradients of the shape functions at the points of a cell, in the configuration of the accepted state: the only
//! place, with the weights, where plane, axisymmetric and solid bodies differ.

use crate::mesh::Space;
use crate::mesh::cells::{Cell, MAX_NODES};
use crate::tensor::Tensor2;

/// Gradient operator of one point of a cell with a given number of nodes.
#[derive(Debug, Clone)]
pub struct PointGradient {
    /// Gradient of each shape function.
    pub grad: Vec<[f64; 3]>,
    /// `N_L / r` in the axisymmetric case, else zero.
    pub hoop: Vec<f64>,
    /// Volume the point stands for: determinant times weight, times the circumference when axisymmetric (not times
    /// the thickness).
    pub volume: f64,
}

/// The shape functions at one reference point, with its weight: the same for all cells of a kind.
pub struct Shapes {
    n: [f64; MAX_NODES],
    dn: [[f64; 3]; MAX_NODES],
    weight: f64,
}

impl Shapes {
    /// Those of the cell `kind` at `xi`.
    pub fn new(kind: &Cell, xi: [f64; 3], weight: f64) -> Self {
        let (mut n, mut dn) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
        (kind.shape)(xi, &mut n, &mut dn);
        Self { n, dn, weight }
    }
}

/// Gradients at one point of a cell with nodes at `x`; `None` if the cell is inside out there, or not to the right of
/// the axis.
pub fn at(shapes: &Shapes, x: &[[f64; 3]], space: Space) -> Option<PointGradient> {
    let count = x.len();
    let Shapes { n, dn, weight } = shapes;
    let mut jacobian = Tensor2::zero();
    for (x, dn) in x.iter().zip(dn) {
        for i in 0..3 {
            for a in 0..3 {
                jacobian[(i, a)] += x[i] * dn[a];
            }
        }
    }
    if space != Space::Solid {
        jacobian[(2, 2)] = 1.0;
    }
    let det = jacobian.det();
    let radius: f64 = n.iter().zip(x).map(|(n, x)| n * x[0]).sum();
    let axisymmetric = space == Space::Axisymmetric;
    // A NaN fails both comparisons and is refused with the rest.
    if !(det > 0.0 && (!axisymmetric || radius > 0.0)) {
        return None;
    }
    let inverse = jacobian.inverse();
    let grad = dn[..count].iter().map(|dn| std::array::from_fn(|i| (0..3).map(|a| dn[a] * inverse[(a, i)]).sum()));
    let around = if axisymmetric { std::f64::consts::TAU * radius } else { 1.0 };
    let hoop = n[..count].iter().map(|n| if axisymmetric { n / radius } else { 0.0 });
    Some(PointGradient { grad: grad.collect(), hoop: hoop.collect(), volume: det * weight * around })
}

impl PointGradient {
    /// Deformation `I + grad(du)` for nodal displacements with `dim` components each.
    pub fn deformation(&self, du: &[f64], dim: usize) -> Tensor2 {
        let mut f = Tensor2::identity();
        for ((du, grad), hoop) in du.chunks_exact(dim).zip(&self.grad).zip(&self.hoop) {
            for i in 0..dim {
                for j in 0..dim {
                    f[(i, j)] += du[i] * grad[j];
                }
            }
            f[(2, 2)] += du[0] * hoop;
        }
        f
    }

    /// Derivative of `ln det` of the deformation `f` along each nodal displacement.
    pub fn volume_gradient(&self, f: &Tensor2, dim: usize, out: &mut [f64]) {
        let inverse = f.inverse();
        for ((out, grad), hoop) in out.chunks_exact_mut(dim).zip(&self.grad).zip(&self.hoop) {
            for (m, out) in out.iter_mut().enumerate() {
                *out = (0..dim).map(|n| inverse[(n, m)] * grad[n]).sum();
            }
            out[0] += inverse[(2, 2)] * hoop;
        }
    }
}
