//! Friction by a mean pressure on faces in space, with a tool: as in the plane (`contact::nonlocal`), with two tangents.

use super::geometry::Geometry;
use super::open::OpenContact;
use super::pair::Contact;
use super::point::Triad;
use super::rigid;
use super::target::{Cast, Memory, Standing};
use crate::contact::nonlocal::Mean;
use crate::system::Local;
use crate::tool::Ray;
use std::ops::Range;

impl Contact {
    /// Appends the unknowns of the faces around a point.
    pub(super) fn unknowns_around(&self, index: usize, out: &mut Vec<usize>) {
        for &face in self.neighbours.others(index) {
            let nodes = self.parts.surface.faces[face].nodes.iter().chain(self.nodes_around(face));
            out.extend(nodes.flat_map(|&node| [0, 1, 2].map(|axis| self.parts.dofs.node(node) + axis)));
        }
    }
}

impl OpenContact<'_> {
    /// The mean pressure around a point for values `u` of its unknowns; none where friction is local.
    pub(super) fn mean_pressure(&self, index: usize, g: &Geometry, u: &[f64]) -> Option<Mean> {
        let (parts, rigid) = (self.contact.neighbours.of(index)?, self.contact.parts.target.as_tool()?);
        let mut mean = Mean { pressure: 0.0, slopes: vec![0.0; u.len()] };
        let (tool, mut memory) = (g.layout.hit.clone(), Memory::default());
        let standing = Standing::Tool(rigid, rigid::pose(&u[tool.clone()]));
        for &(point, part) in parts {
            let nodes = self.nodes_of(index, point, g);
            self.add_pressure((point, part), (nodes, tool.clone()), u, (&standing, &mut mean, &mut memory));
        }
        Some(mean)
    }

    /// Where the unknowns of a neighbour's nodes, and of the nodes around its face, stand in the stencil of a point.
    fn nodes_of(&self, index: usize, neighbour: usize, g: &Geometry) -> [Range<usize>; 2] {
        let (surface, mut start) = (&self.contact.parts.surface, g.layout.count());
        let face = surface.points[neighbour].face;
        if face == surface.points[index].face {
            return [0..g.layout.own, g.layout.around.clone()];
        }
        for &other in self.contact.neighbours.others(index) {
            let middle = start + 3 * surface.faces[other].nodes.len();
            let end = middle + 3 * self.contact.nodes_around(other).len();
            if other == face {
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
        (standing, mean, memory): (&Standing, &mut Mean, &mut Memory),
    ) {
        let (contact, parts) = (self.contact, &self.contact.parts);
        let spot = &parts.surface.points[point];
        let placed = contact.placed_locally(spot.face, &u[own.clone()], &u[around.clone()]);
        let (a, tangents) = placed.stand(spot);
        let inward = Triad::new(tangents).inward;
        let ray = Ray { origin: a, direction: inward };
        let cast = Cast { ray, ..contact.bounds(point, self.depths[point], self.reach) };
        let Some(hit) = standing.cast(&cast, memory) else { return };
        let seen = hit.u + self.closure(point) - contact.least;
        if seen <= 0.0 {
            return;
        }
        let (stiffness, cosine) = (part * parts.options.penalty, hit.normal.dot(inward));
        mean.pressure += stiffness * seen;
        for (k, column) in own.clone().enumerate() {
            mean.slopes[column] -= stiffness * hit.normal[k % 3] * spot.n[k / 3] / cosine;
        }
        for (column, turned) in own.chain(around).zip(placed.normal_rates(spot)) {
            mean.slopes[column] -= stiffness * hit.normal.dot(turned) * hit.u / cosine;
        }
        let rates = parts.target.rates(hit.facet, hit.s, &u[tool.clone()], a + inward * hit.u);
        for (rate, column) in rates.iter().zip(tool) {
            mean.slopes[column] += stiffness * hit.normal.dot(*rate) / cosine;
        }
    }

    /// Adds to the tangent what the mean pressure does to the friction of a point, `s` and `t` the derivatives of its
    /// shear stresses along the mean.
    pub(super) fn add_neighbours(&self, (g, [s, t]): (&Geometry, [f64; 2]), mean: &Mean, local: &mut Local) {
        let n = local.force.len();
        let triad = Triad::new(g.place.tangents);
        let force = (triad.along[0] * s + triad.along[1] * t) * (triad.area * g.spot.weight);
        let rows = self.rows::<f64>((g, &local.u), (g.place.b, g.place.b), force);
        for (i, row) in rows[..g.layout.count()].iter().enumerate() {
            for (entry, change) in local.tangent[i * n..(i + 1) * n].iter_mut().zip(&mean.slopes) {
                *entry += row * change;
            }
        }
    }
}
