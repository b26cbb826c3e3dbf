//! The field during one attempt: who sees whom, the law at each node, forces and tangents.

use super::configuration::{Configuration, TargetInPlace};
use super::contact::{FieldContact, FieldTarget};
use super::corner::Pointing;
use super::corners::WAYS;
use super::cover::{CornerTouch, FEET, Landing, Patch};
use super::face::{FieldFace, ShapeFunctions, moved};
use super::faces::{FaceProjection, FaceRay, LEAST_COSINE};
use super::linear::Linear;
use super::nearer::Nearer;
use super::nodes::NodesInPlace;
use super::point::{Facing, Touched};
use super::space::{Spread, spread};
use super::spot::{GAUSS, IntervalPoint};
use super::stencil::{COUNT, NodeSums, StencilInPlace};
use super::support::FieldSearch;
use super::tip::TipFoot;
use crate::contact::Overlap;
use crate::contact::augment;
use crate::contact::energy::account;
use crate::contact::increment::{in_contact, refuse_jump};
use crate::contact::kink::answer;
use crate::contact::record::{entry, leave, past, stresses, write};
use crate::interface::{Interface, Past, Status};
use crate::system::{
    Answer, Attempt, Branch, Coordinates, Couplings, History, Instant, Kinks, Local, Stencil, Stencils, Term,
};
use crate::tensor::{Vec3, root};
use crate::{Failure, FailureKind};
use std::cell::RefCell;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError, RwLock};

thread_local! {
    static SUMS: RefCell<NodeSums> = RefCell::default();
}

/// A field during one attempt.
pub struct FieldAttempt<'a> {
    /// The contact.
    pub contact: &'a FieldContact,
    /// The law at its end.
    pub law: Arc<dyn Interface>,
    /// Its history in the accepted state.
    pub history: &'a History,
    /// Accepted unknowns.
    pub accepted: &'a [f64],
    /// The accepted configuration.
    pub before: Configuration<'a>,
    /// Where the tips of the tool lay in it.
    pub tips_before: Vec<Option<TipFoot>>,
    /// How corners of bodies touch.
    pub pointings: Vec<Pointing>,
    /// Largest admissible penetration at each face.
    pub depths: Vec<f64>,
    /// Largest shares of dual functions at each node.
    pub duals: Vec<[f64; 2]>,
    /// Largest gap at which the target is seen.
    pub reach: f64,
    /// Unknowns that the last increment, carried on, leads to: a guess of what will couple.
    pub ahead: Vec<f64>,
    /// How much nearer the target lies than in the mean, slot by slot.
    pub nearer: Vec<Nearer>,
    /// How much deeper closed nodes lie by the arcs of the accepted state than by those of the one before it, slot by slot; none over flat faces.
    pub redrawn: Vec<f64>,
    /// Closure and slips that multipliers stand for, slot by slot.
    pub shifts: Vec<[f64; COUNT]>,
    /// How often they were improved in the attempt,
    pub augmented: usize,
    /// and the penetration that the last improvement with the same penalty began from.
    pub before_augmented: f64,
    /// When it ends.
    pub at: Instant,
    /// Normal penalty of the attempt,
    pub normal: f64,
    /// whether that was changed in it,
    pub stiffened: bool,
    /// and the tangential ones, slot by slot.
    pub tangential: Vec<f64>,
    /// What the last search found.
    pub found: RwLock<Arc<FieldSearch>>,
    /// How the coordinates of closed nodes changed and what forces their stresses were where they were evaluated last.
    pub linear: Vec<Mutex<Linear>>,
    /// Bonds that hold whatever they bear until the state has converged, slot by slot.
    pub bonds: Vec<bool>,
    /// Nodes that leave the stress to others of their faces, slot by slot.
    pub idle: Vec<bool>,
    /// Whether any node bore a pressure at the accepted state: one that closes then takes over from others what slides all the while.
    pub bore: bool,
    /// Gap from which on a node is too far away to close in the next iteration.
    pub far: f64,
    /// Length of the increment over that of the last; zero without one.
    pub part: f64,
    /// Whether this is the first guess, which holds nodes closed,
    pub hold: AtomicBool,
    /// and whether it held any that is open there.
    pub held: AtomicBool,
}

impl FieldAttempt<'_> {
    /// The configuration at unknowns `u`, with the arcs of the accepted one.
    fn in_place(&self, u: &[f64]) -> Configuration<'_> {
        Configuration::with(self.contact, u, self.before.arcs.clone())
    }

    fn search(&self, u: &[f64]) -> FieldSearch {
        let now = Configuration { duals: &self.duals, ..self.in_place(u) };
        let tips = now.tips(self.contact.longest, Some(&self.tips_before), |foot| self.foot_before(foot));
        let list_touched =
            |now: &Configuration, patch: &Patch, nodes: &mut Vec<usize>| self.list_touched(now, patch, nodes);
        let mut found = self.contact.find(
            (&now, tips, &self.pointings),
            self.reach,
            (&self.depths, (&self.before, self.accepted)),
            Some(self.history),
            list_touched,
        );
        for (slot, support) in found.supports.iter_mut().enumerate() {
            let pressed = self.history.slot(slot)[entry::PRESSURE] > 0.0;
            if let Some(node) = self.contact.node_of(slot).filter(|_| pressed && support.patches.is_empty()) {
                support.parted = now.parted(node, slot % self.contact.pieces);
            }
        }
        found
    }

    /// Nodes of the faces that the points of a patch saw at the accepted state.
    fn list_touched(&self, now: &Configuration, patch: &Patch, nodes: &mut Vec<usize>) {
        if patch.tip.is_some() {
            let seen = self.before_tip(patch).map(|(face, _)| face);
            seen.into_iter().for_each(|face| nodes.extend_from_slice(&self.contact.parts.surface.faces[face].nodes));
            return;
        }
        if let Some(touch) = patch.corner {
            let seen = self.before_corner(touch).map(|(_, face, _)| face);
            seen.into_iter().for_each(|face| nodes.extend_from_slice(&face.nodes));
            return;
        }
        let Some(faces) = self.contact.parts.target.as_faces() else { return };
        let mut places = Vec::new();
        if let (TargetInPlace::Faces(target), false) = (&now.target, self.contact.parts.surface.plane) {
            let (cubic, own) = (self.contact.is_cubic(patch), now.face(patch.face));
            spread(cubic, own.corners(), target.corners(patch.target), |place: Spread<f64>| places.push(place.xi));
        } else {
            let [from, to] = patch.near;
            let place = |point: &IntervalPoint| [0.5 * (from + to) + 0.5 * (to - from) * point.eta, 0.0];
            places.extend(GAUSS.iter().map(place));
        }
        let own = &self.contact.parts.surface.faces[patch.face];
        places.extend(patch.vertices().map(|corner| own.corner_place(corner)));
        for xi in places {
            if let Some((face, _)) = self.seen_before(patch, xi, |_| true) {
                nodes.extend_from_slice(&faces.surface.faces[face].nodes);
            }
        }
    }

    /// The face that a place saw at the accepted state: of those that are `known` the nearest that looked at it, or what continues
    /// the one seen now.
    fn seen_before(
        &self,
        patch: &Patch,
        xi: [f64; 2],
        known: impl Fn(usize) -> bool,
    ) -> Option<(usize, FaceProjection)> {
        let TargetInPlace::Faces(before) = &self.before.target else { return None };
        let at = self.before.face(patch.face).at(xi);
        let ray = FaceRay { x: at.x, n: at.normal.unit() };
        let range = [-2.0 * self.depths[patch.face], 2.0 * self.reach];
        let admits = |face: usize, hit: &FaceProjection| {
            self.contact.may_touch(patch.face, face) && -hit.normal().dot(ray.n) > LEAST_COSINE && known(face)
        };
        let present = before.project(patch.target, &ray).map(|hit| (patch.target, hit));
        let same = |&(face, hit): &(usize, FaceProjection)| {
            let within = before.holds(face, hit.s, 1e-9) && (range[0]..=range[1]).contains(&hit.gap);
            within && admits(face, &hit)
        };
        // In space the search is dear, and most places see what they saw.
        if let Some(present) = present.filter(|present| !self.contact.parts.surface.plane && same(present)) {
            return Some(present);
        }
        before.nearest(&ray, range, admits).or(present)
    }

    /// The face on which a foot of a tip lay at the accepted state.
    fn foot_before(&self, foot: usize) -> Option<usize> {
        Some(self.tips_before.get(foot)?.as_ref()?.patch.face)
    }

    /// Face over which a foot of a tip lay at the accepted state, and where; if it has none, that of another foot of the tip.
    fn before_tip(&self, patch: &Patch) -> Option<(usize, Landing)> {
        let first = patch.target / FEET * FEET;
        let feet = [patch.target].into_iter().chain(first..first + FEET);
        let found = feet.filter_map(|foot| self.tips_before.get(foot).copied().flatten()).next()?;
        Some((found.patch.face, found.patch.tip?))
    }

    /// The face of the other side that a corner saw at the accepted state along the direction in which it points, by its number, and where.
    fn before_corner(&self, touch: CornerTouch) -> Option<(usize, &FieldFace, ShapeFunctions)> {
        let own = self.contact.corners[touch.number / WAYS].own;
        let (face, shape) = self.pointings[touch.number].saw?;
        Some((face, self.contact.face_of(!own, face)?, shape))
    }

    fn recall(&self, at: &NodesInPlace, patch: &Patch, xi: [f64; 2]) -> Option<Touched> {
        if patch.tip.is_some() {
            let (number, landing) = self.before_tip(patch)?;
            let face = &self.contact.parts.surface.faces[number];
            let shape = face.shape(landing.xi);
            let (now, tip) = (shape.value(at.placed(face).nodes()), at.tool.as_ref()?.place(landing.own));
            let face = Some((number, shape));
            return Some(Touched { now, slopes: [Vec3::zero(); 2], facing: None, face, tip });
        }
        if let Some(touch) = patch.corner {
            let (number, face, shape) = self.before_corner(touch)?;
            let (now, face) = (shape.value(at.placed(face).nodes()), Some((number, shape)));
            return Some(Touched { now, slopes: [Vec3::zero(); 2], facing: None, face, tip: now });
        }
        let face = self.before.face(patch.face);
        let place = face.at(xi);
        match (&self.before.target, &self.contact.parts.target) {
            (TargetInPlace::Tool(before), FieldTarget::Tool(_)) => {
                let (foot, now) = (before.closest(patch.target, place.x), at.tool.as_ref()?);
                let carry = |v: Vec3| now.rotate(before.rotate_back(v));
                let slopes = place.tangents.map(|tangent| carry(foot.slide(tangent)));
                let [a, b] = face.at(face.face.middle()).tangents;
                let m = a.cross(b);
                let facing = Facing {
                    n: -carry(foot.normal),
                    slopes: place.tangents.map(|tangent| -carry(foot.turned(tangent))),
                    contravariant: [b.cross(m), m.cross(a)].map(|base| carry(base * m.dot(m).recip())),
                };
                Some(Touched {
                    now: now.place(before.withdraw(foot.point)),
                    slopes,
                    facing: Some(facing),
                    face: None,
                    tip: Vec3::zero(),
                })
            }
            (TargetInPlace::Faces(_), FieldTarget::Faces(faces)) => {
                // A state beside the one that was searched may have seen others by a hair.
                let nodes = |face: usize| faces.surface.faces[face].nodes.iter();
                let known = |face: usize| nodes(face).all(|node| at.place(*node).is_some());
                let (number, hit) = self.seen_before(patch, xi, known)?;
                let n = place.normal.unit();
                let placed = at.placed(&faces.surface.faces[number]);
                let [a, b] = hit.shape.tangents(placed.nodes(), self.contact.parts.surface.plane);
                let slopes = [0, 1].map(|k| {
                    let (_, s) =
                        hit.follow(n, place.tangents[k] + place.normal.turned(place.normal_slopes[k]) * hit.gap);
                    a * s[0] + b * s[1]
                });
                let (now, face) = (hit.shape.value(placed.nodes()), Some((number, hit.shape)));
                Some(Touched { now, slopes, facing: None, face, tip: Vec3::zero() })
            }
            _ => None,
        }
    }

    /// What is added to the penetration of a node before the law sees it.
    fn closure(&self, slot: usize) -> f64 {
        let options = &self.contact.parts.options;
        // A tip stands back by what is worn of the surface beneath it, and takes none along.
        let [own, beneath] = match self.contact.node_of(slot) {
            Some(_) => [self.law.recession(), 0.0],
            None => [0.0, self.law.recession() * self.worn_beneath(slot)],
        };
        let recession = options.overlap.recession(own, self.history.slot(slot), self.at) - beneath;
        self.shift(slot)[0] + self.nearer[slot].most + recession - self.laid(slot)
    }

    /// How deep a corner lay in what it begins to touch in this increment.
    fn laid(&self, slot: usize) -> f64 {
        let begins = self.history.slot(slot)[entry::OVERLAP] == 0.0;
        self.pointing(slot).filter(|_| begins).map_or(0.0, |pointing| pointing.laid)
    }

    /// What is kept of an open node. A corner that lets go lies nowhere any more.
    fn leave(&self, slot: usize, old: &[f64], new: &mut [f64]) {
        leave(&*self.law, old, new);
        if self.pointing(slot).is_some() && Overlap::fits(new) && new[entry::OVERLAP] > 0.0 {
            Overlap::lay(new, 0.0);
        }
    }

    /// How much deeper an open node must lie for the law to answer as for a closed one, where it is held: by its bond, or by the first guess if
    /// it was closed, and its pressure, carried on as the unknowns are, still presses.
    fn lift(&self, slot: usize, past: &Past, y: [f64; COUNT]) -> f64 {
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
    fn past(&self, slot: usize, stretch: f64) -> Past<'_> {
        let old = self.history.slot(slot);
        let mut past = past(old, [self.normal, self.tangential[slot]].map(|k| k / stretch), self.at.dt);
        let [_, s, t] = self.shift(slot).map(|shift| past.tangential_penalty * shift);
        past.shear = [past.shear[0] + s, past.shear[1] + t];
        if old[entry::SEGMENT] < 0.0 {
            past.penetration = self.law.touch(&past);
        }
        past
    }

    fn stencil<'s>(&'s self, found: &'s FieldSearch, slot: usize, u: &'s [f64]) -> StencilInPlace<'s> {
        StencilInPlace::new(self.contact, (found, slot), u)
    }

    /// The sums of a node; None where it sees nothing.
    fn sum(&self, stencil: &StencilInPlace, derivatives: bool, sums: &mut NodeSums) -> Option<()> {
        if !stencil.sees() {
            return None;
        }
        stencil.sum((&|at, patch, xi| self.recall(at, patch, xi), self.carried(stencil)), derivatives, sums)
    }

    /// The line that the tangents of a node followed at the accepted state, moved with the tool.
    fn carried(&self, stencil: &StencilInPlace) -> Option<Vec3> {
        let (TargetInPlace::Tool(before), Some(now)) = (&self.before.target, &stencil.at.tool) else { return None };
        let (mesh, dofs) = (&self.contact.parts.mesh, &self.contact.parts.dofs);
        let [from, to] =
            stencil.line()?.nodes.map(|node| moved(mesh.points[node], &self.accepted[dofs.displacements(node)]));
        Some(now.rotate(before.rotate_back(to - from)))
    }

    fn found(&self) -> Arc<FieldSearch> {
        self.found.read().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn evaluate_node(
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
        }
        if self.sum(stencil, false, sums).is_none() {
            if stencil.is_through() && old[entry::PRESSURE] != 0.0 {
                let reason = format!("the target came through at {}", contact.name_of(slot));
                return Err(Failure::new(reason).of(FailureKind::Passage));
            }
            self.leave(slot, old, new);
            local.energies.across = -across(old, stencil.parted());
            self.add_fracture(slot, [old[entry::XI] * old[entry::HALF], old[entry::HALF]], local);
            return Ok(0);
        }
        let (stretch, stretching) = stencil.stretch();
        let (past, law) = (self.past(slot, stretch), &*self.law);
        let areas = [old[entry::XI] * old[entry::HALF], sums.area * stretch];
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
    fn extended(&self, slot: usize, mut answer: Answer, lift: f64) -> Answer {
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
    fn answer_of(&self, (slot, past): (usize, &Past), y: &Coordinates) -> Result<Answer, Failure> {
        let flat = self.flattened((slot, past), y)?;
        self.behind((slot, past), flat, y)
    }

    /// How a corner touches, of its slot.
    fn pointing(&self, slot: usize) -> Option<&Pointing> {
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

    /// The gap at the accepted state of a node that closes.
    fn gap_before(&self, slot: usize) -> f64 {
        let (old, node) = (self.history.slot(slot), self.contact.node_of(slot));
        match node.filter(|_| old[entry::SEGMENT] < 0.0) {
            Some(node) => self.before.parted(node, slot % self.contact.pieces),
            None if old[entry::SEGMENT] < 0.0 && self.contact.corner_of(slot).is_some() => {
                self.pointings[slot - self.contact.nodal_slots()].gap.max(0.0)
            }
            None => -(old[entry::PENETRATION] + self.closure(slot)),
        }
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
            // Overlap that is yet to be removed lay there before.
            let lay = if old[entry::SEGMENT] >= 0.0 { old[entry::PENETRATION].max(0.0) } else { 0.0 };
            refuse_jump(sums.y[0] - lay, depth, || contact.name_of(slot))?;
        }
        let Some(rigid) = contact.parts.target.as_tool() else { return Ok(()) };
        rigid.refuse_turn(stencil.at.motion(), self.accepted, || contact.name_of(slot))
    }
}

/// What the trapezoid of the work of supports and loads has over a `gap` of a node that was, or is, closed at its end: half the pressure all
/// the way, while there is none where the node is apart from the target.
fn across(closed: &[f64], gap: f64) -> f64 {
    0.5 * closed[entry::PRESSURE].max(0.0) * closed[entry::HALF] * closed[entry::XI] * gap.max(0.0)
}

/// Step of the stretch in differences, as a part of it.
const STRETCHED: f64 = 1e-5;

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

impl Attempt for FieldAttempt<'_> {
    fn is_fixed(&self) -> bool {
        false
    }

    fn scratch(&self, index: usize) -> Vec<f64> {
        vec![0.0; self.history.slot(index).len()]
    }

    fn reach(&self, couplings: &mut Couplings) {
        let mut stencils = Stencils::default();
        self.list(&self.ahead, &mut stencils);
        stencils.list.iter().for_each(|stencil| couplings.push(stencils.dofs(stencil)));
    }

    fn stencils(&self, u: &[f64], out: &mut Stencils) -> Result<(), Failure> {
        let found = self.list(u, out);
        self.linear.iter().for_each(|linear| linear.lock().unwrap_or_else(PoisonError::into_inner).u.clear());
        *self.found.write().unwrap_or_else(PoisonError::into_inner) = Arc::new(found);
        Ok(())
    }

    fn evaluate(&self, index: usize, _: &Stencil, new: &mut [f64], local: &mut Local) -> Result<Branch, Failure> {
        let (found, u) = (self.found(), std::mem::take(&mut local.u));
        let stencil = self.stencil(&found, index, &u);
        let branch = SUMS.with_borrow_mut(|sums| self.evaluate_node(index, &stencil, new, (local, sums)));
        local.u = u;
        branch
    }

    fn kink(&self, index: usize, _: &Stencil, u: &[f64], out: &mut Kinks) -> Result<(), Failure> {
        let found = self.found();
        let stencil = self.stencil(&found, index, u);
        let mut linear = self.linear[index].lock().unwrap_or_else(PoisonError::into_inner);
        if linear.u == u {
            linear.tell(self.contact.coordinates(), out);
            return Ok(());
        }
        SUMS.with_borrow_mut(|sums| {
            if self.idle[index] || self.sum(&stencil, false, sums).is_none() || sums.y[0] < -self.far {
                return;
            }
            self.sum(&stencil, true, sums);
            stencil.find_forces(sums);
            let y = [sums.y[0] + self.closure(index), sums.y[1], sums.y[2]];
            linear.keep(u, y, stencil.stretch().0, sums);
            linear.tell(self.contact.coordinates(), out);
        });
        Ok(())
    }

    fn before(&self, stencil: usize) -> Coordinates {
        stresses(self.history.slot(stencil))
    }

    fn answer(&self, stencil: usize, y: &Coordinates) -> Result<Answer, Failure> {
        let stretch = self.found.read().unwrap_or_else(PoisonError::into_inner).supports[stencil].stretch;
        let past = self.past(stencil, stretch);
        let lift = self.lift(stencil, &past, [y[0], y[1], y[2]]);
        Ok(self.extended(stencil, self.answer_of((stencil, &past), &[y[0] + lift, y[1], y[2], y[3]])?, lift))
    }

    fn sticking(&self, stencil: usize, y: &Coordinates) -> Result<Answer, Failure> {
        let stretch = self.found.read().unwrap_or_else(PoisonError::into_inner).supports[stencil].stretch;
        let (past, still) = (self.past(stencil, stretch), [y[0], 0.0, 0.0, y[3]]);
        let mut answer = self.answer_of((stencil, &Past { shear: [0.0; 2], ..past }), &still)?;
        if answer.slopes[1][1] == 0.0 {
            return self.answer(stencil, y);
        }
        for (c, shear) in past.shear.iter().enumerate() {
            answer.stress[c + 1] = shear + answer.slopes[c + 1][1] * y[1] + answer.slopes[c + 1][2] * y[2];
        }
        Ok(answer)
    }

    fn hold(&self, hold: bool) {
        self.hold.store(hold, Ordering::Relaxed);
        self.held.store(false, Ordering::Relaxed);
    }

    fn holds(&self) -> bool {
        self.held.load(Ordering::Relaxed)
    }

    /// Takes what converged nodes still penetrate and slip into their multipliers, unless that suffices (Simo & Laursen,
    /// Comput. Struct. 42, 1992).
    fn augment(&mut self, u: &[f64], new: &mut History, taken: [f64; 2]) -> Result<bool, Failure> {
        self.refuse_passage(u, new)?;
        let goes_on = self.break_bonds(new)? || self.yield_tips(u) || self.improve(new, taken)?;
        if !goes_on {
            self.wear_beneath_tips(new);
        }
        Ok(goes_on)
    }
}

/// Part of the excess over its strength of the bond that breaks first above which others break with it.
const FIRST: f64 = 0.8;
/// Excess over a strength, as a part of it, that is rounding.
const ROUNDED: f64 = 1e-9;
/// Part of what a tip had in the area of a face below which a converged increment goes on with what it has now.
const CHANGED: f64 = 0.75;

impl FieldAttempt<'_> {
    /// Augments, or changes the penalty, and says whether it did.
    fn improve(&mut self, new: &mut History, taken: [f64; 2]) -> Result<bool, Failure> {
        let Some(augmentation) = self.contact.parts.options.augmentation else { return Ok(self.stiffen(new, taken)) };
        let (mut better, mut left) = (self.shifts.clone(), augment::Left::default());
        for (slot, shift) in better.iter_mut().enumerate() {
            let (new, size) = (new.slot(slot), self.contact.size_at(slot));
            if new[entry::SEGMENT] < 0.0 {
                shift[0] = 0.0;
                continue;
            }
            let stretch = new[entry::HALF];
            let borne = new[entry::PRESSURE] * stretch / self.normal;
            let closed = new[entry::STATUS] > 0.0;
            let raised = if closed { borne } else { (shift[0] + new[entry::PENETRATION]).max(0.0) };
            left.penetration = left.penetration.max((raised - shift[0]).abs() / size);
            shift[0] = raised;
            if closed {
                let old = self.history.slot(slot);
                let elastic = [(entry::SHEAR, 1), (entry::SHEAR2, 2)]
                    .map(|(shear, c)| ((new[shear] - old[shear]) * stretch / self.tangential[slot], c));
                let sticks = new[entry::STATUS] == 1.0;
                for (borne, c) in elastic {
                    if sticks {
                        left.slip = left.slip.max((borne - shift[c]).abs() / size);
                    }
                    shift[c] = borne;
                }
            }
        }
        if !augmentation.goes_on(&left, self.augmented, self.contact.title())? {
            let kept = new.slot_mut(self.contact.slots());
            kept.iter_mut().zip(&self.shifts).for_each(|(closure, shift)| *closure = shift[0]);
            return Ok(false);
        }
        let part = self.hasten(left.penetration);
        better.iter_mut().for_each(|shift| shift[0] *= part);
        (self.shifts, self.augmented) = (better, self.augmented + 1);
        Ok(true)
    }

    /// Nodes beneath a place of a face, with the functions of its corners there.
    fn beneath(&self, f: usize, xi: [f64; 2]) -> impl Iterator<Item = (usize, f64)> + '_ {
        let (surface, face) = (&self.contact.parts.surface, &self.contact.parts.surface.faces[f]);
        let functions = face.corner_functions(face.nearest(xi));
        (0..face.corners()).map(move |corner| (surface.field[f][corner], functions.n[corner]))
    }

    /// What has been rubbed of the surface beneath a foot of a tip at the accepted state.
    fn worn_beneath(&self, slot: usize) -> f64 {
        let foot = self.tips_before.get(slot - self.contact.nodal_slots()).copied().flatten();
        let Some((face, landing)) = foot.and_then(|foot| Some((foot.patch.face, foot.patch.tip?))) else { return 0.0 };
        let rubbed = |node: usize| {
            let pieces = (0..self.contact.pieces).map(|piece| self.history.slot(self.contact.slot(node, piece)));
            pieces.map(|values| values[entry::RUBBED]).fold(0.0, f64::max)
        };
        self.beneath(face, landing.xi).map(|(node, n)| n * rubbed(node)).sum()
    }

    /// What tips rubbed in a converged increment wears the nodes beneath them: the volume is that of the tip (Archard), its place the one
    /// to which the tip has come.
    fn wear_beneath_tips(&self, new: &mut History) {
        let found = self.found();
        for slot in self.contact.nodal_slots()..self.contact.slots() {
            let rubbed = new.slot(slot)[entry::RUBBED] - self.history.slot(slot)[entry::RUBBED];
            let Some(&(number, _)) = found.supports[slot].patches.first().filter(|_| rubbed > 0.0) else { continue };
            let (patch, area) = (&found.patches[number].patch, new.slot(slot)[entry::XI]);
            let Some(landing) = patch.tip else { continue };
            for (node, n) in self.beneath(patch.face, landing.xi) {
                let depth = rubbed * area * n / self.contact.areas[node];
                for piece in 0..self.contact.pieces {
                    let values = new.slot_mut(self.contact.slot(node, piece));
                    values[entry::RUBBED] += depth;
                    values[entry::WORN] += if piece == 0 { depth } else { 0.0 };
                }
            }
        }
    }

    /// Refuses a state in which a node has closed on a side of a body behind which it lay: it has gone through the body, as where iterations push off a
    /// block that stands on an edge. So has a corner that lies in a body and bears nothing.
    fn refuse_passage(&self, u: &[f64], new: &History) -> Result<(), Failure> {
        let bears = |number: usize| self.contact.bears(number, new);
        if !self.contact.corners.is_empty()
            && let Some(number) = self.in_place(u).unseen_corner(&self.before, bears)
        {
            let name = self.contact.name_of(self.contact.nodal_slots() + WAYS * number);
            return Err(Failure::new(format!("{name} came to lie in the other body unseen")).of(FailureKind::Passage));
        }
        let found = self.found();
        for slot in 0..self.contact.nodal_slots() {
            let closes = self.history.slot(slot)[entry::STATUS] == 0.0 && new.slot(slot)[entry::STATUS] > 0.0;
            let patches = found.supports[slot].patches.iter().filter(|_| closes);
            let mut patches = patches.map(|&(number, _)| &found.patches[number]);
            if patches.any(|found| self.contact.comes_out(found, (&self.before, self.history))) {
                let reason = format!("{} came out through another side of the body", self.contact.name_of(slot));
                return Err(Failure::new(reason).of(FailureKind::Passage));
            }
        }
        Ok(())
    }

    /// Breaks the bonds that bear more than their strength at a converged state, those that bear most alone: what others bear follows from it. A
    /// state from which all of them broke at once would depend on the increment, and on the iterates that led there. Says whether any did.
    fn break_bonds(&mut self, new: &History) -> Result<bool, Failure> {
        let beyond = |slot: usize| {
            let (old, values) = (self.history.slot(slot), new.slot(slot));
            if !self.bonds[slot] || values[entry::SEGMENT] < 0.0 {
                return Ok(0.0);
            }
            let past = self.past(slot, values[entry::HALF]);
            let [s, t] = [entry::SLIP, entry::SLIP2].map(|slip| values[slip] - old[slip]);
            let here = values[entry::PENETRATION] + self.contact.least + self.closure(slot);
            let lift = self.lift(slot, &past, [here, s, t]);
            let held = self.extended(slot, self.answer_of((slot, &past), &[here + lift, s, t, 0.0])?, lift).stress;
            let own = self.answer_of((slot, &past), &[here, s, t, 0.0])?.stress;
            let open = here - self.contact.least <= self.law.opens(&past, [s, t]);
            let strength = self.law.tensile_strength(&past);
            let [sheared, shear] = [held, own].map(|stress| stress[1].hypot(stress[2]));
            let beyond = if open { -held[0] - strength } else { sheared - shear };
            Ok::<_, Failure>(if beyond > ROUNDED * strength { beyond } else { 0.0 })
        };
        let beyond = (0..self.contact.slots()).map(beyond).collect::<Result<Vec<f64>, _>>()?;
        let most = beyond.iter().copied().fold(0.0, f64::max);
        let breaks = |beyond: f64| beyond > 0.0 && beyond >= FIRST * most;
        self.bonds.iter_mut().zip(&beyond).filter(|(_, beyond)| breaks(**beyond)).for_each(|(bond, _)| *bond = false);
        Ok(most > 0.0)
    }

    /// Leaves tips the part that their surroundings leave them in a converged state, where that has become smaller, and says whether it
    /// did.
    fn yield_tips(&mut self, u: &[f64]) -> bool {
        let share = |feet: &[Option<TipFoot>]| Some(feet.iter().flatten().next()?.patch.tip?.share);
        if self.tips_before.chunks(FEET).filter_map(share).all(|before| before == 0.0) {
            return false;
        }
        let mut changed = false;
        let found = self.in_place(u).tips(self.contact.longest, Some(&[]), |_| None);
        for (before, now) in self.tips_before.chunks_mut(FEET).zip(found.chunks(FEET)) {
            if let (Some(had), Some(share)) = (share(before), share(now))
                && share < CHANGED * had
            {
                let landings = before.iter_mut().flatten().filter_map(|found| found.patch.tip.as_mut());
                landings.for_each(|landing| (landing.share, changed) = (share, true));
            }
        }
        changed
    }

    /// Lists the stencils of all nodes at unknowns `u`.
    fn list(&self, u: &[f64], out: &mut Stencils) -> FieldSearch {
        let found = self.search(u);
        for support in &found.supports {
            let start = out.dofs.len();
            let choice =
                support.patches.first().map_or(0, |&(number, _)| found.patches[number].patch.target as u32 + 1);
            if choice > 0 {
                let dofs = &self.contact.parts.dofs;
                out.dofs.extend(support.nodes.iter().flat_map(|&node| dofs.displacements(node)));
                if let FieldTarget::Tool(rigid) = &self.contact.parts.target {
                    out.dofs.extend(rigid.unknowns());
                }
            }
            out.close(start, Stencil { choice, ..Stencil::default() });
        }
        found
    }
}
