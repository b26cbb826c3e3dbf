//! A term some of whose nodes follow, and its attempts.

use super::map::Map;
use super::{Arm, Following};
use crate::Failure;
use crate::system::{
    Answer, Attempt, Branch, Coordinates, Couplings, History, Instant, Kinks, Local, Role, State, Stencil, Stencils,
    Term, Unevenness,
};
use crate::tensor::Vec3;
use std::sync::{Arc, PoisonError, RwLock};

/// A term some of whose nodes follow.
pub struct Led {
    following: Arc<Following>,
    term: Arc<dyn Term>,
}

impl Led {
    /// A term with what its nodes may follow.
    pub fn new(following: Arc<Following>, term: Arc<dyn Term>) -> Self {
        Self { following, term }
    }
}

impl Term for Led {
    fn name(&self) -> &str {
        self.term.name()
    }
    fn role(&self) -> Role {
        self.term.role()
    }
    fn initial(&self) -> History {
        self.term.initial()
    }
    fn returned(&self, accepted: &State, at: Instant, until: f64) -> Result<History, Failure> {
        self.term.returned(accepted, at, until)
    }
    fn unevenness(&self, old: &History, new: &History, dt: f64) -> Unevenness {
        self.term.unevenness(old, new, dt)
    }
    fn at_start(&self, forces: &mut [f64]) -> Result<f64, Failure> {
        let mut own = vec![0.0; forces.len()];
        let stored = self.term.at_start(&mut own)?;
        let per_node = self.following.per_node;
        for (&first, Arm { leader, arm, .. }) in &self.following.nodes {
            let force = Vec3(std::array::from_fn(|axis| if axis < per_node { own[first + axis] } else { 0.0 }));
            let moment = arm.cross(force);
            for axis in 0..per_node {
                own[first + axis] = 0.0;
                own[leader + axis] += force[axis];
            }
            self.following.turns().enumerate().for_each(|(k, axis)| own[leader + per_node + k] += moment[axis]);
        }
        forces.iter_mut().zip(own).for_each(|(force, own)| *force += own);
        Ok(stored)
    }
    fn attempt<'a>(
        &'a self,
        accepted: &'a State,
        history: &'a History,
        at: Instant,
    ) -> Result<Box<dyn Attempt + 'a>, Failure> {
        let attempt = self.term.attempt(accepted, history, at)?;
        Ok(Box::new(LedAttempt { following: &self.following, attempt, maps: RwLock::default() }))
    }
    fn name_of(&self, stencil: usize) -> String {
        self.term.name_of(stencil)
    }
    fn bends(&self) -> bool {
        self.term.bends()
    }
    fn describe_motions(&self, motions: &[Vec<f64>]) -> Vec<String> {
        let follow = |motion: &Vec<f64>| {
            let mut motion = motion.clone();
            for (&first, Arm { leader, arm, .. }) in &self.following.nodes {
                let q = &motion[*leader..leader + self.following.unknowns()];
                let turned = self.following.rotation(q).cross(*arm);
                let moved: Vec<f64> = (0..self.following.per_node).map(|axis| q[axis] + turned[axis]).collect();
                motion[first..first + moved.len()].copy_from_slice(&moved);
            }
            motion
        };
        self.term.describe_motions(&motions.iter().map(follow).collect::<Vec<_>>())
    }
    fn branches(&self) -> &'static [&'static str] {
        self.term.branches()
    }
}

/// The same during an attempt.
struct LedAttempt<'a> {
    following: &'a Following,
    attempt: Box<dyn Attempt + 'a>,
    /// One for each stencil listed last; none where nothing of it follows.
    maps: RwLock<Vec<Option<Map>>>,
}

impl LedAttempt<'_> {
    fn placed(&self, u: &[f64]) -> Vec<f64> {
        let mut placed = u.to_vec();
        self.following.place(&mut placed);
        placed
    }

    /// Calls `on` with the map of a stencil.
    fn with<T>(&self, index: usize, on: impl FnOnce(Option<&Map>) -> T) -> T {
        let maps = self.maps.read().unwrap_or_else(PoisonError::into_inner);
        on(maps.get(index).and_then(Option::as_ref))
    }
}

impl Attempt for LedAttempt<'_> {
    fn is_fixed(&self) -> bool {
        self.attempt.is_fixed()
    }
    fn scratch(&self, index: usize) -> Vec<f64> {
        self.attempt.scratch(index)
    }
    fn reach(&self, couplings: &mut Couplings) {
        let mut own = Couplings::default();
        self.attempt.reach(&mut own);
        own.iter().for_each(|group| couplings.push(&self.following.map(group).0));
    }
    fn stencils(&self, u: &[f64], out: &mut Stencils) -> Result<(), Failure> {
        let mut own = Stencils::default();
        self.attempt.stencils(&self.placed(u), &mut own)?;
        let mut maps = Vec::with_capacity(own.list.len());
        for stencil in &own.list {
            let (start, (dofs, map)) = (out.dofs.len(), self.following.map(own.dofs(stencil)));
            out.dofs.extend(dofs);
            out.close(start, *stencil);
            maps.push((!map.nodes.is_empty()).then_some(map));
        }
        *self.maps.write().unwrap_or_else(PoisonError::into_inner) = maps;
        Ok(())
    }
    fn evaluate(&self, index: usize, stencil: &Stencil, new: &mut [f64], local: &mut Local) -> Result<Branch, Failure> {
        self.with(index, |map| {
            let Some(map) = map else { return self.attempt.evaluate(index, stencil, new, local) };
            let (u, rates) = map.lead(self.following, &local.u);
            let count = u.len();
            let mut own = Local { u, wants_tangent: local.wants_tangent, acting: local.acting, ..Local::default() };
            own.reset(count);
            let branch = self.attempt.evaluate(index, &Stencil { len: count, ..*stencil }, new, &mut own)?;
            map.pull(self.following, (&own, &rates), local);
            local.energies = own.energies;
            Ok(branch)
        })
    }
    fn kink(&self, index: usize, stencil: &Stencil, u: &[f64], out: &mut Kinks) -> Result<(), Failure> {
        self.with(index, |map| {
            let Some(map) = map else { return self.attempt.kink(index, stencil, u, out) };
            let (own, rates) = map.lead(self.following, u);
            let (places, mut kinks): (Vec<usize>, _) = ((0..own.len()).collect(), Kinks::default());
            kinks.begin((0, index), &places);
            self.attempt.kink(index, &Stencil { len: own.len(), ..*stencil }, &own, &mut kinks)?;
            let lead = |values: &mut dyn Iterator<Item = (usize, f64)>| {
                let mut led = vec![0.0; u.len()];
                for ((_, value), rates) in values.zip(&rates) {
                    rates.iter().for_each(|&(place, rate)| led[place] += rate * value);
                }
                led
            };
            let Some(kink) = kinks.list().first() else { return Ok(()) };
            for coordinate in 0..kink.count {
                let slopes = lead(&mut kinks.rates(kink, coordinate));
                let forces = lead(&mut kinks.forces(kink, coordinate));
                out.coordinate(kink.y[coordinate], slopes.into_iter(), forces.into_iter());
            }
            Ok(())
        })
    }
    fn augment(&mut self, u: &[f64], new: &mut History, taken: [f64; 2]) -> Result<bool, Failure> {
        let placed = self.placed(u);
        self.attempt.augment(&placed, new, taken)
    }
    fn hold(&self, hold: bool) {
        self.attempt.hold(hold);
    }
    fn holds(&self) -> bool {
        self.attempt.holds()
    }
    fn before(&self, stencil: usize) -> Coordinates {
        self.attempt.before(stencil)
    }
    fn answer(&self, stencil: usize, y: &Coordinates) -> Result<Answer, Failure> {
        self.attempt.answer(stencil, y)
    }
    fn sticking(&self, stencil: usize, y: &Coordinates) -> Result<Answer, Failure> {
        self.attempt.sticking(stencil, y)
    }
}
