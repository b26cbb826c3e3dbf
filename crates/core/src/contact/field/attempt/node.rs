//! The law at a node, with its forces and its tangent.

use super::FieldAttempt;
use crate::contact::Overlap;
use crate::contact::energy::account;
use crate::contact::field::corner::Pointing;
use crate::contact::field::stencil::{COUNT, NodeSums, StencilInPlace};
use crate::contact::increment::{in_contact, refuse_jump};
use crate::contact::kink::answer;
use crate::contact::record::{area, entry, leave, normal_force, past, write};
use crate::interface::{Past, Status};
use crate::system::{Answer, Branch, Coordinates, Local, Term};
use crate::tensor::root;
use crate::{Failure, FailureKind};
use std::cell::RefCell;
use std::sync::PoisonError;
use std::sync::atomic::Ordering;

/// Step of the stretch in differences, as a part of it.
const STRETCHED: f64 = 1e-5;

impl FieldAttempt<'_> {
    /// What is added to the penetration of a node before the law sees it.
    pub(super) fn closure(&self, slot: usize) -> f64 {
        let options = &self.contact.parts.options;
        // A tip stands back by what is worn of the surface beneath it, and takes none along.
        let [own, beneath] = match self.contact.node_of(slot) {
            Some(_) => [self.law.recession(), 0.0],
            None => [0.0, self.law.recession() * self.worn_beneath(slot)],
        };
        let recession = options.overlap.recession(own, self.history.slot(slot), self.at) - beneath;
        self.shift(slot)[0] + self.nearer[slot].most + recession - self.laid(slot)
    }

    /// What is kept of an open node. A corner or a tip that lets go lies nowhere any more.
    fn leave(&self, slot: usize, old: &[f64], new: &mut [f64]) {
        leave(&*self.law, old, new);
        // Tips of a surface that is meant to fit lie there for good.
        let is_tip = self.contact.node_of(slot).is_none() && self.contact.parts.options.overlap != Overlap::Fit;
        if (self.pointing(slot).is_some() || is_tip) && Overlap::fits(new) && new[entry::OVERLAP] > 0.0 {
            Overlap::lay(new, 0.0);
        }
    }

    /// How much deeper an open node must lie for the law to answer as for a closed one, where it is held: by its bond, or by the first guess if
    /// it was closed, and its pressure, carried on as the unknowns are, still presses.
    pub(super) fn lift(&self, slot: usize, past: &Past, y: [f64; COUNT]) -> f64 {
        let (old, y0) = (self.history.slot(slot), y[0] - self.contact.least);
        if self.bonds[slot] {
            return (self.law.keeps(past) - y0).max(0.0);
        }
        let pressure = old[entry::PRESSURE] + self.part * (old[entry::PRESSURE] - old[entry::PRESSURE_BEFORE]);
        let held = self.hold.load(Ordering::Relaxed) && old[entry::STATUS] > 0.0 && pressure > 0.0;
        if !held || y0 > self.law.opens(past, [y[1], y[2]]) {
            return 0.0;
        }
        self.held.store(true, Ordering::Relaxed);
        past.penetration - y0
    }

    fn shift(&self, slot: usize) -> [f64; COUNT] {
        self.shifts.get(slot).copied().unwrap_or_default()
    }

    /// What the law may know of a node. Penalties are for undeformed area, stresses for present.
    pub(super) fn past(&self, slot: usize, stretch: f64) -> Past<'_> {
        let old = self.history.slot(slot);
        let mut past = past(old, [self.normal, self.tangential[slot]].map(|k| k / stretch), self.at.dt);
        let [_, s, t] = self.shift(slot).map(|shift| past.tangential_penalty * shift);
        past.shear = [past.shear[0] + s, past.shear[1] + t];
        if old[entry::SEGMENT] < 0.0 {
            past.penetration = self.law.touch(&past);
        }
        past
    }

    pub(super) fn evaluate_node(
        &self,
        slot: usize,
        stencil: &StencilInPlace,
        new: &mut [f64],
        local: (&mut Local, &mut NodeSums),
    ) -> Result<Branch, Failure> {
        let (local, sums) = local;
        let (contact, old) = (self.contact, self.history.slot(slot));
        new.fill(0.0);
        new[entry::SEGMENT] = -1.0;
        if let Some(node) = contact.node_of(slot) {
            [new[entry::UNBENT], new[entry::AT_REST]] = self.duals[node];
            new[entry::TAKEN] = stencil.taken();
        }
        if self.sum(stencil, false, sums).is_none() {
            if stencil.is_through() && old[entry::PRESSURE] != 0.0 {
                let reason = format!("the target came through at {}", contact.name_of(slot));
                return Err(Failure::new(reason).of(FailureKind::Passage));
            }
            self.leave(slot, old, new);
            let area = area(old);
            if old[entry::STATUS] > 0.0 {
                let past = self.past(slot, old[entry::HALF]);
                let (terms, options) = ((&*self.law, &past, old), (&contact.parts.options, self.at));
                account(terms, options, ([area, 0.0], 0.0), (None, stencil.slid()), local);
            }
            local.energies.across = -across(old, stencil.parted());
            self.add_fracture(slot, [area, old[entry::HALF]], local);
            return Ok(0);
        }
        let (stretch, stretching) = stencil.stretch();
        let (past, law) = (self.past(slot, stretch), &*self.law);
        let areas = [area(old), sums.area * stretch];
        let (options, multiplied, terms) = (&contact.parts.options, self.shift(slot)[0], (law, &past, old));
        (new[entry::SEGMENT], new[entry::XI], new[entry::HALF]) = (stencil.segment(), sums.area, stretch);
        (new[entry::PENETRATION], new[entry::CLOSURE]) = (sums.y[0], self.closure(slot));
        new[entry::NEARER] = self.nearer[slot].most;
        if let Some(pointing) = self.pointing(slot) {
            new[entry::POINTS..entry::POINTS + 3].copy_from_slice(&pointing.along.0);
        }
        new[entry::COUNT..].copy_from_slice(&old[entry::COUNT..]);
        let (here, slip) = (sums.y[0] + self.closure(slot), [sums.y[1], sums.y[2]]);
        let lift = self.lift(slot, &past, [here, slip[0], slip[1]]);
        let seen = here + lift;
        if self.idle[slot] || seen <= law.opens(&past, slip) + contact.least {
            self.leave(slot, old, new);
            let slid = if old[entry::STATUS] == f64::from(Status::Slip as u8) { slip } else { [0.0; 2] };
            account(terms, (options, self.at), (areas, multiplied), (None, slid), local);
            local.energies.across = -across(old, -here);
            self.add_fracture(slot, [sums.area * stretch, stretch], local);
            return Ok(0);
        }
        self.refuse_leap(slot, (stencil, sums))?;
        let y = [seen, sums.y[1], sums.y[2], 0.0];
        let flat = self.flattened((slot, &past), &y)?;
        // A bond that is held near its strength and bears no more than that is as its law has it.
        let own = if here > law.opens(&past, slip) + contact.least { here } else { seen };
        let (touch, penetration) = (law.touch(&past), own - contact.least - flat);
        new[entry::PENETRATION] -= contact.least;
        (new[entry::CLOSURE], new[entry::NEARER]) = (new[entry::CLOSURE] - flat, new[entry::NEARER] - flat);
        let part = in_contact(penetration - touch, past.penetration - touch);
        let (whole, slip) = (slip, slip.map(|slip| slip * part));
        let entered = Past { penetration: past.penetration.max(touch), ..past };
        let mut response = law.respond([penetration, slip[0], slip[1]], &entered, &mut new[entry::COUNT..])?;
        let slip = if self.bore && response.status == Status::Slip {
            response.slide(whole[0].hypot(whole[1]) * (1.0 - part));
            whole
        } else {
            slip
        };
        write(&response, (slip, law.recession()), old, new);
        let laid = self.laid(slot);
        if laid > 0.0 {
            Overlap::lay(new, laid);
        }
        if let Some(node) = contact.node_of(slot) {
            new[entry::WORN] += (new[entry::RUBBED] - old[entry::RUBBED]) * (sums.area / contact.areas[node]).min(1.0);
        }
        if local.wants_tangent {
            self.sum(stencil, true, sums);
        }
        stencil.find_forces(sums);
        let n = local.force.len();
        let mut t = response.stress;
        let wanted = local.wants_tangent || lift > 0.0;
        let tangent = if wanted { self.behind((slot, &past), flat, &y)? } else { Answer::default() };
        let tangent = self.extended(slot, tangent, lift);
        if lift > 0.0 {
            t.copy_from_slice(&tangent.stress[..COUNT]);
        }
        for (c, t) in t.iter().enumerate() {
            let unit = &sums.forces[c * n..(c + 1) * n];
            local.force.iter_mut().zip(unit).for_each(|(force, unit)| *force += stretch * t * unit);
        }
        if local.wants_tangent {
            add_material(&tangent.slopes, stretch, sums, &mut local.tangent);
            let acting = local.acting.map_or(t, |acting| [acting[0], acting[1], acting[2]]);
            stencil.add_geometric(acting, stretch, sums, &mut local.tangent);
            let slopes = self.stretch_slopes((slot, stretch), y)?;
            add_stretching(&slopes, &stretching, sums, &mut local.tangent);
            let y = [here, sums.y[1], sums.y[2]];
            self.linear[slot].lock().unwrap_or_else(PoisonError::into_inner).keep(stencil.at.u, y, stretch, sums);
        }
        account(terms, (options, self.at), (areas, multiplied), (Some(&response), slip), local);
        new[entry::PENALTY] = self.normal;
        local.energies.supplied += sums.area * self.supplied(old, new);
        if old[entry::STATUS] == 0.0 {
            local.energies.across = across(new, self.gap_before(slot));
        }
        let pressure = 0.5 * (old[entry::PRESSURE] + new[entry::PRESSURE]);
        let nearer = new[entry::NEARER] - old[entry::NEARER] + self.redrawn.get(slot).copied().unwrap_or_default();
        local.energies.supplied += sums.area * stretch * pressure * nearer;
        Ok(response.status as Branch)
    }

    /// The answer of a closed node, carried on along its tangent to a penetration that is less by `lift`; a bond keeps its shear strength.
    pub(super) fn extended(&self, slot: usize, mut answer: Answer, lift: f64) -> Answer {
        if self.bonds[slot] && lift > 0.0 {
            answer.slopes[1..].iter_mut().for_each(|slopes| slopes[0] = 0.0);
        }
        answer.stress.iter_mut().zip(&answer.slopes).for_each(|(stress, slopes)| *stress -= slopes[0] * lift);
        answer
    }

    /// Takes up the fracture energy of the bond of a node that opens: what it stores at its tensile strength over its present `area`.
    fn add_fracture(&self, slot: usize, [area, stretch]: [f64; 2], local: &mut Local) {
        if self.history.slot(slot)[entry::STATUS] > 0.0 {
            let past = self.past(slot, stretch);
            let fracture = area * self.law.stored(self.law.tensile_strength(&past), past.penalty);
            (local.energies.bonds, local.energies.dissipated) = (fracture, local.energies.dissipated + fracture);
        }
    }

    /// What the law answers at a node, where what bears flattens.
    pub(super) fn answer_of(&self, (slot, past): (usize, &Past), y: &Coordinates) -> Result<Answer, Failure> {
        let flat = self.flattened((slot, past), y)?;
        self.behind((slot, past), flat, y)
    }

    /// How a corner touches, of its slot.
    pub(super) fn pointing(&self, slot: usize) -> Option<&Pointing> {
        self.pointings.get(slot.checked_sub(self.contact.nodal_slots())?)
    }

    /// By how much the pressure of a node makes less what is added to its penetration: a spring in series with the law.
    fn flattened(&self, (slot, past): (usize, &Past), y: &Coordinates) -> Result<f64, Failure> {
        let nearer = &self.nearer[slot];
        let least = self.contact.least;
        let most = nearer.most.min(y[0] - self.law.opens(past, [y[1], y[2]]) - least);
        if nearer.most <= least || most <= 0.0 {
            return Ok(0.0);
        }
        // A bond under tension flattens nothing.
        if answer(&*self.law, past, least, y)?.stress[0] <= 0.0 {
            return Ok(0.0);
        }
        let failure = RefCell::new(None);
        let flat = root([0.0, most], |flat| match answer(&*self.law, past, least, &[y[0] - flat, y[1], y[2], y[3]]) {
            Ok(Answer { stress, slopes }) => {
                let [taken, slope] = nearer.flattening(stress[0]);
                [flat - taken, 1.0 + slope * slopes[0][0]]
            }
            Err(error) => {
                *failure.borrow_mut() = Some(error);
                [0.0, 1.0]
            }
        });
        failure.into_inner().map_or(Ok(flat), Err)
    }

    /// What the law answers behind so much of flattening, with the slopes of both in series.
    fn behind(&self, (slot, past): (usize, &Past), flat: f64, y: &Coordinates) -> Result<Answer, Failure> {
        let mut found = answer(&*self.law, past, self.contact.least, &[y[0] - flat, y[1], y[2], y[3]])?;
        if flat > 0.0 {
            let [_, slope] = self.nearer[slot].flattening(found.stress[0]);
            let pressure = found.slopes[0].map(|rate| rate / (1.0 + slope * found.slopes[0][0]));
            for rates in &mut found.slopes {
                let closing = rates[0] * slope;
                rates.iter_mut().zip(&pressure).for_each(|(rate, pressure)| *rate -= closing * pressure);
            }
        }
        Ok(found)
    }

    /// Derivative of the stresses over undeformed area along the stretch, as a central difference: zero but for laws that know a
    /// stress of their own.
    fn stretch_slopes(&self, (slot, stretch): (usize, f64), y: Coordinates) -> Result<[f64; COUNT], Failure> {
        let step = STRETCHED * stretch;
        let at = |stretch: f64| {
            let stress = self.answer_of((slot, &self.past(slot, stretch)), &y)?.stress;
            Ok::<_, Failure>(stress.map(|stress| stress * stretch))
        };
        let (up, down) = (at(stretch + step)?, at(stretch - step)?);
        Ok(std::array::from_fn(|c| {
            let (rise, size) = (up[c] - down[c], up[c].abs() + down[c].abs());
            if rise.abs() <= 1e-12 * size { 0.0 } else { 0.5 * rise / step }
        }))
    }

    /// Energy per undeformed area that a penalty raised since the accepted state adds: what the mean pressure does over the increment is
    /// less than what is then stored.
    fn supplied(&self, old: &[f64], new: &[f64]) -> f64 {
        let [before, now] = [old, new].map(|values| values[entry::PRESSURE] * values[entry::HALF]);
        let raised = old[entry::PENALTY] > 0.0 && self.contact.parts.options.augmentation.is_none();
        let compliance = if raised { 1.0 / old[entry::PENALTY] - 1.0 / self.normal } else { 0.0 };
        0.5 * before * now * compliance
    }

    /// Refuses a node that closes too deep, and a touching tool that turned too far.
    fn refuse_leap(&self, slot: usize, (stencil, sums): (&StencilInPlace, &NodeSums)) -> Result<(), Failure> {
        let contact = self.contact;
        let depth = stencil.faces().map(|face| self.depths[face]).fold(f64::INFINITY, f64::min);
        let old = self.history.slot(slot);
        if old[entry::STATUS] == 0.0 {
            // Overlap that is yet to be removed lay there before, and so did a corner or tip that the field bore.
            let lay = if old[entry::SEGMENT] >= 0.0 { old[entry::PENETRATION].max(0.0) } else { 0.0 };
            refuse_jump(sums.y[0] - lay.max(self.laid(slot)), depth, || contact.name_of(slot))?;
        }
        let Some(rigid) = contact.parts.target.as_tool() else { return Ok(()) };
        rigid.refuse_turn(stencil.at.motion(), self.accepted, || contact.name_of(slot))
    }
}

/// What the trapezoid of the work of supports and loads has over a `gap` of a node that was, or is, closed at its end: half the pressure all
/// the way, while there is none where the node is apart from the target.
fn across(closed: &[f64], gap: f64) -> f64 {
    0.5 * normal_force(closed) * gap.max(0.0)
}

/// Adds what stresses over undeformed area change with the stretch.
fn add_stretching(slopes: &[f64; COUNT], stretching: &[f64], sums: &NodeSums, tangent: &mut [f64]) {
    let n = stretching.len();
    for (c, slope) in slopes.iter().enumerate().filter(|(_, slope)| **slope != 0.0) {
        for (force, row) in sums.forces[c * n..(c + 1) * n].iter().zip(tangent.chunks_exact_mut(n)) {
            row.iter_mut().zip(stretching).for_each(|(entry, rate)| *entry += force * slope * rate);
        }
    }
}

/// Adds `factor H C G`.
fn add_material(slopes: &[Coordinates; 4], factor: f64, sums: &NodeSums, tangent: &mut [f64]) {
    let n = sums.gradients.len() / COUNT;
    for (c, slopes) in slopes.iter().enumerate().take(COUNT) {
        if slopes.iter().all(|slope| *slope == 0.0) {
            continue;
        }
        let row = |j: usize| (0..COUNT).map(|d| slopes[d] * sums.gradients[d * n + j]).sum::<f64>() * factor;
        let change: Vec<f64> = (0..n).map(row).collect();
        for (force, row) in sums.forces[c * n..(c + 1) * n].iter().zip(tangent.chunks_exact_mut(n)) {
            if *force != 0.0 {
                row.iter_mut().zip(&change).for_each(|(entry, change)| *entry += force * change);
            }
        }
    }
}
