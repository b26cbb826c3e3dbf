//! The Gauss points around each point, with the weights of a mean over them.

use crate::tensor::Vec3;

/// The points around each point of a surface.
#[derive(Debug, Clone, Default)]
pub struct Neighbours {
    /// For each point its neighbours, itself among them, and their parts of the mean.
    parts: Vec<Vec<(usize, f64)>>,
    /// For each point the other edges or faces on which they lie.
    others: Vec<Vec<usize>>,
}

impl Neighbours {
    /// Within `radius` of points with these places on the undeformed surface, each on one of its edges or faces.
    pub fn new(places: &[Vec3], on: impl Fn(usize) -> usize, radius: f64, area: impl Fn(usize) -> f64) -> Self {
        let weight = |i: usize, j: usize| {
            let part = ((places[i] - places[j]).norm() / radius).powi(2);
            if part < 1.0 { (1.0 / (part - 1.0)).exp() * area(j) } else { 0.0 }
        };
        let mut neighbours = Self::default();
        for i in 0..places.len() {
            let near: Vec<_> = (0..places.len()).map(|j| (j, weight(i, j))).filter(|(_, w)| *w > 0.0).collect();
            let sum: f64 = near.iter().map(|(_, w)| w).sum();
            let mut others: Vec<usize> = near.iter().map(|&(j, _)| on(j)).filter(|&other| other != on(i)).collect();
            others.dedup();
            neighbours.parts.push(near.into_iter().map(|(j, w)| (j, w / sum)).collect());
            neighbours.others.push(others);
        }
        neighbours
    }

    /// Whether there are any.
    pub fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    /// The neighbours of a point and their parts of the mean; none where friction is local.
    pub fn of(&self, point: usize) -> Option<&[(usize, f64)]> {
        self.parts.get(point).map(Vec::as_slice)
    }

    /// The edges or faces of a point's neighbours, but for its own.
    pub fn others(&self, point: usize) -> &[usize] {
        self.others.get(point).map_or(&[], Vec::as_slice)
    }
}
