//! Thermal strain: a prescribed temperature stretches a body alike in all directions, by `1 + alpha T` against its size
//! at the reference temperature. The law sees the rest of the deformation, `f (1 + alpha T_n)/(1 + alpha T_n+1)`.
//!
//! Where nodes have temperatures of their own, that of a point has the degree of the strain that its cell can have: the mean of
//! its corners in cells of first degree, linear between the corners in those of second; with reduced integration all nodes count, since
//! its points are where a quadratic field has the values of the nearest linear one. With F-bar it has the terms of the
//! shared change of volume. Strain that follows from it alone is then without stress in regular cells.

use super::Integration;
use super::attempt::OpenBody;
use super::volume::{Functions, value};
use crate::Failure;
use crate::amplitude::Timeline;
use crate::mesh::cells::{Cell, MAX_NODES};
use crate::system::Instant;

/// The temperature of a body and what it does to its size.
#[derive(Debug, Clone, PartialEq)]
pub struct Heat {
    /// Linear expansion for a unit of temperature.
    pub expansion: f64,
    /// Temperature above that at which the undeformed body is free of stress.
    pub temperature: Temperature,
}

/// The temperature of the nodes of a body in time.
#[derive(Debug, Clone, PartialEq)]
pub struct Temperature {
    courses: Vec<Timeline>,
    /// The number of the course of each node of the mesh; empty where all have the first.
    of: Vec<usize>,
}

impl Temperature {
    /// One for the whole body.
    pub fn uniform(course: Timeline) -> Self {
        Self { courses: vec![course], of: vec![] }
    }

    /// One of these courses for each node of the mesh, by its number.
    pub fn of_nodes(courses: Vec<Timeline>, of: Vec<usize>) -> Self {
        Self { courses, of }
    }
}

impl Heat {
    /// Thermal stretches at an instant.
    ///
    /// # Errors
    /// A [`Failure`] where nothing of the body would be left.
    pub(super) fn stretch(&self, at: Instant) -> Result<Stretch<'_>, Failure> {
        let stretch = |course: &Timeline| 1.0 + self.expansion * course.value(at.step, at.step_time);
        let courses: Vec<f64> = self.temperature.courses.iter().map(stretch).collect();
        if courses.iter().all(|&stretch| stretch > 0.0) {
            Ok(Stretch { courses, of: &self.temperature.of })
        } else {
            Err(Failure::new("the cold leaves nothing of the body"))
        }
    }
}

/// Thermal stretches at an instant, by the nodes.
pub(super) struct Stretch<'a> {
    courses: Vec<f64>,
    of: &'a [usize],
}

impl Stretch<'_> {
    /// At a point, by the nodes of its cell and their weights there.
    fn at(&self, nodes: &[usize], weights: &[f64]) -> f64 {
        nodes.iter().zip(weights).map(|(&node, weight)| self.courses[self.of[node]] * weight).sum()
    }
}

/// Weights of the first nodes of a cell at a place, so that the temperature has the degree of the strain that the cell can have: the
/// mean in first degree without incompatible modes.
pub(super) fn weights(kind: &Cell, xi: [f64; 3], integration: Integration, modes: usize) -> Vec<f64> {
    let (count, reduced) = (kind.linear.nodes.len(), integration == Integration::Reduced);
    if kind.degree == 1 && modes == 0 {
        return vec![(count as f64).recip(); count];
    }
    let kind = if reduced { kind } else { kind.linear };
    let (mut n, mut dn, count) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES], kind.nodes.len());
    (kind.shape)(xi, &mut n[..count], &mut dn[..count]);
    n[..count].to_vec()
}

impl OpenBody<'_> {
    /// Terms of the thermal stretch of a cell with F-bar whose nodes have stretches of their own.
    pub(super) fn shared_stretch(&self, index: usize) -> Option<Functions> {
        let stretch = self.stretch.as_ref().filter(|stretch| !stretch.of.is_empty())?;
        let mut terms = Functions::default();
        for &member in self.body.patches.members(index) {
            let nodes = self.nodes(member);
            let points = &self.body.shapes(self.body.kind(member)).warmth;
            for (weights, place) in points.iter().zip(self.body.places.cell(member)) {
                let weight = place.volume * stretch.at(nodes, weights);
                terms.iter_mut().zip(place.functions).for_each(|(term, phi)| *term += weight * phi);
            }
        }
        Some(terms)
    }

    /// Thermal stretch at a point of a cell, where the body has a temperature.
    pub(super) fn stretch_at(&self, (index, point): (usize, usize), shared: Option<&Functions>) -> Option<f64> {
        let stretch = self.stretch.as_ref()?;
        if stretch.of.is_empty() {
            return stretch.courses.first().copied();
        }
        Some(match shared {
            Some(terms) => value(terms, &self.body.places.cell(index)[point].functions),
            None => stretch.at(self.nodes(index), &self.body.shapes(self.body.kind(index)).warmth[point]),
        })
    }
}
