//! The evaluation of a Gauss point on the segment that the search found: law, forces, tangent, energies, and what bends.

use super::attempt::{PaperAttempt, write_hit};
use super::mean;
use super::point::{self, PointConstants, Triad};
use super::seed::Seed;
use super::stencil::{D, DIRECTIONS, PointGeometry};
use crate::Failure;
use crate::contact::energy::account;
use crate::contact::increment::refuse_jump;
use crate::contact::record::{entry, leave, write};
use crate::interface::{Linearised, Past};
use crate::mesh::Space;
use crate::system::{Branch, Coordinates, Kinks, Local, Stencil, Term};

impl PaperAttempt<'_> {
    /// Adds the coordinates over which a point's forces bend, penetration and slips, to the stencil begun last.
    pub(super) fn bend(&self, (index, stencil): (usize, &Stencil), g: &PointGeometry, u: &[f64], out: &mut Kinks) {
        let (place, plane) = (g.seeded::<D>(), self.contact.surface().plane);
        let (triad, columns) = (Triad::new(place.tangents, plane), self.columns(g));
        let [s, t] = place.slip(&triad);
        let coordinates = [place.penetration(&triad, g.hit.normal) + self.closure(index), s, t];
        let area = self.present_area(g);
        let directions = [triad.inward, triad.along[0], triad.along[1]];
        let slips = if plane { 1 } else { 2 };
        let none = std::iter::repeat(0.0);
        for (y, direction) in coordinates.into_iter().zip(directions).take(1 + slips) {
            let rates = columns.iter().map(|column| y.du.iter().zip(column).map(|(s, c)| s * c).sum::<f64>());
            let rows = self.rows(g, (g.place.b, g.place.b), direction.re() * area);
            out.coordinate(
                y.re,
                rates.chain(none.clone()).take(stencil.len),
                rows.into_iter().chain(none.clone()).take(stencil.len),
            );
        }
        if let Some(mean) = self.mean_pressure(index, g, u) {
            let penalty = self.contact.parts.options.penalty;
            let rates = mean.slopes.iter().map(|slope| slope / penalty);
            out.coordinate(mean.pressure / penalty, rates, none.take(stencil.len));
        }
    }

    pub(super) fn evaluate_over<T: Seed<DIRECTIONS>>(
        &self,
        index: usize,
        g: &PointGeometry,
        new: &mut [f64],
        local: &mut Local,
    ) -> Result<Branch, Failure> {
        let (law, old, past) = (&*self.law, self.history.slot(index), self.past(index));
        let constants = self.constants(index, g, &past, local.acting);
        let past = Past { penetration: constants.before.max(constants.touch), ..past };
        write_hit(Some(g.hit), new);
        new[entry::CLOSURE] = constants.closure;
        new[entry::COUNT..].copy_from_slice(&old[entry::COUNT..]);
        let mean = self.mean_pressure(index, g, &local.u);
        let (by, mut by_mean) = (mean.as_ref().map(|mean| mean.pressure), [0.0; 2]);
        let closed = point::evaluate(&g.seeded::<T>(), &constants, |motion| {
            let (response, slopes) = mean::ask((law, by), motion, &past, &mut new[entry::COUNT..])?;
            by_mean = slopes;
            Ok(response)
        })?;
        let Some(closed) = closed else {
            leave(law, old, new);
            self.account(index, g, None, local);
            return Ok(0);
        };
        self.refuse_leap(index, (g, &local.u))?;
        new[entry::PENETRATION] -= constants.least;
        write(&closed.response, (closed.slip.map(T::re), law.recession()), old, new);
        self.add(g, &closed, local);
        if let Some(mean) = mean.filter(|_| local.wants_tangent) {
            self.add_neighbours((g, by_mean), &mean, local);
        }
        self.account(index, g, Some(&closed.response), local);
        Ok(closed.response.status as Branch)
    }

    fn constants(&self, index: usize, g: &PointGeometry, past: &Past, acting: Option<Coordinates>) -> PointConstants {
        let parts = &self.contact.parts;
        let flat = matches!(parts.space, Space::PlaneStrain | Space::PlaneStress);
        PointConstants {
            normal: g.hit.normal,
            closure: self.closure(index),
            before: past.penetration,
            touch: self.law.touch(past),
            opens: self.law.opens(past, g.slip()),
            least: self.contact.least,
            weight: g.point.weight * if flat { parts.options.thickness } else { 1.0 },
            revolves: parts.space == Space::Axisymmetric,
            plane: parts.surface.plane,
            acting,
        }
    }

    /// Refuses a point that closes too deep, and a touching tool that turned too far.
    fn refuse_leap(&self, index: usize, (g, u): (&PointGeometry, &[f64])) -> Result<(), Failure> {
        let name = || self.contact.name_of(index);
        if g.place.touched.is_none() {
            return refuse_jump(g.hit.u, self.depths[index], name);
        }
        let Some(rigid) = self.contact.parts.target.as_tool() else { return Ok(()) };
        rigid.refuse_turn(&u[g.met.clone()], self.accepted, name)
    }

    fn account(&self, index: usize, g: &PointGeometry, now: Option<&Linearised>, local: &mut Local) {
        let (options, old) = (&self.contact.parts.options, self.history.slot(index));
        let area = self.present_area(g) * options.loads.share();
        account((&*self.law, &self.past(index), old), (options, self.at), ([area; 2], 0.0), (now, g.slip()), local);
    }
}
