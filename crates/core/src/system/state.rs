//! Everything the next increment reads.

use super::Preconditioner;
use serde::{Deserialize, Serialize};

/// History of one term: a block of values for each of its slots (an element, a contact point).
///
/// Two lanes, two rules. The lane in the accepted [`State`] is at t_n: read during evaluation, never changed. The
/// lane of an attempt is at t_n+1: written during evaluation, never read before it is written. To commit is to swap;
/// to cut back is to do nothing.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct History {
    /// Values of slot `i` are `data[starts[i]..starts[i + 1]]`.
    pub starts: Vec<usize>,
    /// All values.
    pub data: Vec<f64>,
}

impl History {
    /// Zeroed history whose slots have the given lengths.
    pub fn new(lengths: impl IntoIterator<Item = usize>) -> Self {
        let mut starts = vec![0];
        let mut total = 0;
        for length in lengths {
            total += length;
            starts.push(total);
        }
        Self { starts, data: vec![0.0; total] }
    }
    /// Number of slots.
    pub fn slots(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }
    /// Values of one slot.
    pub fn slot(&self, i: usize) -> &[f64] {
        &self.data[self.starts[i]..self.starts[i + 1]]
    }
    /// Values of one slot, to write.
    pub fn slot_mut(&mut self, i: usize) -> &mut [f64] {
        &mut self.data[self.starts[i]..self.starts[i + 1]]
    }
}

/// Energies of one term: what it stores now and what it has dissipated since the start.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Energies {
    /// Recoverable energy in the current state.
    pub stored: f64,
    /// Dissipated energy, accumulated over accepted increments.
    pub dissipated: f64,
    /// Energy that heat supplied, overlap that was removed, and work of supports and loads that a trapezoid over the increment misses
    /// since friction turned within it, or has over gaps; accumulated likewise.
    pub supplied: f64,
    /// Work that a rate law neither stores nor dissipates, accumulated likewise.
    pub residue: f64,
    /// Work that the trapezoid of supports and loads over the last increment has too much where a contact bears nothing on the way; of a state what was
    /// taken off `supplied` for it.
    pub across: f64,
    /// Part of what was dissipated that bonds had which broke over the last increment; of a state over all.
    pub bonds: f64,
}

impl std::ops::AddAssign for Energies {
    fn add_assign(&mut self, other: Self) {
        let Self { stored, dissipated, supplied, residue, across, bonds } = other;
        self.stored += stored;
        self.dissipated += dissipated;
        self.supplied += supplied;
        self.residue += residue;
        self.across += across;
        self.bonds += bonds;
    }
}

impl Energies {
    /// Work that the term has taken up: in equilibrium that of supports and loads.
    pub fn taken(&self) -> f64 {
        self.stored + self.dissipated + self.residue - self.supplied
    }
}

/// How far a body lies in another, in itself or in a tool.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Interpenetration {
    /// The depth that counts, over a size of the mesh.
    pub relative: f64,
    /// The whole depth, a length.
    pub depth: f64,
    /// Where.
    pub place: [f64; 3],
    /// The two, in words; empty where nothing lies in anything.
    pub pair: [String; 2],
    /// The increment.
    pub increment: usize,
}

/// What attempts that failed teach about the size of the increments that follow.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Caution {
    /// The size that failed last and that none has passed since; zero if there is none.
    pub failed: f64,
    /// Increments that must still succeed before a larger one is tried,
    pub rest: usize,
    /// and how many had to when it failed.
    pub patience: usize,
    /// The size accepted last without relaxation; zero before the first of a step.
    pub proven: f64,
    /// Whether a relaxation in this step found no equilibrium: another is then tried only before the run gives up.
    pub vain: bool,
}

/// Signs of the pivots of a tangent.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Signs {
    /// Time of the state.
    pub time: f64,
    /// Step in which it was, from zero, which says the free unknowns.
    pub step: usize,
    /// Whether it was symmetric.
    pub symmetric: bool,
    /// Number of negative eigenvalues if it was; else zero or one by the sign of the determinant, and where that changed once more what the
    /// symmetric part has.
    pub negative: usize,
}

/// The softest mode of the tangent as it is followed from one increment to the next: the eigenvector of its symmetric part that
/// belongs to the smallest eigenvalue, so far as the iterations have brought it.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Softest {
    /// The vector over the free unknowns, of length one.
    pub mode: Vec<f64>,
    /// Its Rayleigh quotient.
    pub eigenvalue: f64,
    /// Time of the state to which both belong.
    pub time: f64,
    /// That step, from zero.
    pub step: usize,
    /// Change of the quotient over time since it was found before, if it was in the same step.
    pub slope: Option<f64>,
    /// Increments since.
    pub passed: usize,
    /// The quotient of another sign than the pivots say, that a factor has refuted last; zero if there is none.
    pub refuted: f64,
}

impl Softest {
    /// Change of the quotient over time to another at a later time of the same step.
    pub fn slope_to(&self, (step, time): (usize, f64), eigenvalue: f64) -> Option<f64> {
        (step == self.step && time > self.time).then(|| (eigenvalue - self.eigenvalue) / (time - self.time))
    }
    /// The quotient at a time, carried on as it changed last.
    pub fn carried(&self, time: f64) -> Option<f64> {
        self.slope.map(|slope| self.eigenvalue + slope * (time - self.time))
    }
}

/// The accepted state. Serialised, it is the checkpoint; anything kept elsewhere can be rebuilt from it and the model.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Current step, from zero; equal to the number of steps when all are done.
    pub step: usize,
    /// Accepted increments so far in all steps.
    pub increment: usize,
    /// Accepted increments of the present step.
    pub step_increment: usize,
    /// Time since the start.
    pub time: f64,
    /// Time since the start of the step.
    pub step_time: f64,
    /// All unknowns: displacements and the motion of the tools.
    pub u: Vec<f64>,
    /// Change of the unknowns over the last accepted increment.
    pub last_change: Vec<f64>,
    /// Time of the last accepted increment; zero before the first and where its motion must not be carried on.
    pub last_dt: f64,
    /// Second divided difference of the unknowns over time at the last three states; empty where there is none,
    pub bend: Vec<f64>,
    /// and whether the unknowns go along a parabola, as far as the last increment tells.
    pub bends: bool,
    /// Size the controller wants for the next increment.
    pub next_dt: f64,
    /// What sizes that failed have taught.
    pub caution: Caution,
    /// Motion of the last increment over the size of the model where it was many times as fast as that of the increment
    /// before, else zero.
    pub leap: f64,
    /// What the audit found in the last increment.
    pub interpenetration: Interpenetration,
    /// The worst that it found in any.
    pub worst_interpenetration: Interpenetration,
    /// The deepest node in the last increment of all that contacts bear, over the length of its sides.
    pub deepest_node: Interpenetration,
    /// Unknowns at the beginning of the step, from which prescribed values ramp.
    pub step_start: Vec<f64>,
    /// Forces of all internal terms on all unknowns: reactions and applied loads together.
    pub internal: Vec<f64>,
    /// Forces of all loads on all unknowns.
    pub load: Vec<f64>,
    /// Load factor in a step that follows a path, else the part of the step's time that is over,
    pub factor: f64,
    /// its change over the last increment of a path,
    pub last_factor: f64,
    /// and the length of the path over time, zero before the first increment of the step.
    pub arc: f64,
    /// Load factors at which such steps ended other than one, by the numbers of the steps.
    pub load_factors: Vec<(usize, f64)>,
    /// Whether what the step lets go has been noted.
    pub entered: bool,
    /// After the last increment of a step, of each contact its number among the terms and its forces, by unknown: the next
    /// step may do without it. Else empty.
    pub leaving: Vec<(usize, Vec<(usize, f64)>)>,
    /// Forces on all unknowns that held when the step began and that are let go little by little over it; empty where there are
    /// none.
    pub handed: Vec<f64>,
    /// Unknowns of tools that a load drives and that stand on a stop, since nothing bears them any more in the step.
    pub stopped: Vec<usize>,
    /// The largest force and moment that have been in play: sums of the magnitudes of the forces of stencils on an unknown.
    pub in_play: [f64; 2],
    /// Energies of each term.
    pub energies: Vec<Energies>,
    /// Work of supports and loads since the start.
    pub external_work: f64,
    /// What its trapezoids may miss where forces grow along an increment.
    pub unresolved_work: f64,
    /// Increments that ended beyond an instability,
    pub jumps: usize,
    /// and the energy that was set free in them, and in those in which bonds broke.
    pub released: f64,
    /// Increments in which something that nothing held was held still.
    pub held: usize,
    /// History of each term.
    pub histories: Vec<History>,
    /// Signs of the pivots when they were last known.
    pub signs: Option<Signs>,
    /// The softest mode, where it is followed.
    pub softest: Option<Softest>,
    /// What the linear solver begins the next increment with, where that is not a matrix of its own.
    pub preconditioner: Option<Preconditioner>,
    /// Attempts and iterations spent so far.
    pub attempts: usize,
    /// Iterations spent so far.
    pub iterations: usize,
}

impl State {
    /// Unknowns that the motion leads to over `dt`: the last increment carried on, or the parabola through the last three states where
    /// the unknowns go along one.
    pub fn ahead(&self, dt: f64) -> Vec<f64> {
        if self.last_dt > 0.0 { self.carried(dt, self.bends) } else { self.u.clone() }
    }

    /// The unknowns after `dt` at the velocity of the last increment or along the parabola.
    pub fn carried(&self, dt: f64, parabola: bool) -> Vec<f64> {
        let straight = self.u.iter().zip(&self.last_change).map(|(u, change)| u + change * (dt / self.last_dt));
        let bend = dt * (dt + self.last_dt);
        match parabola {
            true => straight.zip(&self.bend).map(|(u, b)| u + bend * b).collect(),
            false => straight.collect(),
        }
    }
}
