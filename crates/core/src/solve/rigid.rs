//! Rigid motions that nothing holds, before the first increment and without factorising anything: those of the parts that
//! hang together and of the tools that the constraints allow and that no term resists.
//!
//! A motion that deforms cells without resistance is not among them: that only a factorisation finds.

use super::constants::rigid_motions::{ALLOWED, HELD, TRIED};
use super::problem::Problem;
use super::schedule::Step;
use crate::Failure;
use crate::system::{Assembly, Constraints, Evaluation, Instant, Row, State, Tangent, Trial, Workspace, kernel};

/// Motions of all unknowns that span those which nothing holds at an accepted state.
///
/// # Errors
/// A [`Failure`] of a term that cannot be evaluated there.
pub(super) fn free_motions(problem: &Problem, state: &State, dt: f64) -> Result<Vec<Vec<f64>>, Failure> {
    let step = &problem.steps[state.step];
    let allowed = allowed(problem, &step.constraints);
    if allowed.is_empty() {
        return Ok(allowed);
    }
    let mut resistance = Resistance::new(problem, state, step, dt)?;
    let mean = resistance.mean()?;
    let with_force = |motion: Vec<f64>| {
        let mut force = resistance.of(&motion)?;
        force.iter_mut().for_each(|f| *f /= mean.max(f64::MIN_POSITIVE));
        Ok((force, motion))
    };
    let pairs = allowed.into_iter().map(with_force).collect::<Result<Vec<_>, Failure>>()?;
    let size = (step.constraints.free_count() as f64).sqrt();
    Ok(kernel(pairs, HELD * size).0.into_iter().map(unit).collect())
}

/// Rigid motions, of largest entry one, that the constraints allow.
fn allowed(problem: &Problem, constraints: &Constraints) -> Vec<Vec<f64>> {
    let tools = problem.dofs.node(problem.dofs.nodes())..problem.dofs.count();
    let of_a_tool = |dof: usize| {
        let mut motion = vec![0.0; problem.dofs.count()];
        motion[dof] = 1.0;
        motion
    };
    let wholes = problem.wholes.iter().flat_map(|whole| whole.rigid_motions(&problem.dofs));
    let candidates = wholes.chain(tools.map(of_a_tool));
    let pairs = candidates.map(|motion| (missed(constraints, &motion), motion)).collect();
    kernel(pairs, ALLOWED).0.into_iter().map(unit).collect()
}

/// By what a motion misses the constraints.
fn missed(constraints: &Constraints, motion: &[f64]) -> Vec<f64> {
    let free = constraints.free();
    let miss = |(dof, moved): (usize, &f64)| match constraints.row(dof) {
        Row::Free(_) => None,
        Row::Fixed => Some(*moved),
        Row::Combined(terms) => Some(moved - terms.iter().map(|&(i, c)| c * motion[free[i]]).sum::<f64>()),
    };
    motion.iter().enumerate().filter_map(miss).collect()
}

fn unit(mut motion: Vec<f64>) -> Vec<f64> {
    let largest = motion.iter().fold(0.0_f64, |m, x| m.max(x.abs())).max(f64::MIN_POSITIVE);
    motion.iter_mut().for_each(|x| *x /= largest);
    motion
}

/// Forces by which all terms answer a motion.
struct Resistance<'a> {
    state: &'a State,
    assembly: Assembly<'a>,
    workspace: Workspace,
    evaluation: Evaluation,
    length: f64,
    cell: f64,
}

impl<'a> Resistance<'a> {
    fn new(problem: &'a Problem, state: &'a State, step: &'a Step, dt: f64) -> Result<Self, Failure> {
        let at = Instant { step: state.step, step_time: state.step_time + dt, time: state.time + dt, dt, factor: None };
        let attempts = problem.open(state, at)?;
        let (terms, dofs) = (&problem.terms, &problem.dofs);
        let assembly = Assembly { terms, attempts, dofs, constraints: &step.constraints, apart: 0..0 };
        let mut workspace = Workspace::default();
        workspace.list_stencils(&assembly, state)?;
        let evaluation = Evaluation::new(&problem.terms, state);
        Ok(Self { state, assembly, workspace, evaluation, length: problem.size, cell: problem.cell_size })
    }

    /// Force over motion on the free unknowns, for a motion of largest entry one.
    fn of(&mut self, motion: &[f64]) -> Result<Vec<f64>, Failure> {
        self.along(motion, TRIED * self.length)
    }

    /// Root mean square force over motion of unknowns that all go their own ways.
    fn mean(&mut self) -> Result<f64, Failure> {
        let scatter = |dof: usize| ((dof + 1) as f64 * std::f64::consts::SQRT_2).fract() - 0.5;
        let mut motion = vec![0.0; self.state.u.len()];
        self.assembly.constraints.free().iter().for_each(|&dof| motion[dof] = scatter(dof));
        let force = self.along(&motion, TRIED * self.cell)?;
        let square = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>();
        Ok((square(&force) / square(&motion).max(f64::MIN_POSITIVE)).sqrt())
    }

    fn along(&mut self, motion: &[f64], part: f64) -> Result<Vec<f64>, Failure> {
        let [ahead, behind] = [self.residual(motion, part)?, self.residual(motion, -part)?];
        Ok(ahead.iter().zip(&behind).map(|(a, b)| (a - b) / (2.0 * part)).collect())
    }

    fn residual(&mut self, motion: &[f64], part: f64) -> Result<Vec<f64>, Failure> {
        let u: Vec<f64> = self.state.u.iter().zip(motion).map(|(u, v)| u + part * v).collect();
        let trial = Trial::at(&u, Tangent::None);
        self.workspace.evaluate(&self.assembly, &trial, &mut self.evaluation)?;
        let unbalanced: Vec<f64> = (0..u.len()).map(|dof| self.evaluation.residual(dof)).collect();
        let mut free = vec![0.0; self.assembly.constraints.free_count()];
        self.assembly.constraints.gather(&unbalanced, &mut free);
        Ok(free)
    }
}
