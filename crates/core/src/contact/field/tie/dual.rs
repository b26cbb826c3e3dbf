//! Functions of a face that are biorthogonal to those of its nodes, on the part of it that has something opposite.

use super::places::TiePlace;
use crate::contact::field::face::MOST;
use crate::mesh::cells::Cell;
use crate::tensor::inverse;

/// The part of the functions between two corners that those of the corners take.
const ALPHA: f64 = 0.2;
/// A part of a face so small, over what its points are spread over, has no functions of its own.
const SINGULAR: f64 = 1e-12;

/// The functions `N~` of a face, made of its shape functions.
#[derive(Debug, Clone)]
pub struct FaceBasis {
    /// Nodes in the middle of an edge, each with the corners at its ends.
    middles: Vec<(usize, [usize; 2])>,
    /// The part that corners take.
    pub alpha: f64,
}

/// Those of a kind of face. Where all shape functions have positive means they stay what they are; the radius may spoil that on
/// edges of second degree.
pub fn basis(kind: &Cell) -> FaceBasis {
    let changes = matches!(kind.nodes.len(), 3 | 6 | 8) && kind.degree > 1;
    let corners = kind.linear.nodes.len();
    let middle = |k: usize| {
        let pairs = (0..corners).flat_map(|a| (0..a).map(move |b| [b, a]));
        let halfway =
            |[a, b]: &[usize; 2]| (0..3).all(|i| (kind.nodes[*a][i] + kind.nodes[*b][i]) * 0.5 == kind.nodes[k][i]);
        pairs.into_iter().find(halfway).map(|ends| (k, ends))
    };
    let middles = (corners..kind.nodes.len()).filter(|_| changes).filter_map(middle).collect();
    FaceBasis { middles, alpha: ALPHA }
}

impl FaceBasis {
    /// The corners between which a node lies.
    pub fn between(&self, node: usize) -> Option<[usize; 2]> {
        self.middles.iter().find(|(middle, _)| *middle == node).map(|(_, ends)| *ends)
    }

    /// Values of the functions where the shape functions have the values `n`.
    pub fn values(&self, n: &[f64]) -> Vec<f64> {
        let mut values = n.to_vec();
        for &(middle, ends) in &self.middles {
            ends.iter().for_each(|&end| values[end] += self.alpha * n[middle]);
            values[middle] = (1.0 - 2.0 * self.alpha) * n[middle];
        }
        values
    }
}

/// The functions of a face and their duals.
#[derive(Debug, Clone)]
pub struct DualBasis {
    /// The functions.
    pub basis: FaceBasis,
    /// Their integrals; none where nothing lies opposite.
    pub weights: Vec<f64>,
    /// `psi_i = sum_k factors[i][k] N~_k`.
    factors: Vec<Vec<f64>>,
}

impl DualBasis {
    /// Over the places of a face: `D M^-1` with `M = int N~ N~^t dA` and `D` its sums.
    pub fn new(kind: &Cell, places: &[TiePlace]) -> Self {
        let (basis, count) = (basis(kind), kind.nodes.len().min(MOST));
        let (mut mass, mut weights) = (vec![vec![0.0; count]; count], vec![0.0; count]);
        for place in places {
            let n = basis.values(&place.shape.n[..count]);
            for i in 0..count {
                weights[i] += place.area * n[i];
                (0..count).for_each(|j| mass[i][j] += place.area * n[i] * n[j]);
            }
        }
        match inverse(mass, SINGULAR) {
            Some(inverse) => {
                let factors =
                    inverse.iter().zip(&weights).map(|(row, w)| row.iter().map(|x| x * w).collect()).collect();
                Self { basis, weights, factors }
            }
            None => Self { basis, weights: Vec::new(), factors: Vec::new() },
        }
    }

    /// Values of the duals where the shape functions have the values `n`.
    pub fn values(&self, n: &[f64]) -> Vec<f64> {
        let n = self.basis.values(n);
        self.factors.iter().map(|row| row.iter().zip(&n).map(|(a, n)| a * n).sum()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::cells::{LINE2, LINE3, QUAD4, QUAD8, QUAD9, TRI3, TRI6};

    /// Functions of a face sum to one and have positive means where they are to be dual.
    #[test]
    fn functions_of_all_faces_have_positive_means() {
        for kind in [&LINE2, &LINE3, &TRI3, &TRI6, &QUAD4, &QUAD8, &QUAD9] {
            let (basis, rule) = (basis(kind), kind.gauss[2].unwrap());
            let mut means = vec![0.0; kind.nodes.len()];
            for (xi, weight) in rule.points.iter().zip(rule.weights) {
                let (mut n, mut dn) = (vec![0.0; means.len()], vec![[0.0; 3]; means.len()]);
                (kind.shape)(*xi, &mut n, &mut dn);
                let values = basis.values(&n);
                assert!((values.iter().sum::<f64>() - 1.0).abs() < 1e-14);
                means.iter_mut().zip(values).for_each(|(mean, value)| *mean += weight * value);
            }
            assert!(means.iter().all(|&mean| mean > 1e-3), "{}: {means:?}", kind.name);
        }
    }
}
