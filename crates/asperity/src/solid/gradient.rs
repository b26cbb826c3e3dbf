//! Gradients of the shape functions at the points of a cell, in the configuration of the accepted state: the only
//! place, with the weights, where plane, axisymmetric and solid bodies differ.

use crate::mesh::Space;
use crate::mesh::cells::{Cell, MAX_NODES};
use crate::tensor::Tensor2;

/// Gradient of one shape function, and behind it `N_L / r` in the axisymmetric case, else zero.
pub type NodeGradient = [f64; 4];

/// Gradient operator of one point of a cell.
#[derive(Debug, Clone, Copy)]
pub struct PointGradient<'a> {
    /// Of each node.
    pub nodes: &'a [NodeGradient],
    /// Volume the point stands for: determinant times weight, times the circumference when axisymmetric (not times
    /// the thickness).
    pub volume: f64,
}

/// The gradient operators of many points, one cell after another.
#[derive(Debug, Clone, Default)]
pub struct Gradients {
    nodes: Vec<NodeGradient>,
    volumes: Vec<f64>,
    /// Where each cell ends among nodes and volumes.
    ends: Vec<[usize; 2]>,
}

impl Gradients {
    /// Room for so many cells of so many points and nodes.
    pub fn with_capacity(cells: usize, points: usize, nodes: usize) -> Self {
        Self {
            nodes: Vec::with_capacity(cells * points * nodes),
            volumes: Vec::with_capacity(cells * points),
            ends: Vec::with_capacity(cells),
        }
    }

    /// Adds the next point of the present cell, whose nodes are at `x`; says no if the cell is inside out there, or not to
    /// the right of the axis.
    #[must_use]
    pub fn push(&mut self, shapes: &Shapes, x: &[[f64; 3]], space: Space) -> bool {
        let volume = at(shapes, x, space, &mut self.nodes);
        self.volumes.extend(volume);
        volume.is_some()
    }

    /// Ends the present cell.
    pub fn close(&mut self) {
        self.ends.push([self.nodes.len(), self.volumes.len()]);
    }

    /// The points of a cell, in the order in which they were added.
    pub fn cell(&self, index: usize) -> impl DoubleEndedIterator<Item = PointGradient<'_>> + ExactSizeIterator + Clone {
        let [first, from] = index.checked_sub(1).map_or([0, 0], |before| self.ends[before]);
        let [last, to] = self.ends[index];
        let (nodes, volumes) = (&self.nodes[first..last], &self.volumes[from..to]);
        let count = (nodes.len() / volumes.len().max(1)).max(1);
        nodes.chunks_exact(count).zip(volumes).map(|(nodes, &volume)| PointGradient { nodes, volume })
    }
}

/// The shape functions at one reference point, with its weight: the same for all cells of a kind.
pub struct Shapes {
    /// Values.
    pub n: [f64; MAX_NODES],
    /// Derivatives along the reference coordinates.
    pub dn: [[f64; 3]; MAX_NODES],
    /// The weight.
    pub weight: f64,
}

impl Shapes {
    /// Those of the cell `kind` at `xi`.
    pub fn new(kind: &Cell, xi: [f64; 3], weight: f64) -> Self {
        let (mut n, mut dn) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
        (kind.shape)(xi, &mut n, &mut dn);
        Self { n, dn, weight }
    }
}

/// Adds to `out` the gradients at one point of a cell with nodes at `x` and returns the point's volume; `None` if the cell
/// is inside out there, or not to the right of the axis.
pub fn at(shapes: &Shapes, x: &[[f64; 3]], space: Space, out: &mut Vec<NodeGradient>) -> Option<f64> {
    let (n, dn) = (&shapes.n[..x.len()], &shapes.dn[..x.len()]);
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
    let (around, hoop) = if axisymmetric { (std::f64::consts::TAU * radius, radius.recip()) } else { (1.0, 0.0) };
    out.extend(n.iter().zip(dn).map(|(n, dn)| {
        let along = |i: usize| dn[0] * inverse[(0, i)] + dn[1] * inverse[(1, i)] + dn[2] * inverse[(2, i)];
        [along(0), along(1), along(2), n * hoop]
    }));
    Some(det * shapes.weight * around)
}

impl PointGradient<'_> {
    /// Deformation `I + grad(du)` for nodal displacements with `DIM` components each.
    #[inline]
    pub fn deformation<const DIM: usize>(&self, du: &[f64]) -> Tensor2 {
        let mut f = Tensor2::identity();
        for (du, grad) in du.as_chunks::<DIM>().0.iter().zip(self.nodes) {
            for i in 0..DIM {
                for j in 0..DIM {
                    f[(i, j)] += du[i] * grad[j];
                }
            }
            if DIM == 2 {
                f[(2, 2)] += du[0] * grad[3];
            }
        }
        f
    }

    /// Derivative of `ln det` of the deformation `f` along each nodal displacement.
    pub fn volume_gradient<const DIM: usize>(&self, f: &Tensor2, out: &mut [f64]) {
        let inverse = f.inverse();
        for (out, grad) in out.as_chunks_mut::<DIM>().0.iter_mut().zip(self.nodes) {
            for (m, out) in out.iter_mut().enumerate() {
                *out = (0..DIM).map(|n| inverse[(n, m)] * grad[n]).sum();
            }
            out[0] += inverse[(2, 2)] * grad[3];
        }
    }
}
