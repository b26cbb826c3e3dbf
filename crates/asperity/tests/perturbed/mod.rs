//! States to perturb: increments without equilibrium, and the check of all stencils of an attempt.
#![allow(dead_code)] // each test binary uses a part of it

use asperity::Failure;
use asperity::contact::{ContactOptions, LoadedSides, Overlap};
use asperity::system::{Attempt, History, Instant, Local, State, Stencil, Stencils, TangentCheck, Term, check_tangent};

/// Numbers in (-1, 1) from a linear congruence (Knuth's MMIX), the same in every run.
pub struct Random(pub u64);

impl Random {
    /// The next.
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

pub fn state(u: Vec<f64>, history: History) -> State {
    State { last_change: vec![0.0; u.len()], u, histories: vec![history], ..State::default() }
}

pub fn instant() -> Instant {
    Instant { dt: 1.0, ..Instant::default() }
}

/// The state after an increment to `u`, whether in equilibrium or not.
pub fn commit(term: &dyn Term, from: &State, u: Vec<f64>) -> Result<State, Failure> {
    let attempt = term.attempt(from, &from.histories[0], instant())?;
    let (mut stencils, mut new, mut local) = (Stencils::default(), from.histories[0].clone(), Local::default());
    attempt.stencils(&u, &mut stencils)?;
    for (i, stencil) in stencils.list.iter().enumerate() {
        local.u = stencils.dofs(stencil).iter().map(|&dof| u[dof]).collect();
        local.reset(stencil.len);
        attempt.evaluate(i, stencil, new.slot_mut(i), &mut local)?;
    }
    drop(attempt);
    Ok(state(u, new))
}

/// Options of a contact whose moduli and lengths are of the order of one.
pub fn options(loads: LoadedSides) -> ContactOptions {
    ContactOptions {
        raised: None,
        penalty: 1.0,
        modulus: 1.0,
        tangential_penalty: 0.7,
        elastic_slip: None,
        thickness: 1.0,
        loads,
        coupling: true,
        augmentation: None,
        overlap: Overlap::Keep,
        wear: None,
    }
}

/// Forces of all stencils on all unknowns, after two increments to `first` and `second`.
pub fn forces(term: &dyn Term, start: &State, first: Vec<f64>, second: &[f64]) -> Option<Vec<f64>> {
    let accepted = commit(term, start, first).ok()?;
    let attempt = term.attempt(&accepted, &accepted.histories[0], instant()).unwrap();
    let (mut stencils, mut local, mut sum) = (Stencils::default(), Local::default(), vec![0.0; second.len()]);
    attempt.stencils(second, &mut stencils).unwrap();
    for (i, stencil) in stencils.list.iter().enumerate() {
        let dofs = stencils.dofs(stencil);
        local.u = dofs.iter().map(|&dof| second[dof]).collect();
        local.reset(stencil.len);
        attempt.evaluate(i, stencil, &mut attempt.scratch(i), &mut local).ok()?;
        dofs.iter().zip(&local.force).for_each(|(&dof, force)| sum[dof] += force);
    }
    Some(sum)
}

/// The largest size of a value.
pub fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}

/// Checks all stencils of an attempt at `u`; lengths and angles are of the order of one here, and steps small beside the way over which
/// a large arc passes from one edge to the next.
pub fn check(attempt: &dyn Attempt, u: &[f64]) -> Result<Vec<TangentCheck>, Failure> {
    let mut stencils = Stencils::default();
    attempt.stencils(u, &mut stencils)?;
    let one = |(i, stencil): (usize, &Stencil)| {
        let here: Vec<f64> = stencils.dofs(stencil).iter().map(|&dof| u[dof]).collect();
        check_tangent(attempt, i, stencil, &here, &vec![0.05; here.len()])
    };
    stencils.list.iter().enumerate().map(one).collect()
}
