//! Gradients of the shape functions at the points of a cell, in the configuration of the accepted state: the only
//! place, with the weights, where plane, axisymmetric and solid bodies differ.

use crate::mesh::Space;
use crate::mesh::cells::{Cell, MAX_NODES};
use crate::tensor::Tensor2;

/// Three values for each node: `dN_L/dx` of all nodes, then `dN_L/dy`, then `dN_L/dz` in space, `N_L / r` in the
/// axisymmetric case and zero in the plane. Rows are filled up with zeros to the length that [`padded`] says.
pub type Rows<const N: usize> = [[f64; N]; 3];

/// Length of the rows of a cell with so many nodes: whole vectors of any processor, in few lengths.
pub const fn padded(nodes: usize) -> usize {
    match nodes {
        0..=4 => 4,
        5..=8 => 8,
        9..=12 => 12,
        13..=16 => 16,
        17..=20 => 20,
        _ => MOST,
    }
}

/// The longest row.
pub const MOST: usize = MAX_NODES.next_multiple_of(4);

/// Gradient operator of one point of a cell.
#[derive(Debug, Clone, Copy)]
pub struct PointGradient<'a> {
    /// Its rows, one after another.
    rows: &'a [f64],
    /// Volume the point stands for: determinant times weight, times the circumference when axisymmetric (not times
    /// the thickness).
    pub volume: f64,
}

/// The gradient operators of many points, one cell after another.
#[derive(Debug, Clone, Default)]
pub struct Gradients {
    rows: Vec<f64>,
    volumes: Vec<f64>,
    /// Where each cell ends among rows and volumes.
    ends: Vec<[usize; 2]>,
}

impl Gradients {
    /// Room for so many cells of so many points and nodes.
    pub fn with_capacity(cells: usize, points: usize, nodes: usize) -> Self {
        Self {
            rows: Vec::with_capacity(3 * cells * points * padded(nodes)),
            volumes: Vec::with_capacity(cells * points),
            ends: Vec::with_capacity(cells),
        }
    }

    /// Adds the next point of the present cell, whose nodes are at `x`; says no if the cell is inside out there, or not to
    /// the right of the axis.
    #[must_use]
    pub fn push(&mut self, shapes: &Shapes, x: &[[f64; 3]], space: Space) -> bool {
        let volume = at(shapes, x, space, &mut self.rows);
        self.volumes.extend(volume);
        volume.is_some()
    }

    /// Rows and volumes of the points added to the present cell.
    pub fn present(&mut self) -> (&mut [f64], &mut [f64]) {
        let [rows, volumes] = self.ends.last().copied().unwrap_or_default();
        (&mut self.rows[rows..], &mut self.volumes[volumes..])
    }

    /// Ends the present cell.
    pub fn close(&mut self) {
        self.ends.push([self.rows.len(), self.volumes.len()]);
    }

    /// The points of a cell, in the order in which they were added.
    pub fn cell(&self, index: usize) -> impl Iterator<Item = PointGradient<'_>> {
        let [first, from] = index.checked_sub(1).map_or([0, 0], |before| self.ends[before]);
        let [last, to] = self.ends[index];
        let (rows, volumes) = (&self.rows[first..last], &self.volumes[from..to]);
        let count = (rows.len() / volumes.len().max(1)).max(1);
        rows.chunks_exact(count).zip(volumes).map(|(rows, &volume)| PointGradient { rows, volume })
    }
}

/// The shape functions at one reference point, with its weight: the same for all cells of a kind. Behind those of the nodes may
/// stand incompatible modes.
pub struct Shapes {
    /// Values; none of the modes.
    pub n: [f64; MAX_NODES],
    /// Derivatives along the reference coordinates.
    pub dn: [[f64; 3]; MAX_NODES],
    /// The weight.
    pub weight: f64,
    /// How many modes there are.
    pub modes: usize,
}

impl Shapes {
    /// Those of the cell `kind` at `xi`.
    pub fn new(kind: &Cell, xi: [f64; 3], weight: f64) -> Self {
        let (mut n, mut dn) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
        (kind.shape)(xi, &mut n, &mut dn);
        Self { n, dn, weight, modes: 0 }
    }

    /// With so many incompatible modes `1 - xi_k^2` behind its nodes, and a fourth `xi_1 xi_2 xi_3`.
    pub fn with_modes(mut self, kind: &Cell, xi: [f64; 3], modes: usize) -> Self {
        self.modes = modes;
        let (dn, [x, y, z]) = (&mut self.dn[kind.nodes.len()..], xi);
        (0..modes.min(3)).for_each(|k| dn[k][k] = -2.0 * xi[k]);
        if modes > 3 {
            dn[3] = [y * z, z * x, x * y];
        }
        self
    }
}

/// Adds to `out` the gradients at one point of a cell with nodes at `x`, in the order of [`Rows`] with those of its modes behind
/// the nodes, and returns the point's volume; `None` if the cell is inside out there, or not to the right of the axis.
pub fn at(shapes: &Shapes, x: &[[f64; 3]], space: Space, out: &mut Vec<f64>) -> Option<f64> {
    let columns = x.len() + shapes.modes;
    let (n, dn) = (&shapes.n[..columns], &shapes.dn[..columns]);
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
    let (begun, length) = (out.len(), padded(columns));
    out.resize(begun + 3 * length, 0.0);
    for (i, row) in out[begun..].chunks_exact_mut(length).enumerate() {
        if i < 2 || space == Space::Solid {
            let [a, b, c] = [inverse[(0, i)], inverse[(1, i)], inverse[(2, i)]];
            row.iter_mut().zip(dn).for_each(|(along, dn)| *along = dn[0] * a + dn[1] * b + dn[2] * c);
        } else {
            row.iter_mut().zip(n).for_each(|(along, n)| *along = n * hoop);
        }
    }
    Some(det * shapes.weight * around)
}

impl<'a> PointGradient<'a> {
    /// Its rows; `N` is the length that [`padded`] says.
    #[inline]
    pub fn rows<const N: usize>(&self) -> &'a Rows<N> {
        self.rows.as_chunks().0.first_chunk().expect("rows of the padded length")
    }
}
