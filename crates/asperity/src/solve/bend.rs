//! Putting Newton's step right for the stencils that bend over it, by an old factor too: what their stresses do is then
//! known roughly only, and the solution with the matrix tells what they do.

use super::influences::{Influences, Site};
use super::linear::{LinearError, LinearSolver};
use super::newton::{Newton, Trouble, Variant};
use super::piecewise::Piecewise;
use super::step::{Motion, TIGHTEST, norm};
use crate::Failure;
use crate::system::Constraints;

/// Most of its right-hand side that an iterative solution may leave where that is much smaller than the unbalanced forces.
const LOOSE: f64 = 0.3;
/// Part of the unbalanced forces that stencils which bend may leave, what asking them again must lower that to, and what
/// they may leave where that does not come about so many times.
const LEFT: f64 = 0.002;
const GAIN: f64 = 0.5;
const TOLERABLE: f64 = 0.1;
const PATIENCE: usize = 2;

/// The linear system of an iteration, to be solved to a part `forcing` of the unbalanced forces of this `size`, or by the
/// factor alone where that is its own.
struct Loose<'a> {
    constraints: &'a Constraints,
    values: &'a [f64],
    size: f64,
    forcing: Option<f64>,
}

impl Loose<'_> {
    fn gather(&self, forces: &[f64]) -> Vec<f64> {
        let mut free = vec![0.0; self.constraints.free_count()];
        self.constraints.gather(forces, &mut free);
        free
    }

    /// Size of forces on the free unknowns.
    fn size_of(&self, forces: &[f64]) -> f64 {
        norm(&self.gather(forces))
    }

    /// Takes out of a step what forces do; false, with the step as it was, where an old factor does not serve.
    fn push(&self, forces: &[f64], solver: &mut dyn LinearSolver, du: &mut [f64]) -> Result<bool, LinearError> {
        let mut rhs = self.gather(forces);
        match self.forcing {
            Some(forcing) => {
                let tolerance = (forcing * self.size / norm(&rhs).max(f64::MIN_POSITIVE)).clamp(TIGHTEST, LOOSE);
                if !solver.iterate_again(self.values, &mut rhs, tolerance)? {
                    return Ok(false);
                }
            }
            None => solver.solve(&mut rhs)?,
        }
        rhs.iter_mut().for_each(|dq| *dq = -*dq);
        self.constraints.expand(&rhs, du);
        Ok(true)
    }
}

impl Newton<'_> {
    /// Puts the linear step right for the stencils that bend over it. False where an old factor does not tell how: a fresh
    /// one then may.
    pub(super) fn bend(&mut self, size: f64, motion: &mut Motion, forcing: f64) -> Result<bool, Trouble> {
        let (constraints, memory) = (&self.step.constraints, &mut *self.memory);
        let exact = motion.factorised || self.problem.newton.variant != Variant::Full;
        let mut piecewise = Piecewise::new(Site::of(&self.assembly, &memory.kinks), &motion.du)?;
        let Some(part) = piecewise.settle((&mut memory.influences, self.solver))? else { return Ok(exact) };
        if !piecewise.bends() {
            return Ok(true);
        }
        motion.du.iter_mut().for_each(|du| *du *= part);
        motion.part = part;
        let system = Loose { constraints, values: &self.evaluation.values, size, forcing: (!exact).then_some(forcing) };
        match push_until_settled((&mut piecewise, &system), (&mut memory.influences, self.solver), motion) {
            Err(Unsolved::Factor(error)) => Err(self.explain(error, 1)),
            Err(Unsolved::Law(failure)) => Err(failure.into()),
            Ok(settled) => Ok(settled),
        }
    }
}

/// Why stresses could not be pushed.
enum Unsolved {
    Factor(LinearError),
    Law(Failure),
}

impl From<LinearError> for Unsolved {
    fn from(error: LinearError) -> Self {
        Self::Factor(error)
    }
}

impl From<Failure> for Unsolved {
    fn from(failure: Failure) -> Self {
        Self::Law(failure)
    }
}

/// Takes out of the step what the stresses do that were put right. What they do by an old factor is known roughly; the
/// solution with the matrix then tells what they do, until they leave little of the unbalanced forces. False where they
/// leave much in the end.
fn push_until_settled(
    (piecewise, system): (&mut Piecewise, &Loose),
    (influences, solver): (&mut Influences, &mut dyn LinearSolver),
    motion: &mut Motion,
) -> Result<bool, Unsolved> {
    let (mut before, mut missed, mut known) = (vec![0.0; motion.du.len()], f64::INFINITY, Vec::new());
    let mut patience = PATIENCE;
    loop {
        let forces = piecewise.forces(before.len());
        let more: Vec<f64> = forces.iter().zip(&before).map(|(now, before)| now - before).collect();
        if !system.push(&more, solver, &mut motion.du)? {
            return Ok(missed <= TOLERABLE);
        }
        if system.forcing.is_none() {
            return Ok(true);
        }
        let now = system.size_of(&piecewise.miss(&motion.du)?) / system.size;
        if now <= LEFT {
            return Ok(true);
        }
        patience -= usize::from(now > GAIN * missed);
        let left = piecewise.left().to_vec();
        if patience == 0 || !piecewise.settle_again((motion.part, &known), &motion.du, (influences, solver))? {
            return Ok(now <= TOLERABLE);
        }
        (before, missed, known) = (forces, now, left);
    }
}
