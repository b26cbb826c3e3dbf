//! How the unknowns of a stencil follow from those in their place.

use super::{Arm, Following};
use crate::system::Local;
use crate::tensor::Vec3;

/// Where an unknown of a stencil comes from.
#[derive(Debug, Clone, Copy)]
pub enum Source {
    /// The unknown in this place.
    Own(usize),
    /// This node and axis.
    Led(usize, usize),
}

/// How the unknowns of a stencil follow from those in their place.
#[derive(Debug, Clone, Default)]
pub struct Map {
    /// Where each unknown comes from.
    pub sources: Vec<Source>,
    /// Nodes that follow: place of their leader's first unknown, and their arms.
    pub nodes: Vec<(usize, Arm)>,
}

/// Rates of the unknowns of a stencil along those in their place, a few for each.
pub type Rates = Vec<Vec<(usize, f64)>>;

impl Map {
    /// The unknowns of the stencil, and their rates.
    pub fn lead(&self, following: &Following, u: &[f64]) -> (Vec<f64>, Rates) {
        let (unknowns, turns) = (following.unknowns(), following.turns());
        let moved: Vec<_> = self
            .nodes
            .iter()
            .map(|&(slot, ref arm)| {
                let q = &u[slot..slot + unknowns];
                (following.moved(arm, q), following.turned(arm, q, Vec3::zero())[0])
            })
            .collect();
        let rates = |source: &Source| match *source {
            Source::Own(place) => (u[place], vec![(place, 1.0)]),
            Source::Led(node, axis) => {
                let (slot, (to, turned)) = (self.nodes[node].0, &moved[node]);
                let turn = |(k, component): (usize, usize)| (slot + following.per_node + k, turned[axis].du[component]);
                let all = std::iter::once((slot + axis, 1.0)).chain(turns.clone().enumerate().map(turn));
                (to[axis], all.collect())
            }
        };
        self.sources.iter().map(rates).unzip()
    }

    /// Forces on the unknowns in place from those of the stencil, in `own`, and their tangent.
    pub fn pull(&self, following: &Following, (own, rates): (&Local, &Rates), local: &mut Local) {
        let (count, n) = (self.sources.len(), local.u.len());
        for (force, rates) in own.force.iter().zip(rates) {
            rates.iter().for_each(|&(place, rate)| local.force[place] += rate * force);
        }
        if !local.wants_tangent {
            return;
        }
        for (k, rows) in rates.iter().enumerate() {
            for (l, columns) in rates.iter().enumerate() {
                let value = own.tangent[k * count + l];
                for &(i, ci) in rows {
                    columns.iter().for_each(|&(j, cj)| local.tangent[i * n + j] += ci * cj * value);
                }
            }
        }
        for (number, &(slot, ref arm)) in self.nodes.iter().enumerate() {
            let mut force = Vec3::zero();
            for (source, value) in self.sources.iter().zip(&own.force) {
                if let Source::Led(node, axis) = source
                    && *node == number
                {
                    force[*axis] += value;
                }
            }
            let [_, moment] = following.turned(arm, &local.u[slot..slot + following.unknowns()], force);
            let first = slot + following.per_node;
            for (i, a) in following.turns().enumerate() {
                for (j, b) in following.turns().enumerate() {
                    local.tangent[(first + i) * n + first + j] += moment[a].du[b];
                }
            }
        }
    }
}
