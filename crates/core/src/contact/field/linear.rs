//! What the evaluation of a node leaves for the kinks of the same iteration.

use super::stencil::{COUNT, NodeSums};
use crate::system::Kinks;

/// Coordinates of a node at its unknowns `u`, with their gradients and the forces of a unit of each stress.
#[derive(Debug, Default)]
pub struct Linear {
    /// Unknowns at which it holds; none where it holds nowhere.
    pub u: Vec<f64>,
    y: [f64; COUNT],
    gradients: Vec<f64>,
    forces: Vec<f64>,
}

impl Linear {
    /// Keeps the sums of a node and the forces of a unit of each stress over undeformed area.
    pub fn keep(&mut self, u: &[f64], y: [f64; COUNT], stretch: f64, sums: &NodeSums) {
        self.y = y;
        let kept = [&mut self.u, &mut self.gradients, &mut self.forces];
        for (kept, new) in kept.into_iter().zip([u, &sums.gradients, &sums.forces]) {
            kept.clear();
            kept.extend_from_slice(new);
        }
        self.forces.iter_mut().for_each(|force| *force *= stretch);
    }

    /// Tells the kinks of the iteration.
    pub fn tell(&self, coordinates: usize, out: &mut Kinks) {
        let n = self.u.len();
        for (c, &y) in self.y.iter().enumerate().take(coordinates) {
            let range = c * n..(c + 1) * n;
            out.coordinate(y, self.gradients[range.clone()].iter().copied(), self.forces[range].iter().copied());
        }
    }
}
