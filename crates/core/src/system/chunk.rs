//! Chunks of stencils: what one thread evaluates at a time, with the lane of history that it writes.

use super::check::perturb;
use super::{Attempt, Branch, Constraints, Dofs, Energies, History, Local, Origin, Shares, Stencils, Tangent, Trial};
use crate::Failure;
use std::ops::Range;

/// Stencils a chunk holds; fixed, so that results do not depend on the number of threads.
pub const CHUNK: usize = 32;

/// Results of the stencils of one chunk: all of them on the rank that owns it, elsewhere nothing but tangents.
#[derive(Debug, Default)]
pub struct Chunk {
    local: Local,
    /// Forces of all stencils, one after another.
    pub forces: Vec<f64>,
    /// What motion that is missing adds to them, where it is.
    pub carried: Vec<f64>,
    /// Tangents of the stencils that have rows of this rank, one after another.
    pub tangents: Vec<f64>,
    /// Branch and discrete choice of each stencil.
    pub branches: Vec<(Branch, u32)>,
    /// Sum of their energies.
    pub energies: Energies,
    /// The stencil at which the chunk ends early, if it does, and why.
    pub failure: Option<(usize, Failure)>,
}

/// What all chunks of a term share.
pub struct Pass<'a> {
    /// The term.
    pub attempt: &'a dyn Attempt,
    /// Its number.
    pub term: usize,
    /// Its stencils.
    pub stencils: &'a Stencils,
    /// Numbering.
    pub dofs: &'a Dofs,
    /// How unknowns follow from the free ones.
    pub constraints: &'a Constraints,
    /// Who owns what.
    pub shares: &'a Shares,
    /// Where it is evaluated.
    pub trial: &'a Trial<'a>,
}

impl Pass<'_> {
    /// Whether this rank owns the chunk that begins with a stencil.
    pub fn owns(&self, first: usize) -> bool {
        self.stencils.owner(first, self.shares) == self.shares.rank()
    }
    /// Whether the tangent of a stencil of these unknowns is to be added here.
    fn adds(&self, dofs: &[usize]) -> bool {
        self.trial.tangent != Tangent::None && self.shares.has(self.constraints, dofs)
    }
}

/// New history of the stencils of one chunk.
pub struct Lane<'a> {
    stencils: Range<usize>,
    starts: &'a [usize],
    data: &'a mut [f64],
}

impl Lane<'_> {
    fn slot(&mut self, index: usize) -> &mut [f64] {
        let k = index - self.stencils.start;
        let [from, to] = [self.starts[k], self.starts[k + 1]].map(|start| start - self.starts[0]);
        &mut self.data[from..to]
    }
}

/// Cuts the history of some stencils into one lane for each chunk.
pub fn lanes(history: &mut History, stencils: Range<usize>) -> Vec<Lane<'_>> {
    let starts = &history.starts;
    let mut rest = &mut history.data[starts[stencils.start]..starts[stencils.end]];
    let mut lanes = Vec::with_capacity(stencils.len().div_ceil(CHUNK));
    for begin in stencils.clone().step_by(CHUNK) {
        let end = (begin + CHUNK).min(stencils.end);
        let (data, tail) = std::mem::take(&mut rest).split_at_mut(starts[end] - starts[begin]);
        lanes.push(Lane { stencils: begin..end, starts: &starts[begin..=end], data });
        rest = tail;
    }
    lanes
}

impl Chunk {
    /// Evaluates the stencils of a lane.
    pub fn run(&mut self, pass: &Pass, mut lane: Lane) {
        self.forces.clear();
        self.carried.clear();
        self.tangents.clear();
        self.branches.clear();
        self.energies = Energies::default();
        let owns = pass.owns(lane.stencils.start);
        let failed = lane.stencils.clone().find_map(|index| {
            let evaluated = self.evaluate(index, (pass, owns), lane.slot(index));
            evaluated.err().map(|failure| (index, failure))
        });
        self.failure = failed;
    }

    fn evaluate(&mut self, index: usize, (pass, owns): (&Pass, bool), new: &mut [f64]) -> Result<(), Failure> {
        let (stencil, tangent) = (&pass.stencils.list[index], pass.trial.tangent);
        let (dofs, local) = (pass.stencils.dofs(stencil), &mut self.local);
        let adds = pass.adds(dofs);
        if !owns && !adds {
            return Ok(());
        }
        let before = self.tangents.len();
        local.u.clear();
        local.u.extend(dofs.iter().map(|&dof| pass.trial.u[dof]));
        if let Tangent::Perturbation(step) = tangent {
            let is_rotation = |k: usize| pass.dofs.is_rotation(dofs[k]);
            local.wants_tangent = false;
            perturb(pass.attempt, index, stencil, (step, &is_rotation), local, &mut self.tangents);
        }
        local.wants_tangent = tangent == Tangent::Exact;
        local.acting = pass.trial.acting.get(pass.term).and_then(|acting| acting.get(index)).copied();
        local.origin = pass.trial.origin;
        local.from.clear();
        if local.origin == Origin::Step && local.wants_tangent {
            local.from.extend(dofs.iter().map(|&dof| pass.trial.from[dof]));
        }
        local.reset(stencil.len);
        let branch = pass.attempt.evaluate(index, stencil, new, local)?;
        if local.wants_tangent {
            self.tangents.extend_from_slice(&local.tangent);
        }
        if let Some(missing) = pass.trial.missing.filter(|_| owns && tangent != Tangent::None) {
            let rows = self.tangents[before..].chunks_exact(dofs.len().max(1));
            let force = |row: &[f64]| row.iter().zip(dofs).map(|(k, &other)| k * missing[other]).sum::<f64>();
            self.carried.extend(rows.map(force));
        }
        if !adds {
            self.tangents.truncate(before);
        }
        if !owns {
            return Ok(());
        }
        self.branches.push((branch, stencil.choice));
        self.forces.extend_from_slice(&local.force);
        self.energies += local.energies;
        Ok(())
    }
}
