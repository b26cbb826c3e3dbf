//! A contact during one attempt: its points as stencils, evaluated on the segments that the search found.

use super::augment::Shift;
use super::capture::{refuse_jump, refuse_turn};
use super::geometry::{DIRECTIONS, Geometry};
use super::kink::{answer, answer_by_mean};
use super::nonlocal;
use super::pair::Contact;
use super::point::{self, Constants, Place};
use super::record::{entry, leave, stresses, write};
use super::seed::Seed;
use super::surface::SurfacePoint;
use super::target::{Hit, Standing};
use super::variational::ContactForm;
use crate::interface::{Interface, Linearised, Past};
use crate::mesh::Space;
use crate::system::{Answer, Attempt, Branch, Coordinates, Couplings, History, Kinks, Local, Stencil, Stencils};
use crate::tensor::{Dual, Vec3};
use crate::{Failure, Kind};
use std::sync::Arc;

pub(super) type D = Dual<DIRECTIONS>;

/// A contact during one attempt.
pub struct OpenContact<'a> {
    /// The contact.
    pub contact: &'a Contact,
    /// The law at its end.
    pub law: Arc<dyn Interface>,
    /// Its history in the accepted state.
    pub history: &'a History,
    /// Accepted unknowns.
    pub accepted: &'a [f64],
    /// The target in the accepted configuration, where it deforms.
    pub standing: Option<Standing<'a>>,
    /// Largest admissible penetration at each point.
    pub depths: Vec<f64>,
    /// Largest gap at which the target is seen.
    pub reach: f64,
    /// Unknowns that the last increment, carried on, leads to: a guess of what will couple.
    pub ahead: Vec<f64>,
    /// Multipliers of the corners; none without augmentation.
    pub shifts: Vec<Shift>,
    /// How often they were improved in the attempt.
    pub augmented: usize,
    /// The part of the overlap that is removed at the beginning and at the end.
    pub settled: [f64; 2],
    /// Length of the increment.
    pub dt: f64,
}

/// Begins the new history of a point with what the search found.
pub fn write_hit(spot: &SurfacePoint, hit: Option<Hit>, values: &mut [f64]) {
    values.fill(0.0);
    (values[entry::XI], values[entry::HALF]) = (spot.xi, spot.half);
    match hit {
        Some(hit) => {
            values[entry::PENETRATION] = hit.u;
            values[entry::SEGMENT] = hit.segment as f64;
            [values[entry::S], values[entry::S2]] = hit.s;
        }
        None => values[entry::SEGMENT] = -1.0,
    }
}

impl Attempt for OpenContact<'_> {
    fn is_fixed(&self) -> bool {
        false
    }

    fn scratch(&self, index: usize) -> Vec<f64> {
        vec![0.0; self.history.slot(index).len()]
    }

    fn reach(&self, couplings: &mut Couplings) {
        if self.contact.target.deforms() || !self.contact.around.is_empty() {
            let mut stencils = Stencils::default();
            self.list(&self.ahead, &mut stencils);
            stencils.list.iter().for_each(|stencil| couplings.push(stencils.dofs(stencil)));
        }
    }

    fn stencils(&self, u: &[f64], out: &mut Stencils) -> Result<(), Failure> {
        self.list(u, out);
        Ok(())
    }

    fn evaluate(&self, index: usize, stencil: &Stencil, new: &mut [f64], local: &mut Local) -> Result<Branch, Failure> {
        let Some(geometry) = self.geometry(index, stencil, &local.u)? else {
            if stencil.also[2] > 0 && self.history.slot(index)[entry::SEGMENT] >= 0.0 {
                let reason = format!("the target came through at {}", self.contact.describe(index));
                return Err(Failure::new(reason).of(Kind::Passage));
            }
            write_hit(&self.contact.surface.points[index], None, new);
            leave(&*self.law, self.history.slot(index), new);
            return Ok(0);
        };
        if local.wants_tangent {
            self.evaluate_over::<D>((index, stencil), &geometry, new, local)
        } else {
            self.evaluate_over::<f64>((index, stencil), &geometry, new, local)
        }
    }

    fn kink(&self, index: usize, stencil: &Stencil, u: &[f64], out: &mut Kinks) -> Result<(), Failure> {
        if let Some(geometry) = self.geometry(index, stencil, u)? {
            self.bend((index, stencil), &geometry, u, out);
        }
        Ok(())
    }

    fn before(&self, stencil: usize) -> Coordinates {
        stresses(self.history.slot(stencil))
    }

    fn answer(&self, stencil: usize, y: &Coordinates) -> Result<Answer, Failure> {
        let shear = self.history.slot(stencil)[entry::SHEAR];
        let (law, past) = (&*self.law, self.past(stencil, shear));
        if self.contact.neighbours.is_empty() {
            return answer(law, &past, self.contact.least, y);
        }
        answer_by_mean(law, &past, (self.contact.least, 1), y)
    }

    fn augment(&mut self, u: &[f64], new: &mut History) -> Result<bool, Failure> {
        self.refuse_passage(u, new)?;
        self.improve(u, new)
    }

    fn multipliers(&self) -> Vec<[f64; 4]> {
        self.shifts.iter().map(Shift::numbers).collect()
    }

    fn follow(&mut self, leading: &[[f64; 4]], u: &[f64], new: &History) -> bool {
        self.take_up(leading, u, new)
    }
}

pub(super) fn seed<T: Seed<DIRECTIONS>>(v: Vec3, direction: usize) -> Vec3<T> {
    Vec3([T::seed(v[0], direction), T::seed(v[1], direction + 1), T::zero()])
}

/// A place with its directions.
fn seeded<T: Seed<DIRECTIONS>>(g: &Geometry) -> Place<T> {
    Place {
        a: seed(g.place.a, 0),
        tangent: seed(g.place.tangent, 2),
        b: seed(g.place.b, 4),
        touched: g.place.touched.map(|x| seed(x, 6)),
    }
}

impl OpenContact<'_> {
    fn evaluate_over<T: Seed<DIRECTIONS>>(
        &self,
        (index, stencil): (usize, &Stencil),
        geometry: &Geometry,
        new: &mut [f64],
        local: &mut Local,
    ) -> Result<Branch, Failure> {
        let (contact, old, g) = (self.contact, self.history.slot(index), geometry);
        let mut past = self.past(index, g.before.shear);
        if g.before.entered {
            past.penetration = self.law.touch(&past);
        }
        let (place, constants) = (seeded::<T>(g), self.constants(index, g, &past, local.acting));
        let past = Past { penetration: constants.before.max(constants.touch), ..past };
        write_hit(&g.spot, Some(g.hit), new);
        new[entry::CLOSURE] = constants.closure;
        new[entry::COUNT..].copy_from_slice(&old[entry::COUNT..]);
        let mean = self.mean_pressure(index, g, &local.u);
        let (by, mut by_mean) = (mean.as_ref().map(|mean| mean.pressure), [0.0; 2]);
        let (_, closed) = point::evaluate(&place, &constants, |motion| {
            let (response, slopes) = nonlocal::ask((&*self.law, by), motion, &past, &mut new[entry::COUNT..])?;
            by_mean = slopes;
            Ok(response)
        })?;
        let Some(closed) = closed else {
            leave(&*self.law, self.history.slot(index), new);
            self.account(index, g, Carried::default(), local);
            return Ok(0);
        };
        self.refuse_leap(index, (g, &local.u))?;
        new[entry::PENETRATION] -= constants.least;
        write(&closed.response, [closed.slip.re(), 0.0], old, new);
        match contact.options.form {
            ContactForm::Traction => self.add(g, &closed, local),
            ContactForm::Variational | ContactForm::Field => {
                self.add_variational((index, stencil), g, &closed, local)?
            }
        }
        if let Some(mean) = mean.filter(|_| local.wants_tangent) {
            self.add_neighbours((g, by_mean[0]), &mean, local);
        }
        let response = &closed.response;
        self.account(index, g, Carried::of(response), local);
        Ok(response.status as Branch)
    }

    fn constants(&self, index: usize, g: &Geometry, past: &Past, acting: Option<Coordinates>) -> Constants {
        let contact = self.contact;
        Constants {
            normal: g.hit.normal,
            closure: self.closure(index),
            before: past.penetration,
            touch: self.law.touch(past),
            opens: self.law.opens(past, [g.place.slip(), 0.0]),
            least: contact.least,
            weight: g.spot.weight * contact.thickness(),
            acting,
            axisymmetric: contact.space == Space::Axisymmetric,
        }
    }

    /// Refuses a point that closes too deep, and a touching tool that turned too far.
    fn refuse_leap(&self, index: usize, (g, u): (&Geometry, &[f64])) -> Result<(), Failure> {
        let name = || self.contact.describe(index);
        if g.place.touched.is_none() || g.before.entered {
            return refuse_jump(g.hit.u, self.depths[index], name);
        }
        let Some(rigid) = self.contact.target.as_tool() else { return Ok(()) };
        refuse_turn(u[g.layout.hit.end - 1] - self.accepted[rigid.unknowns().end - 1], name)
    }

    /// What the law may know of a point.
    fn past(&self, index: usize, shear: f64) -> Past<'_> {
        let (options, old) = (&self.contact.options, self.history.slot(index));
        Past {
            penalty: options.penalty,
            tangential_penalty: options.tangential_penalty,
            penetration: old[entry::PENETRATION] + old[entry::CLOSURE],
            pressure: old[entry::PRESSURE],
            shear: [shear + options.tangential_penalty * self.shift(index).slip[0], 0.0],
            vars: &old[entry::COUNT..],
            dt: self.dt,
        }
    }

    /// Energy stored by a pressure and a friction stress, and dissipated over the increment: the work of the mean
    /// friction stress on the whole slip, less what of it is stored, and of the mean pressure on the closure that stays.
    /// A point that closes or opens takes part with half its stress, so that one which passes a peak of pressure within an
    /// increment does not lose its work. Where multipliers bear the stress nothing is stored by a slip, and all work is
    /// that of the sliding.
    fn account(&self, index: usize, g: &Geometry, now: Carried, local: &mut Local) {
        let (contact, old) = (self.contact, self.history.slot(index));
        let (options, before) = (&contact.options, g.before.shear);
        let area = contact.acting_area(index, &g.spot, (g.place.a, g.place.tangent));
        let area = area * options.loads.share();
        let multiplied = if now.pressure == 0.0 { 0.0 } else { self.shift(index).closure };
        local.stored = 0.5 * now.pressure * (now.pressure / options.penalty - multiplied) * area;
        let mean = 0.5 * (before + now.shear);
        let friction = if options.augmentation.is_some() {
            mean * now.slipped
        } else {
            let stored = |shear: f64| 0.5 * shear * shear / options.tangential_penalty;
            local.stored += area * stored(now.shear);
            mean * g.place.slip() - (stored(now.shear) - stored(before))
        };
        let pressure = 0.5 * (old[entry::PRESSURE] + now.pressure);
        local.supplied = area * pressure * (self.settled[1] - self.settled[0]) * old[entry::OVERLAP];
        local.dissipated = area * (friction + pressure * now.closure);
    }
}

/// What a point carries, for its energy; the slip has the sign of the shear.
#[derive(Debug, Clone, Copy, Default)]
struct Carried {
    pressure: f64,
    shear: f64,
    slipped: f64,
    closure: f64,
}

impl Carried {
    fn of(response: &Linearised) -> Self {
        let [pressure, shear, _] = response.stress;
        Self { pressure, shear, slipped: response.slipped.copysign(shear), closure: response.closure }
    }
}
