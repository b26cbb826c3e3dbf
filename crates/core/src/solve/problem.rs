//! What is to be solved, and the words for its parts.

use super::newton::NewtonOptions;
use super::observer::IterationRecord;
use super::schedule::Step;
use crate::Failure;
use crate::audit::Audit;
use crate::system::{Attempt, Dofs, Energies, Following, History, Idle, Instant, Role, State, Term, Unknown, Whole};
use std::ops::Range;
use std::sync::Arc;

/// What is to be solved: terms, numbering, steps.
pub struct Problem {
    /// The terms of equilibrium.
    pub terms: Vec<Arc<dyn Term>>,
    /// Those of them that are contacts.
    pub contacts: Range<usize>,
    /// Those of them that steps may do without.
    pub removable: Range<usize>,
    /// The numbering of the unknowns.
    pub dofs: Dofs,
    /// The steps.
    pub steps: Vec<Step>,
    /// Options of the iterations.
    pub newton: NewtonOptions,
    /// Size of the model, a length.
    pub size: f64,
    /// Size of its smallest cell, a length: the measure of perturbations.
    pub cell_size: f64,
    /// What of the mesh hangs together.
    pub wholes: Vec<Whole>,
    /// The independent check of every increment, if it is wanted.
    pub audit: Option<Audit>,
    /// Names of the tools, and of the rigid groups behind them.
    pub tools: Vec<String>,
    /// Nodes that follow tools as rigid bodies.
    pub following: Arc<Following>,
    /// Names a node in messages: its number and group.
    pub node_name: Box<dyn Fn(usize) -> String + Send + Sync>,
}

impl Problem {
    /// Whether a contact bears in a state with these energies of the terms: what it holds may let go, and snap to and fro.
    pub(super) fn contact_bears(&self, energies: &[Energies]) -> bool {
        self.terms.iter().zip(energies).any(|(term, energies)| term.bends() && energies.stored > 0.0)
    }

    /// The state before the first increment.
    pub fn initial_state(&self) -> State {
        let count = self.dofs.count();
        let histories: Vec<_> = self.terms.iter().map(|term| term.initial()).collect();
        let mut internal = vec![0.0; count];
        // A first state that cannot be evaluated is told by the first attempt.
        let stored: Vec<f64> = self.terms.iter().map(|term| term.at_start(&mut internal).unwrap_or(0.0)).collect();
        State {
            u: vec![0.0; count],
            last_change: vec![0.0; count],
            step_start: vec![0.0; count],
            internal,
            load: vec![0.0; count],
            external_work: stored.iter().sum(),
            unresolved_work: 0.0,
            energies: stored.iter().map(|&stored| Energies { stored, ..Energies::default() }).collect(),
            next_dt: self.steps.first().map_or(0.0, |s| s.increments.first * s.duration),
            histories,
            ..State::default()
        }
    }

    /// Opens all terms at an accepted state, those that the step does without as nothing.
    ///
    /// # Errors
    /// A [`Failure`] of a term that cannot go on from there.
    pub(super) fn open<'a>(&'a self, state: &'a State, at: Instant) -> Result<Vec<Box<dyn Attempt + 'a>>, Failure> {
        let idle = self.steps.get(at.step).map_or(&[][..], |step| &step.idle);
        let open = |(number, (term, history)): (usize, (&'a Arc<dyn Term>, &'a History))| match idle.contains(&number) {
            true => Ok(Box::new(Idle) as Box<dyn Attempt + 'a>),
            false => term.attempt(state, history, at),
        };
        self.terms.iter().zip(&state.histories).enumerate().map(open).collect()
    }

    /// Whether a state read from elsewhere is one of this problem.
    ///
    /// # Errors
    /// What does not fit, in words.
    pub fn fits(&self, state: &State) -> Result<(), String> {
        let own = self.initial_state();
        let lengths = |s: &State| [&s.u, &s.last_change, &s.step_start, &s.internal, &s.load].map(Vec::len);
        let same_slots = |(a, b): (&History, &History)| a.starts == b.starts && a.data.len() == b.data.len();
        let same_histories =
            own.histories.len() == state.histories.len() && own.histories.iter().zip(&state.histories).all(same_slots);
        let bent = state.bend.is_empty() || state.bend.len() == state.u.len();
        if lengths(&own) != lengths(state) || !bent || !same_histories || own.energies.len() != state.energies.len() {
            return Err("this state belongs to another model".into());
        }
        let of_terms = |(term, forces): &(usize, Vec<(usize, f64)>)| {
            self.removable.contains(term) && forces.iter().all(|(dof, _)| *dof < state.u.len())
        };
        if !state.leaving.iter().all(of_terms) || !(state.handed.is_empty() || state.handed.len() == state.u.len()) {
            return Err("the forces that leave with terms of this state belong to another model".into());
        }
        if state.step > self.steps.len() || !state.next_dt.is_finite() {
            return Err("this state stands outside the steps of the model".into());
        }
        if !state.signs.iter().all(|signs| signs.step < self.steps.len() && signs.time <= state.time) {
            return Err("the signs of this state belong to another model".into());
        }
        if !state.softest.iter().all(|softest| softest.step < self.steps.len()) {
            return Err("the softest mode of this state belongs to another model".into());
        }
        if !state.preconditioner.iter().all(|held| held.fits(&self.dofs)) {
            return Err("the matrix of this state belongs to another model".into());
        }
        Ok(())
    }

    /// Words for an unknown: "node 12 of 'bore' along y".
    pub fn name_of(&self, dof: usize) -> String {
        let axis = |axis: usize| ["x", "y", "z"][axis];
        let tool = |tool: usize| self.tools.get(tool).map_or("", String::as_str);
        match self.dofs.describe(dof) {
            Unknown::Node(node, a) => format!("{} along {}", (self.node_name)(node), axis(a)),
            Unknown::ToolTranslation(t, a) => format!("tool '{}' along {}", tool(t), axis(a)),
            Unknown::ToolRotation(t, a) => format!("tool '{}' about {}", tool(t), axis(a)),
        }
    }

    /// Whether increments that fail may be relaxed. Without contact only what is moved: that a load has no equilibrium nearby
    /// is its limit, which is to be told.
    pub(super) fn relaxes(&self) -> bool {
        let loaded = self.terms.iter().any(|term| term.role() == Role::Load);
        self.newton.relax && (!loaded || self.terms.iter().any(|term| term.bends()))
    }

    /// How many contact points were open, stuck and slipping in an iteration, over all terms that know these words.
    pub fn points_by_status(&self, iteration: &IterationRecord) -> [usize; 3] {
        let terms = || self.terms.iter().zip(&iteration.branches);
        ["open", "stick", "slip"].map(|word| {
            let place = |term: &Arc<dyn Term>| term.branches().iter().position(|name| *name == word);
            terms().filter_map(|(term, counts)| counts.get(place(term)?).copied()).sum()
        })
    }

    /// Words for motions of all unknowns, in any mixture: what moves, and how.
    pub(super) fn name_motions(&self, motions: &[Vec<f64>]) -> Vec<String> {
        let mut named: Vec<String> = self.terms.iter().flat_map(|term| term.describe_motions(motions)).collect();
        let bodies = self.dofs.nodes() * self.dofs.per_node();
        let of_a_tool = |motion: &&Vec<f64>| largest(motion).is_some_and(|dof| dof >= bodies);
        named.extend(motions.iter().filter(of_a_tool).map(|motion| self.name_of_largest(motion)));
        if named.is_empty() {
            named.extend(motions.iter().map(|motion| self.name_of_largest(motion)));
        }
        named.sort();
        named.dedup();
        named
    }

    pub(super) fn name_of_largest(&self, motion: &[f64]) -> String {
        largest(motion).map_or_else(|| "the model".into(), |dof| format!("{} is free", self.name_of(dof)))
    }
}

/// The unknown that moves most.
pub(super) fn largest(motion: &[f64]) -> Option<usize> {
    (0..motion.len()).max_by(|&a, &b| motion[a].abs().total_cmp(&motion[b].abs()))
}
