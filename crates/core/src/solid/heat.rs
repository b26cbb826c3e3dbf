//! Thermal strain: a prescribed temperature stretches a body alike in all directions, by `1 + alpha T` against its size
//! at the reference temperature. The law sees the rest of the deformation, `f (1 + alpha T_n)/(1 + alpha T_n+1)`, and the temperature.
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
    /// Temperatures over an increment.
    ///
    /// # Errors
    /// A [`Failure`] where nothing of the body would be left.
    pub(super) fn over(&self, at: Instant) -> Result<Warmth<'_>, Failure> {
        let (begun, courses) = (at.step_time - at.dt, &self.temperature.courses);
        let over = |course: &Timeline| [begun, at.step_time].map(|time| course.value(at.step, time));
        let warmth =
            Warmth { expansion: self.expansion, courses: courses.iter().map(over).collect(), of: &self.temperature.of };
        if warmth.courses.iter().all(|&[_, now]| warmth.stretch(now) > 0.0) {
            Ok(warmth)
        } else {
            Err(Failure::new("the cold leaves nothing of the body"))
        }
    }
}

/// Temperatures at the beginning and at the end of an increment, by the nodes.
pub(super) struct Warmth<'a> {
    expansion: f64,
    courses: Vec<[f64; 2]>,
    of: &'a [usize],
}

impl Warmth<'_> {
    /// At a point, by the nodes of its cell and their weights there.
    fn at(&self, nodes: &[usize], weights: &[f64]) -> [f64; 2] {
        let of = |time: usize| {
            nodes.iter().zip(weights).map(|(&node, weight)| self.courses[self.of[node]][time] * weight).sum()
        };
        [of(0), of(1)]
    }

    /// What a temperature stretches.
    pub(super) fn stretch(&self, temperature: f64) -> f64 {
        1.0 + self.expansion * temperature
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
    /// Terms of the temperatures of a cell with F-bar whose nodes have temperatures of their own.
    pub(super) fn shared_warmth(&self, index: usize) -> Option<[Functions; 2]> {
        let warmth = self.warmth.as_ref().filter(|warmth| !warmth.of.is_empty())?;
        let mut terms = [Functions::default(); 2];
        for &member in self.body.patches.members(index) {
            let nodes = self.nodes(member);
            let points = &self.body.shapes(self.body.kind(member)).warmth;
            for (weights, place) in points.iter().zip(self.body.places.cell(member)) {
                for (terms, at) in terms.iter_mut().zip(warmth.at(nodes, weights)) {
                    terms.iter_mut().zip(place.functions).for_each(|(term, phi)| *term += place.volume * at * phi);
                }
            }
        }
        Some(terms)
    }

    /// Temperatures over the increment at a point of a cell, and the thermal stretch at its end, where the body has a temperature.
    pub(super) fn warmth_at(
        &self,
        (index, point): (usize, usize),
        shared: Option<&[Functions; 2]>,
    ) -> Option<([f64; 2], f64)> {
        let warmth = self.warmth.as_ref()?;
        let at = if warmth.of.is_empty() {
            *warmth.courses.first()?
        } else if let Some(terms) = shared {
            [0, 1].map(|time| value(&terms[time], &self.body.places.cell(index)[point].functions))
        } else {
            warmth.at(self.nodes(index), &self.body.shapes(self.body.kind(index)).warmth[point])
        };
        Some((at, warmth.stretch(at[1])))
    }
}
