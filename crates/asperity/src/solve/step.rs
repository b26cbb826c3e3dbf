//! One step of Newton's method: the linear system, what bends over its solution, and how far to go along it.

use super::influences::Site;
use super::jump::Matrix;
use super::linear::LinearError;
use super::newton::{Newton, Trouble, Variant};
use crate::Failure;
use crate::system::Tangent;

/// Slope, as a part of the initial one, at which the search for a shorter step ends.
const GOOD: f64 = 0.8;
/// Bounds of what an iterative solution may leave of its right-hand side.
const LOOSEST: f64 = 1e-3;
pub(super) const TIGHTEST: f64 = 1e-8;
/// Part of the unbalanced forces allowed at the end that it may always leave.
const ENOUGH: f64 = 0.01;
/// Rings of stencils around those near contact that the columns of the inverse reach from the start.
const RINGS: usize = 2;
/// Shortest step of the line search.
const SHORTEST: f64 = 0.01;
/// A step is at most a cell long, or this multiple of what was moved in the increment so far and what is still missing,
const FAR: f64 = 4.0;
/// and turns a tool by at most so much, in radians.
const TURN: f64 = 0.5;

/// A step.
pub(super) struct Motion {
    /// Change of all unknowns.
    pub du: Vec<f64>,
    /// Part of the whole step that it is.
    pub part: f64,
    /// Whether a matrix was factorised for it.
    pub factorised: bool,
    /// Change of the load factor of a path.
    pub load: f64,
}

impl Newton<'_> {
    /// Newton's step from `u`, as far as the functions that bend over it allow; `forcing` bounds what an iterative solution
    /// leaves of the linear system.
    pub(super) fn linearise(
        &mut self,
        (iteration, u): (usize, &[f64]),
        missing: Option<&[f64]>,
        forcing: f64,
    ) -> Result<Motion, Trouble> {
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
        let mut motion = Motion { du, part: 1.0, factorised, load: 0.0 };
        if self.problem.newton.piecewise && !self.bend(size, &mut motion, forcing)? {
            self.solver.refuse();
            return self.linearise((iteration, u), missing, forcing);
        }
        self.limit(u, missing, &mut motion);
        self.memory.mixed.aim(&self.assembly, &self.memory.kinks, &motion.du)?;
        Ok(motion)
    }

    /// Shortens a step that leads far beyond what the increment moves: something is then free that a shorter step may
    /// find held.
    pub(super) fn limit(&self, u: &[f64], missing: Option<&[f64]>, motion: &mut Motion) {
        let (mut longest, mut usual) = ([0.0_f64; 2], [self.problem.cell_size, TURN]);
        for (dof, du) in motion.du.iter().enumerate() {
            let kind = usize::from(self.problem.dofs.is_rotation(dof));
            longest[kind] = longest[kind].max(du.abs());
            let moved = (u[dof] - self.state.u[dof]).abs().max(missing.map_or(0.0, |missing| missing[dof].abs()));
            usual[kind] = usual[kind].max(FAR * moved);
        }
        let allowed = longest.iter().zip(&usual).map(|(longest, usual)| usual / longest).fold(1.0, f64::min);
        if allowed < 1.0 {
            motion.du.iter_mut().for_each(|du| *du *= allowed);
            motion.part *= allowed;
        }
    }

    /// Tells the solver of the pattern if it is new, and whether its unknowns are those that it knows.
    fn follow(&mut self) {
        let (analysis, free) = (self.memory.workspace.analysis(), self.step.constraints.free());
        if self.memory.followed == analysis {
            return;
        }
        if self.memory.free != free || !self.solver.follow(self.memory.workspace.pattern()) {
            self.solver.refuse();
            self.memory.influences.forget();
            self.memory.free = free.to_vec();
        }
        (self.memory.followed, self.memory.current) = (analysis, false);
    }

    /// Factorises the matrix at hand, and analyses its pattern before if that is new.
    pub(super) fn factorise_matrix(&mut self) -> Result<(), LinearError> {
        let of = (self.problem, &self.step.constraints);
        self.memory.factorise(of, &self.evaluation.values, self.solver)
    }

    /// Factorises if this iteration asks for it, and says whether it did.
    fn factorise(&mut self, iteration: usize) -> Result<bool, Trouble> {
        let keep = match self.problem.newton.variant {
            Variant::Full => false,
            Variant::Modified => iteration > 0,
            Variant::Kept => iteration != 4,
        };
        if keep && self.medium.is_none() && self.memory.current {
            return Ok(false);
        }
        self.memory.current = false;
        self.propped.clear();
        match self.factorise_matrix() {
            Err(LinearError::Singular(motions)) if self.may_hold() => self.prop(&motions, iteration)?,
            factorised => {
                factorised.map_err(|e| self.explain(e, iteration))?;
                self.memory.current = true;
            }
        }
        Ok(true)
    }

    /// Forgets what an earlier factor said of the unknowns near contact.
    fn begin_influences(&mut self) -> Result<(), Failure> {
        let (terms, memory) = (self.assembly.terms, &mut *self.memory);
        let stays = self.problem.newton.variant == Variant::Full && self.solver.iterates();
        let dofs = memory.kinks.dofs();
        let mut near = dofs.to_vec();
        // Where contact may go while the factor serves.
        for _ in 0..if stays { RINGS } else { 0 } {
            near = memory.workspace.around(&near, |t| terms[t].bends());
        }
        let site = Site::of(&self.assembly, &memory.kinks);
        memory.influences.begin(site, near, stays)
    }

    /// Puts the factor right for what has changed near contact.
    fn put_right(&mut self) -> Result<(), Failure> {
        let memory = &mut *self.memory;
        let site = Site::of(&self.assembly, &memory.kinks);
        let matrix = Matrix::of(&memory.workspace, &self.evaluation.values);
        memory.influences.cover(site);
        let change = memory.influences.change((site, matrix), self.solver)?;
        self.solver.change(change);
        Ok(())
    }

    /// Solves with the present matrix or that of the variant, and says whether a matrix was factorised.
    pub(super) fn solve_linear(&mut self, iteration: usize, rhs: &mut [f64], forcing: f64) -> Result<bool, Trouble> {
        self.follow();
        if self.problem.newton.variant == Variant::Full && self.solver.iterates() {
            self.put_right()?;
            let solved = self.solver.iterate(&self.evaluation.values, rhs, forcing);
            if solved.map_err(|e| self.explain(e, 1))? {
                return Ok(false);
            }
        }
        let factorised = self.factorise(iteration)?;
        self.begin_influences()?;
        let again = (factorised && self.may_hold() && self.state.increment > 0).then(|| rhs.to_vec());
        match (self.solver.solve(rhs), again) {
            // A matrix that rounding cannot tell from a singular one: the iterate may have lost a contact that the solution has.
            (Err(LinearError::Inaccurate(_)), Some(begun)) => {
                rhs.copy_from_slice(&begun);
                self.prop(&[], iteration)?;
                self.memory.current = false;
                self.solver.solve(rhs).map_err(|e| self.explain(e, 1))?;
            }
            (solved, _) => solved.map_err(|e| self.explain(e, 1))?,
        }
        Ok(factorised)
    }

    /// Moves `u` along a step, evaluates there, with no more than the `tangent` where nothing is missing any more, and
    /// returns the part of the whole step that was taken.
    pub(super) fn advance(
        &mut self,
        u: &mut Vec<f64>,
        (motion, tangent): (&Motion, Tangent),
        missing: Option<&[f64]>,
    ) -> Result<f64, Failure> {
        let (begin, slope) = (u.clone(), self.slope(&motion.du));
        let along = |part: f64| -> Vec<f64> { begin.iter().zip(&motion.du).map(|(u, d)| u + part * d).collect() };
        let rest = |part: f64| missing.filter(|_| part < 1.0).map(|m| m.iter().map(|m| m * (1.0 - part)).collect());
        let mut part = 1.0;
        loop {
            self.memory.mixed.follow(part);
            *u = along(part);
            let missing: Option<Vec<f64>> = rest(part * motion.part);
            let tangent = if missing.is_some() { self.tangent() } else { tangent };
            match self.evaluate(u, missing.as_deref(), tangent) {
                Ok(()) => break,
                Err(failure) if part <= SHORTEST => return Err(failure),
                Err(_) => part *= 0.5,
            }
        }
        if !self.problem.newton.line_search || missing.is_some() || part < 1.0 {
            return Ok(part * motion.part);
        }
        let end = self.slope(&motion.du);
        if end.abs() <= self.bound * slope.abs() {
            return Ok(motion.part);
        }
        part = self.search(&along, &motion.du, (slope, end))?;
        self.memory.mixed.follow(part);
        *u = along(part);
        self.evaluate(u, None, self.tangent())?;
        Ok(part * motion.part)
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
