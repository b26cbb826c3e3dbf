//! Newton's step on a piecewise smooth function: the linear solution, put right for the contact points that close, open, stick or
//! slip over it.
//!
//! It is the step of Newton's method for B-differentiable functions (Pang, Math. Oper. Res. 15, 1990). What the linear solution
//! leaves of the contact stresses is a small problem of its own ([`small`]), whose matrix is the Schur complement of the stresses: the
//! compliance of contact. By an old factor that is known roughly only, and the solution with the matrix tells what the stresses do.

mod mip;
mod small;

pub(super) use mip::MipStress;

use super::constants::semismooth::{GAIN, LEFT, LOOSE, PATIENCE, RINGS, TOLERABLE};
use super::constants::steps::TIGHTEST;
use super::linear::{JumpSites, LinearError, LinearSystem, Unsolved};
use super::step::{NewtonStep, norm};
use crate::Failure;
use crate::system::{Answer, Assembly, Constraints, Coordinates, Kink, Kinks, Workspace};
use frontal::Sparse;
use small::{ContactLaws, SmallProblem, Stress};
use std::collections::BTreeSet;

/// The contact points of an iteration, and where their forces act.
#[derive(Clone, Copy)]
pub(super) struct ContactSystem<'a> {
    pub assembly: &'a Assembly<'a>,
    pub kinks: &'a Kinks,
    pub workspace: &'a Workspace,
}

impl ContactSystem<'_> {
    fn constraints(&self) -> &Constraints {
        self.assembly.constraints
    }

    fn response(&self, kink: &Kink, y: &Coordinates) -> Result<Answer, Failure> {
        self.assembly.attempts[kink.term].answer(kink.stencil, y)
    }

    /// Forces of a unit of stress on free unknowns.
    fn forces(&self, kink: &Kink, coordinate: usize) -> Sparse {
        let forces = self.kinks.forces(kink, coordinate);
        forces.flat_map(|(dof, force)| self.constraints().followed(dof).map(move |(i, c)| (i, c * force))).collect()
    }

    /// The free unknowns that these follow, ascending.
    fn free(&self, dofs: &[usize]) -> Vec<usize> {
        let mut dofs = dofs.to_vec();
        dofs.sort_unstable();
        dofs.dedup();
        let mut free: Vec<usize> =
            dofs.iter().flat_map(|&dof| self.constraints().followed(dof)).map(|(i, _)| i).collect();
        free.sort_unstable();
        free.dedup();
        free
    }
}

impl JumpSites for ContactSystem<'_> {
    fn near(&self, wide: bool) -> Vec<usize> {
        let mut near = self.kinks.dofs().to_vec();
        for _ in 0..if wide { RINGS } else { 0 } {
            near = self.workspace.around(&near, |t| self.assembly.terms[t].bends());
        }
        self.free(&near)
    }

    fn closed(&self) -> Result<BTreeSet<usize>, Failure> {
        let mut closed = BTreeSet::new();
        for kink in self.kinks.list() {
            let slopes = self.response(kink, &kink.y)?.slopes;
            if slopes.as_flattened().iter().any(|slope| *slope != 0.0) {
                closed.extend(self.forces(kink, 0).into_iter().map(|(unknown, _)| unknown));
            }
        }
        Ok(closed)
    }
}

/// The contact points as the small problem asks for them.
struct Points<'a, 's> {
    contact: ContactSystem<'a>,
    system: &'s mut LinearSystem,
}

impl ContactLaws for Points<'_, '_> {
    fn response(&self, point: usize, y: &Coordinates) -> Result<Answer, Failure> {
        self.contact.response(&self.contact.kinks.list()[point], y)
    }

    fn sticking(&self, point: usize, y: &Coordinates) -> Result<Answer, Failure> {
        let kink = &self.contact.kinks.list()[point];
        self.contact.assembly.attempts[kink.term].sticking(kink.stencil, y)
    }

    fn compliance(&mut self, stresses: &[Stress]) -> Result<Vec<Vec<Coordinates>>, Unsolved> {
        let ContactSystem { kinks, .. } = self.contact;
        let constraints = self.contact.constraints();
        let load = |&(kink, coordinate): &Stress| self.contact.forces(&kinks.list()[kink], coordinate);
        let loads: Vec<Sparse> = stresses.iter().map(load).collect();
        let wanted = self.contact.free(kinks.dofs());
        let motions = self.system.compliance(&loads, &wanted)?;
        let mut places = vec![0; constraints.free_count()];
        wanted.iter().enumerate().for_each(|(place, &unknown)| places[unknown] = place);
        let mut all = vec![vec![Coordinates::default(); kinks.list().len()]; loads.len()];
        let mut along = vec![0.0; loads.len()];
        for (number, kink) in kinks.list().iter().enumerate() {
            for coordinate in 0..kink.count {
                along.fill(0.0);
                for (dof, rate) in kinks.rates(kink, coordinate) {
                    for (unknown, share) in constraints.followed(dof) {
                        let motions = &motions[places[unknown] * loads.len()..][..loads.len()];
                        along.iter_mut().zip(motions).for_each(|(along, motion)| *along += rate * (share * motion));
                    }
                }
                all.iter_mut().zip(&along).for_each(|(all, along)| all[number][coordinate] = *along);
            }
        }
        Ok(all)
    }
}

/// The linear system of an iteration: the matrix, and the part `forcing` of the unbalanced forces of this `size` to which it is to
/// be solved where the factor is not its own.
pub(super) struct Linearised<'a> {
    pub values: &'a [f64],
    pub size: f64,
    pub forcing: Option<f64>,
}

/// Puts the linear step right for the contact points, and the part of it that is taken. False where an old factor does not tell
/// how: a fresh one then may.
///
/// # Errors
/// When a law cannot answer, or a solution with the factor fails.
pub(super) fn put_right(
    contact: ContactSystem,
    system: &mut LinearSystem,
    linearised: &Linearised,
    step: &mut NewtonStep,
) -> Result<bool, Unsolved> {
    let kinks = contact.kinks;
    let y: Vec<Coordinates> = kinks.list().iter().map(|kink| kink.y).collect();
    let counts = kinks.list().iter().map(|kink| kink.count).collect();
    let along = kinks.list().iter().map(|kink| kinks.along(kink, &step.du)).collect();
    let mut points = Points { contact, system };
    let mut problem = SmallProblem::new((y, counts), along, &points)?;
    let Some(part) = problem.settle(&mut points)? else {
        step.lost = true;
        return Ok(linearised.forcing.is_none());
    };
    if !problem.is_nonsmooth() {
        return Ok(true);
    }
    step.du.iter_mut().for_each(|du| *du *= part);
    step.part = part;
    push_until_settled((&mut problem, linearised), &mut points, step)
}

/// Takes out of the step what the stresses do that were put right. What they do by an old factor is known roughly; the
/// solution with the matrix then tells what they do, until they leave little of the unbalanced forces. False where they
/// leave much in the end.
fn push_until_settled(
    (problem, linearised): (&mut SmallProblem, &Linearised),
    points: &mut Points,
    step: &mut NewtonStep,
) -> Result<bool, Unsolved> {
    let kinks = points.contact.kinks;
    let (mut before, mut missed, mut known) = (vec![0.0; step.du.len()], f64::INFINITY, Vec::new());
    let mut patience = PATIENCE;
    loop {
        let mut forces = vec![0.0; before.len()];
        let stresses = problem.stresses();
        stresses.for_each(|((kink, coordinate), w)| kinks.push(&kinks.list()[kink], coordinate, w, &mut forces));
        let more: Vec<f64> = forces.iter().zip(&before).map(|(now, before)| now - before).collect();
        if !linearised.push(&more, points, &mut step.du)? {
            return Ok(missed <= TOLERABLE);
        }
        if linearised.forcing.is_none() {
            return Ok(true);
        }
        let along: Vec<Coordinates> = kinks.list().iter().map(|kink| kinks.along(kink, &step.du)).collect();
        let mut left = vec![0.0; before.len()];
        for ((kink, coordinate), w) in problem.missed(&along, points)? {
            kinks.push(&kinks.list()[kink], coordinate, w, &mut left);
        }
        let now = norm(&gather(points.contact.constraints(), &left)) / linearised.size;
        if now <= LEFT {
            return Ok(true);
        }
        patience -= usize::from(now > GAIN * missed);
        let left = problem.left().to_vec();
        if patience == 0 || !problem.settle_again((step.part, &known), &along, points)? {
            return Ok(now <= TOLERABLE);
        }
        (before, missed, known) = (forces, now, left);
    }
}

fn gather(constraints: &Constraints, forces: &[f64]) -> Vec<f64> {
    let mut free = vec![0.0; constraints.free_count()];
    constraints.gather(forces, &mut free);
    free
}

impl Linearised<'_> {
    /// Takes out of a step what forces do; false, with the step as it was, where an old factor does not serve.
    fn push(&self, forces: &[f64], points: &mut Points, du: &mut [f64]) -> Result<bool, LinearError> {
        let constraints = points.contact.constraints();
        let mut rhs = gather(constraints, forces);
        let tolerance = self
            .forcing
            .map_or(0.0, |forcing| (forcing * self.size / norm(&rhs).max(f64::MIN_POSITIVE)).clamp(TIGHTEST, LOOSE));
        if !points.system.solve_again(self.values, &mut rhs, tolerance)? {
            return Ok(false);
        }
        rhs.iter_mut().for_each(|dq| *dq = -*dq);
        constraints.expand(&rhs, du);
        Ok(true)
    }
}
