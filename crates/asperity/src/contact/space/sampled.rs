//! Penetration between the contact points in space.

use super::pair::Contact;
use super::target::{Cast, Memory};
use crate::contact::sampled::{Sample, admitted, is_sampled};
use crate::system::History;

/// Where a face with four sides is sampled, and one with three: in the middle and just within the corners.
const QUADRILATERAL: [[f64; 2]; 5] = [[0.0, 0.0], [-0.98, -0.98], [0.98, -0.98], [0.98, 0.98], [-0.98, 0.98]];
const TRIANGLE: [[f64; 2]; 4] = [[1.0 / 3.0, 1.0 / 3.0], [0.01, 0.01], [0.98, 0.01], [0.01, 0.98]];

impl Contact {
    /// The deepest place of the surface in an accepted state, sought along rays between its points; none without penetration.
    pub fn sampled(&self, u: &[f64], history: &History) -> Option<Sample> {
        let (surface, depths) = (self.surface(), self.depths(u));
        let (standing, mut memory) = (self.target().stand(u), Memory::default());
        let mut sample = |face: usize, xi: [f64; 2]| {
            let index = surface.points_of(face).next()?;
            let ray = self.ray(&surface.moved(index, xi, 1.0), u);
            let hit = standing.cast(&Cast { ray, ..self.bounds(index, depths[index], f64::INFINITY) }, &mut memory)?;
            let penetration = hit.u - admitted(history.slot(index));
            (penetration > 0.0).then_some(Sample { penetration, edge: face, position: ray.origin })
        };
        let mut deepest: Option<Sample> = None;
        for (number, face) in surface.faces.iter().enumerate() {
            if !is_sampled(self.target().deforms(), history, surface.points_of(number)) {
                continue;
            }
            let places = if face.nodes.len() % 3 == 0 && face.nodes.len() < 9 { &TRIANGLE[..] } else { &QUADRILATERAL };
            for found in places.iter().filter_map(|&xi| sample(number, xi)) {
                deepest = Some(deepest.map_or(found, |old| old.deeper(found)));
            }
        }
        deepest
    }
}
