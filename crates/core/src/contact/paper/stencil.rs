//! Where everything is at one Gauss point, which unknowns that depends on, and the chain rule from its fifteen directions to
//! those unknowns: those of its own nodes, of the segment it hits, and of the segment touched at the last accepted state where
//! that is another one.

use super::attempt::{PaperAttempt, touched};
use super::point::{Closed, PointPlace, Triad};
use super::seed::Seed;
use super::segment::{SegmentInPlace, dofs_of, placed};
use super::surface::GaussPoint;
use crate::Failure;
use crate::contact::LoadedSides;
use crate::contact::field::face::PlacedFace;
use crate::system::{Local, Stencil, Term};
use crate::tensor::{Dual, Scalar, Vec3};
use crate::tool::{Hit, ProfileRay};
use std::ops::Range;

/// Directions in which a point is differentiated: five vectors.
pub const DIRECTIONS: usize = 15;
/// A number with derivatives along them.
pub type D = Dual<DIRECTIONS>;

/// Where everything is at one point, in plain numbers.
pub struct PointGeometry<'a> {
    /// The point.
    pub point: &'a GaussPoint,
    /// Positions.
    pub place: PointPlace<f64>,
    /// Triad.
    pub triad: Triad<f64>,
    /// Where the target is hit.
    pub hit: Hit,
    /// The segment that is hit.
    pub segment: SegmentInPlace<'a>,
    /// Number of the unknowns of its own nodes, which come first.
    pub own: usize,
    /// Places of the unknowns of that segment.
    pub met: Range<usize>,
    /// What was touched at the last accepted state: segment, place on it, places of its unknowns.
    before: Option<(SegmentInPlace<'a>, [f64; 2], Range<usize>)>,
    /// Number of the unknowns that move the point itself.
    pub count: usize,
    /// Its face.
    pub placed: PlacedFace,
}

impl PointGeometry<'_> {
    /// The positions with their directions.
    pub fn seeded<T: Seed<DIRECTIONS>>(&self) -> PointPlace<T> {
        PointPlace {
            a: seed(self.place.a, 0),
            tangents: [seed(self.place.tangents[0], 3), seed(self.place.tangents[1], 6)],
            b: seed(self.place.b, 9),
            touched: self.place.touched.map(|x| seed(x, 12)),
        }
    }

    /// Slips of the increment.
    pub fn slip(&self) -> [f64; 2] {
        self.place.slip(&self.triad)
    }
}

fn seed<T: Seed<DIRECTIONS>>(v: Vec3, first: usize) -> Vec3<T> {
    Vec3(std::array::from_fn(|i| T::seed(v[i], first + i)))
}

impl<'a> PaperAttempt<'a> {
    /// Appends the unknowns of a point: its own, those of the segment it hits, of the one it touched, of the faces around it.
    pub(super) fn unknowns(&self, index: usize, stencil: &Stencil, out: &mut Vec<usize>) {
        let parts = &self.contact.parts;
        out.extend(dofs_of(&self.contact.face(index).nodes, &parts.dofs));
        let Some(segment) = (stencil.choice as usize).checked_sub(1) else { return };
        out.extend(parts.target.unknowns(segment, &parts.dofs));
        if let Some((other, _)) = self.touched_elsewhere(index, segment) {
            out.extend(parts.target.unknowns(other, &parts.dofs));
        }
        for &face in self.contact.neighbours.others(index) {
            out.extend(dofs_of(&parts.surface.faces[face].nodes, &parts.dofs));
        }
    }

    /// The segment of a body touched at the last accepted state, and where, if it is not the one that is hit now.
    fn touched_elsewhere(&self, index: usize, segment: usize) -> Option<(usize, [f64; 2])> {
        let deforms = self.contact.parts.target.deforms();
        touched(self.history.slot(index)).filter(|(other, _)| deforms && *other != segment)
    }

    /// Where everything is for values `u` of a stencil's unknowns; None where it hits nothing.
    pub(super) fn geometry(
        &self,
        index: usize,
        stencil: &Stencil,
        u: &[f64],
    ) -> Result<Option<PointGeometry<'a>>, Failure> {
        let Some(number) = (stencil.choice as usize).checked_sub(1) else { return Ok(None) };
        let (contact, parts, site) = (self.contact, &self.contact.parts, self.contact.site());
        let lost = || Failure::new(format!("{}: its ray runs along the target", contact.name_of(index)));
        let (point, face) = (&self.contact.points[index], self.contact.face(index));
        let own = parts.dofs.per_node() * face.nodes.len();
        let met = own..own + parts.target.unknowns(number, &parts.dofs).len();
        let placed = placed(&face.nodes, &parts.mesh, &u[..own]);
        let (a, plane) = (point.shape.value(placed.nodes()), contact.surface().plane);
        let tangents = point.shape.tangents(placed.nodes(), plane);
        let triad = Triad::new(tangents, plane);
        let inward = triad.inward;
        let segment = parts.target.segment(number, site, &u[met.clone()]);
        let hit = segment.meet(&ProfileRay { origin: a, direction: inward }, stencil.near).ok_or_else(lost)?;
        let mut count = met.end;
        let before = touched(self.history.slot(index)).map(|(other, s)| {
            let range = match self.touched_elsewhere(index, number) {
                Some(_) => met.end..met.end + parts.target.unknowns(other, &parts.dofs).len(),
                None => met.clone(),
            };
            count = count.max(range.end);
            (parts.target.segment(other, site, &u[range.clone()]), s, range)
        });
        let touched = before.as_ref().map(|(segment, s, _)| segment.point(*s));
        let place = PointPlace { a, tangents, b: a + inward * hit.u, touched };
        Ok(Some(PointGeometry { point, place, triad, hit, segment, own, met, before, count, placed }))
    }

    /// What a force at a point does to each unknown of its stencil: `-N_L f` to its own nodes, and to the target its
    /// work along the target's rates, unless the target loads itself.
    pub(super) fn rows<T: Scalar>(&self, g: &PointGeometry, place: (Vec3<T>, Vec3<T>), force: Vec3<T>) -> Vec<T> {
        let axes = self.contact.parts.dofs.per_node();
        let mut rows: Vec<T> = (0..g.own).map(|k| -force[k % axes] * g.point.shape.n[k / axes]).collect();
        if self.contact.parts.options.loads == LoadedSides::Both {
            rows.extend(g.segment.receive(&g.hit, place, force));
        }
        rows.resize(g.count, T::zero());
        rows
    }

    /// Adds the forces of a closed point and their derivatives by the chain rule.
    pub(super) fn add<T: Seed<DIRECTIONS>>(&self, g: &PointGeometry, closed: &Closed<T>, local: &mut Local) {
        let n = local.force.len();
        let forces = self.rows(g, (closed.hit.re(), g.place.b), closed.force);
        local.force.iter_mut().zip(&forces).for_each(|(force, row)| *force += row);
        if !local.wants_tangent {
            return;
        }
        let rows = self.rows(g, (closed.hit, seed(g.place.b, 9)), closed.linear);
        let columns = self.columns(g);
        for (i, row) in rows.iter().enumerate() {
            let slopes = row.slopes();
            for (entry, column) in local.tangent[i * n..].iter_mut().zip(&columns) {
                *entry += slopes.iter().zip(column).map(|(s, c)| s * c).sum::<f64>();
            }
        }
        if self.contact.parts.options.loads == LoadedSides::Both {
            let first = g.met.start;
            g.segment.stiffen((closed.hit.re(), closed.linear.re()), &mut |row, column, value| {
                local.tangent[(first + row) * n + first + column] += value;
            });
        }
    }

    /// Derivatives of the fifteen directions along each unknown that moves the point.
    pub(super) fn columns(&self, g: &PointGeometry) -> Vec<[f64; DIRECTIONS]> {
        let axes = self.contact.parts.dofs.per_node();
        let (mut columns, shape) = (vec![[0.0; DIRECTIONS]; g.count], &g.point.shape);
        for (k, column) in columns[..g.own].iter_mut().enumerate() {
            column[k % axes] = shape.n[k / axes];
            column[3 + k % axes] = shape.dn[k / axes][0];
            column[6 + k % axes] = if axes == 3 { shape.dn[k / axes][1] } else { 0.0 };
        }
        if self.contact.parts.options.coupling {
            spread(&mut columns[g.met.clone()], &g.segment.rates(g.hit.s, g.place.b), 9);
            if let Some(((segment, s, range), at)) = g.before.as_ref().zip(g.place.touched) {
                spread(&mut columns[range.clone()], &segment.rates(*s, at), 12);
            }
        }
        columns
    }

    /// Present area that a point stands for.
    pub(super) fn present_area(&self, g: &PointGeometry) -> f64 {
        let (surface, point) = (self.contact.surface(), g.point);
        surface.density_at(&surface.faces[point.face], &g.placed, point.xi) * point.weight
    }
}

fn spread(columns: &mut [[f64; DIRECTIONS]], rates: &[Vec3], direction: usize) {
    for (column, rate) in columns.iter_mut().zip(rates) {
        (0..3).for_each(|axis| column[direction + axis] += rate[axis]);
    }
}
