//! What equilibrium is a sum of.

use super::{Answer, Coordinates, Couplings, Energies, History, Kinks, Shares, State};
use crate::Failure;

/// Whether a term resists (a body, a contact, a spring) or acts from outside (a load).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// Its forces enter equilibrium with a plus sign, and their work is stored or dissipated.
    Internal,
    /// Its forces enter equilibrium with a minus sign, and their work is supplied.
    Load,
}

/// The instant at which an attempt ends.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Instant {
    /// Step, from zero.
    pub step: usize,
    /// Time since the start of the step.
    pub step_time: f64,
    /// Time since the start.
    pub time: f64,
    /// Length of the increment.
    pub dt: f64,
    /// In a step that follows a path, the load factor: the part of what it changes of loads and prescribed motion.
    pub factor: Option<f64>,
}

/// Which smooth piece of its function a stencil was evaluated on (open, stick, slip); Newton's order is measured only
/// while no branch changes. The meaning belongs to the term.
pub type Branch = u8;

/// One stencil of one iteration. Its number in the list is its history slot.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Stencil {
    /// First of its unknowns in [`Stencils::dofs`].
    pub start: usize,
    /// Number of its unknowns; repeats are allowed.
    pub len: usize,
    /// Discrete choice made by the search (hit segment); zero when there is none.
    pub choice: u32,
    /// Where on it, roughly: which of several roots is meant.
    pub near: [f64; 2],
}

/// The stencils of a term, owned by the assembly for one iteration.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Stencils {
    /// One stencil for each history slot.
    pub list: Vec<Stencil>,
    /// Their unknowns.
    pub dofs: Vec<usize>,
}

impl Stencils {
    /// Forgets all stencils and keeps the memory.
    pub fn clear(&mut self) {
        self.list.clear();
        self.dofs.clear();
    }
    /// Adds a stencil.
    pub fn push(&mut self, dofs: impl IntoIterator<Item = usize>, choice: u32) {
        let start = self.dofs.len();
        self.dofs.extend(dofs);
        self.close(start, Stencil { choice, ..Stencil::default() });
    }
    /// Adds a stencil with the choices of another, whose unknowns already stand in [`dofs`](Self::dofs) from `start` on.
    pub fn close(&mut self, start: usize, stencil: Stencil) {
        self.list.push(Stencil { start, len: self.dofs.len() - start, ..stencil });
    }
    /// The rank that owns the chunk which begins with a stencil: that of the first unknown from there on, the first rank where there
    /// is none.
    pub fn owner(&self, first: usize, shares: &Shares) -> usize {
        self.dofs.get(self.list[first].start).map_or(0, |&dof| shares.owner(dof))
    }
    /// Unknowns of a stencil.
    pub fn dofs(&self, stencil: &Stencil) -> &[usize] {
        &self.dofs[stencil.start..stencil.start + stencil.len]
    }
}

/// Where the step to a trial state began, for stencils whose tangents turn and move with the stress that it leads to.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Origin {
    /// They turn with the stress of the trial state, so that the tangent is the derivative of the forces.
    #[default]
    Unknown,
    /// At the accepted state, of which the trial state is the first guess: the stress there.
    Accepted,
    /// At these unknowns: the stress that a linear step from there leads to.
    Step,
}

/// Where a stencil reads and writes: scratch of one thread, reused without allocation.
#[derive(Debug)]
pub struct Local {
    /// Trial values of the stencil's unknowns.
    pub u: Vec<f64>,
    /// Forces on the stencil's unknowns, zeroed before evaluation.
    pub force: Vec<f64>,
    /// Derivative of `force[i]` along `u[j]` at `[i * n + j]`, zeroed before evaluation.
    pub tangent: Vec<f64>,
    /// Whether the tangent is wanted.
    pub wants_tangent: bool,
    /// Stresses over the coordinates of a stencil that bends with which its tangent turns and moves; none for those of the
    /// trial state, with which the tangent is the derivative of the forces.
    pub acting: Option<Coordinates>,
    /// Where the step to the trial unknowns began,
    pub origin: Origin,
    /// and the stencil's unknowns there.
    pub from: Vec<f64>,
    /// Energy stored in the stencil at the trial state, and what it took up over the increment.
    pub energies: Energies,
}

impl Default for Local {
    fn default() -> Self {
        Self {
            u: Vec::new(),
            force: Vec::new(),
            tangent: Vec::new(),
            wants_tangent: false,
            acting: None,
            origin: Origin::Unknown,
            from: Vec::new(),
            energies: Energies::default(),
        }
    }
}

impl Local {
    /// Makes room for a stencil and zeroes its results.
    pub fn reset(&mut self, len: usize) {
        self.force.clear();
        self.force.resize(len, 0.0);
        if self.wants_tangent {
            self.tangent.clear();
            self.tangent.resize(len * len, 0.0);
        }
        self.energies = Energies::default();
    }
}

/// How unevenly a term crept over an increment over which its strain is taken to grow evenly (Zienkiewicz and Cormeau 1974).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Unevenness {
    /// How wrong the largest stress may be, as a part of it, where the strain is prescribed.
    pub stress: f64,
    /// How much the power of creep changed, as a part of it: where the stress is prescribed the strain is wrong by half of that.
    pub power: f64,
}

/// A term of equilibrium: what of it lasts through the run.
pub trait Term: Send + Sync {
    /// The user's name for it.
    fn name(&self) -> &str;
    /// Whether it resists or acts.
    fn role(&self) -> Role {
        Role::Internal
    }
    /// History before the first increment: a slot for each stencil, and perhaps some for the term as a whole behind them.
    fn initial(&self) -> History;
    /// The same where the term is there again after steps that did without it, from `at` on, in a step that ends at `until`.
    ///
    /// # Errors
    /// A [`Failure`] where it cannot begin then.
    fn returned(&self, _accepted: &State, _at: Instant, _until: f64) -> Result<History, Failure> {
        Ok(self.initial())
    }
    /// Adds the forces that the term exerts before the first increment to those on all unknowns, and returns the energy
    /// that it stores then.
    ///
    /// # Errors
    /// A [`Failure`] where the first state cannot be evaluated.
    fn at_start(&self, _forces: &mut [f64]) -> Result<f64, Failure> {
        Ok(0.0)
    }
    /// Opens an attempt at the increment that follows `accepted`. What is derived from the accepted state (gradients,
    /// capture bands, search trees) lives in the returned object and dies with the attempt. `history` is this term's
    /// own lane of it.
    ///
    /// # Errors
    /// A [`Failure`] when the accepted state cannot be continued.
    fn attempt<'a>(
        &'a self,
        accepted: &'a State,
        history: &'a History,
        at: Instant,
    ) -> Result<Box<dyn Attempt + 'a>, Failure>;
    /// Words for a stencil in messages: "cell 12 of body 'tube'".
    fn name_of(&self, stencil: usize) -> String;
    /// Whether its stencils bend within a step, see [`Attempt::kink`]; it may then hold at the end of a step what it did
    /// not hold at its beginning.
    fn bends(&self) -> bool {
        false
    }
    /// Words for motions of all unknowns that meet no stiffness, as far as they move this term, whatever mixture of them the
    /// vectors are: "body 'billet' is free along y".
    fn describe_motions(&self, _motions: &[Vec<f64>]) -> Vec<String> {
        Vec::new()
    }
    /// How unevenly it crept from one history to the other over `dt`.
    fn unevenness(&self, _old: &History, _new: &History, _dt: f64) -> Unevenness {
        Unevenness::default()
    }
    /// Words for a branch in tables; empty when the term has only one.
    fn branches(&self) -> &'static [&'static str] {
        &[]
    }
}

/// A term during one attempt: a pure function of trial unknowns.
pub trait Attempt: Send + Sync {
    /// Whether the stencils are the same whatever the trial unknowns.
    fn is_fixed(&self) -> bool {
        true
    }
    /// Room for the new history of one stencil, for evaluations whose history is thrown away.
    fn scratch(&self, index: usize) -> Vec<f64>;
    /// Groups of unknowns that may couple during the attempt, beyond those of the stencils at the accepted state.
    fn reach(&self, _couplings: &mut Couplings) {}
    /// Lists the stencils at trial unknowns `u`: one for each history slot, in order.
    ///
    /// # Errors
    /// A [`Failure`] when the trial state is inadmissible (a point that jumped through a tool).
    fn stencils(&self, u: &[f64], out: &mut Stencils) -> Result<(), Failure>;
    /// Evaluates stencil number `index` at `local.u`, writes its forces, tangent, energies and new history.
    ///
    /// # Errors
    /// A [`Failure`] when the law or the geometry cannot be evaluated there.
    fn evaluate(&self, index: usize, stencil: &Stencil, new: &mut [f64], local: &mut Local) -> Result<Branch, Failure>;
    /// Evaluates all stencils at trial unknowns `u` and tells of each its unknowns and what came out; new history is thrown away.
    ///
    /// # Errors
    /// As [`stencils`](Self::stencils) and [`evaluate`](Self::evaluate).
    fn each(&self, u: &[f64], tell: &mut dyn FnMut(&[usize], &Local)) -> Result<(), Failure> {
        let (mut stencils, mut local) = (Stencils::default(), Local::default());
        self.stencils(u, &mut stencils)?;
        for (i, stencil) in stencils.list.iter().enumerate() {
            let dofs = stencils.dofs(stencil);
            local.u = dofs.iter().map(|&dof| u[dof]).collect();
            local.reset(dofs.len());
            self.evaluate(i, stencil, &mut self.scratch(i), &mut local)?;
            tell(dofs, &local);
        }
        Ok(())
    }
    /// Adds to `out` the coordinates over which stencil number `index` bends at `u`, the trial values of its unknowns.
    ///
    /// # Errors
    /// As [`evaluate`](Self::evaluate).
    fn kink(&self, _index: usize, _stencil: &Stencil, _u: &[f64], _out: &mut Kinks) -> Result<(), Failure> {
        Ok(())
    }
    /// Improves what the term holds besides the unknowns (multipliers) when the iterations have converged at `u`, and says
    /// whether they must go on. `new` is the term's history there: what of it belongs to no stencil is written now; `taken` is the
    /// energy that the bodies had taken up at the accepted state and have at `u`.
    ///
    /// # Errors
    /// A [`Failure`] when there is no more to improve and it does not suffice.
    fn augment(&mut self, _u: &[f64], _new: &mut History, _taken: [f64; 2]) -> Result<bool, Failure> {
        Ok(false)
    }
    /// Whether from now on stencils that were closed are held so, their law extended along its tangent where they open.
    fn hold(&self, _hold: bool) {}
    /// Whether that held any which is open.
    fn holds(&self) -> bool {
        false
    }
    /// Stresses of a stencil that bends in the accepted state.
    fn before(&self, _stencil: usize) -> Coordinates {
        Coordinates::default()
    }
    /// Stresses of a stencil that bends, at coordinates `y`.
    ///
    /// # Errors
    /// As [`evaluate`](Self::evaluate).
    fn answer(&self, _stencil: usize, _y: &Coordinates) -> Result<Answer, Failure> {
        Ok(Answer::default())
    }
    /// The same of one that is closed and sticks, whatever its shear.
    ///
    /// # Errors
    /// As [`evaluate`](Self::evaluate).
    fn sticking(&self, stencil: usize, y: &Coordinates) -> Result<Answer, Failure> {
        self.answer(stencil, y)
    }
}
