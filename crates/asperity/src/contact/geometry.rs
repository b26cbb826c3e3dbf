//! Where everything is at one contact point, which unknowns that depends on, and the chain rule from the eight
//! directions of the contact point to those unknowns.
//!
//! The unknowns of a stencil are those of its own nodes, of the segment it hits, of the segment touched at the last
//! accepted state where that is another one, of the vertices at which the target ends over its edge, and of the nodes
//! around it that turn its averaged normals.

use super::averaged::MAX_AROUND;
use super::before::Before;
use super::layout::Layout;
use super::open::OpenContact;
use super::options::Loads;
use super::placed::{End, Placed};
use super::point::{Closed, Place, triad};
use super::seed::Seed;
use super::surface::{MAX_EDGE_NODES, SurfacePoint};
use super::target::{Hit, MAX_UNKNOWNS};
use crate::Failure;
use crate::system::{Local, Stencil};
use crate::tensor::Vec3;
use crate::tool::Ray;

/// Most unknowns of a stencil.
pub const MAX_DOFS: usize = 2 * MAX_EDGE_NODES + 2 * MAX_UNKNOWNS + 4 + 2 * MAX_AROUND;
/// Directions in which a contact point is differentiated.
pub const DIRECTIONS: usize = 8;

/// Where everything is at one point, in plain numbers.
pub struct Geometry<'a> {
    /// Where the point stands on its edge.
    pub spot: SurfacePoint,
    /// Positions.
    pub place: Place<f64>,
    /// Where the target is hit.
    pub hit: Hit,
    /// What it touched at the last accepted state.
    pub before: Before,
    /// Which unknowns they depend on.
    pub layout: Layout,
    ends: [Option<End>; 2],
    /// Its edge.
    placed: Placed<'a>,
}

impl OpenContact<'_> {
    /// Appends the unknowns of a point, in the order of its [`Layout`].
    pub(super) fn unknowns(&self, index: usize, stencil: &Stencil, out: &mut Vec<usize>) {
        let contact = self.contact;
        let nodes = contact.surface.nodes(&contact.surface.points[index]);
        out.extend(nodes.iter().flat_map(|&node| [0, 1].map(|axis| contact.dofs.node(node) + axis)));
        let Some(segment) = (stencil.choice as usize).checked_sub(1) else { return };
        contact.target.unknowns(segment, out);
        match self.touched_segment(index, stencil) {
            Some(touched) if !contact.target.together(segment, touched) => contact.target.unknowns(touched, out),
            _ => {}
        }
        let ends = contact.target.as_faces().into_iter().flat_map(|faces| {
            stencil.also[..2].iter().filter(|&&vertex| vertex > 0).flat_map(|&vertex| faces.unknowns_of(vertex))
        });
        out.extend(ends);
        if let Some(around) = contact.around.get(contact.surface.points[index].edge) {
            out.extend(around.nodes.iter().flat_map(|&node| [0, 1].map(|axis| contact.dofs.node(node) + axis)));
        }
        contact.unknowns_around(index, out);
    }

    fn layout(&self, index: usize, stencil: &Stencil, segment: usize) -> Layout {
        let contact = self.contact;
        let own = 2 * contact.surface.nodes(&contact.surface.points[index]).len();
        let touched = self
            .touched_segment(index, stencil)
            .map(|touched| (!contact.target.together(segment, touched)).then(|| contact.target.count(touched)));
        let ends = [0, 1].map(|k| if stencil.also[k] > 0 { 2 } else { 0 });
        let around = contact.around.get(contact.surface.points[index].edge).map_or(0, |around| 2 * around.nodes.len());
        Layout::new(own, contact.target.count(segment), touched, ends, around)
    }

    /// Where everything is for values `u` of a stencil's unknowns; None where it hits nothing.
    pub(super) fn geometry(&self, index: usize, stencil: &Stencil, u: &[f64]) -> Result<Option<Geometry<'_>>, Failure> {
        let Some(segment) = (stencil.choice as usize).checked_sub(1) else { return Ok(None) };
        let (contact, layout) = (self.contact, self.layout(index, stencil, segment));
        let edge = contact.surface.points[index].edge;
        let placed = contact.placed_locally(edge, &u[..layout.own], &u[layout.around.clone()]);
        let ends = [0, 1].map(|k| self.end(stencil.also[k], &placed, layout.ends[k].clone().map(|range| &u[range])));
        let spot = contact.surface.moved(index, laid(&contact.surface.points[index], &ends));
        let (a, tangent) = placed.stand(&spot);
        if !placed.is_upright(&spot, tangent) {
            return Err(Failure::new(format!("{}: its averaged normal lies across its edge", contact.describe(index))));
        }
        let (_, inward, _) = triad(tangent);
        let lost = || Failure::new(format!("{}: its ray runs along the target", contact.describe(index)));
        let ray = Ray { origin: a, direction: inward };
        let hit = contact.target.meet(segment, &u[layout.hit.clone()], &ray, stencil.near).ok_or_else(lost)?;
        let before = self.before(index, stencil, &spot);
        let of_touched = before.touched.zip(layout.touched.clone());
        let touched = of_touched.map(|((segment, s), range)| contact.target.point(segment, s, &u[range]));
        let place = Place { a, tangent, b: a + inward * hit.u, touched };
        Ok(Some(Geometry { spot, place, hit, before, layout, ends, placed }))
    }

    fn end(&self, vertex: u32, placed: &Placed, u: Option<&[f64]>) -> Option<End> {
        Some(placed.foot(self.contact.target.as_faces()?.place_of(vertex, u?)))
    }

    /// What a force at a point does to each unknown of its stencil: `-N_L f` to its own nodes, and to the target its
    /// work along the target's rates, unless the target loads itself.
    pub(super) fn rows<T: Seed<DIRECTIONS>>(
        &self,
        (g, u): (&Geometry, &[f64]),
        (at, b): (Vec3<T>, Vec3<T>),
        force: Vec3<T>,
    ) -> [T; MAX_DOFS] {
        let (contact, mut rows) = (self.contact, [T::zero(); MAX_DOFS]);
        for (k, row) in rows[..g.layout.own].iter_mut().enumerate() {
            *row = -force[k % 2] * g.spot.n[k / 2];
        }
        if contact.options.loads == Loads::Both {
            let hit = g.layout.hit.clone();
            let received = contact.target.receive((&g.hit, &u[hit.clone()]), (at, b), force);
            rows[hit.clone()].copy_from_slice(&received[..hit.len()]);
        }
        rows
    }

    /// Adds the forces of a closed point and their derivatives by the chain rule.
    pub(super) fn add<T: Seed<DIRECTIONS>>(&self, g: &Geometry, closed: &Closed<T>, local: &mut Local) {
        let (n, count, b) = (local.force.len(), g.layout.count(), super::open::seed(g.place.b, 4));
        let forces = self.rows::<f64>((g, &local.u), (closed.hit.re(), g.place.b), closed.force);
        local.force.iter_mut().zip(&forces).for_each(|(force, row)| *force += row);
        if !local.wants_tangent {
            return;
        }
        let rows = self.rows((g, &local.u), (closed.hit, b), closed.linear);
        let columns = self.columns(g, &local.u);
        for (i, row) in rows[..count].iter().enumerate() {
            let slopes = row.slopes();
            for (entry, column) in local.tangent[i * n..].iter_mut().zip(&columns[..count]) {
                *entry += slopes.iter().zip(column).map(|(s, c)| s * c).sum::<f64>();
            }
        }
        self.add_fixed_rates(g, closed.linear.re(), local);
    }

    /// What the forces' own places on the nodes add: the shape functions move with the ends of the covered part, and the
    /// rates of a tool with its reference point.
    fn add_fixed_rates(&self, g: &Geometry, force: Vec3, local: &mut Local) {
        let n = local.force.len();
        if self.contact.options.loads == Loads::Both {
            let first = g.layout.hit.start;
            for (row, column, value) in self.contact.target.stiffen(force) {
                local.tangent[(first + row) * n + first + column] += value;
            }
        }
        let slope = g.spot.dn.map(|dn| dn / g.spot.half);
        self.each_end(g, |column, [shift, _]| {
            for k in 0..g.layout.own {
                local.tangent[k * n + column] -= force[k % 2] * slope[k / 2] * shift;
            }
        });
    }

    /// Derivatives of the eight directions along each unknown of the stencil.
    pub(super) fn columns(&self, g: &Geometry, u: &[f64]) -> [[f64; DIRECTIONS]; MAX_DOFS] {
        let (contact, mut columns) = (self.contact, [[0.0; DIRECTIONS]; MAX_DOFS]);
        for (k, column) in columns[..g.layout.own].iter_mut().enumerate() {
            column[k % 2] = g.spot.n[k / 2];
        }
        for (column, turning) in g.layout.field().zip(g.placed.turning(&g.spot)) {
            (columns[column][2], columns[column][3]) = (turning[0], turning[1]);
        }
        self.each_end(g, |column, [shift, stretch]| {
            let at = g.placed.frame(g.spot.xi);
            let tangent = at.bend * (g.spot.half * shift) + at.tangent * stretch;
            for (direction, change) in [(0, at.slope * shift), (2, tangent), (6, self.sliding(g, u) * shift)] {
                columns[column][direction] += change[0];
                columns[column][direction + 1] += change[1];
            }
        });
        if !contact.options.coupling {
            return columns;
        }
        let hit = g.layout.hit.clone();
        let rates = contact.target.rates(g.hit.segment, g.hit.s, &u[hit.clone()], g.place.b);
        spread(&mut columns[hit], &rates, 4);
        let touched = g.before.touched.zip(g.layout.touched.clone()).zip(g.place.touched);
        if let Some((((segment, s), range), at)) = touched {
            spread(&mut columns[range.clone()], &contact.target.rates(segment, s, &u[range], at), 6);
        }
        columns
    }

    /// Motion of the touched point as the point moves along its edge, and what of it makes up for the friction stress
    /// that was there: stress enters a law with the slip times the tangential penalty.
    fn sliding(&self, g: &Geometry, u: &[f64]) -> Vec3 {
        let (Some((segment, s)), Some(range)) = (g.before.touched, g.layout.touched.clone()) else {
            return Vec3::zero();
        };
        let Some(faces) = self.contact.target.as_faces() else { return Vec3::zero() };
        let (along, _, _) = triad(g.place.tangent);
        let stress = along * (g.before.shear_slope / self.tangential_penalty);
        faces.tangent(segment, s[0], &u[range]) * g.before.sliding + stress
    }

    /// For each unknown that moves an end of the covered part: how far the point moves along the edge, and by how much
    /// half of the part lengthens.
    fn each_end(&self, g: &Geometry, mut act: impl FnMut(usize, [f64; 2])) {
        let [left, right] = [0.5 * (1.0 - g.spot.rule), 0.5 * (1.0 + g.spot.rule)];
        for (k, (shift, stretch)) in [(left, -0.5), (right, 0.5)].into_iter().enumerate() {
            let Some((end, range)) = g.ends[k].as_ref().zip(g.layout.ends[k].clone()) else { continue };
            let own = g.layout.field().zip(end.own);
            let coupled = if self.contact.options.coupling { range } else { 0..0 };
            for (column, rate) in own.chain(coupled.zip(end.vertex)) {
                act(column, [shift * rate, stretch * rate]);
            }
        }
    }
}

/// Where a point of the rule stands, and half the length of the part, when the rule is laid between two ends.
pub fn laid(point: &SurfacePoint, ends: &[Option<End>; 2]) -> [f64; 2] {
    if *ends == [None; 2] {
        return [point.rule, 1.0];
    }
    let [from, to] = [ends[0].map_or(-1.0, |end| end.xi), ends[1].map_or(1.0, |end| end.xi)];
    [0.5 * (from + to) + 0.5 * (to - from) * point.rule, 0.5 * (to - from)]
}

fn spread(columns: &mut [[f64; DIRECTIONS]], rates: &[Vec3], direction: usize) {
    for (column, rate) in columns.iter_mut().zip(rates) {
        column[direction] += rate[0];
        column[direction + 1] += rate[1];
    }
}
