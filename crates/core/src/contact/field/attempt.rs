//! The field during one attempt: who sees whom, and what its solver asks of it.

mod before;
mod converged;
mod node;

use super::configuration::Configuration;
use super::contact::{FieldContact, FieldTarget};
use super::corner::Pointing;
use super::cover::Patch;
use super::linear::Linear;
use super::nearer::Nearer;
use super::stencil::{COUNT, NodeSums, StencilInPlace};
use super::support::FieldSearch;
use super::tip::TipFoot;
use crate::Failure;
use crate::contact::record::{entry, stresses};
use crate::interface::{Interface, Past};
use crate::system::{
    Answer, Attempt, Branch, Coordinates, Couplings, History, Instant, Kinks, Local, Stencil, Stencils,
};
use std::cell::RefCell;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError, RwLock};

thread_local! {
    static SUMS: RefCell<NodeSums> = RefCell::default();
}

/// A field during one attempt.
pub struct FieldAttempt<'a> {
    /// The contact.
    pub contact: &'a FieldContact,
    /// The law at its end.
    pub law: Arc<dyn Interface>,
    /// Its history in the accepted state.
    pub history: &'a History,
    /// Accepted unknowns.
    pub accepted: &'a [f64],
    /// The accepted configuration.
    pub before: Configuration<'a>,
    /// Where the tips of the tool lay in it.
    pub tips_before: Vec<Option<TipFoot>>,
    /// How corners of bodies touch.
    pub pointings: Vec<Pointing>,
    /// Largest admissible penetration at each face.
    pub depths: Vec<f64>,
    /// Largest shares of dual functions at each node.
    pub duals: Vec<[f64; 2]>,
    /// Largest gap at which the target is seen.
    pub reach: f64,
    /// Unknowns that the last increment, carried on, leads to: a guess of what will couple.
    pub ahead: Vec<f64>,
    /// How much nearer the target lies than in the mean, slot by slot.
    pub nearer: Vec<Nearer>,
    /// How much deeper closed nodes lie by the arcs of the accepted state than by those of the one before it, slot by slot; none over flat faces.
    pub redrawn: Vec<f64>,
    /// Closure and slips that multipliers stand for, slot by slot.
    pub shifts: Vec<[f64; COUNT]>,
    /// How often they were improved in the attempt,
    pub augmented: usize,
    /// and the penetration that the last improvement with the same penalty began from.
    pub before_augmented: f64,
    /// When it ends.
    pub at: Instant,
    /// Normal penalty of the attempt,
    pub normal: f64,
    /// whether that was changed in it,
    pub stiffened: bool,
    /// and the tangential ones, slot by slot.
    pub tangential: Vec<f64>,
    /// What the last search found.
    pub found: RwLock<Arc<FieldSearch>>,
    /// How the coordinates of closed nodes changed and what forces their stresses were where they were evaluated last.
    pub linear: Vec<Mutex<Linear>>,
    /// Bonds that hold whatever they bear until the state has converged, slot by slot.
    pub bonds: Vec<bool>,
    /// Nodes that leave the stress to others of their faces, slot by slot.
    pub idle: Vec<bool>,
    /// Whether any node bore a pressure at the accepted state: one that closes then takes over from others what slides all the while.
    pub bore: bool,
    /// Whether the shares of corners and tips are those of a state that bears,
    pub shared: bool,
    /// and that state, where it is not the accepted one that says what corners of the surface take.
    pub taking: Option<Configuration<'a>>,
    /// Gap from which on a node is too far away to close in the next iteration.
    pub far: f64,
    /// Length of the increment over that of the last; zero without one.
    pub part: f64,
    /// Whether this is the first guess, which holds nodes closed,
    pub hold: AtomicBool,
    /// and whether it held any that is open there.
    pub held: AtomicBool,
}

impl FieldAttempt<'_> {
    /// The configuration at unknowns `u`, with the arcs of the accepted one.
    fn in_place(&self, u: &[f64]) -> Configuration<'_> {
        Configuration::with(self.contact, u, self.before.arcs.clone())
    }

    fn search(&self, u: &[f64]) -> FieldSearch {
        let now = Configuration { duals: &self.duals, ..self.in_place(u) };
        let tips = now.tips(self.contact.longest, Some(&self.tips_before), |foot| self.foot_before(foot), None);
        let list_touched =
            |now: &Configuration, patch: &Patch, nodes: &mut Vec<usize>| self.list_touched(now, patch, nodes);
        let mut found = self.contact.find(
            (&now, tips, &self.pointings, &|patch| self.taking.as_ref().unwrap_or(&self.before).taken(patch)),
            self.reach,
            (&self.depths, (&self.before, self.accepted)),
            Some(self.history),
            list_touched,
        );
        for (slot, support) in found.supports.iter_mut().enumerate() {
            let pressed = self.history.slot(slot)[entry::PRESSURE] > 0.0;
            if let Some(node) = self.contact.node_of(slot).filter(|_| pressed && support.patches.is_empty()) {
                support.parted = now.parted(node, slot % self.contact.pieces);
                support.slid = self.slid_out_of_sight(slot, node, &now);
            }
        }
        found
    }

    fn stencil<'s>(&'s self, found: &'s FieldSearch, slot: usize, u: &'s [f64]) -> StencilInPlace<'s> {
        StencilInPlace::new(self.contact, (found, slot), u)
    }

    /// The sums of a node; None where it sees nothing.
    fn sum(&self, stencil: &StencilInPlace, derivatives: bool, sums: &mut NodeSums) -> Option<()> {
        if !stencil.sees() {
            return None;
        }
        stencil.sum((&|at, patch, xi| self.recall(at, patch, xi), self.carried(stencil)), derivatives, sums)
    }

    fn found(&self) -> Arc<FieldSearch> {
        self.found.read().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl Attempt for FieldAttempt<'_> {
    fn is_fixed(&self) -> bool {
        false
    }

    fn scratch(&self, index: usize) -> Vec<f64> {
        vec![0.0; self.history.slot(index).len()]
    }

    fn reach(&self, couplings: &mut Couplings) {
        let mut stencils = Stencils::default();
        self.list(&self.ahead, &mut stencils);
        stencils.list.iter().for_each(|stencil| couplings.push(stencils.dofs(stencil)));
    }

    fn stencils(&self, u: &[f64], out: &mut Stencils) -> Result<(), Failure> {
        let found = self.list(u, out);
        self.linear.iter().for_each(|linear| linear.lock().unwrap_or_else(PoisonError::into_inner).u.clear());
        *self.found.write().unwrap_or_else(PoisonError::into_inner) = Arc::new(found);
        Ok(())
    }

    fn evaluate(&self, index: usize, _: &Stencil, new: &mut [f64], local: &mut Local) -> Result<Branch, Failure> {
        let (found, u) = (self.found(), std::mem::take(&mut local.u));
        let stencil = self.stencil(&found, index, &u);
        let branch = SUMS.with_borrow_mut(|sums| self.evaluate_node(index, &stencil, new, (local, sums)));
        local.u = u;
        branch
    }

    fn kink(&self, index: usize, _: &Stencil, u: &[f64], out: &mut Kinks) -> Result<(), Failure> {
        let found = self.found();
        let stencil = self.stencil(&found, index, u);
        let mut linear = self.linear[index].lock().unwrap_or_else(PoisonError::into_inner);
        if linear.u == u {
            linear.tell(self.contact.coordinates(), out);
            return Ok(());
        }
        SUMS.with_borrow_mut(|sums| {
            if self.idle[index] || self.sum(&stencil, false, sums).is_none() || sums.y[0] < -self.far {
                return;
            }
            self.sum(&stencil, true, sums);
            stencil.find_forces(sums);
            let y = [sums.y[0] + self.closure(index), sums.y[1], sums.y[2]];
            linear.keep(u, y, stencil.stretch().0, sums);
            linear.tell(self.contact.coordinates(), out);
        });
        Ok(())
    }

    fn before(&self, stencil: usize) -> Coordinates {
        stresses(self.history.slot(stencil))
    }

    fn answer(&self, stencil: usize, y: &Coordinates) -> Result<Answer, Failure> {
        let stretch = self.found.read().unwrap_or_else(PoisonError::into_inner).supports[stencil].stretch;
        let past = self.past(stencil, stretch);
        let lift = self.lift(stencil, &past, [y[0], y[1], y[2]]);
        Ok(self.extended(stencil, self.answer_of((stencil, &past), &[y[0] + lift, y[1], y[2], y[3]])?, lift))
    }

    fn sticking(&self, stencil: usize, y: &Coordinates) -> Result<Answer, Failure> {
        let stretch = self.found.read().unwrap_or_else(PoisonError::into_inner).supports[stencil].stretch;
        let (past, still) = (self.past(stencil, stretch), [y[0], 0.0, 0.0, y[3]]);
        let mut answer = self.answer_of((stencil, &Past { shear: [0.0; 2], ..past }), &still)?;
        if answer.slopes[1][1] == 0.0 {
            return self.answer(stencil, y);
        }
        for (c, shear) in past.shear.iter().enumerate() {
            answer.stress[c + 1] = shear + answer.slopes[c + 1][1] * y[1] + answer.slopes[c + 1][2] * y[2];
        }
        Ok(answer)
    }

    fn hold(&self, hold: bool) {
        self.hold.store(hold, Ordering::Relaxed);
        self.held.store(false, Ordering::Relaxed);
    }

    fn holds(&self) -> bool {
        self.held.load(Ordering::Relaxed)
    }

    /// Takes what converged nodes still penetrate and slip into their multipliers, unless that suffices (Simo & Laursen,
    /// Comput. Struct. 42, 1992).
    fn augment(&mut self, u: &[f64], new: &mut History, taken: [f64; 2]) -> Result<bool, Failure> {
        self.refuse_passage(u, new)?;
        let goes_on =
            self.break_bonds(new)? || self.share_anew(u, new) || self.yield_tips(u) || self.improve(new, taken)?;
        if !goes_on {
            self.wear_beneath_tips(new);
        }
        Ok(goes_on)
    }
}

impl FieldAttempt<'_> {
    /// Lists the stencils of all nodes at unknowns `u`.
    fn list(&self, u: &[f64], out: &mut Stencils) -> FieldSearch {
        let found = self.search(u);
        for support in &found.supports {
            let start = out.dofs.len();
            let choice =
                support.patches.first().map_or(0, |&(number, _)| found.patches[number].patch.target as u32 + 1);
            if choice > 0 {
                let dofs = &self.contact.parts.dofs;
                out.dofs.extend(support.nodes.iter().flat_map(|&node| dofs.displacements(node)));
                if let FieldTarget::Tool(rigid) = &self.contact.parts.target {
                    out.dofs.extend(rigid.unknowns());
                }
            }
            out.close(start, Stencil { choice, ..Stencil::default() });
        }
        found
    }
}
