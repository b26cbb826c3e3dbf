//! Where everything is at one contact point, which unknowns that depends on, and the chain rule from the eight
//! directions of the contact point to those unknowns.
//!
//! The unknowns of a stencil are those of its own nodes, of the segment it hits, and of the segment touched at the last
//! accepted state where that is another one.

use super::open::{OpenContact, Seed};
use super::pair::Loads;
use super::point::{Closed, Place, triad};
use super::record::entry;
use super::surface::MAX_EDGE_NODES;
use super::target::{Hit, MAX_UNKNOWNS};
use crate::Failure;
use crate::system::{Local, Stencil};
use crate::tensor::Vec3;
use crate::tool::Ray;
use std::ops::Range;

/// Most unknowns of a stencil.
pub const MAX_DOFS: usize = 2 * MAX_EDGE_NODES + 2 * MAX_UNKNOWNS;
/// Directions in which a contact point is differentiated.
pub const DIRECTIONS: usize = 8;

/// The unknowns of a stencil, by what they move.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// Number of unknowns of its own nodes, which come first.
    pub own: usize,
    /// Those of the segment that is hit.
    pub hit: Range<usize>,
    /// Those of the segment touched at the last accepted state.
    pub touched: Option<Range<usize>>,
}

/// Where everything is at one point, in plain numbers.
pub struct Geometry {
    /// Positions.
    pub place: Place<f64>,
    /// Where the target is hit.
    pub hit: Hit,
    /// Which unknowns they depend on.
    pub layout: Layout,
}

impl OpenContact<'_> {
    /// The segment touched at the last accepted state, and where.
    pub(super) fn touched(&self, index: usize) -> Option<(usize, [f64; 2])> {
        let old = self.history.slot(index);
        (old[entry::SEGMENT] >= 0.0).then(|| (old[entry::SEGMENT] as usize, [old[entry::S], old[entry::S2]]))
    }

    /// Appends the unknowns of a point that hits `segment`, in the order of its [`Layout`].
    pub(super) fn unknowns(&self, index: usize, segment: Option<usize>, out: &mut Vec<usize>) {
        let contact = self.contact;
        let nodes = contact.surface.nodes(&contact.surface.points[index]);
        out.extend(nodes.iter().flat_map(|&node| [0, 1].map(|axis| contact.dofs.node(node) + axis)));
        let Some(segment) = segment else { return };
        contact.target.unknowns(segment, out);
        match self.touched(index) {
            Some((touched, _)) if !contact.target.together(segment, touched) => contact.target.unknowns(touched, out),
            _ => {}
        }
    }

    fn layout(&self, index: usize, segment: usize) -> Layout {
        let contact = self.contact;
        let own = 2 * contact.surface.nodes(&contact.surface.points[index]).len();
        let hit = own..own + contact.target.count(segment);
        let touched = self.touched(index).map(|(touched, _)| match contact.target.together(segment, touched) {
            true => hit.clone(),
            false => hit.end..hit.end + contact.target.count(touched),
        });
        Layout { own, hit, touched }
    }

    /// Where everything is for values `u` of a stencil's unknowns; None where it hits nothing.
    pub(super) fn geometry(&self, index: usize, stencil: &Stencil, u: &[f64]) -> Result<Option<Geometry>, Failure> {
        let Some(segment) = (stencil.choice as usize).checked_sub(1) else { return Ok(None) };
        let contact = self.contact;
        let (point, layout) = (&contact.surface.points[index], self.layout(index, segment));
        let nodes = contact.surface.nodes(point);
        let mut x = [Vec3::zero(); MAX_EDGE_NODES];
        for ((x, u), &node) in x.iter_mut().zip(u.chunks_exact(2)).zip(nodes) {
            *x = contact.mesh.points[node] + Vec3::new(u[0], u[1], 0.0);
        }
        let (a, tangent) = point.place(&x[..nodes.len()]);
        let (_, inward, _) = triad(tangent);
        let lost = || Failure::new(format!("{}: its ray runs along the target", contact.describe(index)));
        let ray = Ray { origin: a, direction: inward };
        let hit = contact.target.meet(segment, &u[layout.hit.clone()], &ray, stencil.near).ok_or_else(lost)?;
        let of_touched = self.touched(index).zip(layout.touched.clone());
        let touched = of_touched.map(|((segment, s), range)| contact.target.point(segment, s, &u[range]));
        Ok(Some(Geometry { place: Place { a, tangent, b: a + inward * hit.u, touched }, hit, layout }))
    }

    /// What a force at a point does to each unknown of its stencil: `-N_L f` to its own nodes, and to the target its
    /// work along the target's rates, unless the target loads itself.
    pub(super) fn rows<T: Seed>(
        &self,
        index: usize,
        (g, u): (&Geometry, &[f64]),
        (at, b): (Vec3<T>, Vec3<T>),
        force: Vec3<T>,
    ) -> [T; MAX_DOFS] {
        let (contact, mut rows) = (self.contact, [T::zero(); MAX_DOFS]);
        let n = &contact.surface.points[index].n;
        for (k, row) in rows[..g.layout.own].iter_mut().enumerate() {
            *row = -force[k % 2] * n[k / 2];
        }
        if contact.options.loads == Loads::Both {
            let hit = g.layout.hit.clone();
            let received = contact.target.receive((&g.hit, &u[hit.clone()]), (at, b), force);
            rows[hit.clone()].copy_from_slice(&received[..hit.len()]);
        }
        rows
    }

    /// Adds the forces of a closed point and their derivatives by the chain rule.
    pub(super) fn add<T: Seed>(&self, index: usize, g: &Geometry, closed: &Closed<T>, local: &mut Local) {
        let (n, b) = (local.force.len(), super::open::seed(g.place.b, 4));
        let rows = self.rows(index, (g, &local.u), (closed.hit, b), closed.force);
        for (force, row) in local.force.iter_mut().zip(&rows) {
            *force += row.re();
        }
        if !local.wants_tangent {
            return;
        }
        let columns = self.columns(index, g, &local.u);
        for (i, row) in rows[..n].iter().enumerate() {
            let slopes = row.slopes();
            for (entry, column) in local.tangent[i * n..].iter_mut().zip(&columns[..n]) {
                *entry += slopes.iter().zip(column).map(|(s, c)| s * c).sum::<f64>();
            }
        }
        if self.contact.options.loads == Loads::Both {
            let first = g.layout.hit.start;
            for (row, column, value) in self.contact.target.stiffen(closed.force.re()) {
                local.tangent[(first + row) * n + first + column] += value;
            }
        }
    }

    /// Derivatives of the eight directions along each unknown of the stencil.
    pub(super) fn columns(&self, index: usize, g: &Geometry, u: &[f64]) -> [[f64; DIRECTIONS]; MAX_DOFS] {
        let (contact, point) = (self.contact, &self.contact.surface.points[index]);
        let mut columns = [[0.0; DIRECTIONS]; MAX_DOFS];
        for (k, column) in columns[..g.layout.own].iter_mut().enumerate() {
            column[k % 2] = point.n[k / 2];
            column[2 + k % 2] = point.dn[k / 2];
        }
        if !contact.options.coupling {
            return columns;
        }
        let hit = g.layout.hit.clone();
        let rates = contact.target.rates(g.hit.segment, g.hit.s, &u[hit.clone()], g.place.b);
        spread(&mut columns[hit], &rates, 4);
        let touched = self.touched(index).zip(g.layout.touched.clone()).zip(g.place.touched);
        if let Some((((segment, s), range), at)) = touched {
            spread(&mut columns[range.clone()], &contact.target.rates(segment, s, &u[range], at), 6);
        }
        columns
    }
}

fn spread(columns: &mut [[f64; DIRECTIONS]], rates: &[Vec3], direction: usize) {
    for (column, rate) in columns.iter_mut().zip(rates) {
        column[direction] += rate[0];
        column[direction + 1] += rate[1];
    }
}
