//! Adding up what chunks of stencils come to: forces, energies and branches one after another, and their matrices.

use super::band::Frame;
use super::chunk::{CHUNK, Chunk};
use super::{Evaluation, Role, Stencils, Tangent, Trial};
use std::ops::Range;

/// The pattern lacks an entry that a stencil needs.
pub struct Miss;

/// Chunks that were evaluated.
pub struct Round<'a> {
    /// Their results.
    pub chunks: &'a [Chunk],
    /// All stencils of the term,
    pub stencils: &'a Stencils,
    /// and the first of these.
    pub first: usize,
}

impl Round<'_> {
    /// Each chunk with the numbers of its stencils.
    pub fn parts(&self) -> impl Iterator<Item = (&Chunk, Range<usize>)> {
        let count = self.stencils.list.len();
        let begins = (self.first..count).step_by(CHUNK);
        self.chunks.iter().zip(begins.map(move |begin| begin..(begin + CHUNK).min(count)))
    }
}

/// Where the chunks of one term are added up.
pub struct Sink<'a> {
    out: &'a mut Evaluation,
    term: usize,
    trial: &'a Trial<'a>,
    role: Role,
    frame: Frame<'a>,
    apart: bool,
}

impl<'a> Sink<'a> {
    /// A sink for term number `term`.
    pub fn new(
        (out, term): (&'a mut Evaluation, usize),
        (trial, role): (&'a Trial<'a>, Role),
        frame: Frame<'a>,
    ) -> Self {
        Self { out, term, trial, role, frame, apart: false }
    }

    /// The same for a term whose forces are asked for apart too.
    pub fn apart(self, apart: bool) -> Self {
        Self { apart, ..self }
    }

    /// Adds the results of a round; the sink's order is that of the calls.
    pub fn scatter(&mut self, round: &Round) -> Result<(), Miss> {
        let wanted = self.trial.tangent != Tangent::None;
        // At once, while the threads that evaluated the round are still awake.
        let result = if wanted { self.frame.add(round, &mut self.out.values) } else { Ok(()) };
        for (chunk, numbers) in round.parts() {
            let (mut forces, mut matrices) = (chunk.forces.as_slice(), chunk.tangents.as_slice());
            for stencil in &round.stencils.list[numbers] {
                let dofs = round.stencils.dofs(stencil);
                self.add_forces(dofs, take(&mut forces, stencil.len));
                if let Some(missing) = self.trial.missing.filter(|_| wanted) {
                    self.carry(dofs, take(&mut matrices, stencil.len * stencil.len), missing);
                }
            }
            self.account(chunk);
        }
        result
    }

    fn account(&mut self, chunk: &Chunk) {
        self.out.branches[self.term].extend_from_slice(&chunk.branches);
        let energies = &mut self.out.energies[self.term];
        energies.stored += chunk.energies.stored;
        energies.dissipated += chunk.energies.dissipated;
        energies.supplied += chunk.energies.supplied;
        energies.residue += chunk.energies.residue;
    }

    fn add_forces(&mut self, dofs: &[usize], forces: &[f64]) {
        let Evaluation { load, internal, magnitude, .. } = &mut *self.out;
        let sum = if self.role == Role::Load { load } else { internal }.as_mut_slice();
        for (&dof, &force) in dofs.iter().zip(forces) {
            sum[dof] += force;
            magnitude[dof] += force.abs();
        }
        if let Some((_, apart)) = self.out.apart.last_mut().filter(|_| self.apart) {
            apart.extend(dofs.iter().copied().zip(forces.iter().copied()));
        }
    }

    fn carry(&mut self, dofs: &[usize], matrix: &[f64], missing: &[f64]) {
        for (row, &dof) in matrix.chunks_exact(dofs.len().max(1)).zip(dofs) {
            let force: f64 = row.iter().zip(dofs).map(|(k, &other)| k * missing[other]).sum();
            self.out.carried[dof] += self.frame.sign * force;
        }
    }
}

/// The first `count` of some values, which are left without them.
pub fn take<'a>(values: &mut &'a [f64], count: usize) -> &'a [f64] {
    let (first, rest) = values.split_at(count);
    *values = rest;
    first
}
