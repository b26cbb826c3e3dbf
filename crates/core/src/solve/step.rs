//! One step of Newton's method: the linear system, the contact points over its solution, and the line search along it.

use super::constants::iterations::{ASCENT, FLOWING, SLOPE, STRICT};
use super::constants::steps::{ENOUGH, FAR, GOOD, LOOSEST, SHORTEST, TIGHTEST, TURN};
use super::linear::{LinearError, Unsolved};
use super::newton::{Newton, SolveError, Variant};
use super::semismooth::{self, ContactSystem, Linearised};
use crate::system::Tangent;
use crate::{Failure, FailureKind};
use std::time::Instant;

/// A step.
pub(super) struct NewtonStep {
    /// Change of all unknowns.
    pub du: Vec<f64>,
    /// Part of the whole step that it is.
    pub part: f64,
    /// Whether a matrix was factorised for it.
    pub factorised: bool,
    /// Change of the load factor of a path.
    pub load: f64,
    /// Whether no states of the contact points were found over it.
    pub lost: bool,
}

impl Newton<'_> {
    /// Newton's step from `u`, as far as the contact points over it allow; `forcing` bounds what an iterative solution
    /// leaves of the linear system.
    pub(super) fn linearise(
        &mut self,
        (iteration, u): (usize, &[f64]),
        missing: Option<&[f64]>,
        forcing: f64,
    ) -> Result<NewtonStep, SolveError> {
        let constraints = &self.step.constraints;
        let mut rhs = vec![0.0; self.residual.len()];
        let mut du = vec![0.0; self.state.u.len()];
        if let Some(missing) = missing {
            constraints.gather(&self.evaluation.carried, &mut rhs);
            du.copy_from_slice(missing);
        }
        rhs.iter_mut().zip(&self.residual).for_each(|(rhs, r)| *rhs = -(*rhs + r));
        self.memory.workspace.kinks(&self.assembly, u, &mut self.memory.kinks)?;
        let size = norm(&rhs);
        let factorised = self.solve_linear(iteration, &mut rhs, forcing)?;
        constraints.expand(&rhs, &mut du);
        let mut step = NewtonStep { du, part: 1.0, factorised, load: 0.0, lost: false };
        if self.problem.newton.piecewise && !self.put_right(size, &mut step, forcing)? {
            self.system.invalidate_factor();
            return self.linearise((iteration, u), missing, forcing);
        }
        self.limit(u, missing, &mut step);
        self.memory.mip.aim(&self.assembly, &self.memory.kinks, (u, &step.du))?;
        Ok(step)
    }

    /// Puts the linear step right for the contact points over it; false where an old factor does not tell how.
    fn put_right(&mut self, size: f64, step: &mut NewtonStep, forcing: f64) -> Result<bool, SolveError> {
        let exact = step.factorised || self.problem.newton.variant != Variant::Full;
        let linearised = Linearised { values: &self.evaluation.values, size, forcing: (!exact).then_some(forcing) };
        let (kinks, workspace) = (&self.memory.kinks, &self.memory.workspace);
        let contact = ContactSystem { assembly: &self.assembly, kinks, workspace };
        let (begun, before) = (Instant::now(), self.system.counts().time());
        let put_right = semismooth::put_right(contact, self.system, &linearised, step);
        let linear = self.system.counts().time() - before;
        self.memory.spent.contact += begun.elapsed().saturating_sub(linear);
        put_right.map_err(|unsolved| self.unsolved(unsolved, 1))
    }

    /// Shortens a step that leads far beyond what the increment moves: something is then free that a shorter step may
    /// find held.
    pub(super) fn limit(&self, u: &[f64], missing: Option<&[f64]>, step: &mut NewtonStep) {
        let (mut longest, mut usual) = ([0.0_f64; 2], [self.problem.cell_size, TURN]);
        for (dof, du) in step.du.iter().enumerate() {
            let kind = usize::from(self.problem.dofs.is_rotation(dof));
            longest[kind] = longest[kind].max(du.abs());
            let moved = (u[dof] - self.state.u[dof]).abs().max(missing.map_or(0.0, |missing| missing[dof].abs()));
            usual[kind] = usual[kind].max(FAR * moved);
        }
        let allowed = longest.iter().zip(&usual).map(|(longest, usual)| usual / longest).fold(1.0, f64::min);
        if allowed < 1.0 {
            step.du.iter_mut().for_each(|du| *du *= allowed);
            step.part *= allowed;
        }
    }

    /// Tells the linear system of the pattern, where that is new.
    fn set_pattern(&mut self) {
        let workspace = &self.memory.workspace;
        let free = self.step.constraints.free();
        if self.system.set_pattern(workspace.analysis(), workspace.pattern(), free) {
            self.memory.current = false;
        }
    }

    /// Factorises the matrix at hand.
    pub(super) fn factorise_matrix(&mut self) -> Result<(), LinearError> {
        self.set_pattern();
        self.system.factorise(&self.evaluation.values)
    }

    /// Solves with the present matrix or that of the variant, and says whether a matrix was factorised.
    pub(super) fn solve_linear(&mut self, iteration: usize, rhs: &mut [f64], forcing: f64) -> Result<bool, SolveError> {
        self.set_pattern();
        let modified = self.problem.newton.variant == Variant::Modified;
        if modified && iteration > 0 && self.medium.is_none() && self.memory.current {
            self.system.solve_again(&self.evaluation.values, rhs, forcing).map_err(|e| self.explain(e, 1))?;
            return Ok(false);
        }
        let begun = self.may_hold().then(|| rhs.to_vec());
        let regularised = std::mem::take(&mut self.regularised);
        self.memory.current = true;
        let error = match self.solve_system(rhs, forcing) {
            Ok(factorised) => {
                if !factorised {
                    self.regularised = regularised;
                }
                return Ok(factorised);
            }
            Err(unsolved) => unsolved,
        };
        self.memory.current = false;
        // An iterate may have lost a contact that the solution has: in a matrix that is singular, or that rounding cannot tell from
        // one.
        match (error, begun) {
            (Unsolved::Engine(LinearError::Singular(motions)), Some(begun)) => {
                self.regularise(&motions);
                rhs.copy_from_slice(&begun);
            }
            (Unsolved::Engine(LinearError::Inaccurate(_)), Some(begun)) if self.state.increment > 0 => {
                self.regularise(&[]);
                rhs.copy_from_slice(&begun);
            }
            (unsolved, _) => return Err(self.unsolved(unsolved, iteration)),
        }
        self.system.invalidate_factor();
        self.solve_system(rhs, forcing).map_err(|unsolved| self.unsolved(unsolved, iteration))
    }

    fn solve_system(&mut self, rhs: &mut [f64], forcing: f64) -> Result<bool, Unsolved> {
        let (kinks, workspace) = (&self.memory.kinks, &self.memory.workspace);
        let contact = ContactSystem { assembly: &self.assembly, kinks, workspace };
        self.system.solve(&self.evaluation.values, &contact, rhs, forcing)
    }

    /// What a system that was not solved means.
    fn unsolved(&self, unsolved: Unsolved, iteration: usize) -> SolveError {
        match unsolved {
            Unsolved::Engine(error) => self.explain(error, iteration),
            Unsolved::Law(failure) => failure.into(),
        }
    }

    /// Moves `u` along a step, evaluates there, with no more than the `tangent` where nothing is missing any more, and
    /// returns the part of the whole step that was taken.
    pub(super) fn advance(
        &mut self,
        u: &mut Vec<f64>,
        (step, tangent): (&NewtonStep, Tangent),
        missing: Option<&[f64]>,
    ) -> Result<f64, Failure> {
        let (begin, slope, unbalanced) = (u.clone(), self.slope(&step.du), norm(&self.residual));
        let along = |part: f64| -> Vec<f64> { begin.iter().zip(&step.du).map(|(u, d)| u + part * d).collect() };
        let rest = |part: f64| missing.filter(|_| part < 1.0).map(|m| m.iter().map(|m| m * (1.0 - part)).collect());
        let mut part = 1.0;
        loop {
            self.memory.mip.follow(part);
            *u = along(part);
            let missing: Option<Vec<f64>> = rest(part * step.part);
            let tangent = if missing.is_some() { self.tangent() } else { tangent };
            match self.evaluate(u, missing.as_deref(), tangent) {
                Ok(()) => break,
                Err(failure) if part <= SHORTEST || failure.kind == FailureKind::Apart => return Err(failure),
                Err(_) => part *= 0.5,
            }
        }
        if !self.problem.newton.line_search || missing.is_some() || part < 1.0 {
            return Ok(part * step.part);
        }
        let end = self.slope(&step.du);
        let allowed = if self.strict {
            STRICT
        } else if self.flows() {
            FLOWING
        } else {
            SLOPE
        };
        let ascends = slope > 0.0 && !self.strict;
        if end.abs() <= allowed * slope.abs() || ascends && norm(&self.residual) <= ASCENT * unbalanced {
            return Ok(step.part);
        }
        part = self.search(&along, &step.du, (slope, end))?;
        self.memory.mip.follow(part);
        *u = along(part);
        self.evaluate(u, None, self.tangent())?;
        Ok(part * step.part)
    }

    /// Whether bodies flow where the terms were evaluated last.
    pub(super) fn flows(&self) -> bool {
        let terms = self.problem.terms.iter().zip(&self.evaluation.energies);
        terms.filter(|(term, _)| term.branches().is_empty()).any(|(_, energies)| energies.dissipated > 0.0)
    }

    /// Work of the present unbalanced forces along a direction.
    pub(super) fn slope(&self, direction: &[f64]) -> f64 {
        let free = self.step.constraints.free().iter();
        free.zip(&self.residual).map(|(&dof, r)| direction[dof] * r).sum()
    }

    /// Looks for a part of the step where the slope is small: regula falsi (Illinois) where it changes sign, halving
    /// where it only grows.
    fn search(
        &mut self,
        along: &dyn Fn(f64) -> Vec<f64>,
        direction: &[f64],
        (begin, end): (f64, f64),
    ) -> Result<f64, Failure> {
        let (mut low, mut high) = ((0.0, begin), (1.0, end));
        let mut best = (end.abs(), 1.0);
        for _ in 0..6 {
            let crosses = low.1 * high.1 < 0.0;
            let part = if crosses { high.0 - high.1 * (high.0 - low.0) / (high.1 - low.1) } else { 0.5 * high.0 };
            let part = part.max(SHORTEST);
            self.evaluate(&along(part), None, Tangent::None)?;
            let slope = self.slope(direction);
            if slope.abs() < best.0 {
                best = (slope.abs(), part);
            }
            if slope.abs() <= GOOD * begin.abs() || part <= SHORTEST {
                break;
            }
            if slope * high.1 < 0.0 {
                low = (part, slope);
                high.1 *= 0.5;
            } else {
                high = (part, slope);
            }
        }
        Ok(best.1)
    }
}

pub(super) fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Residual of an iterative solution over its right-hand side, from the unbalanced forces now and an iteration before:
/// what the linear system leaves is no more than what the next iteration finds anyway, so that the order stays
/// quadratic (Eisenstat & Walker, SIAM J. Sci. Comput. 17, 1996, their second choice). Nor need it be less than a small
/// part of what is `allowed` at the end.
pub(super) fn forcing(now: f64, before: f64, allowed: f64) -> f64 {
    let enough = ENOUGH * allowed / now.max(f64::MIN_POSITIVE);
    (now / before.max(f64::MIN_POSITIVE)).powi(2).max(enough).clamp(TIGHTEST, LOOSEST)
}
