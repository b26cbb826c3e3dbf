//! The sum of all terms at a trial state: forces, matrix, new histories, energies, branches.
//!
//! Stencils are evaluated in parallel in chunks of fixed size and added up in stencil order, so that no bit depends
//! on the number of threads. The [`Workspace`] only keeps memory and what follows exactly from the pattern.

use super::band::Frame;
use super::chunk::{CHUNK, Chunk, Pass, lanes};
use super::parcel::{Parcel, Parcels, share_histories};
use super::shares::{Shares, apart};
use super::sink::{Miss, Round, Sink};
use super::structure::Structure;
use super::{
    Attempt, Branch, Communicator, Constraints, Coordinates, Csr, Dofs, Energies, History, Kinks, Origin, Role, State,
    Stencils, Term,
};
use crate::Failure;
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::ops::Range;
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

/// Where the terms are evaluated, and what is wanted there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trial<'a> {
    /// All unknowns.
    pub u: &'a [f64],
    /// The motion that prescribed unknowns have yet to make.
    pub missing: Option<&'a [f64]>,
    /// Whether and how the matrix is to be found.
    pub tangent: Tangent,
    /// Stresses with which the tangents of stencils that bend turn and move, term by term and stencil by stencil; those of
    /// the trial state where none are given.
    pub acting: &'a [Vec<Coordinates>],
    /// Where the step to the unknowns began.
    pub origin: Origin,
    /// The unknowns there; none where it is not a step.
    pub from: &'a [f64],
}

impl<'a> Trial<'a> {
    /// At these unknowns, where nothing is known of a step to them.
    pub fn at(u: &'a [f64], tangent: Tangent) -> Self {
        Self { u, missing: None, tangent, acting: &[], origin: Origin::Unknown, from: &[] }
    }
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
    /// Of each term whose forces are asked for apart, its number and its forces, in the order of its stencils: unknowns may
    /// come again.
    pub apart: Vec<(usize, Vec<(usize, f64)>)>,
    /// Matrix values in the order of the pattern; meaningful when the tangent was wanted.
    pub values: Vec<f64>,
    /// History of each term at the trial state; where several ranks evaluate, that of their own chunks until they
    /// [share](Workspace::share_histories) it.
    pub histories: Vec<History>,
    /// Energy stored in each term now, and over the increment what it dissipated, heat supplied, and a rate law left over.
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
    /// Terms whose forces are asked for apart.
    pub apart: Range<usize>,
}

/// Memory that lives through the run: pattern, places in it, chunk buffers.
#[derive(Debug, Default)]
pub struct Workspace {
    shares: Shares,
    structure: Structure,
    stencils: Vec<Stencils>,
    chunks: Vec<Chunk>,
    enlarged: usize,
}

/// Chunks evaluated before they are added up: so few that local matrices are still in the cache of a thread that is alone,
/// so many that it pays others to wake up.
const ROUND: [usize; 2] = [4, 64];

impl Workspace {
    /// A workspace of one of several ranks, if they are, that evaluate together.
    pub fn of(with: Option<&'static dyn Communicator>) -> Self {
        Self { shares: Shares::new(with, &Dofs::new(2, 0, 0), &[]), ..Self::default() }
    }
    /// Who owns what.
    pub fn shares(&self) -> &Shares {
        &self.shares
    }
    /// The pattern of the matrix, or of the rows of this rank.
    pub fn pattern(&self) -> &Csr {
        self.structure.pattern()
    }
    /// Changes whenever the pattern changes.
    pub fn analysis(&self) -> usize {
        self.structure.analysis()
    }
    /// Number of the stencils of a term.
    pub fn stencils(&self, term: usize) -> usize {
        self.stencils[term].list.len()
    }
    /// How often a pattern had to be enlarged inside an attempt.
    pub fn enlarged(&self) -> usize {
        self.enlarged
    }

    /// Lists the stencils that bend at `u`, where the terms were evaluated last.
    ///
    /// # Errors
    /// The first [`Failure`] in the order of terms and stencils.
    pub fn kinks(&self, assembly: &Assembly, u: &[f64], out: &mut Kinks) -> Result<(), Failure> {
        let mut local = Vec::new();
        out.clear();
        for (t, stencils) in self.stencils.iter().enumerate().filter(|(t, _)| assembly.terms[*t].bends()) {
            for (index, stencil) in stencils.list.iter().enumerate() {
                let dofs = stencils.dofs(stencil);
                local.clear();
                local.extend(dofs.iter().map(|&dof| u[dof]));
                out.begin((t, index), dofs);
                assembly.attempts[t].kink(index, stencil, &local, out)?;
                out.end();
            }
        }
        Ok(())
    }

    /// The unknowns of all stencils of the terms that bend which share one with `dofs`, and those themselves.
    pub fn around(&self, dofs: &[usize], bends: impl Fn(usize) -> bool) -> Vec<usize> {
        let marked: BTreeSet<usize> = dofs.iter().copied().collect();
        let mut found: Vec<usize> = marked.iter().copied().collect();
        for (_, stencils) in self.stencils.iter().enumerate().filter(|(t, _)| bends(*t)) {
            let all = stencils.list.iter().map(|stencil| stencils.dofs(stencil));
            found.extend(all.filter(|dofs| dofs.iter().any(|dof| marked.contains(dof))).flatten());
        }
        found
    }

    /// Prepares the pattern of an attempt: a function of the accepted state alone.
    ///
    /// # Errors
    /// A [`Failure`] of a search at the accepted state.
    pub fn prepare(&mut self, assembly: &Assembly, accepted: &State) -> Result<(), Failure> {
        self.list_stencils(assembly, accepted)?;
        self.shares = Shares::new(self.shares.with(), assembly.dofs, assembly.constraints.free());
        self.structure.prepare(assembly, &self.stencils, self.shares.own());
        Ok(())
    }

    /// Lists the stencils at the accepted state, which is enough to evaluate forces without a matrix.
    ///
    /// # Errors
    /// A [`Failure`] of a search at the accepted state.
    pub fn list_stencils(&mut self, assembly: &Assembly, accepted: &State) -> Result<(), Failure> {
        self.stencils.resize_with(assembly.terms.len(), Stencils::default);
        for (attempt, stencils) in assembly.attempts.iter().zip(&mut self.stencils) {
            stencils.clear();
            attempt.stencils(&accepted.u, stencils)?;
        }
        Ok(())
    }

    /// Lists the stencils at `u` of the terms whose stencils change.
    ///
    /// # Errors
    /// A [`Failure`] of a search.
    pub fn find_stencils(&mut self, assembly: &Assembly, u: &[f64]) -> Result<(), Failure> {
        for (attempt, stencils) in assembly.attempts.iter().zip(&mut self.stencils) {
            if !attempt.is_fixed() {
                stencils.clear();
                attempt.stencils(u, stencils)?;
            }
        }
        Ok(())
    }

    /// Evaluates all terms at a trial state.
    ///
    /// # Errors
    /// The first [`Failure`] in the order of terms and stencils.
    pub fn evaluate(&mut self, assembly: &Assembly, trial: &Trial, out: &mut Evaluation) -> Result<(), Failure> {
        self.find_stencils(assembly, trial.u)?;
        loop {
            out.clear(assembly.dofs.count(), self.pattern().columns.len(), trial.tangent);
            out.apart.clear();
            let evaluated = match self.shares.with() {
                None => self.evaluate_alone(assembly, trial, out)?,
                Some(with) => self.evaluate_together(assembly, trial, out, with)?,
            };
            match evaluated {
                Ok(()) => return Ok(()),
                Err(Miss) => {
                    self.enlarged += 1;
                    self.structure.enlarge(assembly, &self.stencils);
                }
            }
        }
    }

    fn evaluate_alone(
        &mut self,
        assembly: &Assembly,
        trial: &Trial,
        out: &mut Evaluation,
    ) -> Result<Result<(), Miss>, Failure> {
        let mut result = Ok(());
        for t in 0..assembly.terms.len() {
            let part = self.evaluate_term((assembly, t, trial), out, None);
            result = part.map_err(|(_, failure)| failure)?.and(result);
        }
        Ok(result)
    }

    fn evaluate_together(
        &mut self,
        assembly: &Assembly,
        trial: &Trial,
        out: &mut Evaluation,
        with: &dyn Communicator,
    ) -> Result<Result<(), Miss>, Failure> {
        with.agree(trial.u).map_err(apart)?;
        let mut parcel = Parcel::default();
        for t in 0..assembly.terms.len() {
            match self.evaluate_term((assembly, t, trial), out, Some(&mut parcel)) {
                Ok(Ok(())) => {}
                Ok(Err(Miss)) => parcel.miss(),
                Err(failed) => {
                    parcel.fail(t, failed);
                    break;
                }
            }
        }
        let mut parcels = match parcel.exchange(with)? {
            Ok(parcels) => parcels,
            Err(Miss) => return Ok(Err(Miss)),
        };
        for t in 0..assembly.terms.len() {
            self.receive((assembly, t, trial), out, &mut parcels);
        }
        Ok(Ok(()))
    }

    /// Completes new histories of which each rank has those of its own chunks.
    ///
    /// # Errors
    /// A [`Failure`] where ranks have come apart.
    pub fn share_histories(&self, histories: &mut [History]) -> Result<(), Failure> {
        let Some(with) = self.shares.with() else { return Ok(()) };
        let owner = |term: usize, first: usize| self.stencils[term].owner(first, &self.shares);
        share_histories(with, &self.stencils, histories, owner).map_err(apart)
    }

    /// Adds up the forces of the loads alone at `u`, where the terms were evaluated last.
    ///
    /// # Errors
    /// The first [`Failure`] in the order of terms and stencils.
    pub fn evaluate_loads(&mut self, assembly: &Assembly, u: &[f64], out: &mut Evaluation) -> Result<(), Failure> {
        out.clear(assembly.dofs.count(), 0, Tangent::None);
        out.apart.clear();
        let trial = Trial::at(u, Tangent::None);
        for t in (0..assembly.terms.len()).filter(|&t| assembly.terms[t].role() == Role::Load) {
            // Nothing can miss a matrix that is not found.
            let evaluated = self.evaluate_term((assembly, t, &trial), out, None);
            let _ = evaluated.map_err(|(_, failure)| failure)?;
        }
        Ok(())
    }

    /// Evaluates a term and adds up what it comes to; among several ranks its matrix, and what there is else into a parcel.
    fn evaluate_term(
        &mut self,
        of: (&Assembly, usize, &Trial),
        out: &mut Evaluation,
        parcel: Option<&mut Parcel>,
    ) -> Result<Result<(), Miss>, (usize, Failure)> {
        let term = of.1;
        let mut history = std::mem::take(&mut out.histories[term]);
        let result = self.evaluate_rounds(of, (&mut history, out), parcel);
        out.histories[term] = history;
        result
    }

    fn evaluate_rounds(
        &mut self,
        (assembly, t, trial): (&Assembly, usize, &Trial),
        (history, out): (&mut History, &mut Evaluation),
        mut parcel: Option<&mut Parcel>,
    ) -> Result<Result<(), Miss>, (usize, Failure)> {
        let alone = Shares::new(None, assembly.dofs, assembly.constraints.free());
        let shares = if parcel.is_some() { &self.shares } else { &alone };
        let (stencils, dofs, constraints) = (&self.stencils[t], assembly.dofs, assembly.constraints);
        let attempt = assembly.attempts[t].as_ref();
        let pass = Pass { attempt, term: t, stencils, dofs, constraints, shares, trial };
        let (pattern, places) = (self.structure.pattern(), self.structure.places(t));
        let role = assembly.terms[t].role();
        let sign = if role == Role::Load { -1.0 } else { 1.0 };
        let frame = Frame { constraints, pattern, places, shares, sign };
        let mut sink = Sink::new((out, t), role);
        if parcel.is_none() {
            sink.begin(assembly.apart.contains(&t));
        }
        let (mut result, count) = (Ok(()), stencils.list.len());
        let round = CHUNK * ROUND[usize::from(rayon::current_num_threads() > 1)];
        for first in (0..count).step_by(round) {
            let end = (first + round).min(count);
            let number = (end - first).div_ceil(CHUNK);
            if self.chunks.len() < number {
                self.chunks.resize_with(number, Chunk::default);
            }
            let chunks = &mut self.chunks[..number];
            chunks.par_iter_mut().zip(lanes(history, first..end)).for_each(|(chunk, lane)| chunk.run(&pass, lane));
            if let Some(failed) = chunks.iter_mut().find_map(|chunk| chunk.failure.take()) {
                return Err(failed);
            }
            let round = Round { chunks, stencils, first };
            // At once, while the threads that evaluated the round are still awake.
            if trial.tangent != Tangent::None {
                result = sink.add_matrices(&frame, &round).and(result);
            }
            match &mut parcel {
                None => sink.scatter(&round),
                Some(parcel) => {
                    let own = round.parts().filter(|(_, numbers)| pass.owns(numbers.start));
                    own.for_each(|(chunk, _)| parcel.add(chunk));
                }
            }
        }
        Ok(result)
    }

    /// Adds up what ranks have told of a term.
    fn receive(
        &mut self,
        (assembly, t, trial): (&Assembly, usize, &Trial),
        out: &mut Evaluation,
        parcels: &mut Parcels,
    ) {
        let stencils = &self.stencils[t];
        let carried = trial.missing.is_some() && trial.tangent != Tangent::None;
        let mut sink = Sink::new((out, t), assembly.terms[t].role());
        sink.begin(assembly.apart.contains(&t));
        let (mut chunk, count) = (Chunk::default(), stencils.list.len());
        for first in (0..count).step_by(CHUNK) {
            let range = first..(first + CHUNK).min(count);
            parcels.read(stencils.owner(first, &self.shares), (stencils, range), carried, &mut chunk);
            sink.scatter(&Round { chunks: std::slice::from_ref(&chunk), stencils, first });
        }
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
