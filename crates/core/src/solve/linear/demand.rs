//! What a run takes of memory and work, known before anything is assembled: from the symbolic analysis of the graph of its
//! nodes, and from counts.

use super::super::constants::demand::{
    BESIDES, GROWTH, PER_ENTRY, PER_ENTRY_OF_CONTACT, PER_PAIR, PER_UNKNOWN, PLENTY, ranks,
};
use super::frontal::dense;
use super::{Unknowns, engine};
use crate::machine::{Room, room};
use crate::solve::Problem;
use crate::system::{Constraints, Couplings, Csr, Instant, Reduced, State, Stencils};
use crate::{Error, Failure};
use frontal::{NodeGraph, Options, Policy, Prediction, Work};
use std::num::NonZeroUsize;

/// What the first step of a run takes.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Demand {
    /// Unknowns of the linear system.
    pub unknowns: usize,
    /// Entries of its matrix.
    pub entries: usize,
    /// What a factorisation takes of a matrix that is not symmetric,
    pub factorisation: Prediction,
    /// and of one that is.
    pub symmetric: Prediction,
    /// Bytes that the run takes beyond those that the model holds already where a matrix is not symmetric,
    pub bytes: u64,
    /// and where all are.
    pub symmetric_bytes: u64,
    /// Directions of the space, which say how the need grows with the number of unknowns.
    dimension: usize,
}

/// Bytes that ranks of a cluster hold: the first, which writes, and each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OfRanks {
    /// Where MUMPS factorises every matrix.
    pub direct: [u64; 2],
    /// Where BoomerAMG preconditions FGMRES, at most.
    pub multigrid: [u64; 2],
}

impl Problem {
    /// What the first step takes. Nothing is assembled or factorised.
    ///
    /// # Errors
    /// [`Error::Input`] where the matrix has more entries than can be counted, [`Error::NotConverged`] where the state cannot be
    /// evaluated.
    pub fn demand(&self, state: &State) -> Result<Demand, Error> {
        let Some(step) = self.steps.get(state.step) else { return Ok(Demand::default()) };
        let dt = step.next(state.next_dt, state.step_time);
        let at = Instant { step: state.step, step_time: state.step_time + dt, time: state.time + dt, dt, factor: None };
        let groups = self.groups(state, at).map_err(|failure| Error::NotConverged(failure.reason))?;
        let pairs = groups.iter().map(|group| (group.len() * group.len()) as f64).sum::<f64>();
        let graph = graph(self, &step.constraints, &groups);
        drop(groups);
        let (unknowns, entries) = (graph.unknowns(), graph.nonzeros());
        let last = graph.rows_beyond(dense(unknowns));
        let costs = Prediction::of_nodes(graph, &last, &Options::default(), rayon::current_num_threads())
            .map_err(|error| Error::input(format!("the equations cannot be solved: {error}")))?;
        let (policy, dimension) = (self.newton.factors.policy(), self.dofs.per_node());
        let contact = self.terms.iter().any(|term| term.bends());
        // Those of the accepted state are there already.
        let histories = state.histories.iter().map(|history| size_of_val(&*history.data)).sum::<usize>();
        let [bytes, symmetric_bytes] = costs.map(|cost| {
            let bends = contact && policy.affordable_iterations(Work::from(&cost)) > 0;
            let per_entry = PER_ENTRY + if bends { PER_ENTRY_OF_CONTACT[dimension - 2] } else { 0.0 };
            let beside = per_entry * entries as f64 + PER_PAIR * pairs + PER_UNKNOWN * unknowns as f64 + BESIDES;
            cost.bytes as u64 + single(&policy, &cost) + histories as u64 + beside as u64
        });
        let [factorisation, symmetric] = costs;
        Ok(Demand { unknowns, entries, factorisation, symmetric, bytes, symmetric_bytes, dimension })
    }

    /// Whether the first step fits into the memory there is; of small models nothing is asked, and of what an engine from outside takes on
    /// each rank only where its bound is said.
    ///
    /// # Errors
    /// [`Error::Input`] with the need and what would fit.
    pub fn check_memory(&self, state: &State) -> Result<(), Error> {
        let Some(room) = room(self.newton.memory) else { return Ok(()) };
        if engine::provided() {
            return if self.newton.memory.is_some() { self.demand(state)?.check_ranks(&room) } else { Ok(()) };
        }
        if PLENTY * self.dofs.count() as u64 <= room.left() { Ok(()) } else { self.demand(state)?.check(&room) }
    }

    /// Unknowns that couple: those of each stencil, and what the terms reach besides.
    fn groups(&self, state: &State, at: Instant) -> Result<Couplings, Failure> {
        let (mut groups, mut stencils) = (Couplings::default(), Stencils::default());
        for attempt in self.open(state, at)? {
            stencils.clear();
            attempt.stencils(&state.u, &mut stencils)?;
            groups.extend(&stencils);
            attempt.reach(&mut groups);
        }
        Ok(groups)
    }
}

/// Bytes of the factor in single precision, where it preconditions, beyond those of the working memory that it takes the place of.
pub(super) fn single(policy: &Policy, cost: &Prediction) -> u64 {
    if policy.affordable_iterations(Work::from(cost)) > 0 { cost.single_bytes() as u64 } else { 0 }
}

/// The nodes of the free unknowns, and which of them couple.
fn graph(problem: &Problem, constraints: &Constraints, groups: &Couplings) -> NodeGraph {
    let node_of = Unknowns { dofs: &problem.dofs, free: constraints.free() }.owners();
    let count = node_of.last().map_or(0, |last| last + 1);
    let mut weights = vec![0; count];
    node_of.iter().for_each(|&node| weights[node] += 1);
    let couplings = Csr::of(count, &Reduced::new(constraints, groups).owned_by(&node_of));
    let others =
        |node: usize| couplings.row(node).iter().filter(move |&&other| other != node).map(|&other| other as u32);
    let starts = couplings.starts.iter().enumerate().map(|(node, start)| start - node).collect();
    NodeGraph { starts, neighbours: (0..count).flat_map(others).collect(), weights }
}

impl Demand {
    /// Whether it fits where all matrices are symmetric, which shows when they are there: one that is not and does not fit ends
    /// the run then.
    ///
    /// # Errors
    /// [`Error::Input`] with the need and what would fit.
    pub fn check(&self, room: &Room) -> Result<(), Error> {
        self.fits(self.symmetric_bytes, room)
    }

    /// Whether it fits where they are not.
    ///
    /// # Errors
    /// As those of [`check`](Self::check).
    pub fn check_unsymmetric(&self, room: &Room) -> Result<(), Error> {
        self.fits(self.bytes, room)
    }

    /// What each of so many ranks of a cluster holds in all, by what ranks held on models that were measured.
    pub fn of_ranks(&self, count: NonZeroUsize) -> OfRanks {
        let (count, unknowns, entries) = (count.get() as f64, self.unknowns as f64, self.entries as f64);
        let both =
            |all: f64, first: f64| [all + first + ranks::FIRST, all].map(|bytes| (bytes + ranks::BESIDES) as u64);
        let factors = ranks::PER_FACTOR * self.factorisation.factor_entries as f64 * count.powf(ranks::SHARE);
        OfRanks {
            direct: both(
                ranks::PER_UNKNOWN * unknowns + ranks::PER_ENTRY * entries / count + factors,
                ranks::FIRST_PER_UNKNOWN * unknowns + ranks::FIRST_PER_ENTRY * entries,
            ),
            multigrid: both(
                ranks::MULTIGRID_PER_UNKNOWN * unknowns + ranks::MULTIGRID_PER_ENTRY * entries / count,
                ranks::MULTIGRID_FIRST_PER_UNKNOWN * unknowns,
            ),
        }
    }

    /// Whether the ranks there are fit, each by itself, with the one of their engines that takes less.
    ///
    /// # Errors
    /// As those of [`check`](Self::check).
    pub fn check_ranks(&self, room: &Room) -> Result<(), Error> {
        let count = engine::others().map_or(1, |with| with.size());
        let of_ranks = self.of_ranks(NonZeroUsize::new(count).unwrap_or(NonZeroUsize::MIN));
        self.fits(of_ranks.direct[0].min(of_ranks.multigrid[0]).saturating_sub(room.taken), room)
    }

    fn fits(&self, bytes: u64, room: &Room) -> Result<(), Error> {
        if bytes <= room.left() {
            return Ok(());
        }
        let part = room.left() as f64 / bytes.max(1) as f64;
        let fits = self.unknowns as f64 * part.powf(1.0 / GROWTH[self.dimension - 2]);
        let longer = (self.unknowns as f64 / fits.max(1.0)).powf(1.0 / self.dimension as f64);
        Err(Error::input(format!(
            "{}; about {} of its {} unknowns would fit, cells {longer:.1} times as long",
            too_much(room.taken + bytes, room),
            rounded(fits),
            self.unknowns
        )))
    }
}

/// Two leading digits, as of an estimate.
fn rounded(x: f64) -> String {
    let unit = 10_f64.powf((x.max(1.0).log10().floor() - 1.0).max(0.0));
    format!("{:.0}", (x / unit).floor() * unit)
}

/// Words for a need beyond what there is, in bytes.
pub(super) fn too_much(need: u64, room: &Room) -> String {
    format!(
        "the run needs about {:.2} GB of memory, and {:.2} GB is {}",
        need as f64 / 1e9,
        room.total as f64 / 1e9,
        room.source
    )
}
