//! Adding up what chunks of stencils come to: forces, energies and branches one after another, and their matrices.

use super::band::Frame;
use super::chunk::{CHUNK, Chunk};
use super::{Evaluation, Role, Stencils};
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
    role: Role,
    sign: f64,
    apart: bool,
}

impl<'a> Sink<'a> {
    /// A sink for term number `term`.
    pub fn new((out, term): (&'a mut Evaluation, usize), role: Role) -> Self {
        Self { out, term, role, sign: if role == Role::Load { -1.0 } else { 1.0 }, apart: false }
    }

    /// Begins to add forces, which may be asked for apart too.
    pub fn begin(&mut self, apart: bool) {
        self.apart = apart;
        if apart {
            self.out.apart.push((self.term, Vec::new()));
        }
    }

    /// Adds the matrices of a round.
    pub fn add_matrices(&mut self, frame: &Frame, round: &Round) -> Result<(), Miss> {
        frame.add(round, &mut self.out.values)
    }

    /// Adds the other results of a round; the sink's order is that of the calls.
    pub fn scatter(&mut self, round: &Round) {
        for (chunk, numbers) in round.parts() {
            let (mut forces, mut carried) = (chunk.forces.as_slice(), chunk.carried.as_slice());
            for stencil in &round.stencils.list[numbers] {
                let dofs = round.stencils.dofs(stencil);
                self.add_forces(dofs, take(&mut forces, stencil.len));
                if !carried.is_empty() {
                    self.carry(dofs, take(&mut carried, stencil.len));
                }
            }
            self.account(chunk);
        }
    }

    fn account(&mut self, chunk: &Chunk) {
        self.out.branches[self.term].extend_from_slice(&chunk.branches);
        self.out.energies[self.term] += chunk.energies;
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

    fn carry(&mut self, dofs: &[usize], forces: &[f64]) {
        dofs.iter().zip(forces).for_each(|(&dof, force)| self.out.carried[dof] += self.sign * force);
    }
}

/// The first `count` of some values, which are left without them.
pub fn take<'a>(values: &mut &'a [f64], count: usize) -> &'a [f64] {
    let (first, rest) = values.split_at(count);
    *values = rest;
    first
}
