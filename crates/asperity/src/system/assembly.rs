//! The sum of all terms at a trial state: forces, matrix, new histories, energies, branches.
//!
//! Stencils are evaluated in parallel in chunks of fixed size and scattered in stencil order, so that no bit depends
//! on the number of threads. The [`Workspace`] only keeps memory and what follows exactly from the pattern.

use super::check::perturb;
use super::{
    Aid, Attempt, Branch, Constraints, Couplings, Csr, Dofs, Energies, History, Local, Role, Row, State, Stencils, Term,
};
use crate::Failure;
use rayon::prelude::*;
use std::sync::Arc;

/// How the matrix is to be found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tangent {
    /// Not wanted.
    None,
    /// The exact derivative, by dual numbers.
    Exact,
    /// Central differences of every stencil; the number is the step of a displacement (a length). A rotation is
    /// stepped by a fixed small angle.
    Perturbation(f64),
}

/// Result of one evaluation.
#[derive(Debug, Clone, Default)]
pub struct Evaluation {
    /// Forces of internal terms on all unknowns.
    pub internal: Vec<f64>,
    /// Forces of loads on all unknowns.
    pub load: Vec<f64>,
    /// Sum of the absolute forces of the stencils on all unknowns: the yardstick of the residual.
    pub magnitude: Vec<f64>,
    /// Forces that the motion still missing at the prescribed unknowns adds to first order.
    pub carried: Vec<f64>,
    /// Matrix values in the order of the pattern; meaningful when the tangent was wanted.
    pub values: Vec<f64>,
    /// History of each term at the trial state.
    pub histories: Vec<History>,
    /// Energy stored in each term now, and dissipated by it over the increment.
    pub energies: Vec<Energies>,
    /// Branch and discrete choice of each stencil of each term.
    pub branches: Vec<Vec<(Branch, u32)>>,
}

/// The system of one attempt: the opened terms, the accepted state they start from, and the constraints.
pub struct Assembly<'a> {
    /// Terms of the model.
    pub terms: &'a [Arc<dyn Term>],
    /// The same, opened for this attempt.
    pub attempts: Vec<Box<dyn Attempt + 'a>>,
    /// Numbering.
    pub dofs: &'a Dofs,
    /// What is prescribed.
    pub constraints: &'a Constraints,
}

/// Memory that lives through the run: pattern, places in it, chunk buffers.
#[derive(Debug)]
pub struct Workspace {
    couplings: Couplings,
    constraints: Option<Constraints>,
    pattern: Csr,
    analysis: usize,
    stencils: Vec<Stencils>,
    places: Vec<Vec<u32>>,
    chunks: Vec<Chunk>,
    enlarged: usize,
    /// Help that terms are given, see [`Local::aid`].
    pub aid: Aid,
}

/// Stencils a chunk holds; fixed, so that results do not depend on the number of threads.
const CHUNK: usize = 32;
/// Chunks evaluated between two scatters; bounds the memory of local matrices.
const ROUND: usize = 64;
/// A pair of unknowns that is not in the matrix because one is prescribed.
const NOWHERE: u32 = u32::MAX;
/// Marks a stencil that touches combined unknowns and is scattered the long way.
const LONG_WAY: u32 = u32::MAX - 1;

/// Results of the stencils of one chunk.
#[derive(Debug, Default)]
struct Chunk {
    local: Local,
    forces: Vec<f64>,
    tangents: Vec<f64>,
    branches: Vec<(Branch, u32)>,
    energies: Energies,
    failure: Option<Failure>,
}

/// The pattern lacks an entry that a stencil needs.
struct Miss;

impl Default for Workspace {
    fn default() -> Self {
        Self {
            couplings: Couplings::default(),
            constraints: None,
            pattern: Csr::default(),
            analysis: 0,
            stencils: Vec::new(),
            places: Vec::new(),
            chunks: Vec::new(),
            enlarged: 0,
            aid: Aid::NONE,
        }
    }
}

impl Workspace {
    /// The pattern of the matrix.
    pub fn pattern(&self) -> &Csr {
        &self.pattern
    }
    /// Changes whenever the pattern changes.
    pub fn analysis(&self) -> usize {
        self.analysis
    }
    /// How often a pattern had to be enlarged inside an attempt.
    pub fn enlarged(&self) -> usize {
        self.enlarged
    }

    /// Prepares the pattern of an attempt: a function of the accepted state alone.
    ///
    /// # Errors
    /// A [`Failure`] of a search at the accepted state.
    pub fn prepare(&mut self, assembly: &Assembly, accepted: &State) -> Result<(), Failure> {
        self.stencils.resize_with(assembly.terms.len(), Stencils::default);
        let mut couplings = Couplings::default();
        for (attempt, stencils) in assembly.attempts.iter().zip(&mut self.stencils) {
            stencils.clear();
            attempt.stencils(&accepted.u, stencils)?;
            stencils.list.iter().for_each(|s| couplings.push(stencils.dofs(s)));
            attempt.reach(&mut couplings);
        }
        if couplings != self.couplings || self.constraints.as_ref() != Some(assembly.constraints) {
            self.couplings = couplings;
            self.constraints = Some(assembly.constraints.clone());
            self.rebuild(assembly);
        }
        Ok(())
    }

    fn rebuild(&mut self, assembly: &Assembly) {
        self.pattern = Csr::build(assembly.constraints, &self.couplings);
        self.analysis += 1;
        let fixed = assembly.attempts.iter().map(|a| a.is_fixed());
        self.places = fixed
            .zip(&self.stencils)
            .map(|(fixed, s)| if fixed { places(&self.pattern, assembly.constraints, s) } else { Vec::new() })
            .collect();
    }

    /// Evaluates all terms at `u`. `missing` is the motion that prescribed unknowns have yet to make.
    ///
    /// # Errors
    /// The first [`Failure`] in the order of terms and stencils.
    pub fn evaluate(
        &mut self,
        assembly: &Assembly,
        u: &[f64],
        missing: Option<&[f64]>,
        tangent: Tangent,
        out: &mut Evaluation,
    ) -> Result<(), Failure> {
        for (attempt, stencils) in assembly.attempts.iter().zip(&mut self.stencils) {
            if !attempt.is_fixed() {
                stencils.clear();
                attempt.stencils(u, stencils)?;
            }
        }
        loop {
            out.clear(assembly.dofs.count(), self.pattern.columns.len(), tangent);
            let mut miss = false;
            for t in 0..assembly.terms.len() {
                match self.evaluate_term(assembly, t, u, missing, tangent, out)? {
                    Ok(()) => {}
                    Err(Miss) => miss = true,
                }
            }
            if !miss {
                return Ok(());
            }
            for stencils in &self.stencils {
                stencils.list.iter().for_each(|s| self.couplings.push(stencils.dofs(s)));
            }
            self.enlarged += 1;
            self.rebuild(assembly);
        }
    }

    fn evaluate_term(
        &mut self,
        assembly: &Assembly,
        t: usize,
        u: &[f64],
        missing: Option<&[f64]>,
        tangent: Tangent,
        out: &mut Evaluation,
    ) -> Result<Result<(), Miss>, Failure> {
        let (attempt, stencils) = (&assembly.attempts[t], &self.stencils[t]);
        let rotations = |dof: usize| assembly.dofs.is_rotation(dof);
        let mut history = std::mem::take(&mut out.histories[t]);
        let places = self.places.get(t).filter(|p| !p.is_empty());
        let mut sink = Sink { out, constraints: assembly.constraints, pattern: &self.pattern, missing };
        let (mut result, mut place) = (Ok(()), 0);
        let count = stencils.list.len();
        for round in (0..count).step_by(CHUNK * ROUND) {
            let end = (round + CHUNK * ROUND).min(count);
            let chunks = (end - round).div_ceil(CHUNK);
            if self.chunks.len() < chunks {
                self.chunks.resize_with(chunks, Chunk::default);
            }
            let lanes = split(&mut history, round, end);
            self.chunks[..chunks].iter_mut().for_each(|chunk| chunk.local.aid = self.aid);
            self.chunks[..chunks].par_iter_mut().zip(lanes).enumerate().for_each(|(k, (chunk, lane))| {
                let first = round + k * CHUNK;
                let range = first..(first + CHUNK).min(end);
                chunk.run(attempt.as_ref(), stencils, range, u, tangent, lane, &rotations);
            });
            for (k, chunk) in self.chunks[..chunks].iter_mut().enumerate() {
                if let Some(failure) = chunk.failure.take() {
                    sink.out.histories[t] = history;
                    return Err(failure);
                }
                let first = round + k * CHUNK;
                let list = &stencils.list[first..(first + CHUNK).min(end)];
                let places = places.map(|p| &p[place..]);
                place += list.iter().map(|s| s.len * s.len).sum::<usize>();
                let role = assembly.terms[t].role();
                if let Err(miss) = sink.scatter(chunk, list, stencils, role, tangent, places) {
                    result = Err(miss);
                }
                sink.out.branches[t].extend_from_slice(&chunk.branches);
                sink.out.energies[t].stored += chunk.energies.stored;
                sink.out.energies[t].dissipated += chunk.energies.dissipated;
            }
        }
        out.histories[t] = history;
        Ok(result)
    }
}

impl Evaluation {
    /// Room for the results of the given terms.
    pub fn new(terms: &[Arc<dyn Term>], accepted: &State) -> Self {
        Self {
            histories: accepted.histories.clone(),
            energies: vec![Energies::default(); terms.len()],
            branches: vec![Vec::new(); terms.len()],
            ..Self::default()
        }
    }

    fn clear(&mut self, unknowns: usize, entries: usize, tangent: Tangent) {
        for v in [&mut self.internal, &mut self.load, &mut self.magnitude, &mut self.carried] {
            v.clear();
            v.resize(unknowns, 0.0);
        }
        if tangent != Tangent::None {
            self.values.clear();
            self.values.resize(entries, 0.0);
        }
        self.energies.fill(Energies::default());
        self.branches.iter_mut().for_each(Vec::clear);
    }

    /// Unbalanced force on an unknown: internal minus load.
    pub fn residual(&self, dof: usize) -> f64 {
        self.internal[dof] - self.load[dof]
    }
}

/// Cuts the history of stencils `first..end` into one lane for each chunk.
fn split(history: &mut History, first: usize, end: usize) -> Vec<(usize, &[usize], &mut [f64])> {
    let (starts, mut rest) = (&history.starts, &mut history.data[history.starts[first]..history.starts[end]]);
    let mut lanes = Vec::with_capacity((end - first).div_ceil(CHUNK));
    for begin in (first..end).step_by(CHUNK) {
        let stop = (begin + CHUNK).min(end);
        let (lane, tail) = std::mem::take(&mut rest).split_at_mut(starts[stop] - starts[begin]);
        lanes.push((begin, &starts[begin..=stop], lane));
        rest = tail;
    }
    lanes
}

impl Chunk {
    #[allow(clippy::too_many_arguments)]
    fn run(
        &mut self,
        attempt: &dyn Attempt,
        stencils: &Stencils,
        range: std::ops::Range<usize>,
        u: &[f64],
        tangent: Tangent,
        (begin, starts, lane): (usize, &[usize], &mut [f64]),
        is_rotation: &dyn Fn(usize) -> bool,
    ) {
        self.forces.clear();
        self.tangents.clear();
        self.branches.clear();
        (self.energies, self.failure) = (Energies::default(), None);
        for index in range {
            let stencil = &stencils.list[index];
            let dofs = stencils.dofs(stencil);
            let (from, to) = (starts[index - begin] - starts[0], starts[index + 1 - begin] - starts[0]);
            let local = &mut self.local;
            local.u.clear();
            local.u.extend(dofs.iter().map(|&dof| u[dof]));
            if let Tangent::Perturbation(step) = tangent {
                local.wants_tangent = false;
                perturb(attempt, index, stencil, (step, &|k| is_rotation(dofs[k])), local, &mut self.tangents);
            }
            local.wants_tangent = tangent == Tangent::Exact;
            local.reset(stencil.len);
            match attempt.evaluate(index, stencil, &mut lane[from..to], local) {
                Ok(branch) => self.branches.push((branch, stencil.choice)),
                Err(failure) => {
                    self.failure = Some(failure);
                    return;
                }
            }
            self.forces.extend_from_slice(&local.force);
            if local.wants_tangent {
                self.tangents.extend_from_slice(&local.tangent);
            }
            self.energies.stored += local.stored;
            self.energies.dissipated += local.dissipated;
        }
    }
}

/// Where chunks are added up.
struct Sink<'a> {
    out: &'a mut Evaluation,
    constraints: &'a Constraints,
    pattern: &'a Csr,
    missing: Option<&'a [f64]>,
}

impl Sink<'_> {
    fn scatter(
        &mut self,
        chunk: &Chunk,
        list: &[super::Stencil],
        stencils: &Stencils,
        role: Role,
        tangent: Tangent,
        places: Option<&[u32]>,
    ) -> Result<(), Miss> {
        let (mut force, mut entry, mut result) = (0, 0, Ok(()));
        for stencil in list {
            let (n, dofs) = (stencil.len, stencils.dofs(stencil));
            self.add_forces(role, dofs, &chunk.forces[force..force + n]);
            force += n;
            if tangent == Tangent::None {
                continue;
            }
            let (matrix, sign) = (&chunk.tangents[entry..entry + n * n], if role == Role::Load { -1.0 } else { 1.0 });
            if let Some(missing) = self.missing {
                self.carry(dofs, matrix, missing, sign);
            }
            match places.map(|p| &p[entry..entry + n * n]) {
                Some(places) if places.first() != Some(&LONG_WAY) => {
                    for (&place, &value) in places.iter().zip(matrix) {
                        if place != NOWHERE {
                            self.out.values[place as usize] += sign * value;
                        }
                    }
                }
                _ => {
                    if let Err(miss) = self.add_long_way(dofs, matrix, sign) {
                        result = Err(miss);
                    }
                }
            }
            entry += n * n;
        }
        result
    }

    fn add_forces(&mut self, role: Role, dofs: &[usize], forces: &[f64]) {
        let sum = if role == Role::Load { &mut self.out.load } else { &mut self.out.internal };
        for (&dof, &force) in dofs.iter().zip(forces) {
            sum[dof] += force;
            self.out.magnitude[dof] += force.abs();
        }
    }

    fn carry(&mut self, dofs: &[usize], matrix: &[f64], missing: &[f64], sign: f64) {
        for (row, &dof) in matrix.chunks_exact(dofs.len()).zip(dofs) {
            let force: f64 = row.iter().zip(dofs).map(|(k, &other)| k * missing[other]).sum();
            self.out.carried[dof] += sign * force;
        }
    }

    fn add_long_way(&mut self, dofs: &[usize], matrix: &[f64], sign: f64) -> Result<(), Miss> {
        for (row, &dof) in matrix.chunks_exact(dofs.len().max(1)).zip(dofs) {
            for (&value, &other) in row.iter().zip(dofs) {
                if value == 0.0 {
                    continue;
                }
                for &(i, ci) in terms(self.constraints.row(dof)).as_slice() {
                    for &(j, cj) in terms(self.constraints.row(other)).as_slice() {
                        let place = self.pattern.position(i, j).ok_or(Miss)?;
                        self.out.values[place] += sign * ci * cj * value;
                    }
                }
            }
        }
        Ok(())
    }
}

/// The free unknowns a row depends on, without allocation for the usual ones.
enum RowTerms<'a> {
    One([(usize, f64); 1]),
    Many(&'a [(usize, f64)]),
}

impl RowTerms<'_> {
    fn as_slice(&self) -> &[(usize, f64)] {
        match self {
            Self::One(one) => one,
            Self::Many(many) => many,
        }
    }
}

fn terms(row: &Row) -> RowTerms<'_> {
    match row {
        Row::Free(i) => RowTerms::One([(*i, 1.0)]),
        Row::Fixed => RowTerms::Many(&[]),
        Row::Combined(terms) => RowTerms::Many(terms),
    }
}

/// Place in the matrix of every entry of every stencil.
fn places(pattern: &Csr, constraints: &Constraints, stencils: &Stencils) -> Vec<u32> {
    let mut places = Vec::with_capacity(stencils.list.iter().map(|s| s.len * s.len).sum());
    for stencil in &stencils.list {
        let dofs = stencils.dofs(stencil);
        if dofs.iter().any(|&dof| matches!(constraints.row(dof), Row::Combined(_))) {
            places.resize(places.len() + dofs.len() * dofs.len(), LONG_WAY);
            continue;
        }
        for &row in dofs {
            places.extend(dofs.iter().map(|&column| match (constraints.row(row), constraints.row(column)) {
                (Row::Free(i), Row::Free(j)) => pattern.position(*i, *j).map_or(NOWHERE, |p| p as u32),
                _ => NOWHERE,
            }));
        }
    }
    places
}
