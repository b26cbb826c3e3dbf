//! A contact in space during one attempt: its points as stencils, evaluated on the facets that the search found.

use super::geometry::{DIRECTIONS, Geometry};
use super::pair::Contact;
use super::point::{self, Constants};
use super::rigid;
use super::surface::SurfacePoint;
use super::target::Standing;
use crate::Failure;
use crate::contact::ContactForm;
use crate::contact::augment::Shift;
use crate::contact::capture::{refuse_jump, refuse_turn};
use crate::contact::kink::{answer, answer_by_mean};
use crate::contact::nonlocal;
use crate::contact::record::{entry, leave, stresses, write};
use crate::contact::seed::Seed;
use crate::interface::{Interface, Linearised, Past};
use crate::system::{Answer, Attempt, Branch, Coordinates, Couplings, History, Kinks, Local, Stencil, Stencils};
use crate::tensor::{Dual, Vec3};
use crate::tool::space::Hit;
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
    /// Rotation vector of the tool in the accepted state; zero where there is none.
    pub rotation: Vec3,
    /// Largest gap at which the target is seen.
    pub reach: f64,
    /// Unknowns that the last increment, carried on, leads to: a guess of what will couple.
    pub ahead: Vec<f64>,
    /// Multipliers of the corners; none without augmentation.
    pub shifts: Vec<Shift>,
    /// Tangents of the points in the accepted state, with augmentation.
    pub frames: Vec<[Vec3; 2]>,
    /// How often multipliers were improved in the attempt.
    pub augmented: usize,
    /// The part of the overlap that is removed at the beginning and at the end.
    pub settled: [f64; 2],
    /// Length of the increment.
    pub dt: f64,
}

/// Begins the new history of a point with what the search found.
pub fn write_hit(spot: &SurfacePoint, hit: Option<Hit>, values: &mut [f64]) {
    values.fill(0.0);
    ([values[entry::XI], values[entry::XI2]], values[entry::HALF]) = (spot.xi, spot.scale);
    match hit {
        Some(hit) => {
            values[entry::PENETRATION] = hit.u;
            values[entry::SEGMENT] = hit.facet as f64;
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
        if self.contact.parts.target.deforms() || !self.contact.around.is_empty() {
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
        let Some(geometry) = self.geometry(index, (stencil, local.wants_tangent), &local.u)? else {
            write_hit(&self.contact.parts.surface.points[index], None, new);
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
        if let Some(geometry) = self.geometry(index, (stencil, true), u)? {
            self.bend((index, stencil), &geometry, u, out);
        }
        Ok(())
    }

    fn before(&self, stencil: usize) -> Coordinates {
        stresses(self.history.slot(stencil))
    }

    fn answer(&self, stencil: usize, y: &Coordinates) -> Result<Answer, Failure> {
        let (law, past, least) = (&*self.law, self.past(stencil), self.contact.least);
        if self.contact.neighbours.is_empty() {
            return answer(law, &past, least, y);
        }
        answer_by_mean(law, &past, (least, 2), y)
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

pub(super) fn seed<T: Seed<DIRECTIONS>>(v: Vec3, first: usize) -> Vec3<T> {
    Vec3(std::array::from_fn(|i| T::seed(v[i], first + i)))
}

impl OpenContact<'_> {
    fn evaluate_over<T: Seed<DIRECTIONS>>(
        &self,
        (index, stencil): (usize, &Stencil),
        g: &Geometry,
        new: &mut [f64],
        local: &mut Local,
    ) -> Result<Branch, Failure> {
        let old = self.history.slot(index);
        let place = Self::seeded::<T>(g);
        let mut past = self.past(index);
        if g.before.entered {
            past.penetration = self.law.touch(&past);
        }
        let constants = self.constants(index, g, &past, local.acting);
        let past = Past { penetration: constants.before.max(constants.touch), ..past };
        write_hit(&g.spot, Some(g.hit), new);
        new[entry::CLOSURE] = constants.closure;
        new[entry::COUNT..].copy_from_slice(&old[entry::COUNT..]);
        let mean = self.mean_pressure(index, g, &local.u);
        let law = (&*self.law, mean.as_ref().map(|mean| mean.pressure));
        let mut by_mean = [0.0; 2];
        let (_, closed) = point::evaluate(&place, &constants, |motion| {
            let (response, slopes) = nonlocal::ask(law, motion, &past, &mut new[entry::COUNT..])?;
            by_mean = slopes;
            Ok(response)
        })?;
        let Some(closed) = closed else {
            leave(&*self.law, self.history.slot(index), new);
            self.account(index, g, Carried::default(), local);
            return Ok(0);
        };
        if g.place.touched.is_none() || g.before.entered {
            refuse_jump(g.hit.u, self.depths[index], || self.contact.describe(index))?;
        }
        self.refuse_turn(index, (g, &local.u))?;
        new[entry::PENETRATION] -= constants.least;
        write(&closed.response, closed.slip.map(T::re), old, new);
        match self.contact.parts.options.form {
            ContactForm::Traction => self.add(g, &closed, local),
            ContactForm::Variational | ContactForm::Field => {
                self.add_variational((index, stencil), g, &closed, local)?
            }
        }
        if let Some(mean) = mean.filter(|_| local.wants_tangent) {
            self.add_neighbours((g, by_mean), &mean, local);
        }
        let response = &closed.response;
        self.account(index, g, Carried::of(response), local);
        Ok(response.status as Branch)
    }

    fn constants(&self, index: usize, g: &Geometry, past: &Past, acting: Option<Coordinates>) -> Constants {
        Constants {
            normal: g.hit.normal,
            closure: self.closure(index),
            before: past.penetration,
            touch: self.law.touch(past),
            opens: self.law.opens(past, g.place.slip()),
            least: self.contact.least,
            weight: g.spot.weight,
            acting,
        }
    }

    /// What the law may know of a point.
    fn past(&self, index: usize) -> Past<'_> {
        let (options, old) = (&self.contact.parts.options, self.history.slot(index));
        let slips = self.shift(index).1;
        let shear = |k: usize, entry: usize| old[entry] + options.tangential_penalty * slips[k];
        Past {
            penalty: options.penalty,
            tangential_penalty: options.tangential_penalty,
            penetration: old[entry::PENETRATION] + old[entry::CLOSURE],
            pressure: old[entry::PRESSURE],
            shear: [shear(0, entry::SHEAR), shear(1, entry::SHEAR2)],
            vars: &old[entry::COUNT..],
            dt: self.dt,
        }
    }

    /// Energy stored by a pressure and a friction stress, and dissipated over the increment: the work of the mean
    /// friction stress on the whole slip, less what of it is stored, and of the mean pressure on the closure that stays.
    /// A point that closes or opens takes part with half its stress. Where multipliers bear the stress nothing is stored by
    /// a slip, and all work is that of the sliding.
    fn account(&self, index: usize, g: &Geometry, now: Carried, local: &mut Local) {
        let (options, old) = (&self.contact.parts.options, self.history.slot(index));
        let before = [old[entry::SHEAR], old[entry::SHEAR2]];
        let area = self.contact.acting_area(index, &g.spot, g.place.tangents) * options.loads.share();
        let multiplied = if now.pressure == 0.0 { 0.0 } else { self.shift(index).0 };
        local.stored = 0.5 * now.pressure * (now.pressure / options.penalty - multiplied) * area;
        let work = |slip: [f64; 2]| (0..2).map(|i| 0.5 * (before[i] + now.shear[i]) * slip[i]).sum::<f64>();
        let friction = if options.augmentation.is_some() {
            work(now.slid)
        } else {
            let stored = |[s, t]: [f64; 2]| 0.5 * (s * s + t * t) / options.tangential_penalty;
            local.stored += area * stored(now.shear);
            work(g.place.slip()) - (stored(now.shear) - stored(before))
        };
        let pressure = 0.5 * (old[entry::PRESSURE] + now.pressure);
        local.supplied = area * pressure * (self.settled[1] - self.settled[0]) * old[entry::OVERLAP];
        local.dissipated = area * (friction + pressure * now.closure);
    }

    /// Refuses a touching tool that turned too far.
    fn refuse_turn(&self, index: usize, (g, u): (&Geometry, &[f64])) -> Result<(), Failure> {
        if self.contact.parts.target.deforms() || g.place.touched.is_none() {
            return Ok(());
        }
        let turned = (rigid::pose(&u[g.layout.hit.clone()]).rotation - self.rotation).norm();
        refuse_turn(turned, || self.contact.describe(index))
    }
}

/// What a point carries, for its energy; the sliding is along the shear.
#[derive(Debug, Clone, Copy, Default)]
struct Carried {
    pressure: f64,
    shear: [f64; 2],
    slid: [f64; 2],
    closure: f64,
}

impl Carried {
    fn of(response: &Linearised) -> Self {
        let shear = response.shear();
        let part = response.slipped / shear[0].hypot(shear[1]).max(f64::MIN_POSITIVE);
        Self { pressure: response.pressure(), shear, slid: shear.map(|s| s * part), closure: response.closure }
    }
}
