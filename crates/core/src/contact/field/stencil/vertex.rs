//! A vertex where the surface ends in space, as at an edge of a body: node to segment beside the mortar field
//! (Farah, Wall & Popp, Int. J. Numer. Meth. Eng. 114, 2018).
//!
//! The gap of a node is a mean over its faces: a sharp edge lies in the other body by as much as these stand off beside it. Where the vertex
//! lies deeper than the mean it takes a share of what the node stands for. Both have the stresses of the node, so that friction keeps its
//! law and the law of the interface is asked once.

use super::{COUNT, NodePoint, NodeSums};
use crate::contact::field::point::smoothstep;

/// How much deeper than the mean of its node a vertex lies, over the size of its faces, where it begins to bear and where it bears all: a
/// block that is pressed and slides flat has less than the first, the audit lets bodies lie in each other by the second.
const DEEPER: [f64; 2] = [0.04, 0.12];

/// The vertex among the points of a node, with derivatives along each unknown.
#[derive(Debug, Default)]
pub struct VertexShare {
    /// Its share of the area of the node.
    pub share: f64,
    /// Derivatives of the share, and of that area.
    slopes: [Vec<f64>; 2],
    /// Forces of a unit of each stress on each unknown that come with a unit of either.
    pub forces: [Vec<f64>; 2],
    /// Derivatives of penetration and slips at the vertex.
    own: Vec<f64>,
}

impl VertexShare {
    /// Adds what the share and the area do to the tangent under stresses `t`.
    pub fn add_slopes(&self, t: [f64; COUNT], tangent: &mut [f64]) {
        for (forces, slopes) in self.forces.iter().zip(&self.slopes) {
            let n = slopes.len();
            for row in 0..n {
                let force: f64 = (0..COUNT).map(|c| t[c] * forces[c * n + row]).sum();
                tangent[row * n..(row + 1) * n].iter_mut().zip(slopes).for_each(|(to, slope)| *to += force * slope);
            }
        }
    }
}

impl NodeSums {
    /// Gives the vertex of a node whose faces have this `size`, less where a part of its functions is dual, its share where it lies deeper
    /// than the mean; of a flat face under a uniform pressure it has none. `count` unknowns, if derivatives are asked for.
    pub fn press_vertex(&mut self, size: f64, count: Option<usize>) {
        let Some(vertex) = self.vertex else { return };
        let NodePoint { of: (patch, k), slip, .. } = self.points[vertex];
        let point = self.patches[patch].points[k];
        let beside = [-point.gap - self.y[0], slip[0] - self.y[1], slip[1] - self.y[2]];
        let width = (DEEPER[1] - DEEPER[0]) * size;
        let [share, slope] = smoothstep((beside[0] - DEEPER[0] * size) / width);
        if share == 0.0 {
            self.vertex = None;
            return;
        }
        if let Some(n) = count {
            self.find_vertex_gradients((vertex, share), n);
            let Self { gradients, held, .. } = self;
            held.slopes[0].extend((0..n).map(|j| slope / width * (held.own[j] - gradients[j])));
            for (k, (gradient, own)) in gradients.iter_mut().zip(&held.own).enumerate() {
                *gradient += share * (own - *gradient) + beside[k / n] * held.slopes[0][k % n];
            }
        }
        (0..COUNT).for_each(|c| self.y[c] += share * beside[c]);
        self.place += (point.y - point.n * point.gap - self.place) * share;
        self.held.share = share;
        self.points.iter_mut().for_each(|point| point.weight *= 1.0 - share);
        (self.points[vertex].weight, self.points[vertex].shift) = (self.area * share, self.area);
    }

    /// Derivatives at the vertex and of the area; those of the weights of the other points shrink with their part.
    fn find_vertex_gradients(&mut self, (vertex, share): (usize, f64), n: usize) {
        let Self { patches, points, rates, columns, starts, held, .. } = self;
        let (own, [slopes, areas]) = (&mut held.own, &mut held.slopes);
        slopes.clear();
        for (values, count) in [(&mut *own, COUNT * n), (&mut *areas, n)] {
            values.clear();
            values.resize(count, 0.0);
        }
        let mut rest = &mut rates[..];
        for (number, NodePoint { of: (patch, k), .. }) in points.iter().enumerate() {
            let columns = &columns[starts[*patch]..starts[*patch + 1]];
            let (of_node, others) = rest.split_at_mut(columns.len());
            rest = others;
            let of_point = patches[*patch].rates(*k);
            for (i, (node, &j)) in of_node.iter_mut().zip(columns).enumerate() {
                areas[j] += node.weight;
                node.weight *= 1.0 - share;
                if number == vertex {
                    let slopes = node.slopes(of_point.get(i));
                    (0..COUNT).for_each(|c| own[c * n + j] += slopes[c]);
                }
            }
        }
    }
}
