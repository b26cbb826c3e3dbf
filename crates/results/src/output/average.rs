//! Values at integration points to values at nodes: in each cell the least-squares field in the shape functions of its
//! corners, taken at its nodes; then the mean over the cells at each node. A node in no cell has none (NaN). A *bounded*
//! mean takes no value at a node beyond the values at the points of the cell: a flow stress is not exceeded.

use asperity_core::Error;
use asperity_core::mesh::cells::{Cell, MAX_NODES, Quadrature};
use asperity_core::mesh::{CellView, Mesh};
use asperity_core::tensor::inverse;
use std::collections::BTreeMap;

/// For each node of a cell the weights of the values at its integration points.
pub type Extrapolation = Vec<Vec<f64>>;

/// Means at the nodes of a mesh, gathered cell by cell.
pub struct NodalMean<'a> {
    mesh: &'a Mesh,
    width: usize,
    bounded: bool,
    sums: Vec<f64>,
    counts: Vec<usize>,
    known: BTreeMap<(&'static str, usize), Extrapolation>,
}

impl<'a> NodalMean<'a> {
    /// No values yet, of `width` components each.
    pub fn new(mesh: &'a Mesh, width: usize) -> Self {
        let nodes = mesh.points.len();
        let (sums, counts) = (vec![0.0; width * nodes], vec![0; nodes]);
        Self { mesh, width, bounded: false, sums, counts, known: BTreeMap::new() }
    }
    /// The same, with values at the nodes of a cell within those at its points, component by component.
    pub fn bounded(self) -> Self {
        Self { bounded: true, ..self }
    }
    /// Adds a cell by the values at the points of `rule`, point after point, at those of its nodes that take it.
    ///
    /// # Errors
    /// [`Error::Internal`] when the values are not as many as the points.
    pub fn add(
        &mut self,
        cell: usize,
        rule: &Quadrature,
        values: &[f64],
        takes: impl Fn(usize) -> bool,
    ) -> Result<(), Error> {
        let CellView { kind, nodes } = self.mesh.cell(cell);
        if values.len() != self.width * rule.points.len() {
            return Err(Error::Internal(format!("cell {cell} has {} values at its points", values.len())));
        }
        let key = (kind.name, rule.points.len());
        let weights = self.known.entry(key).or_insert_with(|| extrapolation(kind, rule));
        for (&node, weights) in nodes.iter().zip(weights.iter()).filter(|(node, _)| takes(**node)) {
            let sums = &mut self.sums[node * self.width..][..self.width];
            for (component, sum) in sums.iter_mut().enumerate() {
                let at_points = values.iter().skip(component).step_by(self.width).copied();
                let value: f64 = at_points.clone().zip(weights).map(|(value, weight)| weight * value).sum();
                *sum += if self.bounded { within(value, at_points) } else { value };
            }
            self.counts[node] += 1;
        }
        Ok(())
    }
    /// The means, node after node.
    pub fn finish(mut self) -> Vec<f64> {
        for (sums, &count) in self.sums.chunks_exact_mut(self.width).zip(&self.counts) {
            sums.iter_mut().for_each(|sum| *sum /= count as f64);
        }
        self.sums
    }
}

/// The nearest number to `value` within the range of others.
fn within(value: f64, others: impl Iterator<Item = f64>) -> f64 {
    let [low, high] = others.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], x| [l.min(x), h.max(x)]);
    value.min(high).max(low)
}

/// Pivots below this part of the largest diagonal entry: the points are too few for the shape functions.
const RANK: f64 = 1e-10;

/// Least squares in the shape functions of the corners; the plain mean where the points are too few for them.
pub fn extrapolation(kind: &Cell, rule: &Quadrature) -> Extrapolation {
    let corners = kind.linear.nodes.len();
    let at_points: Vec<Vec<f64>> = rule.points.iter().map(|&xi| corner_functions(kind, xi)).collect();
    let normal: Vec<Vec<f64>> =
        (0..corners).map(|i| (0..corners).map(|j| at_points.iter().map(|n| n[i] * n[j]).sum()).collect()).collect();
    let Some(inverse) = inverse(normal, RANK) else {
        let points = rule.points.len();
        return vec![vec![1.0 / points as f64; points]; kind.nodes.len()];
    };
    let weight = |at_node: &[f64], at_point: &[f64]| -> f64 {
        let row = |i: usize| -> f64 { (0..corners).map(|j| inverse[i][j] * at_point[j]).sum() };
        (0..corners).map(|i| at_node[i] * row(i)).sum()
    };
    let node = |&xi: &[f64; 3]| {
        let at_node = corner_functions(kind, xi);
        at_points.iter().map(|at_point| weight(&at_node, at_point)).collect()
    };
    kind.nodes.iter().map(node).collect()
}

fn corner_functions(kind: &Cell, xi: [f64; 3]) -> Vec<f64> {
    let (mut n, mut dn) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
    (kind.linear.shape)(xi, &mut n, &mut dn);
    n[..kind.linear.nodes.len()].to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_core::mesh::cells::ALL;

    /// One undistorted cell, its nodes at their reference coordinates.
    fn single(kind: &'static Cell) -> Mesh {
        let mut mesh = Mesh::new();
        mesh.points = kind.nodes.iter().map(|&x| asperity_core::tensor::Vec3(x)).collect();
        mesh.push_cell(kind, &(0..kind.nodes.len()).collect::<Vec<_>>());
        mesh
    }

    #[test]
    fn a_linear_field_is_met_exactly_where_the_points_can_hold_it() {
        let field = |x: &[f64; 3]| [3.0 - x[0] + 2.0 * x[1] - 0.5 * x[2], 7.0];
        let mut met = 0;
        for kind in ALL.iter().filter(|kind| kind.dimension > 1) {
            for rule in [Some(kind.full), kind.reduced].into_iter().flatten() {
                let mesh = single(kind);
                let mut mean = NodalMean::new(&mesh, 2);
                mean.add(0, rule, &rule.points.iter().flat_map(field).collect::<Vec<_>>(), |_| true).unwrap();
                let nodal = mean.finish();
                let enough = rule.points.len() >= kind.linear.nodes.len();
                for (node, found) in kind.nodes.iter().zip(nodal.chunks_exact(2)) {
                    let expected = field(node);
                    assert!((found[1] - 7.0).abs() < 1e-12, "{}: a constant is a constant", kind.name);
                    assert!(!enough || (found[0] - expected[0]).abs() < 1e-11, "{}: {found:?}", kind.name);
                }
                met += usize::from(enough);
            }
        }
        assert!(met >= 3);
    }

    #[test]
    fn a_bounded_mean_stays_within_the_values_at_the_points() {
        let kind = ALL.iter().find(|kind| kind.name == "quad4").unwrap();
        let mesh = single(kind);
        let values = [400.0, 400.0, 400.0, 250.0];
        let nodal = |mut mean: NodalMean| {
            mean.add(0, kind.full, &values, |_| true).unwrap();
            mean.finish().into_iter().fold([f64::MAX, f64::MIN], |[l, h], x| [l.min(x), h.max(x)])
        };
        let [low, high] = nodal(NodalMean::new(&mesh, 1));
        assert!(low < 249.0 && high > 401.0, "extrapolation exceeds: {low} {high}");
        assert_eq!(nodal(NodalMean::new(&mesh, 1).bounded()), [250.0, 400.0]);
    }

    #[test]
    fn a_node_in_no_cell_has_no_value_and_a_wrong_count_is_refused() {
        let kind = ALL.iter().find(|kind| kind.name == "quad4").unwrap();
        let mut mesh = single(kind);
        mesh.points.push(asperity_core::tensor::Vec3::zero());
        let mut mean = NodalMean::new(&mesh, 1);
        assert!(mean.add(0, kind.full, &[1.0], |_| true).is_err());
        mean.add(0, kind.full, &[1.0; 4], |_| true).unwrap();
        let nodal = mean.finish();
        assert!(nodal[4].is_nan() && nodal[..4].iter().all(|x| (x - 1.0).abs() < 1e-12));
    }
}
