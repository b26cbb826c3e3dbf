//! Friction by a pressure that is a mean over the neighbourhood of a point (Oden and Pires, J. Appl. Mech. 50, 1983), with
//! a tool: `S = sum_j w_j A_j p_j / sum_j w_j A_j`, `w = exp(1 / ((r / rho)^2 - 1))` within the radius `rho`
//! on the undeformed surface.
//!
//! The pressures `p_j = K_p <u_j>` are those at the trial displacements, never those of the last iterate: a point casts
//! the rays of its neighbours too, their nodes are unknowns of its stencil behind its own, and the derivatives of the
//! mean along them are in the tangent. Its own pressure and the place of its forces stay local.

use super::geometry::Geometry;
use super::open::OpenContact;
use super::pair::Contact;
use super::point::triad;
use super::target::{Cast, Memory};
use crate::Failure;
use crate::interface::{Interface, Linearised, Past};
use crate::system::Local;
use crate::tensor::Vec3;
use crate::tool::Ray;
use std::ops::Range;

/// The points around each point of a surface.
#[derive(Debug, Clone, Default)]
pub struct Neighbours {
    /// For each point its neighbours, itself among them, and their parts of the mean.
    parts: Vec<Vec<(usize, f64)>>,
    /// For each point the other edges or faces on which they lie.
    others: Vec<Vec<usize>>,
}

/// A mean pressure and its derivatives along all unknowns of a stencil.
pub struct Mean {
    /// The mean.
    pub pressure: f64,
    /// Its derivatives.
    pub slopes: Vec<f64>,
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

impl Contact {
    /// Appends the unknowns of the edges around a point.
    pub(super) fn unknowns_around(&self, index: usize, out: &mut Vec<usize>) {
        for &edge in self.neighbours.others(index) {
            let around = self.around.get(edge).map_or(&[][..], |around| &around.nodes);
            let nodes = self.surface.edges[edge].nodes.iter().chain(around);
            out.extend(nodes.flat_map(|&node| [0, 1].map(|axis| self.dofs.node(node) + axis)));
        }
    }
}

impl OpenContact<'_> {
    /// The mean pressure around a point for values `u` of its unknowns; none where friction is local.
    pub(super) fn mean_pressure(&self, index: usize, g: &Geometry, u: &[f64]) -> Option<Mean> {
        let parts = self.contact.neighbours.of(index)?;
        let mut mean = Mean { pressure: 0.0, slopes: vec![0.0; u.len()] };
        let mut memory = Memory::default();
        for &(point, part) in parts {
            let nodes = self.nodes_of(index, point, g);
            self.add_pressure((point, part), (nodes, g.layout.hit.clone()), u, (&mut mean, &mut memory));
        }
        Some(mean)
    }

    /// Where the unknowns of a neighbour's nodes, and of the nodes around its edge, stand in the stencil of a point.
    fn nodes_of(&self, index: usize, neighbour: usize, g: &Geometry) -> [Range<usize>; 2] {
        let (surface, mut start) = (&self.contact.surface, g.layout.count());
        let edge = surface.points[neighbour].edge;
        if edge == surface.points[index].edge {
            return [0..g.layout.own, g.layout.around.clone()];
        }
        for &other in self.contact.neighbours.others(index) {
            let middle = start + 2 * surface.edges[other].nodes.len();
            let end = middle + self.contact.around.get(other).map_or(0, |around| 2 * around.nodes.len());
            if other == edge {
                return [start..middle, middle..end];
            }
            start = end;
        }
        [start..start, start..start]
    }

    /// Adds what one neighbour gives to the mean.
    fn add_pressure(
        &self,
        (point, part): (usize, f64),
        ([own, around], tool): ([Range<usize>; 2], Range<usize>),
        u: &[f64],
        (mean, memory): (&mut Mean, &mut Memory),
    ) {
        let (contact, spot) = (self.contact, &self.contact.surface.points[point]);
        let Some(rigid) = contact.target.as_tool() else { return };
        let placed = contact.placed_locally(spot.edge, &u[own.clone()], &u[around.clone()]);
        let (a, tangent) = placed.stand(spot);
        let (along, inward, length) = triad(tangent);
        let motion = &u[tool.clone()];
        let cast =
            Cast { ray: Ray { origin: a, direction: inward }, ..contact.bounds(point, self.depths[point], self.reach) };
        let Some(hit) = rigid.standing(motion).cast(&cast, memory) else { return };
        let seen = hit.u + self.closure(point) - contact.least;
        if seen <= 0.0 {
            return;
        }
        let (stiffness, cosine) = (part * contact.options.penalty, hit.normal.dot(inward));
        mean.pressure += stiffness * seen;
        for (k, column) in own.clone().enumerate() {
            mean.slopes[column] -= stiffness * hit.normal[k % 2] * spot.n[k / 2] / cosine;
        }
        for (column, turning) in own.chain(around).zip(placed.turning(spot)) {
            let turned = along * (-inward.dot(turning) / length);
            mean.slopes[column] -= stiffness * hit.normal.dot(turned) * hit.u / cosine;
        }
        for (rate, column) in rigid.rates(motion, a + inward * hit.u).iter().zip(tool) {
            mean.slopes[column] += stiffness * hit.normal.dot(*rate) / cosine;
        }
    }

    /// Adds to the tangent what the mean pressure does to the friction of a point, `slope` the derivative of its shear
    /// stress along the mean.
    pub(super) fn add_neighbours(&self, (g, slope): (&Geometry, f64), mean: &Mean, local: &mut Local) {
        let (contact, n) = (self.contact, local.force.len());
        let (along, _, _) = triad(g.place.tangent);
        let area = contact.area(&g.spot, g.place.a, g.place.tangent);
        let rows = self.rows::<f64>((g, &local.u), (g.place.b, g.place.b), along * area);
        for (i, row) in rows[..g.layout.count()].iter().enumerate() {
            for (entry, change) in local.tangent[i * n..(i + 1) * n].iter_mut().zip(&mean.slopes) {
                *entry += row * slope * change;
            }
        }
    }
}

/// The answer of a law, its friction that of the mean pressure `by` where there is one, and the derivatives of the two
/// shear stresses along that mean.
///
/// # Errors
/// As the law.
pub fn ask(
    (law, by): (&dyn Interface, Option<f64>),
    motion: [f64; 3],
    past: &Past,
    vars: &mut [f64],
) -> Result<(Linearised, [f64; 2]), Failure> {
    let local = law.respond(motion, past, vars)?;
    let Some(mean) = by else { return Ok((local, [0.0; 2])) };
    let mean = law.respond([mean / past.penalty, motion[1], motion[2]], past, vars)?;
    let ([_, s, t], [_, by_s, by_t]) = (mean.stress, mean.slopes);
    // The mean does not follow the penetration of the point alone.
    let fixed = |slopes: [f64; 3]| [0.0, slopes[1], slopes[2]];
    let (stress, slopes) = ([local.pressure(), s, t], [local.slopes[0], fixed(by_s), fixed(by_t)]);
    let response = Linearised { stress, slopes, closure: local.closure, ..mean };
    Ok((response, [by_s[0], by_t[0]].map(|slope| slope / past.penalty)))
}

/// The radius of a law, if it is not local.
pub fn radius(law: &dyn Interface) -> Option<f64> {
    Some(law.radius()).filter(|radius| *radius > 0.0)
}
