//! Where everything is at one contact point in space, which unknowns that depends on, and the chain rule from its fifteen
//! directions to those unknowns: those of its own nodes, of the segment it hits, and of the segment touched at the last
//! accepted state where that is another one.

use super::open::{D, OpenContact, seed};
use super::point::{Closed, Place, Triad};
use super::surface::MAX_NODES;
use super::target::MAX_UNKNOWNS;
use crate::Failure;
use crate::contact::Loads;
use crate::contact::layout::Layout;
use crate::contact::record::entry;
use crate::contact::seed::Seed;
use crate::system::{Local, Stencil};
use crate::tensor::{Scalar, Vec3};
use crate::tool::Ray;
use crate::tool::space::Hit;

/// Directions in which a contact point is differentiated: five vectors.
pub const DIRECTIONS: usize = 15;
/// Most unknowns of a stencil.
pub const MAX_DOFS: usize = 3 * MAX_NODES + 2 * MAX_UNKNOWNS;

/// Where everything is at one point, in plain numbers.
pub struct Geometry {
    /// Positions.
    pub place: Place<f64>,
    /// Where the target is hit.
    pub hit: Hit,
    /// Segment touched at the last accepted state, and where.
    pub touched: Option<(usize, [f64; 2])>,
    /// Which unknowns they depend on.
    pub layout: Layout,
}

impl OpenContact<'_> {
    /// Appends the unknowns of a point, in the order of its [`Layout`].
    pub(super) fn unknowns(&self, index: usize, stencil: &Stencil, out: &mut Vec<usize>) {
        let parts = &self.contact.parts;
        let nodes = parts.surface.nodes(&parts.surface.points[index]);
        out.extend(nodes.iter().flat_map(|&node| [0, 1, 2].map(|axis| parts.dofs.node(node) + axis)));
        let Some(segment) = (stencil.choice as usize).checked_sub(1) else { return };
        parts.target.unknowns(segment, out);
        match self.touched(index) {
            Some((touched, _)) if !parts.target.together(segment, touched) => parts.target.unknowns(touched, out),
            _ => {}
        }
    }

    fn layout(&self, index: usize, segment: usize) -> Layout {
        let parts = &self.contact.parts;
        let own = 3 * parts.surface.nodes(&parts.surface.points[index]).len();
        let touched = self
            .touched(index)
            .map(|(touched, _)| (!parts.target.together(segment, touched)).then(|| parts.target.count(touched)));
        Layout::new(own, parts.target.count(segment), touched, [0; 2])
    }

    /// Where everything is for values `u` of a stencil's unknowns; None where it hits nothing.
    pub(super) fn geometry(&self, index: usize, stencil: &Stencil, u: &[f64]) -> Result<Option<Geometry>, Failure> {
        let Some(segment) = (stencil.choice as usize).checked_sub(1) else { return Ok(None) };
        let (contact, parts, layout) = (self.contact, &self.contact.parts, self.layout(index, segment));
        let point = &parts.surface.points[index];
        let face = &parts.surface.faces[point.face];
        let x = face.moved(&parts.mesh, u);
        let (a, tangents) = point.place(&x[..face.nodes.len()]);
        let inward = Triad::new(tangents).inward;
        let lost = || Failure::new(format!("{}: its ray runs along the target", contact.describe(index)));
        let ray = Ray { origin: a, direction: inward };
        let hit = parts.target.meet(segment, &u[layout.hit.clone()], &ray, stencil.near).ok_or_else(lost)?;
        let before = self.touched(index);
        let touched = before.zip(layout.touched.clone()).map(|((on, s), range)| parts.target.point(on, s, &u[range]));
        let place = Place { a, tangents, b: a + inward * hit.u, touched };
        Ok(Some(Geometry { place, hit, touched: before, layout }))
    }

    /// The segment touched at the last accepted state, and where.
    fn touched(&self, index: usize) -> Option<(usize, [f64; 2])> {
        let old = self.history.slot(index);
        (old[entry::SEGMENT] >= 0.0).then(|| (old[entry::SEGMENT] as usize, [old[entry::S], old[entry::S2]]))
    }

    /// What a force at a point does to each unknown of its stencil: `-N_L f` to its own nodes, and to the target its
    /// work along the target's rates, unless the target loads itself.
    pub(super) fn rows<T: Scalar>(
        &self,
        (index, g, u): (usize, &Geometry, &[f64]),
        (at, b): (Vec3<T>, Vec3<T>),
        force: Vec3<T>,
    ) -> [T; MAX_DOFS] {
        let (parts, mut rows) = (&self.contact.parts, [T::zero(); MAX_DOFS]);
        let shapes = &parts.surface.points[index].n;
        for (k, row) in rows[..g.layout.own].iter_mut().enumerate() {
            *row = -force[k % 3] * shapes[k / 3];
        }
        if parts.options.loads == Loads::Both {
            let hit = g.layout.hit.clone();
            let received = parts.target.receive((&g.hit, &u[hit.clone()]), (at, b), force);
            rows[hit.clone()].copy_from_slice(&received[..hit.len()]);
        }
        rows
    }

    /// Adds the forces of a closed point and their derivatives by the chain rule.
    pub(super) fn add<T: Seed<DIRECTIONS>>(&self, index: usize, g: &Geometry, closed: &Closed<T>, local: &mut Local) {
        let (n, hit) = (local.force.len(), g.layout.hit.clone());
        let rows = self.rows((index, g, &local.u), (closed.hit, seed(g.place.b, 9)), closed.force);
        for (force, row) in local.force.iter_mut().zip(&rows) {
            *force += row.re();
        }
        if !local.wants_tangent {
            return;
        }
        let columns = self.columns(index, g, &local.u);
        // Nothing acts on what was touched.
        for (i, row) in rows[..hit.end].iter().enumerate() {
            let slopes = row.slopes();
            for (entry, column) in local.tangent[i * n..].iter_mut().zip(&columns[..n]) {
                *entry += slopes.iter().zip(column).map(|(s, c)| s * c).sum::<f64>();
            }
        }
        if self.contact.parts.options.loads == Loads::Both {
            let load = (closed.hit.re(), closed.force.re());
            self.contact.parts.target.stiffen(&local.u[hit.clone()], load, &mut |row, column, value| {
                local.tangent[(hit.start + row) * n + hit.start + column] += value;
            });
        }
    }

    /// Derivatives of the fifteen directions along each unknown of the stencil.
    pub(super) fn columns(&self, index: usize, g: &Geometry, u: &[f64]) -> [[f64; DIRECTIONS]; MAX_DOFS] {
        let (parts, mut columns) = (&self.contact.parts, [[0.0; DIRECTIONS]; MAX_DOFS]);
        let point = &parts.surface.points[index];
        for (k, column) in columns[..g.layout.own].iter_mut().enumerate() {
            column[k % 3] = point.n[k / 3];
            column[3 + k % 3] = point.dn[k / 3][0];
            column[6 + k % 3] = point.dn[k / 3][1];
        }
        if !parts.options.coupling {
            return columns;
        }
        let hit = g.layout.hit.clone();
        let rates = parts.target.rates(g.hit.facet, g.hit.s, &u[hit.clone()], g.place.b);
        spread(&mut columns[hit], &rates, 9);
        if let Some((((segment, s), range), at)) = g.touched.zip(g.layout.touched.clone()).zip(g.place.touched) {
            spread(&mut columns[range.clone()], &parts.target.rates(segment, s, &u[range], at), 12);
        }
        columns
    }

    /// The seeds of a place.
    pub(super) fn seeded<T: Seed<DIRECTIONS>>(g: &Geometry) -> Place<T> {
        Place {
            a: seed(g.place.a, 0),
            tangents: [seed(g.place.tangents[0], 3), seed(g.place.tangents[1], 6)],
            b: seed(g.place.b, 9),
            touched: g.place.touched.map(|x| seed(x, 12)),
        }
    }

    /// Those that carry derivatives.
    pub(super) fn variable(g: &Geometry) -> Place<D> {
        Self::seeded(g)
    }
}

fn spread(columns: &mut [[f64; DIRECTIONS]], rates: &[Vec3], direction: usize) {
    for (column, rate) in columns.iter_mut().zip(rates) {
        (0..3).for_each(|axis| column[direction + axis] += rate[axis]);
    }
}
