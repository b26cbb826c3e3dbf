//! Where everything is at one contact point in space, which unknowns that depends on, and the chain rule from its fifteen
//! directions to those unknowns: those of its own nodes, of the segment it hits, of the segment touched at the last accepted
//! state where that is another one, of the border of the target over its face, and of the nodes around it that turn its
//! averaged normals.

use super::before::Before;
use super::open::{D, OpenContact, seed};
use super::placed::Placed;
use super::point::{Closed, Place, Triad};
use super::split::{self, Border, VERTICES};
use super::surface::{MAX_NODES, SurfacePoint};
use super::target::MAX_UNKNOWNS;
use crate::Failure;
use crate::contact::Loads;
use crate::contact::layout::Layout;
use crate::contact::seed::Seed;
use crate::system::{Local, Stencil};
use crate::tensor::{Scalar, Vec3};
use crate::tool::Ray;
use crate::tool::space::Hit;

/// Directions in which a contact point is differentiated: five vectors.
pub const DIRECTIONS: usize = 15;
/// Most unknowns of a stencil, but for those of the nodes around its face.
pub const MAX_DOFS: usize = 3 * MAX_NODES + 2 * MAX_UNKNOWNS + 3 * VERTICES;

/// Where everything is at one point, in plain numbers.
pub struct Geometry<'a> {
    /// Where the point stands on its face.
    pub spot: SurfacePoint,
    /// Positions.
    pub place: Place<f64>,
    /// Where the target is hit.
    pub hit: Hit,
    /// What it touched at the last accepted state.
    pub before: Before,
    /// Which unknowns they depend on.
    pub layout: Layout,
    moving: Option<Box<Moving>>,
    /// Its face.
    placed: Placed<'a>,
}

/// How a point moves that stands on a part of its face.
struct Moving {
    /// Derivatives of its two coordinates and of the root of the part along the unknowns on which its normal depends,
    /// then those of the border.
    rates: Vec<[f64; 3]>,
    /// Derivatives of the position over the whole face.
    along: [Vec3; 2],
    /// Tangents of the whole face.
    tangents: [Vec3; 2],
    /// Their derivatives.
    bend: [[Vec3; 2]; 2],
}

impl OpenContact<'_> {
    /// Appends the unknowns of a point, in the order of its [`Layout`].
    pub(super) fn unknowns(&self, index: usize, stencil: &Stencil, out: &mut Vec<usize>) {
        let parts = &self.contact.parts;
        let nodes = parts.surface.nodes(&parts.surface.points[index]);
        out.extend(nodes.iter().flat_map(|&node| [0, 1, 2].map(|axis| parts.dofs.node(node) + axis)));
        let Some(segment) = (stencil.choice as usize).checked_sub(1) else { return };
        parts.target.unknowns(segment, out);
        match self.touched_segment(index, stencil) {
            Some(touched) if !parts.target.together(segment, touched) => parts.target.unknowns(touched, out),
            _ => {}
        }
        if let Some(faces) = parts.target.as_faces() {
            out.extend(Border::of(stencil).list().flat_map(|node| faces.unknowns_of(node)));
        }
        let around = self.contact.nodes_around(parts.surface.points[index].face);
        out.extend(around.iter().flat_map(|&node| [0, 1, 2].map(|axis| parts.dofs.node(node) + axis)));
        self.contact.unknowns_around(index, out);
    }

    fn layout(&self, index: usize, stencil: &Stencil, segment: usize) -> Layout {
        let parts = &self.contact.parts;
        let own = 3 * parts.surface.nodes(&parts.surface.points[index]).len();
        let touched = self
            .touched_segment(index, stencil)
            .map(|touched| (!parts.target.together(segment, touched)).then(|| parts.target.count(touched)));
        let around = 3 * self.contact.nodes_around(parts.surface.points[index].face).len();
        Layout::new(own, parts.target.count(segment), touched, [3 * Border::of(stencil).list().count(), 0], around)
    }

    /// Where everything is for values `u` of a stencil's unknowns, and how it moves if those rates are wanted; None where it
    /// hits nothing.
    pub(super) fn geometry(
        &self,
        index: usize,
        (stencil, rates): (&Stencil, bool),
        u: &[f64],
    ) -> Result<Option<Geometry<'_>>, Failure> {
        let Some(segment) = (stencil.choice as usize).checked_sub(1) else { return Ok(None) };
        let (contact, parts, layout) = (self.contact, &self.contact.parts, self.layout(index, stencil, segment));
        let lost = || Failure::new(format!("{}: its ray runs along the target", contact.describe(index)));
        let face = parts.surface.points[index].face;
        let placed = contact.placed_locally(face, &u[..layout.own], &u[layout.around.clone()]);
        let border = layout.ends[0].clone().map(|range| &u[range]);
        let (spot, moving) = self.spot((index, stencil), &placed, border, rates).ok_or_else(lost)?;
        if !placed.is_upright(&spot) {
            return Err(Failure::new(format!("{}: its averaged normal lies across its face", contact.describe(index))));
        }
        let (a, tangents) = placed.stand(&spot);
        let inward = Triad::new(tangents).inward;
        let ray = Ray { origin: a, direction: inward };
        let hit = parts.target.meet(segment, &u[layout.hit.clone()], &ray, stencil.near).ok_or_else(lost)?;
        let before = self.before(index, stencil, &spot);
        let of_touched = before.touched.zip(layout.touched.clone());
        let touched = of_touched.map(|((on, s), range)| parts.target.point(on, s, &u[range]));
        let place = Place { a, tangents, b: a + inward * hit.u, touched };
        Ok(Some(Geometry { spot, place, hit, before, layout, moving, placed }))
    }

    /// Where a point stands on its face, and how it moves there with its nodes and those of the border, whose unknowns
    /// are `u`.
    fn spot(
        &self,
        (index, stencil): (usize, &Stencil),
        placed: &Placed,
        u: Option<&[f64]>,
        rates: bool,
    ) -> Option<(SurfacePoint, Option<Box<Moving>>)> {
        let (surface, border) = (&self.contact.parts.surface, Border::of(stencil));
        let (Some(faces), Some(u)) = (self.contact.parts.target.as_faces(), u) else {
            return Some((surface.points[index], None));
        };
        let vertices: Vec<Vec3> =
            border.list().zip(u.chunks_exact(3)).map(|(node, u)| faces.place_of(node, u)).collect();
        let (xi, scale) = split::laid(placed, border, &vertices, &surface.points[index])?;
        let moving = || {
            let rates = split::rates(placed, border, &vertices, &surface.points[index])?;
            let (along, tangents) = (placed.at(xi).1, placed.frame(xi).1);
            Some(Box::new(Moving { rates, along, tangents, bend: placed.bend(xi) }))
        };
        let moving = if rates { Some(moving()?) } else { None };
        Some((surface.moved(index, xi, scale), moving))
    }

    /// What a force at a point does to each unknown of its stencil: `-N_L f` to its own nodes, and to the target its
    /// work along the target's rates, unless the target loads itself.
    pub(super) fn rows<T: Scalar>(
        &self,
        (g, u): (&Geometry, &[f64]),
        (at, b): (Vec3<T>, Vec3<T>),
        force: Vec3<T>,
    ) -> [T; MAX_DOFS] {
        let (parts, mut rows) = (&self.contact.parts, [T::zero(); MAX_DOFS]);
        for (k, row) in rows[..g.layout.own].iter_mut().enumerate() {
            *row = -force[k % 3] * g.spot.n[k / 3];
        }
        if parts.options.loads == Loads::Both {
            let hit = g.layout.hit.clone();
            let received = parts.target.receive((&g.hit, &u[hit.clone()]), (at, b), force);
            rows[hit.clone()].copy_from_slice(&received[..hit.len()]);
        }
        rows
    }

    /// Adds the forces of a closed point and their derivatives by the chain rule.
    pub(super) fn add<T: Seed<DIRECTIONS>>(&self, g: &Geometry, closed: &Closed<T>, local: &mut Local) {
        let (n, hit) = (local.force.len(), g.layout.hit.clone());
        let forces = self.rows::<f64>((g, &local.u), (closed.hit.re(), g.place.b), closed.force);
        local.force.iter_mut().zip(&forces).for_each(|(force, row)| *force += row);
        if !local.wants_tangent {
            return;
        }
        let rows = self.rows((g, &local.u), (closed.hit, seed(g.place.b, 9)), closed.linear);
        let columns = self.columns(g, &local.u);
        // Nothing acts on what was touched.
        for (i, row) in rows[..hit.end].iter().enumerate() {
            let slopes = row.slopes();
            for (entry, column) in local.tangent[i * n..].iter_mut().zip(&columns) {
                *entry += slopes.iter().zip(column).map(|(s, c)| s * c).sum::<f64>();
            }
        }
        self.add_fixed_rates(g, (closed.hit.re(), closed.linear.re()), local);
    }

    /// What the forces' own places on the nodes add: the rates of a tool move with its reference point, and the shape
    /// functions with a point that moves over its face.
    fn add_fixed_rates(&self, g: &Geometry, load: (Vec3, Vec3), local: &mut Local) {
        let (n, hit, parts) = (local.force.len(), g.layout.hit.clone(), &self.contact.parts);
        if parts.options.loads == Loads::Both {
            parts.target.stiffen(&local.u[hit.clone()], load, &mut |row, column, value| {
                local.tangent[(hit.start + row) * n + hit.start + column] += value;
            });
        }
        self.each_rate(g, |_, column, [xi, eta, _]| {
            for k in 0..g.layout.own {
                let [p, q] = g.spot.dn[k / 3].map(|slope| slope / g.spot.scale);
                local.tangent[k * n + column] -= load.1[k % 3] * (p * xi + q * eta);
            }
        });
    }

    /// For each unknown that moves a point over its face: the derivatives of its coordinates and of the root of the part.
    fn each_rate(&self, g: &Geometry, mut act: impl FnMut(&Moving, usize, [f64; 3])) {
        let Some((moving, ends)) = g.moving.as_ref().zip(g.layout.ends[0].clone()) else { return };
        let coupled = if self.contact.parts.options.coupling { ends } else { 0..0 };
        let columns = g.layout.field().chain(coupled).zip(&moving.rates);
        columns.for_each(|(column, rates)| act(moving, column, *rates));
    }

    /// Derivatives of the fifteen directions along each unknown of the stencil.
    pub(super) fn columns(&self, g: &Geometry, u: &[f64]) -> Vec<[f64; DIRECTIONS]> {
        let (parts, mut columns) = (&self.contact.parts, vec![[0.0; DIRECTIONS]; g.layout.count()]);
        for (k, column) in columns[..g.layout.own].iter_mut().enumerate() {
            column[k % 3] = g.spot.n[k / 3];
            column[3 + k % 3] = g.spot.dn[k / 3][0];
            column[6 + k % 3] = g.spot.dn[k / 3][1];
        }
        if let Some(turning) = g.placed.turning(&g.spot) {
            for (column, [first, second]) in g.layout.field().zip(turning) {
                columns[column][3..6].copy_from_slice(&first.0);
                columns[column][6..9].copy_from_slice(&second.0);
            }
        }
        let sliding = self.sliding(g, u);
        self.each_rate(g, |moving, column, [xi, eta, stretch]| {
            let along = |[p, q]: [Vec3; 2]| p * xi + q * eta;
            let tangent = |a: usize| along(moving.bend[a]) * g.spot.scale + moving.tangents[a] * stretch;
            let changes = [along(moving.along), tangent(0), tangent(1), Vec3::zero(), along(sliding)];
            for (direction, change) in columns[column].iter_mut().zip(changes.iter().flat_map(|change| change.0)) {
                *direction += change;
            }
        });
        if !parts.options.coupling {
            return columns;
        }
        let hit = g.layout.hit.clone();
        let rates = parts.target.rates(g.hit.facet, g.hit.s, &u[hit.clone()], g.place.b);
        spread(&mut columns[hit], &rates, 9);
        let touched = g.before.touched.zip(g.layout.touched.clone()).zip(g.place.touched);
        if let Some((((segment, s), range), at)) = touched {
            spread(&mut columns[range.clone()], &parts.target.rates(segment, s, &u[range], at), 12);
        }
        columns
    }

    /// Motion of the touched point along both coordinates of the face.
    fn sliding(&self, g: &Geometry, u: &[f64]) -> [Vec3; 2] {
        let (parts, before) = (&self.contact.parts, &g.before);
        let segment = before.touched.zip(g.layout.touched.clone()).zip(parts.target.as_faces());
        let Some((((segment, s), range), faces)) = segment.filter(|_| g.moving.is_some()) else {
            return [Vec3::zero(); 2];
        };
        let [t, v] = faces.tangents(segment, s, &u[range]);
        before.sliding.map(|[p, q]| t * p + v * q)
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
